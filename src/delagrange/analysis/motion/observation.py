"""A motion as it is observed: sampled at even times, with the growth of its tangent from sample to sample."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from delagrange.analysis.forcing import Forcing
from delagrange.common.progress import Progress
from delagrange.engines.flow import Flow, FlowPath
from delagrange.problem.dashpots import FROZEN, dashpot_places
from delagrange.problem.status import COMPLETED

_PARTS = 40  # pieces of a run, between which the progress is shown
_AT_ONCE = 10_000  # periods of a transient
_SEED = 1980  # of the first tangent vectors


@dataclass(frozen=True)
class Observation:
    """What was seen of a motion, up to its loss if it was lost."""

    forcing: Forcing
    times: np.ndarray  # (n,) [s]
    states: np.ndarray  # (n, n_state)
    growth: np.ndarray  # (n - 1, n_moving), logarithms of the growth of the orthogonalised tangent columns
    divergence: np.ndarray  # (n,) [1], integral of the trace of the Jacobian over time from the first time
    status: int  # place in delagrange.problem.status.STATUS
    status_time: float  # [s]

    @property
    def duration(self) -> float:
        """Time observed [s]."""
        return float(self.times[-1] - self.times[0])

    @property
    def section(self) -> np.ndarray:
        """The states once in a period of the forcing, (n_periods, n_state)."""
        return self.states[:: self.forcing.samples]


def moving_places(path: FlowPath, dashpots: str) -> np.ndarray:
    """Places in the state of what moves: all of it, or without the dashpots where these are frozen."""
    places = np.arange(len(path.weights))
    return np.delete(places, dashpot_places(path.problem.model)) if dashpots == FROZEN else places


def first_tangent(path: FlowPath, moving: np.ndarray) -> np.ndarray:
    """(n_state, n_moving): vectors orthonormal in units of the weights, in general position, always the same.

    A vector along an axis may be special by symmetry; one in general position has a part in every direction.
    """
    size = len(moving)
    directions, _ = np.linalg.qr(np.random.default_rng(_SEED).standard_normal((size, size)))
    tangent = np.zeros((len(path.weights), size))
    tangent[moving] = path.weights[moving, None] * directions
    return tangent


def observe(
    path: FlowPath,
    flow: Flow,
    forcing: Forcing,
    start: np.ndarray,
    moving: np.ndarray,
    periods: int,
    transient: int = 0,
    progress: Progress = Progress(),  # noqa: B008  (frozen)
) -> Observation:
    """Follow the motion from `start`, (n_state,), at t = 0 through `transient` and then `periods` periods.

    The tangent is followed, and made orthonormal at each sample, after the transient only.
    """
    state = start
    for first in range(0, transient, _AT_ONCE):
        whole = np.arange(first, min(first + _AT_ONCE, transient) + 1)
        before = flow(path, state, whole * forcing.period)
        if before.status != COMPLETED:
            return _lost_before(forcing, before.status, before.status_time, start, len(moving))
        state = before.state[-1]
        progress.advance_to(float(whole[-1] * forcing.period))
    times = (transient + np.arange(periods * forcing.samples + 1) / forcing.samples) * forcing.period
    return _follow(path, flow, forcing, state, times, first_tangent(path, moving), progress)


def _follow(
    path: FlowPath,
    flow: Flow,
    forcing: Forcing,
    state: np.ndarray,
    times: np.ndarray,
    tangent: np.ndarray,
    progress: Progress,
) -> Observation:
    states, growths, divergences = [state[None]], [], [np.zeros(1)]
    status, end = COMPLETED, float(times[0])
    for first, last in _pieces(len(times)):
        piece = flow(path, states[-1][-1], times[first : last + 1], tangent, normalise=True)
        status, end, tangent = piece.status, piece.status_time, piece.tangent
        reached = int(np.sum(np.all(np.isfinite(piece.state), axis=1)))
        states.append(piece.state[1:reached])
        growths.append(piece.growth[: reached - 1])
        divergences.append(divergences[-1][-1] + piece.divergence[1:reached])
        if status != COMPLETED:
            break
        progress.advance_to(float(times[last]))
    seen = np.concatenate(states)
    return Observation(
        forcing, times[: len(seen)], seen, np.concatenate(growths), np.concatenate(divergences), status, end
    )


def _pieces(count: int) -> list[tuple[int, int]]:
    ends = np.unique(np.linspace(0, count - 1, _PARTS + 1).astype(int))
    return [(int(first), int(last)) for first, last in pairwise(ends)]


def _lost_before(forcing: Forcing, status: int, end: float, start: np.ndarray, moving: int) -> Observation:
    return Observation(forcing, np.zeros(1), start[None], np.zeros((0, moving)), np.zeros(1), status, end)
