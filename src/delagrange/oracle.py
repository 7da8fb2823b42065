"""The slow witness of the ensemble: every lane by itself through `scipy.integrate.solve_ivp`.

It shares no integrator, step control, interpolant or search for extrema with the ensemble: extrema are
events of `solve_ivp` where a rate passes zero.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from delagrange import loss
from delagrange.ensemble import Report, segments
from delagrange.lanes import Interrupted, Outcome, Settings, empty_outcome
from delagrange.problem import Problem


def integrate_one_by_one(
    problem: Problem, initial_state: np.ndarray, settings: Settings, report: Report | None = None
) -> Outcome:
    """As `delagrange.ensemble.integrate_lanes`; steps and rejections are not counted."""
    outcome = empty_outcome(initial_state, problem.model.COORDINATE_COUNT, loss.INTERRUPTED)
    try:
        for lane in range(initial_state.shape[1]):
            with np.errstate(all="ignore"):
                _run_lane(problem.take(lane), initial_state[:, lane], settings, outcome, lane)
            if report is not None:
                report(lane + 1)
    except KeyboardInterrupt as interruption:
        raise Interrupted(outcome) from interruption
    return outcome


def _run_lane(problem: Problem, state: np.ndarray, settings: Settings, outcome: Outcome, lane: int) -> None:
    count = len(outcome.maximum)
    values, time = [np.empty((count, 0))], 0.0
    status = _status(problem, 0.0, state, settings)
    for start, stop in segments(problem, settings):
        if status != loss.COMPLETED:
            break
        measured = settings.window[0] <= start and stop <= settings.window[1]
        solution = _solve(problem.piece(start, stop), state, start, stop, settings)
        if measured:
            values += [
                solution.y[:count],
                *(y.reshape(-1, len(state))[:, :count].T for y in solution.y_events[1:]),
            ]
        state, time, status = solution.y[:, -1], solution.t[-1], _status_after(problem, solution, settings)
    seen = np.concatenate(values, axis=1)
    outcome.maximum[:, lane] = seen.max(axis=1, initial=-np.inf)
    outcome.minimum[:, lane] = seen.min(axis=1, initial=np.inf)
    outcome.state[:, lane], outcome.status[lane], outcome.status_time[lane] = state, status, time


def _solve(problem: Problem, state: np.ndarray, start: float, stop: float, settings: Settings):
    def lost(time: float, state: np.ndarray) -> float:
        return float(loss.margin(problem.principal_stretches(time, state), settings.limits))

    lost.terminal = True
    count = problem.model.COORDINATE_COUNT
    rates = [lambda time, state, place=place: state[place] for place in range(count, 2 * count)]
    return solve_ivp(
        problem.rhs,
        (start, stop),
        state,
        method=settings.tableau.name,
        rtol=settings.control.rtol,
        atol=settings.control.atol,
        events=[lost, *rates],
    )


def _status(problem: Problem, time: float, state: np.ndarray, settings: Settings) -> int:
    principal = problem.principal_stretches(time, state)
    kept = loss.margin(principal, settings.limits) > 0
    return loss.COMPLETED if kept else int(loss.kind_of_loss(principal, settings.limits))


def _status_after(problem: Problem, solution, settings: Settings) -> int:
    if solution.status == 1:
        principal = problem.principal_stretches(solution.t[-1], solution.y[:, -1])
        return int(loss.kind_of_loss(principal, settings.limits))
    return loss.COMPLETED if solution.success else loss.DIVERGED
