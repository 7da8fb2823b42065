"""The verdicts as a coloured table, and as Markdown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from delagrange.cli import console

if TYPE_CHECKING:
    from delagrange.derive.check.verdict import Verdict
    from delagrange.derive.pipeline import Derivation

_COLOURS = {"EQUAL": "green", "SCALED": "cyan", "DIFFERS": "red", "MISSING": "dim"}


def colour(verdict: Verdict) -> str:
    """By outcome; where the print differs, yellow if one edit of it mends it, else red."""
    return "yellow" if verdict.corrections else _COLOURS[verdict.outcome.name]


def show(verdicts: tuple[Verdict, ...], details: bool) -> None:
    """Print the table, a line for each equation and derivation; with `details` what differs below it."""
    from delagrange.derive.check.report import summary

    output = console.output()
    console.show("Printed equations against the derived ones", _table(verdicts))
    if details:
        for paragraph in _details(verdicts):
            output.print(paragraph)
    output.print(summary(verdicts))


def _table(verdicts: tuple[Verdict, ...]) -> Table:
    from delagrange.derive.check.report import HEADINGS, rows

    table = console.table(*HEADINGS[:4])
    for verdict, row in zip(verdicts, rows(verdicts), strict=True):
        table.add_row(*row[:3], Text(row[3], style=colour(verdict)))
    return table


def _details(verdicts: tuple[Verdict, ...]) -> Iterable[Text | Padding]:
    from delagrange.derive.check.report import rows

    for verdict, (number, quantity, model, outcome, detail) in zip(verdicts, rows(verdicts), strict=True):
        if detail:
            yield Text.assemble(f"{number} {quantity}, {model}: ", (outcome, colour(verdict)))
            yield Padding(Text(detail), (0, 0, 1, 4), expand=False)


def as_markdown(verdicts: tuple[Verdict, ...], details: bool) -> str:
    """A Markdown table, with the column of details or without."""
    from delagrange.derive.check.report import HEADINGS, rows

    columns = len(HEADINGS) if details else len(HEADINGS) - 1
    lines = [HEADINGS, ("---",) * len(HEADINGS), *rows(verdicts)]
    return "".join(f"| {' | '.join(map(_cell, line[:columns]))} |\n" for line in lines)


def _cell(text: str) -> str:
    """Text that a Markdown table takes as it stands: LaTeX is full of marks that it would read."""
    return "".join(f"\\{mark}" if mark in "\\|*_`<>[]" else mark for mark in text)


def as_recorded(derivation: Derivation) -> bool:
    """Whether all verdicts are the recorded ones; those that are not are named on standard error."""
    lines = derivation.departures
    for line in lines:
        console.complain(f"not as recorded: {line}")
    if not lines:
        console.output().print("[green]all as recorded[/]")
    return not lines
