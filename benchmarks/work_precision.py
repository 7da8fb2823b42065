"""Work and precision of all contestants on one case."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.accuracy import errors
from benchmarks.cases import Case, spread
from benchmarks.contestant import Contestant
from benchmarks.timing import Timed, interleaved


@dataclass(frozen=True)
class Entry:
    """A contestant at a tolerance, ready to be timed."""

    contestant: Contestant
    tolerance: float
    places: np.ndarray  # of the runs that are timed
    task: Timed


def prepared(case: Case, contestants: Sequence[Contestant], repeats: int, every: int = 1) -> list[Entry]:
    """All contestants at every n-th of their tolerances; `repeats`, at least 2, are those of the fast ones."""
    entries = []
    for contestant in contestants:
        print(f"{case.name}: preparing {contestant.label}", file=sys.stderr)
        places = spread(len(case.runs), contestant.subset, contestant.group)
        count = repeats if contestant.repeats is None else min(repeats - 1, contestant.repeats)
        for tolerance in contestant.tolerances[::every]:
            task = Timed(contestant.prepare(case, places, tolerance), count)
            entries.append(Entry(contestant, tolerance, places, task))
    return entries


def measure(
    case: Case, entries: Sequence[Entry], reference: np.ndarray, keep: Callable[[dict], None]
) -> dict[str, object]:
    """Time all entries, interleaved; `keep` is given what there is each time that an entry has been timed.

    Returns:
        JSON: what the runs are, and for each contestant its points (tolerance, errors [1], times [s] of all runs).
    """
    frequency = case.frequency
    grid = {"first_frequency": frequency[0], "last_frequency": frequency[-1], "frequencies": len(frequency)}
    found = {"runs": len(case.runs), "duration": case.duration, **grid, "contestants": _empty(case, entries)}
    for number, (place, time, amplitude) in enumerate(interleaved([entry.task for entry in entries]), 1):
        entry = entries[place]
        series = found["contestants"][entry.contestant.name]
        point = series["points"][_key(entry.tolerance)]
        point["times"].append(time * len(case.runs) / len(entry.places))
        if entry.contestant.accuracy_of is None:
            point |= _accuracy(amplitude, reference[entry.places])
        print(
            f"{case.name} {number}: {entry.contestant.label} {entry.tolerance:g} {time:.3g} s",
            file=sys.stderr,
        )
        _lend_errors(found["contestants"])
        keep(found)
    return found


def _accuracy(amplitude: np.ndarray, reference: np.ndarray) -> dict[str, float | None]:
    """Errors [1], None where a run was lost, and how many were."""
    both = [error if math.isfinite(error) else None for error in errors(amplitude, reference)]
    return {"rms_error": both[0], "maximum_error": both[1], "lost": int(np.isnan(amplitude).sum())}


def _empty(case: Case, entries: Sequence[Entry]) -> dict[str, dict]:
    found: dict[str, dict] = {}
    for entry in entries:
        one = entry.contestant
        about = {"label": one.label, "method": one.method, "timed_runs": len(entry.places), "points": {}}
        about["notes"] = list(one.notes)
        series = found.setdefault(one.name, about | {"accuracy_of": one.accuracy_of})
        series["points"][_key(entry.tolerance)] = {"times": []}
    return found


def _key(tolerance: float) -> str:
    return f"{tolerance:g}"


def _lend_errors(contestants: dict[str, dict]) -> None:
    """A contestant without amplitudes has the errors of the one it names, at equal tolerance."""
    for series in contestants.values():
        lender = contestants.get(series["accuracy_of"] or "")
        for key, point in series["points"].items() if lender else ():
            lent = lender["points"].get(key, {})
            point.update(
                {name: lent[name] for name in ("rms_error", "maximum_error", "lost") if name in lent}
            )
