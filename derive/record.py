"""The recorded verdicts: what the check found when it was last looked at by a person."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib import resources
from typing import Any

from delagrange.derive.printer import PAPER_TEXT
from delagrange.derive.verdict import Outcome, Verdict

RECORD = "sheng_2015_verdicts.json"


def as_record(verdict: Verdict) -> dict[str, Any]:
    """A verdict as JSON can hold it."""
    scaled = verdict.outcome is Outcome.SCALED
    fields = asdict(verdict) | {"factor": PAPER_TEXT(verdict.factor) if scaled else ""}
    return {
        name: list(value) if isinstance(value, tuple) else str(value)
        for name, value in fields.items()
        if value
    }


def to_json(verdicts: tuple[Verdict, ...]) -> str:
    return json.dumps([as_record(verdict) for verdict in verdicts], ensure_ascii=False, indent=1) + "\n"


def recorded() -> list[dict[str, Any]]:
    """The record that stands beside the printed equations."""
    return json.loads(
        resources.files("delagrange.derive.published").joinpath(RECORD).read_text(encoding="utf-8")
    )


def departures(verdicts: tuple[Verdict, ...], record: list[dict[str, Any]]) -> tuple[str, ...]:
    """What differs from the record, a line each; empty where nothing does."""
    now = {(v.number, v.model): as_record(v) for v in verdicts}
    then = {(entry["number"], entry["model"]): entry for entry in record}
    lines = []
    for key in (*now, *(key for key in then if key not in now)):
        found, expected = now.get(key), then.get(key)
        if found != expected:
            lines.append(
                f"Eq. ({key[0]}) against {key[1]}: found {_brief(found)}, recorded {_brief(expected)}"
            )
    return tuple(lines)


def _brief(entry: dict[str, Any] | None) -> str:
    if entry is None:
        return "nothing"
    return "; ".join(
        str(value) for name, value in entry.items() if name not in ("number", "model", "quantity")
    )
