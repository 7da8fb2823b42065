"""Where tables are printed. Colours follow NO_COLOR and whether anybody can see them."""

from __future__ import annotations

import os
import sys
from typing import Any

from rich import box
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

_PIPED_WIDTH = 120  # columns, where no terminal gives a width


def output() -> Console:
    """Standard output."""
    known = sys.stdout.isatty() or "COLUMNS" in os.environ
    return Console(highlight=False, width=None if known else _PIPED_WIDTH)


def messages(quiet: bool = False) -> Console:
    """Standard error, for what is not a result."""
    return Console(stderr=True, highlight=False, quiet=quiet)


class PlainTable(Table):
    """A table that shows every text as it stands: a unit in brackets, like [kg], is no markup."""

    def add_row(self, *cells: RenderableType | None, **options: Any) -> None:
        """As of any table of rich."""
        super().add_row(*(Text(cell) if isinstance(cell, str) else cell for cell in cells), **options)


def table(*headings: str) -> Table:
    """An empty table in the style of all tables, tight enough for 80 columns."""
    empty = PlainTable(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for heading in headings:
        empty.add_column(Text(heading), overflow="fold")
    return empty


def show(title: str, filled: Table) -> None:
    """Print a table under its title."""
    console = output()
    console.print(Text(title, style="bold"))
    console.print(filled)


def complain(text: str) -> None:
    """Name a failed check on standard error."""
    messages().print(Text(text, style="bold red"), soft_wrap=True)
