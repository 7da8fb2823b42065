"""The flow of a model with its tangent through the compiled kernel beside its module."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np

from delagrange.drives.phase import fraction_of_period
from delagrange.engines.flow import PHASE, FlowPath, Source, Travel, checked_start, drive_numbers
from delagrange.model.kernels import VARIATIONAL, kernel_name, load_kernel
from delagrange.problem.problem import Problem
from delagrange.problem.status import DIVERGED

_BUDGET = 20000  # steps of a call, a fifth of a second or less, after which the keyboard is heard


@dataclass(frozen=True)
class _Call:
    """The arrays that a kernel reads and writes, as its `travel` describes them."""

    kernel: ModuleType
    times: np.ndarray
    sources: np.ndarray
    normalise: bool
    frame: np.ndarray
    vector: np.ndarray
    states: np.ndarray
    growth: np.ndarray
    divergence: np.ndarray
    extrema: np.ndarray

    def go_on(self, budget: int) -> bool:
        """Some more steps; whether there are more to do."""
        self.kernel.travel(
            self.times, self.sources, self.normalise, budget, self.frame, self.vector,
            self.states, self.growth, self.divergence, self.extrema,
        )  # fmt: skip
        return bool(self.frame[self.kernel.STATUS] == self.kernel.UNFINISHED)


def flow_compiled(
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
        RuntimeError: the model has no such kernel, or it cannot be compiled on this machine.
    """
    name = kernel_name(path.problem.model, VARIATIONAL)
    if name is None:
        raise RuntimeError(
            f"the model {path.problem.model.MODEL} has no variational kernel beside its module"
        )
    call = _call(load_kernel(name), path, *checked_start(path, state, times, tangent, sources), normalise)
    budget = max(1, _BUDGET // (1 + len(call.sources) // 8))
    while call.go_on(budget):
        pass
    return _travel(path, call)


def _call(
    kernel: ModuleType,
    path: FlowPath,
    state: np.ndarray,
    times: np.ndarray,
    tangent: np.ndarray,
    sources: tuple[Source | None, ...],
    normalise: bool,
) -> _Call:
    columns, coordinates = tangent.shape[1], kernel.COORDINATE_COUNT
    states = np.full((len(times), len(state)), np.nan)
    divergence = np.full(len(times), np.nan)
    states[0], divergence[0] = state, 0.0
    return _Call(
        kernel=kernel,
        times=times,
        sources=np.array([(-1, -1) if s is None else s for s in sources], dtype=np.int64).reshape(columns, 2),
        normalise=bool(normalise),
        frame=_frame(kernel, path, columns),
        vector=np.concatenate([state, tangent.T.ravel(), [0.0]]),
        states=states,
        growth=np.full((len(times) - 1, columns), np.nan if normalise else 0.0),
        divergence=divergence,
        extrema=np.array([state[:coordinates], state[:coordinates]]),
    )


def _frame(kernel: ModuleType, path: FlowPath, columns: int) -> np.ndarray:
    """Everything that stands still, and the numbers that are to change as they are at first."""
    problem = path.problem
    frame = np.zeros(kernel.COLUMN + 2 * columns)
    with np.errstate(all="ignore"):  # what is beyond double precision is lost, and its status says so
        _place(frame, kernel.CONSTANT, kernel.constants(problem.parameters))
    drives = drive_numbers(problem)
    drives[:, PHASE] = fraction_of_period(drives[:, PHASE])
    _place(frame, kernel.DRIVE, drives.T.ravel())
    _place(frame, kernel.WEIGHT, path.weights)
    frame[kernel.TOLERANCE] = path.tolerance
    frame[kernel.SMALLEST] = path.limits.smallest_stretch
    frame[kernel.LARGEST] = path.limits.largest_stretch
    frame[kernel.OLD_ERROR] = 1.0
    frame[kernel.STATUS] = kernel.UNFINISHED
    return frame


def _place(frame: np.ndarray, start: int, values: np.ndarray | list[float]) -> None:
    frame[start : start + len(values)] = values


def _travel(path: FlowPath, call: _Call) -> Travel:
    frame, size = call.frame, call.states.shape[1]
    return Travel(
        state=call.states,
        tangent=call.vector[size:-1].reshape(-1, size).T.copy(),
        growth=call.growth,
        divergence=call.divergence,
        maximum=call.extrema[0],
        minimum=call.extrema[1],
        status=_status(path.problem, call),
        status_time=float(frame[call.kernel.STATUS_TIME]),
        steps=int(frame[call.kernel.STEPS]),
    )


def _status(problem: Problem, call: _Call) -> int:
    """As in `delagrange.problem.status`, whose way of counting is the kernel's.

    A kernel stops where an energy ceases to hold. Where it can resolve no step any more, a spring may be about to lock.
    """
    frame, kernel = call.frame, call.kernel
    status = int(frame[kernel.STATUS])
    if status != DIVERGED:
        return status
    with np.errstate(all="ignore"):
        return int(problem.kind_of_failure(frame[kernel.STATUS_TIME], call.vector[: call.states.shape[1]]))
