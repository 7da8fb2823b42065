"""heyoka.py in batches of eight, with two ways to its extrema, and without.

The ways: a callback after each step, compiled by Numba, on the step's Taylor coefficients; heyoka's own events where
the rate passes zero. A third, its dense output on an even grid (`propagate_grid`) and Hermite polynomials of degree
11 through that, was as fast as the first at an error of 1e-4 and slower below. Only the first coordinate is measured.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import delagrange
from benchmarks import heyoka_system as hs
from benchmarks.cases import Case
from benchmarks.contestant import Contestant, Run

_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14)
Measure = Callable[[], np.ndarray]  # integrates the batch that the integrator stands at: amplitudes, (BATCH,)


def _rate_place(case: Case) -> int:
    return delagrange.load_model(case.model).COORDINATE_COUNT


def _by_steps(case: Case, one) -> Measure:
    from benchmarks.step_extrema import step_callback

    rate, duration = _rate_place(case), hs.scaled_duration(case)
    coefficients, step, state = one.tc, one.last_h, one.state  # views, written anew by each step
    maximum, minimum = np.empty(hs.BATCH), np.empty(hs.BATCH)
    after_step = step_callback(coefficients, step, state, rate, maximum, minimum)

    def measure() -> np.ndarray:
        maximum[:] = minimum[:] = state[0]
        one.propagate_for(duration, callback=after_step, write_tc=True)
        return (np.maximum(maximum, state[0]) - np.minimum(minimum, state[0])) / 2

    return measure


def _without(case: Case, one) -> Measure:
    duration = hs.scaled_duration(case)

    def measure() -> np.ndarray:
        one.propagate_for(duration)
        return np.full(hs.BATCH, np.nan)

    return measure


def _run_batches(case: Case, places: np.ndarray, one, measure: Measure) -> np.ndarray:
    runs = case.runs.take(places)
    rest = hs.initial_state(case.model)
    found = []
    for parameters in hs.batches(runs):
        hs.start(one, rest, parameters)
        found.append(measure())
    return np.concatenate(found)[: len(runs)]


def _preparation(way: Callable[[Case, object], Measure]):
    def prepare(case: Case, places: np.ndarray, tolerance: float) -> Run:
        one = hs.integrator(case.model, tolerance)
        measure = way(case, one)
        _run_batches(case, places[:1], one, measure)  # compiles the measure
        return lambda: _run_batches(case, places, one, measure)

    return prepare


def _prepare_events(case: Case, places: np.ndarray, tolerance: float) -> Run:
    """The events are part of the integrator, and tell the batch's extrema as they come."""
    import heyoka

    maximum, minimum = np.empty(hs.BATCH), np.empty(hs.BATCH)

    def turning(one, time: float, direction: int, lane: int) -> None:
        one.update_d_output(np.full(hs.BATCH, time))
        value = one.d_output[0, lane]
        maximum[lane] = max(maximum[lane], value)
        minimum[lane] = min(minimum[lane], value)

    rate = hs.system(case.model)[_rate_place(case)][0]
    one = hs.integrator(case.model, tolerance, nt_events=[heyoka.nt_event_batch(rate, turning)])
    duration = hs.scaled_duration(case)

    def measure() -> np.ndarray:
        maximum[:] = minimum[:] = one.state[0]
        one.propagate_for(duration)
        return (np.maximum(maximum, one.state[0]) - np.minimum(minimum, one.state[0])) / 2

    return lambda: _run_batches(case, places, one, measure)


_BATCHES = "heyoka.py, taylor_adaptive_batch of eight runs, "
HEYOKA = Contestant(
    "heyoka", "heyoka", _BATCHES + "extrema from the Taylor coefficients of each step in a compiled step callback",
    ("heyoka", "numba"), _TOLERANCES, _preparation(_by_steps),
)  # fmt: skip
HEYOKA_EVENTS = Contestant(
    "heyoka_events", "heyoka, events", _BATCHES + "extrema from its events where the rate passes zero",
    ("heyoka",), _TOLERANCES[::2], _prepare_events, repeats=3,
)  # fmt: skip
HEYOKA_ALONE = Contestant(
    "heyoka_alone", "heyoka without extrema", _BATCHES + "propagated only: no amplitude is measured",
    ("heyoka",), _TOLERANCES, _preparation(_without), accuracy_of="heyoka",
)  # fmt: skip
