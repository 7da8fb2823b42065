"""heyoka.py in batches of eight: as its documentation shows it, and tuned, with extrema and without.

The plain ways to the extrema: a step callback in Python, and the continuous output of each batch gone through by
NumPy; heyoka's events where the rate passes zero took between the two. Only the first coordinate is measured.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import delagrange
from benchmarks import heyoka_system as hs
from benchmarks.cases import Case
from benchmarks.contestant import Contestant, Run

_PLAIN_TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # for errors from 1e-4 to 1e-8, as the others
_TUNED_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
_TIMED_BATCHES = 33  # one in sixteen by the callback, one in eight by the continuous output
Measure = Callable[[], np.ndarray]  # integrates the batch that the integrator stands at: amplitudes, (BATCH,)
Way = Callable[[Case, object, float], Measure]  # (case, integrator, duration in the integrator's time)


def _rate_place(case: Case) -> int:
    return delagrange.load_model(case.model).COORDINATE_COUNT


def _by_python_callback(case: Case, one, duration: float) -> Measure:
    from benchmarks.python_extrema import StepExtrema

    extrema = StepExtrema(one, _rate_place(case))

    def measure() -> np.ndarray:
        extrema.begin()
        one.propagate_for(duration, callback=extrema, write_tc=True)
        return extrema.amplitude()

    return measure


def _by_continuous_output(case: Case, one, duration: float) -> Measure:
    from benchmarks.output_extrema import amplitudes

    rate = _rate_place(case)

    def measure() -> np.ndarray:
        output = one.propagate_for(duration, c_output=True)[0]
        return amplitudes(output, one.state, rate)

    return measure


def _by_compiled_callback(case: Case, one, duration: float) -> Measure:
    from benchmarks.step_extrema import step_callback

    coefficients, step, state = one.tc, one.last_h, one.state  # views, written anew by each step
    maximum, minimum = np.empty(hs.BATCH), np.empty(hs.BATCH)
    after_step = step_callback(coefficients, step, state, _rate_place(case), maximum, minimum)

    def measure() -> np.ndarray:
        maximum[:] = minimum[:] = state[0]
        one.propagate_for(duration, callback=after_step, write_tc=True)
        return (np.maximum(maximum, state[0]) - np.minimum(minimum, state[0])) / 2

    return measure


def _without(case: Case, one, duration: float) -> Measure:
    def measure() -> np.ndarray:
        one.propagate_for(duration)
        return np.full(hs.BATCH, np.nan)

    return measure


def _run_batches(case: Case, places: np.ndarray, rest: np.ndarray, one, measure: Measure) -> np.ndarray:
    runs = case.runs.take(places)
    found = []
    for parameters in hs.batches(runs):
        hs.start(one, rest, parameters)
        found.append(measure())
    return np.concatenate(found)[: len(runs)]


def _preparation(way: Way, writing: hs.Writing):
    def prepare(case: Case, places: np.ndarray, tolerance: float) -> Run:
        one, rest = hs.integrator(case.model, writing, tolerance), hs.initial_state(case.model, writing)
        measure = way(case, one, hs.written_duration(case, writing))
        _run_batches(case, places[:1], rest, one, measure)  # compiles the measure
        return lambda: _run_batches(case, places, rest, one, measure)

    return prepare


_SECONDS = "SI units, hy.sin of the time, fast_math, "
HEYOKA = Contestant(
    "heyoka", "heyoka.py, batch 8", _SECONDS + "extrema by a step callback in Python from its dense output",
    ("heyoka",), _PLAIN_TOLERANCES, _preparation(_by_python_callback, hs.PLAIN),
    subset=_TIMED_BATCHES * hs.BATCH, group=hs.BATCH,
)  # fmt: skip
HEYOKA_OUTPUT = Contestant(
    "heyoka_output", "heyoka.py, batch 8, continuous output",
    _SECONDS + "extrema by NumPy from the continuous output of each batch",
    ("heyoka",), _PLAIN_TOLERANCES, _preparation(_by_continuous_output, hs.PLAIN),
    subset=2 * _TIMED_BATCHES * hs.BATCH, group=hs.BATCH,
)  # fmt: skip
HEYOKA_TUNED = Contestant(
    "heyoka_tuned", "heyoka.py, batch 8, tuned by us",
    "scaled time, the sine as states, fast_math, extrema from the Taylor coefficients in a compiled step callback",
    ("heyoka", "numba"), _TUNED_TOLERANCES, _preparation(_by_compiled_callback, hs.TUNED), notes=hs.TUNING,
)  # fmt: skip
HEYOKA_ALONE = Contestant(
    "heyoka_alone", "heyoka.py, batch 8, no extrema", _SECONDS + "propagated only: no amplitude is measured",
    ("heyoka",), _PLAIN_TOLERANCES, _preparation(_without, hs.PLAIN), accuracy_of="heyoka_output",
)  # fmt: skip
HEYOKA_TUNED_ALONE = Contestant(
    "heyoka_tuned_alone", "heyoka.py, batch 8, tuned by us, no extrema",
    "scaled time, the sine as states, fast_math, propagated only: no amplitude is measured",
    ("heyoka",), _TUNED_TOLERANCES, _preparation(_without, hs.TUNED), accuracy_of="heyoka_tuned",
)  # fmt: skip
