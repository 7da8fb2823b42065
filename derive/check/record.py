"""The recorded verdicts of a paper: what the check found when it was last looked at by a person."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from delagrange.derive.check.verdict import Outcome, Verdict
from delagrange.derive.papers.paper import Paper

RECORD = "verdicts.json"


def as_record(verdict: Verdict) -> dict[str, Any]:
    """A verdict as JSON can hold it."""
    fields = asdict(verdict)
    factor = fields.pop("factor_text")
    fields["factor"] = factor if verdict.outcome is Outcome.SCALED else ""
    return {
        name: list(value) if isinstance(value, tuple) else str(value)
        for name, value in fields.items()
        if value
    }


def to_json(verdicts: tuple[Verdict, ...]) -> str:
    return json.dumps([as_record(verdict) for verdict in verdicts], ensure_ascii=False, indent=1) + "\n"


def record_path(paper: Paper) -> Path:
    """The record stands beside the printed equations."""
    return paper.folder / RECORD


def recorded(paper: Paper) -> list[dict[str, Any]]:
    """The verdicts as they stand in the record of a paper; none of one that was never recorded.

    Raises:
        ValueError: the record cannot be read, is not JSON, or an entry lacks its number or model.
    """
    path = record_path(paper)
    if not path.exists():
        return []
    try:
        return _entries(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ValueError(f"record {path} cannot be read: {reason}") from error


def _entries(found: Any) -> list[dict[str, Any]]:
    if not isinstance(found, list):
        raise ValueError(f"it holds a {type(found).__name__}, where a list of verdicts is allowed")
    for place, entry in enumerate(found, start=1):
        if not (isinstance(entry, dict) and {"number", "model"} <= entry.keys()):
            raise ValueError(f"entry {place} is no verdict with a number and a model")
    return found


def departures(verdicts: tuple[Verdict, ...], record: list[dict[str, Any]]) -> tuple[str, ...]:
    """What differs from the record, a line each; empty where nothing does.

    A number and a model name one verdict: what is found or recorded twice is a departure as well.
    """
    now = {(v.number, v.model): as_record(v) for v in verdicts}
    then = {(entry["number"], entry["model"]): entry for entry in record}
    lines = [
        *_repeated("found", ((v.number, v.model) for v in verdicts)),
        *_repeated("recorded", ((entry["number"], entry["model"]) for entry in record)),
    ]
    for key in (*now, *(key for key in then if key not in now)):
        found, expected = now.get(key), then.get(key)
        if found != expected:
            lines.append(f"{_named(key)}: found {_brief(found)}, recorded {_brief(expected)}")
    return tuple(lines)


def _named(key: tuple[str, str]) -> str:
    return f"Eq. ({key[0]}) against {key[1]}"


def _repeated(how: str, keys: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    return tuple(
        f"{_named(key)}: {how} {count} times, allowed is once"
        for key, count in Counter(keys).items()
        if count > 1
    )


def _brief(entry: dict[str, Any] | None) -> str:
    if entry is None:
        return "nothing"
    return "; ".join(
        str(value) for name, value in entry.items() if name not in ("number", "model", "quantity")
    )
