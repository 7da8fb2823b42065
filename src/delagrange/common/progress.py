"""A progress bar on standard error, or none."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Progress:
    """Where a task reports how far it has come; `bar` is None when nobody looks."""

    bar: Any = None
    task: Any = None

    def advance_to(self, done: float) -> None:
        """Show `done`, in the unit of the total."""
        if self.bar is not None:
            self.bar.update(self.task, completed=done)


@contextmanager
def progress_bar(shown: bool, description: str, total: float, unit: str) -> Iterator[Progress]:
    """A bar from 0 to `total`, drawn on standard error while the block runs."""
    if not shown:
        yield Progress()
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.4g} of {task.total:.4g} " + unit),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(stderr=True)) as bar:
        yield Progress(bar, bar.add_task(description, total=total))


@contextmanager
def working(shown: bool, description: str) -> Iterator[None]:
    """A line on standard error that says what is going on while the block runs, and goes with it."""
    if not shown:
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(description):
        yield
