"""Verdicts as a table for people."""

from __future__ import annotations

import textwrap
from itertools import takewhile

from delagrange.derive.check.verdict import Outcome, Verdict

HEADINGS = ("Eq.", "states", "derivation", "verdict", "detail")


def _quoted(latex: tuple[str, ...]) -> str:
    return " | ".join(f"`{term}`" for term in latex)


def _mended(correction: str) -> str:
    kind, _, change = correction.partition(": ")
    before, _, after = change.partition(" -> ")
    if kind == "bracket":
        return f"the bracket closes behind `{_beyond(before, after)}`"
    return f"{kind}, `{before}` becomes `{after}`"


def _beyond(before: str, after: str) -> str:
    """What a bracket that closes later takes in, or what one that closes earlier leaves inside."""
    same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(before, after, strict=False)))
    inside, _, _ = after[same:].rpartition(r"\right")
    return inside.strip() or after


def detail(verdict: Verdict) -> str:
    """What a person needs to know beyond the verdict, in one paragraph."""
    parts = []
    if verdict.outcome is Outcome.SCALED:
        parts.append(f"printed = derived x {verdict.factor_text}")
    if verdict.derived:
        parts.append(f"derived: {verdict.derived}")
    if verdict.derived_unmatched:
        parts.append(f"derived, without partner: {' | '.join(verdict.derived_unmatched)}")
    if verdict.printed_unmatched:
        parts.append(f"printed, without partner: {_quoted(verdict.printed_unmatched)}")
    if verdict.corrections:
        parts.append(f"one edit mends it: {_mended(verdict.corrections[0])}")
    if verdict.unit_faults:
        parts.append(f"units: {' | '.join(verdict.unit_faults)}")
    if verdict.note:
        parts.append(verdict.note)
    return ". ".join(parts)


def rows(verdicts: tuple[Verdict, ...]) -> tuple[tuple[str, ...], ...]:
    """One row a verdict, in the order of `HEADINGS`."""
    return tuple(
        (f"({v.number})", v.quantity.replace("_", " "), v.model, str(v.outcome), detail(v)) for v in verdicts
    )


def as_text(verdicts: tuple[Verdict, ...], width: int = 110) -> str:
    """A plain table; the detail of each row stands folded below it."""
    table = rows(verdicts)
    columns = [max(len(row[k]) for row in (HEADINGS, *table)) for k in range(4)]
    lines = [
        "  ".join(heading.ljust(size) for heading, size in zip(HEADINGS[:4], columns, strict=True)).rstrip()
    ]
    lines.append("  ".join("-" * size for size in columns))
    for row in table:
        lines.append(
            "  ".join(cell.ljust(size) for cell, size in zip(row[:4], columns, strict=True)).rstrip()
        )
        lines.extend(textwrap.wrap(row[4], width, initial_indent="      ", subsequent_indent="      "))
    return "\n".join(lines)


def summary(verdicts: tuple[Verdict, ...]) -> str:
    counts = [(outcome, sum(v.outcome is outcome for v in verdicts)) for outcome in Outcome]
    return ", ".join(f"{count} {outcome}" for outcome, count in counts if count)
