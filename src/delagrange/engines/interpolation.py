"""The solution inside the last step of many lanes, as polynomials; their extrema and zeros.

Polynomials are arrays of coefficients (degree + 1, ..., n_lanes), lowest power first, in the fraction
x of the step, 0 <= x <= 1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from delagrange.engines.lanes import RunSettings, Trial
from delagrange.engines.step_control import combine
from delagrange.engines.tableau import Tableau
from delagrange.problem.problem import Problem

_PROBES = 8  # intervals in which the search for an extremum starts
_REFINEMENTS = 6  # of Newton's kind: a place right to 1e-8 makes a value right to rounding
_BISECTIONS = 60


def step_polynomial(
    problem: Problem,
    tableau: Tableau,
    stages: np.ndarray,
    time: np.ndarray,
    step: np.ndarray,
    state: np.ndarray,
    count: int | None = None,
) -> np.ndarray:
    """The state over a step that began at `time` [s] in `state`, (degree + 1, n_state, n_lanes).

    stages: (stage_count + 1, n_state, n_lanes), the rates of the step and at its end
    count: how many of the state variables are wanted, from the first on; all if left out
    """
    rates = np.empty((tableau.total_stages, *state.shape))
    rates[: tableau.stage_count + 1] = stages
    for extra, (node, row) in enumerate(zip(tableau.extra_nodes, tableau.extra_coupling)):
        place = tableau.stage_count + 1 + extra
        rates[place] = problem.rhs(time + node * step, state + step * combine(row, rates))
    wanted = rates[:, :count]
    return np.stack([state[:count], *(step * combine(row, wanted) for row in tableau.interpolant)])


def trial_polynomial(
    problem: Problem, trial: Trial, settings: RunSettings, places: np.ndarray, count: int | None = None
) -> np.ndarray:
    """The state over the trial's step of the lanes at `places`, (degree + 1, n_state, n_places).

    count: how many of the state variables are wanted, from the first on; all if left out
    """
    some = trial.take(places)
    before = some.before
    return step_polynomial(
        problem.take(places), settings.tableau, some.stages, before.time, some.step, before.state, count
    )


def evaluate(polynomial: np.ndarray, fraction: float | np.ndarray) -> np.ndarray:
    """Value at `fraction`, by Horner's rule; `fraction` broadcasts over the trailing shape."""
    value = polynomial[-1]
    for coefficient in polynomial[-2::-1]:
        value = value * fraction + coefficient
    return value


def derivative(polynomial: np.ndarray) -> np.ndarray:
    """Derivative by the fraction, one power less."""
    powers = np.arange(1, len(polynomial)).reshape(-1, *(1,) * (polynomial.ndim - 1))
    return polynomial[1:] * powers


def largest_value(polynomial: np.ndarray, stop: float | np.ndarray = 1.0) -> np.ndarray:
    """Largest value for 0 <= x <= `stop`, (degree + 1, n_lanes) -> (n_lanes,).

    The best of a few probes is refined where the slope vanishes beside it. A step of an accurate
    integration holds one extremum at most, or two close to its ends; both are seen by the probes.
    """
    width = stop / _PROBES
    probes = np.arange(_PROBES + 1.0)[:, None] * width
    values = evaluate(polynomial[:, None], probes)
    best = np.argmax(values, axis=0)
    low, high = np.maximum(best - 1, 0) * width, np.minimum(best + 1, _PROBES) * width
    with np.errstate(all="ignore"):  # a straight curve makes Newton divide by zero; bisection takes over
        refined = evaluate(polynomial, _top(polynomial, low, high, best * width))
    return np.maximum(values.max(axis=0), refined)


def _top(polynomial: np.ndarray, low: np.ndarray, high: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Where the slope falls through zero between `low` and `high`: Newton, kept inside by bisection."""
    slope = derivative(polynomial)
    bend = derivative(slope)
    place = start
    for _ in range(_REFINEMENTS):
        rising = evaluate(slope, place)
        low, high = np.where(rising > 0, place, low), np.where(rising > 0, high, place)
        newton = place - rising / evaluate(bend, place)
        place = np.where((newton >= low) & (newton <= high), newton, (low + high) / 2)
    return place


def first_crossing(function: Callable[[np.ndarray], np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    """Fraction of the step at which `function`, positive at 0 and not at 1, crosses zero; by bisection."""
    low, high = np.zeros(shape), np.ones(shape)
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        positive = function(middle) > 0
        low, high = np.where(positive, middle, low), np.where(positive, high, middle)
    return high
