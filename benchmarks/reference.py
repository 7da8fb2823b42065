"""Amplitudes at the limit of double precision, by an integrator that is not ours, kept in a file.

heyoka at tolerance 1e-16; extrema from its continuous output, by bisection of the rate's polynomial in each part of
a step in which it changes sign. Other code than any contestant's.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path

import numpy as np

import delagrange
from benchmarks import heyoka_system as hs
from benchmarks.cases import Case

TOLERANCE = 1e-16
METHOD = (
    "heyoka, tolerance 1e-16, every turn of the continuous output by bisection; 1"  # the number: a new method
)
_PARTS = 4  # of a step, in each of which at most one turn is looked for
_HALVINGS = 52


def reference(case: Case, folder: Path, say=lambda text: print(text, file=sys.stderr)) -> np.ndarray:
    """Amplitudes [1] of all runs, (n_runs,), from the file in `folder` or computed and put there."""
    path = folder / f"reference_{case.name}_{digest(case)}.npz"
    if path.is_file():
        with np.load(path) as kept:
            return kept["amplitude"]
    say(f"reference of {case.name}: {len(case.runs)} runs")
    found = compute(case, np.arange(len(case.runs)))
    folder.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".unfinished.npz")
    np.savez_compressed(unfinished, amplitude=found)
    unfinished.replace(path)
    return found


def digest(case: Case) -> str:
    """Of all that the reference depends on."""
    import heyoka

    runs = case.runs
    content = [
        METHOD, heyoka.__version__, TOLERANCE, hs.TUNED.time_unit, case.model, case.duration,
        [[str(symbol), str(slope)] for symbol, slope in hs.system(case.model, hs.TUNED)],
        [values.tolist() for values in (runs.force, runs.field_amplitude, runs.frequency)],
    ]  # fmt: skip
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()[:16]


def compute(case: Case, places: np.ndarray) -> np.ndarray:
    """Amplitudes [1] of some of the runs, (n_places,)."""
    runs = case.runs.take(places)
    one, rest = hs.integrator(case.model, hs.TUNED, TOLERANCE), hs.initial_state(case.model, hs.TUNED)
    rate = delagrange.load_model(case.model).COORDINATE_COUNT
    found = []
    for parameters in hs.batches(runs):
        hs.start(one, rest, parameters)
        output = one.propagate_for(hs.written_duration(case, hs.TUNED), c_output=True)[0]
        found += [_amplitude(output, rate, lane) for lane in range(hs.BATCH)]
    return np.array(found)[: len(runs)]


def _amplitude(output, rate: int, lane: int) -> float:
    steps = np.diff(output.times[:, lane])
    moved = steps > 0  # a lane that has arrived waits for the others in steps of zero
    values, rates = output.tcs[moved, 0, :, lane].T, output.tcs[moved, rate, :, lane].T
    steps = steps[moved]
    turns = _turns(values, rates, steps)
    ends = _polynomial(values, steps)
    found = np.concatenate([values[0], ends, turns])
    return float(found.max() - found.min()) / 2


def _turns(values: np.ndarray, rates: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Values where the rate changes sign; polynomials (order + 1, n_steps), steps (n_steps,)."""
    bounds = np.linspace(0.0, 1.0, _PARTS + 1)[:, None] * steps
    signs = np.array([_polynomial(rates, time) > 0 for time in bounds])
    part, step = np.nonzero(signs[1:] != signs[:-1])
    low, high, rising = bounds[part, step], bounds[part + 1, step], signs[part, step]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        before = (_polynomial(rates[:, step], middle) > 0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return _polynomial(values[:, step], low)


def _polynomial(coefficients: np.ndarray, time: np.ndarray) -> np.ndarray:
    total = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        total = total * time + coefficient
    return total
