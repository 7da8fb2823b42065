"""The flow of a model with its tangent through SciPy's DOP853: slow, and independent of the compiled one.

For modules that have no compiled kernel beside them, and as a witness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from delagrange.engines.flow import (
    FlowPath,
    Source,
    Travel,
    checked_start,
    drive_numbers,
    drive_slope,
    drive_slope_bound,
)
from delagrange.problem import status as loss


@dataclass(frozen=True)
class _Extended:
    """Right-hand side of the state, its tangent and the integral of the divergence, in one vector."""

    path: FlowPath
    numbers: np.ndarray
    sources: tuple[Source | None, ...]
    shape: tuple[int, int]

    def __call__(self, time: float, vector: np.ndarray) -> np.ndarray:
        problem, size = self.path.problem, self.shape[0]
        state, tangent = vector[:size], vector[size:-1].reshape(self.shape)
        slopes = problem.jacobian(time, state)
        rates = slopes @ tangent
        for column, source in enumerate(self.sources):
            if source is not None:
                inputs = problem.model.input_jacobian(state, problem.inputs(time), problem.parameters)
                rates[:, column] += inputs[:, source.place] * drive_slope(
                    self.numbers[source.place], source.number, time
                )
        return np.concatenate([problem.rhs(time, state), rates.ravel(), [np.trace(slopes)]])

    def driven_lengths(self, state: np.ndarray, start: float, stop: float) -> np.ndarray:
        """(n_columns,), in units of the weights: how far a column's drive alone may carry it from `start` to `stop`."""
        problem, largest = self.path.problem, np.abs(self.numbers[:, :2]).sum(axis=1)
        slopes = problem.model.input_jacobian(state, largest, problem.parameters)
        pull = np.linalg.norm(slopes / self.path.weights[:, None], axis=0)
        lengths = np.zeros(self.shape[1])
        for column, source in enumerate(self.sources):
            if source is not None:
                most = drive_slope_bound(self.numbers[source.place], source.number, stop)
                lengths[column] = (stop - start) * pull[source.place] * most
        return lengths


@dataclass(frozen=True)
class _Leg:
    """What became of the extended vector between two neighbouring times."""

    vector: np.ndarray  # at the end or at the loss
    maximum: np.ndarray  # (n_coordinates,) [1]
    minimum: np.ndarray  # (n_coordinates,) [1]
    status: int
    time: float  # [s], when it ended
    steps: int


def flow_by_scipy(
    path: FlowPath,
    state: np.ndarray,
    times: np.ndarray,
    tangent: np.ndarray | None = None,
    sources: tuple[Source | None, ...] = (),
    normalise: bool = False,
) -> Travel:
    """As `delagrange.engines.flow.Flow`.

    Raises:
        ValueError: arrays whose shapes or values do not fit the model, or each other.
    """
    state, times, tangent, sources = checked_start(path, state, times, tangent, sources)
    coordinates = path.problem.model.COORDINATE_COUNT
    rates = _Extended(path, drive_numbers(path.problem), sources, tangent.shape)
    states = np.full((len(times), len(state)), np.nan)
    growth = np.full((len(times) - 1, len(sources)), np.nan if normalise else 0.0)
    divergence = np.full(len(times), np.nan)
    states[0], divergence[0] = state, 0.0
    start = np.concatenate([state, tangent.ravel(), [0.0]])
    maximum = minimum = state[:coordinates]
    leg = _Leg(start, maximum, minimum, loss.COMPLETED, float(times[0]), 0)
    steps = 0
    with np.errstate(all="ignore"):
        for row in range(1, len(times)):
            leg = _leg(rates, start, (times[row - 1], times[row]))
            steps += leg.steps
            maximum, minimum = np.maximum(maximum, leg.maximum), np.minimum(minimum, leg.minimum)
            tangent = leg.vector[len(state) : -1].reshape(tangent.shape)
            if leg.status != loss.COMPLETED:
                break
            states[row], divergence[row] = leg.vector[: len(state)], divergence[row - 1] + leg.vector[-1]
            if normalise:
                tangent, growth[row - 1] = orthonormalised(tangent, path.weights)
            start = np.concatenate([states[row], tangent.ravel(), [0.0]])
    return Travel(states, tangent, growth, divergence, maximum, minimum, leg.status, leg.time, steps)


def _leg(rates: _Extended, start: np.ndarray, span: tuple[float, float]) -> _Leg:
    """From the extended vector `start` through a span of time [s]."""
    path, (size, columns) = rates.path, rates.shape
    absolute = _absolute(path, start[:size], start[size:-1].reshape(size, columns), rates, span)
    solver = DOP853(rates, span[0], start, span[1], rtol=path.tolerance, atol=absolute)
    coordinates = path.problem.model.COORDINATE_COUNT
    maximum = minimum = start[:coordinates]
    steps, end, status = 0, span[0], loss.COMPLETED
    vector = start
    while solver.status == "running" and status == loss.COMPLETED:
        solver.step()
        if solver.status == "failed":
            status = int(path.problem.kind_of_failure(solver.t, solver.y[:size]))
            break
        steps += 1
        end, status = _kept(path, solver)
        vector = solver.y if status == loss.COMPLETED else solver.dense_output()(end)
        reached = _reached(solver, end, vector, coordinates)
        maximum, minimum = np.maximum(maximum, reached.max(0)), np.minimum(minimum, reached.min(0))
    return _Leg(vector, maximum, minimum, status, float(end), steps)


def orthonormalised(tangent: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Columns orthonormal in units of `weights`, and the logarithms of the lengths that they had."""
    unitary, triangle = np.linalg.qr(tangent / weights[:, None])
    lengths = np.diagonal(triangle)
    return weights[:, None] * unitary * np.sign(lengths), np.log(np.abs(lengths))


def _absolute(
    path: FlowPath, state: np.ndarray, tangent: np.ndarray, rates: _Extended, span: tuple[float, float]
) -> np.ndarray:
    """Absolute tolerances of the extended vector; a column that follows a drive may begin at zero."""
    lengths = np.linalg.norm(tangent / path.weights[:, None], axis=0)
    lengths = np.maximum(lengths, rates.driven_lengths(state, *span))
    parts = (path.weights, np.outer(path.weights, lengths).ravel(), [1.0])
    return path.tolerance * np.maximum(np.concatenate(parts), 1e-300)


def _kept(path: FlowPath, solver: DOP853) -> tuple[float, int]:
    """Until when the step just made counts [s], and what ends it there if anything does."""
    size, dense = len(path.weights), None

    def margin(time: float) -> float:
        return float(path.problem.margin(time, dense(time)[:size], path.limits))

    if path.problem.margin(solver.t, solver.y[:size], path.limits) > 0:
        return solver.t, loss.COMPLETED
    dense = solver.dense_output()
    lost = brentq(margin, solver.t_old, solver.t, xtol=1e-18) if margin(solver.t_old) > 0 else solver.t_old
    return lost, int(path.problem.kind_of_loss(lost, dense(lost)[:size], path.limits))


def _reached(solver: DOP853, end: float, vector: np.ndarray, coordinates: int) -> np.ndarray:
    """The coordinates at the end of the step and where one of them turns in it, (n_places, n_coordinates)."""
    places = [vector[:coordinates]]
    for rate in range(coordinates, 2 * coordinates):
        if solver.y_old[rate] * vector[rate] < 0:
            dense = solver.dense_output()
            turn = brentq(lambda time, at=rate, value=dense: value(time)[at], solver.t_old, end, xtol=1e-18)
            places.append(dense(turn)[:coordinates])
    return np.array(places)
