"""Many runs at once through the compiled kernel of their model, on all cores.

Every lane has its own time, step and error control in the kernel, so that a run's result is the same,
bit for bit, whatever runs are integrated beside it and on however many threads.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np

from delagrange.engines.kernel_drives import piece_rows
from delagrange.engines.lanes import Interrupted, Outcome, RunSettings, Sampling, empty_outcome
from delagrange.engines.locking import name_failures
from delagrange.engines.numpy_engine import Report, segments
from delagrange.engines.threads import run_on_threads, shifted, slices
from delagrange.model.kernels import kernel_name, load_kernel
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem

_DRIVE_NUMBERS = 1 << 22  # of the drives' pieces, in memory at a time


@dataclass(frozen=True)
class Call:
    """The arrays that a kernel reads and writes, as its `integrate` describes them."""

    kernel: ModuleType
    table: np.ndarray
    drives: np.ndarray
    vibrates: np.ndarray
    pieces: np.ndarray
    numerics: np.ndarray
    averages: bool
    results: np.ndarray
    samples: np.ndarray
    stop: np.ndarray  # (1,) of int8, shared by all parts

    def run(self, first: int, last: int, progress: np.ndarray) -> None:
        """Integrate some of the lanes."""
        self.kernel.integrate(
            first, last, self.table, self.drives, self.vibrates, self.pieces, self.numerics, self.averages,
            self.results, self.samples, progress, self.stop,
        )  # fmt: skip


def integrate_compiled(
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None = None,
    report: Report | None = None,
) -> Outcome:
    """As `delagrange.engines.numpy_engine.integrate_lanes`, compiled.

    Raises:
        RuntimeError: the model has no kernel, or it cannot be compiled on this machine.
        Interrupted: from the keyboard; it carries the outcome of the lanes that had ended.
    """
    name = kernel_name(problem.model)
    if name is None:
        raise RuntimeError(f"the model {problem.model.MODEL} has no compiled kernel beside its module")
    kernel = load_kernel(name)
    spans = list(segments(problem, settings))
    lanes = initial_state.shape[1]
    count = 0 if sampling is None else sampling.count
    outcome = empty_outcome(initial_state, problem.model.COORDINATE_COUNT, loss.INTERRUPTED, count)
    for part in slices(lanes, max(1, _DRIVE_NUMBERS // (5 * len(problem.drives) * len(spans)))):
        some = None if sampling is None else sampling.take(part)
        call = _call(kernel, problem.take(part), initial_state[:, part], settings, some, spans)
        try:
            told = shifted(report, part.start)
            run_on_threads(call.run, call.table.shape[1], kernel.LANES, call.stop, settings.threads, told)
        except KeyboardInterrupt as interruption:
            outcome.place_into(part, _outcome(call))
            raise Interrupted(name_failures(outcome, problem, settings.limits)) from interruption
        outcome.place_into(part, _outcome(call))
    return name_failures(outcome, problem, settings.limits)


def _call(
    kernel: ModuleType,
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None,
    spans: list[tuple[float, float]],
) -> Call:
    lanes = initial_state.shape[1]
    drives = piece_rows(problem, spans, kernel)
    amplitudes = drives[:, kernel.AMPLITUDE : kernel.AMPLITUDE + kernel.INPUT_COUNT]
    count = 0 if sampling is None else sampling.count
    return Call(
        kernel=kernel,
        table=_table(kernel, problem, initial_state, sampling),
        drives=drives,
        vibrates=np.any(amplitudes != 0, axis=(0, 2)),
        pieces=np.array([(*span, float(settings.measures(*span))) for span in spans]),
        numerics=_numerics(settings),
        averages=settings.averages,
        results=_empty_results(kernel, lanes),
        samples=np.full((count, kernel.STATE_COUNT, lanes), np.nan),
        stop=np.zeros(1, dtype=np.int8),
    )


def _numerics(settings: RunSettings) -> np.ndarray:
    control, limits = settings.control, settings.limits
    return np.array(
        [control.rtol, control.atol, limits.smallest_stretch, limits.largest_stretch, settings.duration]
    )


def _table(
    kernel: ModuleType, problem: Problem, initial_state: np.ndarray, sampling: Sampling | None
) -> np.ndarray:
    """What every lane is made of, (TABLE_ROWS, n_lanes)."""
    table = np.zeros((kernel.TABLE_ROWS, initial_state.shape[1]))
    with np.errstate(all="ignore"):  # a lane beyond double precision is lost, and its status says so
        for row, value in enumerate(kernel.constants(problem.parameters), start=kernel.FIRST_CONSTANT):
            table[row] = value
    table[kernel.FIRST_STATE : kernel.FIRST_STATE + kernel.STATE_COUNT] = initial_state
    if sampling is not None:
        table[kernel.FIRST_SAMPLE], table[kernel.SAMPLE_SPACING] = sampling.first, sampling.spacing
    return table


def _empty_results(kernel: ModuleType, lanes: int) -> np.ndarray:
    results = np.full((kernel.RESULT_ROWS, lanes), np.nan)
    results[kernel.MAXIMUM : kernel.MAXIMUM + kernel.COORDINATE_COUNT] = -np.inf
    results[kernel.MINIMUM : kernel.MINIMUM + kernel.COORDINATE_COUNT] = np.inf
    results[kernel.STATUS] = kernel.INTERRUPTED
    return results


def _outcome(call: Call) -> Outcome:
    """What the kernel has written, with nothing of lanes that had not ended."""
    kernel, results = call.kernel, call.results
    coordinates = kernel.COORDINATE_COUNT

    def rows(start: int, count: int) -> np.ndarray:
        return results[start : start + count]

    unfinished = results[kernel.STATUS] == kernel.INTERRUPTED
    results[: kernel.STATUS, unfinished] = np.nan
    results[kernel.STATUS + 1 :, unfinished] = 0.0
    averages = np.nan if not call.averages else 0.0
    return Outcome(
        maximum=rows(kernel.MAXIMUM, coordinates),
        minimum=rows(kernel.MINIMUM, coordinates),
        mean=rows(kernel.MEAN, coordinates) + averages,
        mean_square=rows(kernel.MEAN_SQUARE, coordinates) + averages,
        state=rows(kernel.LAST_STATE, kernel.STATE_COUNT),
        status=results[kernel.STATUS].astype(int),
        status_time=results[kernel.STATUS_TIME],
        steps=results[kernel.STEPS_TAKEN].astype(int),
        rejections=results[kernel.STEPS_REJECTED].astype(int),
        samples=call.samples,
    )
