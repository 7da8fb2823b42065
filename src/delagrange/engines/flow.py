"""A model under sinusoidal drives together with its variational equations: where a state and its neighbours go.

The tangent obeys d(delta)/dt = J delta (+ df/du du/da in a column that follows a number `a` of a drive), J and
df/du derived and emitted with the model. Nothing here is a finite difference.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from delagrange.common import checks
from delagrange.drives.drive import Constant, Drive, Sine, Step
from delagrange.drives.inputs import input_name
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits

BIAS, AMPLITUDE, FREQUENCY, PHASE = range(4)  # columns of the numbers of a drive


class Source(NamedTuple):
    """A number of a drive, by which a column of the tangent is the derivative of the state."""

    place: int  # of the input in model.INPUTS
    number: int  # BIAS, AMPLITUDE, FREQUENCY or PHASE


@dataclass(frozen=True)
class Travel:
    """What became of a state, and of the tangent at it, along increasing times."""

    state: np.ndarray  # (n_times, n_state), NaN after a loss; the first row is the start
    tangent: np.ndarray  # (n_state, n_columns) at the last time, or at the loss
    growth: np.ndarray  # (n_times - 1, n_columns), log of each orthogonalised column's, else 0; NaN if lost
    divergence: np.ndarray  # (n_times,) [1], integral of the trace of J since the first time; NaN if lost
    maximum: np.ndarray  # (n_coordinates,) [1], of each coordinate over all times
    minimum: np.ndarray  # (n_coordinates,) [1]
    status: int  # place in delagrange.problem.status.STATUS
    status_time: float  # [s]
    steps: int  # accepted steps of the integrator


@dataclass(frozen=True)
class FlowPath:
    """One run with the accuracy it is wanted with.

    `weights`, (n_state,), are typical sizes of the state variables, each in its unit: errors are measured
    in units of `tolerance` times them, and lengths of tangents in units of them.
    """

    problem: Problem  # of single values
    weights: np.ndarray
    tolerance: float = 1e-11
    limits: Limits = field(default_factory=Limits)


class Flow(Protocol):
    """Carries a state and its tangent through time."""

    def __call__(
        self,
        path: FlowPath,
        state: np.ndarray,
        times: np.ndarray,
        tangent: np.ndarray | None = None,
        sources: tuple[Source | None, ...] = (),
        normalise: bool = False,
    ) -> Travel:
        """From `state`, (n_state,), at times[0] through all `times`, (n_times,) [s], increasing.

        Args:
            tangent: (n_state, n_columns) at times[0]; none if left out.
            sources: for each column the number of a drive by which it is a derivative, or None; all None if empty.
            normalise: at every time after the first, make the columns orthonormal in units of `path.weights`
                (Gram and Schmidt, in their order), and note the logarithms of their lengths in `growth`: what
                they have grown by, where the columns given were orthonormal.

        A tangent is right to the tolerance in units of its columns' lengths, now or at the last of the times,
        whichever is larger. One that grows beyond double precision counts as a loss, like a state that does.
        """


def drive_numbers(problem: Problem) -> np.ndarray:
    """(n_inputs, 4): bias, amplitude, frequency [Hz] and phase [rad] of the drive of every input.

    Raises:
        ValueError: a drive that is neither constant nor a sine.
    """
    entries = zip(problem.model.INPUTS, problem.drives)
    rows = [_numbers(input_name(entry.name), drive) for entry, drive in entries]
    return np.array(rows, dtype=float).reshape(len(rows), 4)


Start = tuple[np.ndarray, np.ndarray, np.ndarray, tuple[Source | None, ...]]


def checked_start(
    path: FlowPath,
    state: np.ndarray,
    times: np.ndarray,
    tangent: np.ndarray | None,
    sources: tuple[Source | None, ...],
) -> Start:
    """State, times, tangent and sources of a travel: copies of floats, of shapes that fit, what is left out filled in.

    Raises:
        ValueError: a shape that does not fit the model, times that do not increase, a weight or tolerance that is
            not positive, a source that is no number of a drive of the model.
    """
    model, size = path.problem.model, len(path.problem.model.STATE)
    tangent = np.zeros((size, 0)) if tangent is None else tangent
    columns = np.shape(tangent)[1] if np.ndim(tangent) == 2 else 0
    _check_shape("state", state, (size,))
    _check_shape("tangent", tangent, (size, columns))
    _check_shape("weights of the path", path.weights, (size,))
    checks.positive("weights of the path", path.weights, "the unit of each state variable")
    checks.positive("tolerance of the path", path.tolerance, "1")
    times = checks.increasing("times", times, "s")
    sources = tuple(sources) or (None,) * columns
    if len(sources) != columns:
        raise ValueError(f"sources must be one a column of the tangent, {columns}, got {len(sources)}")
    for source in sources:
        if source is not None:
            checks.count("place of a source", source[0], 0, len(model.INPUTS) - 1)
            checks.count("number of a source", source[1], 0, PHASE)
    return np.array(state, dtype=float), np.array(times), np.array(tangent, dtype=float), sources


def _check_shape(name: str, array: np.ndarray, shape: tuple[int, ...]) -> None:
    if np.shape(array) != shape:
        raise ValueError(f"{name} must have the shape {shape}, got {np.shape(array)}")


def _numbers(name: str, drive: Drive) -> tuple[float, float, float, float]:
    if isinstance(drive, Constant):
        return float(drive.value), 0.0, 0.0, 0.0
    if isinstance(drive, Step) and drive.time <= 0:
        return float(drive.value), 0.0, 0.0, 0.0
    if isinstance(drive, Sine):
        return float(drive.bias), float(drive.amplitude), float(drive.frequency), float(drive.phase)
    raise ValueError(f"{name} must be constant or a delagrange.Sine here, got {drive}")


def drive_slope(numbers: np.ndarray, number: int, time: float) -> float:
    """Derivative of bias + amplitude sin(2 pi frequency t + phase) by one of the four, (4,) `numbers`."""
    _, amplitude, frequency, phase = numbers
    argument = 2 * np.pi * frequency * time + phase
    slopes = (
        1.0,
        np.sin(argument),
        2 * np.pi * time * amplitude * np.cos(argument),
        amplitude * np.cos(argument),
    )
    return float(slopes[number])


def drive_slope_bound(numbers: np.ndarray, number: int, time: float) -> float:
    """The largest size of `drive_slope` up to `time` [s]."""
    amplitude = abs(float(numbers[AMPLITUDE]))
    return (1.0, 1.0, 2 * np.pi * abs(time) * amplitude, amplitude)[number]
