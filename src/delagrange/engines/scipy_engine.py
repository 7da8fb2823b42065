"""The slow witness of the ensemble: every lane by itself through `scipy.integrate.solve_ivp`.

It shares no integrator, step control, interpolant, quadrature or search for extrema with the ensemble:
extrema are events of `solve_ivp` where a rate passes zero, averages and samples come from its dense output.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from delagrange.engines.lanes import Interrupted, Outcome, RunSettings, Sampling, empty_outcome
from delagrange.engines.numpy_engine import Report, segments
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem

_QUADRATURE_POINTS = 8  # a step: exact for the square of a polynomial of degree 7


def integrate_one_by_one(
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None = None,
    report: Report | None = None,
) -> Outcome:
    """As `delagrange.engines.numpy_engine.integrate_lanes`; steps and rejections are not counted."""
    samples = 0 if sampling is None else sampling.count
    outcome = empty_outcome(initial_state, problem.model.COORDINATE_COUNT, loss.INTERRUPTED, samples)
    try:
        for lane in range(initial_state.shape[1]):
            times = sampling.take(slice(lane, lane + 1)).times()[:, 0] if samples else np.empty(0)
            with np.errstate(all="ignore"):
                _run_lane(problem.take(lane), initial_state[:, lane], settings, times, outcome, lane)
            if report is not None:
                report(lane + 1)
    except KeyboardInterrupt as interruption:
        raise Interrupted(outcome) from interruption
    return outcome


def _run_lane(
    problem: Problem, state: np.ndarray, settings: RunSettings, times: np.ndarray, outcome: Outcome, lane: int
) -> None:
    """Run one lane over all segments; `times`, (count,) [s], are those of its samples."""
    outcome.samples[times == 0.0, :, lane] = state
    time, status, measured = 0.0, _status(problem, 0.0, state, settings), []
    for start, stop in segments(problem, settings):
        if status != loss.COMPLETED:
            break
        piece = problem.piece(start, stop)
        solution = _solve(piece, state, start, stop, settings, settings.averages or len(times) > 0)
        if settings.measures(start, stop):
            measured.append(solution)
        state, time, status = solution.y[:, -1], solution.t[-1], _status_after(problem, solution, settings)
        sampled = (times > start) & (times <= time)
        if np.any(sampled):
            outcome.samples[sampled, :, lane] = solution.sol(times[sampled]).T
    _measure_into(outcome, measured, settings, lane)
    outcome.state[:, lane], outcome.status[lane], outcome.status_time[lane] = state, status, time


def _measure_into(outcome: Outcome, solutions: list, settings: RunSettings, lane: int) -> None:
    """Write the extrema and the averages over the solutions in the window."""
    count = len(outcome.maximum)
    values = [part for solution in solutions for part in _values(solution, count)]
    seen = np.concatenate([np.empty((count, 0)), *values], axis=1)
    outcome.maximum[:, lane] = seen.max(axis=1, initial=-np.inf)
    outcome.minimum[:, lane] = seen.min(axis=1, initial=np.inf)
    if settings.averages:
        covered = sum(solution.t[-1] - solution.t[0] for solution in solutions)
        integrals = sum((_integrals(solution, count) for solution in solutions), np.zeros((2, count)))
        outcome.mean[:, lane], outcome.mean_square[:, lane] = np.divide(integrals, covered)


def _values(solution, count: int) -> list[np.ndarray]:
    """The first `count` state variables at the ends of steps and where a rate vanishes, (count, n) each."""
    events = (states.reshape(-1, len(solution.y))[:, :count].T for states in solution.y_events[1:])
    return [solution.y[:count], *events]


def _integrals(solution, count: int) -> np.ndarray:
    """Integrals over time [s] of the first `count` state variables and of their squares, (2, count)."""

    def powers(times: np.ndarray) -> np.ndarray:
        value = solution.sol(times)[:count]
        return np.stack([value, value**2])

    from scipy.integrate import fixed_quad

    steps = (fixed_quad(powers, *span, n=_QUADRATURE_POINTS)[0] for span in pairwise(solution.t))
    return sum(steps, np.zeros((2, count)))


def _solve(problem: Problem, state: np.ndarray, start: float, stop: float, settings: RunSettings, dense: bool):
    def lost(time: float, state: np.ndarray) -> float:
        return float(problem.margin(time, state, settings.limits))

    lost.terminal = True
    count = problem.model.COORDINATE_COUNT
    rates = [lambda time, state, place=place: state[place] for place in range(count, 2 * count)]
    from scipy.integrate import solve_ivp  # takes half a second, which other engines need not wait

    return solve_ivp(
        problem.rhs,
        (start, stop),
        state,
        method=settings.tableau.name,
        rtol=settings.control.rtol,
        atol=settings.control.atol,
        events=[lost, *rates],
        dense_output=dense,
    )


def _status(problem: Problem, time: float, state: np.ndarray, settings: RunSettings) -> int:
    kept = problem.margin(time, state, settings.limits) > 0
    return loss.COMPLETED if kept else int(problem.kind_of_loss(time, state, settings.limits))


def _status_after(problem: Problem, solution, settings: RunSettings) -> int:
    if solution.status == 1:
        return int(problem.kind_of_loss(solution.t[-1], solution.y[:, -1], settings.limits))
    if solution.success:
        return loss.COMPLETED
    return int(problem.kind_of_failure(solution.t[-1], solution.y[:, -1]))
