"""What the reproduction found when a person last looked: numbers and answers, and how far a run departs."""

from __future__ import annotations

import json
from importlib import resources
from math import isclose
from pathlib import Path
from typing import Any

from delagrange.reproduction.claims.numbers import Comparison, Found
from delagrange.reproduction.claims.statements import Judgement

RECORD = "found.json"
SAME_ACCURATE = 1e-6  # relative, of amplitudes: other processors may round otherwise
SAME_ROUGH = 1e-3  # at rtol 1e-3 rounding shows more


def _found(found: Found) -> dict[str, float]:
    return {"frequency": found.frequency, "amplitude": found.amplitude, "lost": found.lost}


def as_record(comparisons: tuple[Comparison, ...], judgements: tuple[Judgement, ...]) -> dict[str, Any]:
    """Numbers and answers by name, as JSON can hold them."""
    numbers = {
        f"Fig. {c.peak.figure}{c.peak.panel}, {c.formulation or c.model}, {c.peak.load}": {
            "accurate": _found(c.accurate),
            "like_paper": _found(c.paper_numerics),
        }
        for c in comparisons
    }
    answers = {
        f"Fig. {j.statement.figure}, {j.statement.model}: {j.statement.text}": j.answer for j in judgements
    }
    return {"numbers": numbers, "answers": answers}


def recorded() -> dict[str, Any]:
    """The record that is checked in."""
    return json.loads(resources.files("delagrange.reproduction").joinpath(RECORD).read_text(encoding="utf-8"))


def write(record: dict[str, Any], folder: Path) -> None:
    """Write a record as `found.json`, for a person to compare and to check in."""
    text = json.dumps(record, ensure_ascii=False, indent=1) + "\n"
    (folder / RECORD).write_text(text, encoding="utf-8")


def departures(found: dict[str, Any], record: dict[str, Any]) -> tuple[str, ...]:
    """What differs from the record, a line each; empty where nothing does."""
    lines = []
    for kind, same in (("numbers", _same_numbers), ("answers", lambda a, b: a == b)):
        for name in dict.fromkeys((*found[kind], *record[kind])):
            now, then = found[kind].get(name), record[kind].get(name)
            if now is None or then is None or not same(now, then):
                lines.append(f"{name}: found {now}, recorded {then}")
    return tuple(lines)


def _same_numbers(now: dict[str, Any], then: dict[str, Any]) -> bool:
    return all(
        now[numerics]["frequency"] == then[numerics]["frequency"]
        and isclose(now[numerics]["amplitude"], then[numerics]["amplitude"], rel_tol=tolerance)
        for numerics, tolerance in (("accurate", SAME_ACCURATE), ("like_paper", SAME_ROUGH))
    )
