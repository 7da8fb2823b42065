"""The road of one run through SciPy's solvers, step by step, to its end or its loss."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import BDF, DOP853, LSODA, RK45, OdeSolver, Radau
from scipy.optimize import brentq

from delagrange.common.progress import progress_bar
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits

_SOLVERS: dict[str, type[OdeSolver]] = {
    "DOP853": DOP853,
    "RK45": RK45,
    "Radau": Radau,
    "BDF": BDF,
    "LSODA": LSODA,
}
EXPLICIT = ("DOP853", "RK45")  # the methods that ask for no Jacobian
METHODS = (*_SOLVERS, "auto")
_STIFF_RATIO = 30.0  # fastest decay over fastest vibration beyond which "auto" goes implicit


@dataclass(frozen=True)
class Trajectory:
    """A run at its output times."""

    state: np.ndarray  # (n_state, n_times), NaN after the loss of the solution
    status: int  # place in delagrange.problem.status.STATUS
    status_time: float  # [s]
    method: str


@dataclass(frozen=True)
class Stride:
    """One accepted step of a solver, cut short where the solution is lost in it."""

    start: float  # [s]
    stop: float  # [s]
    state: np.ndarray  # (n_state,), at `stop`
    dense: (
        Callable[[np.ndarray], np.ndarray] | None
    )  # state at times inside, until the next step; None if stuck
    status: int  # COMPLETED while all is well


def integrate(
    problem: Problem,
    state: np.ndarray,
    times: np.ndarray,
    duration: float,
    method: str,
    rtol: float,
    atol: float,
    limits: Limits,
    progress: bool = False,
) -> Trajectory:
    """Integrate from `state`, (n_state,), at t = 0 and sample at `times`, (n_times,) [s]."""
    method = choose_method(problem, state) if method == "auto" else method
    samples = np.full((len(state), len(times)), np.nan)
    samples[:, times == 0.0] = state[:, None]
    status, end = loss.COMPLETED, 0.0
    with np.errstate(all="ignore"), progress_bar(progress, "simulate", duration, "s") as bar:
        for stride in strides(problem, state, duration, method, rtol, atol, limits):
            first, last = np.searchsorted(times, (stride.start, stride.stop), side="right")
            if last > first:
                samples[:, first:last] = stride.dense(times[first:last])
            status, end = stride.status, stride.stop
            bar.advance_to(end)
    return Trajectory(samples, status, end, method)


def strides(
    problem: Problem,
    state: np.ndarray,
    duration: float,
    method: str,
    rtol: float,
    atol: float,
    limits: Limits,
) -> Iterator[Stride]:
    """The steps of a run, begun anew at each breakpoint of the drives; the last may be a loss."""
    if not _distance(problem, 0.0, state, limits) > 0:
        yield Stride(0.0, 0.0, state, None, int(_kind(problem, 0.0, state, limits)))
        return
    bounds = (0.0, *problem.breakpoints(0.0, duration), duration)
    for start, stop in pairwise(bounds):
        for stride in _segment(problem.piece(start, stop), state, start, stop, method, rtol, atol, limits):
            yield stride
            if stride.status != loss.COMPLETED:
                return
            state = stride.state


def _segment(
    problem: Problem,
    state: np.ndarray,
    start: float,
    stop: float,
    method: str,
    rtol: float,
    atol: float,
    limits: Limits,
) -> Iterator[Stride]:
    options = {"jac": problem.jacobian} if method not in EXPLICIT else {}
    solver = _SOLVERS[method](problem.rhs, start, state, stop, rtol=rtol, atol=atol, **options)
    while solver.status == "running":
        good = solver.t, solver.y
        if not _stepped(solver):
            kind = int(problem.kind_of_failure(*good))
            yield Stride(good[0], good[0], good[1], None, kind)
            return
        yield _cut_at_loss(problem, solver, limits)


def _stepped(solver: OdeSolver) -> bool:
    """Whether the solver made a step with a finite result; a singular or infinite matrix is none."""
    try:
        solver.step()
    except (np.linalg.LinAlgError, ValueError):
        return False
    return solver.status != "failed" and bool(np.all(np.isfinite(solver.y)))


def _cut_at_loss(problem: Problem, solver: OdeSolver, limits: Limits) -> Stride:
    start, stop = float(solver.t_old), float(solver.t)

    def dense(times: np.ndarray) -> np.ndarray:
        return solver.dense_output()(times)  # made when asked for: most steps hold no sample

    if _distance(problem, stop, solver.y, limits) > 0:
        return Stride(start, stop, solver.y, dense, loss.COMPLETED)
    lost = brentq(
        lambda time: _distance(problem, time, dense(time), limits), start, stop, xtol=1e-15, rtol=1e-14
    )
    return Stride(start, lost, dense(lost), dense, int(_kind(problem, lost, dense(lost), limits)))


def _distance(problem: Problem, time: float, state: np.ndarray, limits: Limits) -> float:
    distance = float(problem.margin(time, state, limits))
    return distance if np.isfinite(distance) else -1.0


def _kind(problem: Problem, time: float, state: np.ndarray, limits: Limits) -> int:
    return problem.kind_of_loss(time, state, limits)


def choose_method(problem: Problem, state: np.ndarray) -> str:
    """Radau where the start has a decay much faster than its fastest vibration, else DOP853."""
    with np.errstate(all="ignore"):
        values = np.linalg.eigvals(problem.jacobian(0.0, state))
    decay, vibration = np.max(-values.real), np.max(np.abs(values.imag))
    return "Radau" if decay > _STIFF_RATIO * vibration else "DOP853"
