"""Many runs at once through the compiled core, on all cores of the machine.

Every run has its own time, step and error control, so that its result is the same, bit for bit, whatever runs are
integrated beside it and on however many threads.
"""

from __future__ import annotations

import numpy as np

from delagrange.core.kernel import Core, RunsCall, load_core
from delagrange.core.structures import UNRESOLVED
from delagrange.engines.core_drives import piece_rows
from delagrange.engines.lanes import Interrupted, Outcome, RunSettings, Sampling, empty_outcome
from delagrange.engines.numpy_engine import Report, segments
from delagrange.engines.threads import run_on_threads, shifted, slices
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem

_DRIVE_NUMBERS = 1 << 22  # of the drives' pieces, in memory at a time


def integrate_by_core(
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None = None,
    report: Report | None = None,
) -> Outcome:
    """As `delagrange.engines.numpy_engine.integrate_lanes`, compiled.

    Raises:
        RuntimeError: the model has no header, or it cannot be compiled on this machine.
        Interrupted: from the keyboard; it carries the outcome of the lanes that had ended.
    """
    core = load_core(problem.model)
    if core is None:
        raise RuntimeError(f"the model {problem.model.MODEL} has no header beside its module")
    spans = list(segments(problem, settings))
    count = 0 if sampling is None else sampling.count
    coordinates, lanes = problem.model.COORDINATE_COUNT, initial_state.shape[1]
    outcome = empty_outcome(initial_state, coordinates, loss.INTERRUPTED, count)
    for part in slices(lanes, max(1, _DRIVE_NUMBERS // (5 * max(1, len(problem.drives)) * len(spans)))):
        some = None if sampling is None else sampling.take(part)
        found = empty_outcome(initial_state[:, part], coordinates, loss.INTERRUPTED, count)
        stop = np.zeros(1, dtype=np.int8)
        call = _call(core, problem.take(part), initial_state[:, part], settings, some, spans, found, stop)
        try:
            told = shifted(report, part.start)
            run_on_threads(call.integrate, call.job.runs, call.lanes, stop, settings.threads, told)
        except KeyboardInterrupt as interruption:
            outcome.place_into(part, _finished(found))
            raise Interrupted(outcome) from interruption
        outcome.place_into(part, _finished(found))
    return outcome


def _call(
    core: Core,
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None,
    spans: list[tuple[float, float]],
    found: Outcome,
    stop: np.ndarray,
) -> RunsCall:
    found.maximum[:], found.minimum[:] = -np.inf, np.inf
    control, limits = settings.control, settings.limits
    results = {
        name: getattr(found, name)
        for name in (
            "maximum",
            "minimum",
            "mean",
            "mean_square",
            "status",
            "status_time",
            "steps",
            "rejections",
        )
    }
    return core.runs(
        parameter_rows(problem),
        np.ascontiguousarray(initial_state, dtype=float),
        np.array([(*span, float(settings.measures(*span))) for span in spans]),
        piece_rows(problem, spans),
        rtol=control.rtol,
        atol=np.broadcast_to(np.asarray(control.atol, dtype=float), (len(initial_state),)).copy(),
        smallest=limits.smallest_stretch,
        largest=limits.largest_stretch,
        averages=settings.averages,
        results=results | {"last_state": found.state},
        samples=None if sampling is None else found.samples,
        first_sample=None if sampling is None else np.array(sampling.first, dtype=float),
        sample_spacing=None if sampling is None else np.array(sampling.spacing, dtype=float),
        stop=stop,
    )


def parameter_rows(problem: Problem) -> np.ndarray:
    """(n_parameters, n_lanes), or 1 where all lanes have them in common."""
    shape = np.broadcast_shapes((1,), *map(np.shape, problem.parameters))
    rows = np.empty((len(problem.parameters), *shape))
    for row, value in zip(rows, problem.parameters):
        row[:] = value
    return rows


def _finished(found: Outcome) -> Outcome:
    """What the core has written, with nothing of lanes that had not ended."""
    unfinished = found.status == loss.INTERRUPTED
    for name in ("maximum", "minimum", "mean", "mean_square", "state"):
        getattr(found, name)[:, unfinished] = np.nan
    for name in ("status_time", "steps", "rejections"):
        getattr(found, name)[unfinished] = 0
    found.status[:] = known_status(found.status)
    return found


def known_status(status: np.ndarray) -> np.ndarray:
    """Statuses of the core as `delagrange.problem.status` counts them, where what no step resolves has diverged."""
    return np.where(np.equal(status, UNRESOLVED), loss.DIVERGED, status)
