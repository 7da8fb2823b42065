"""The flow of a model with its tangent through the compiled core."""

from __future__ import annotations

import numpy as np

from delagrange.core.kernel import TangentCall, load_core
from delagrange.core.structures import AMPLITUDE, FREQUENCY, LEVEL, PHASE
from delagrange.engines.core_drives import piece_rows
from delagrange.engines.core_engine import known_status, parameter_rows
from delagrange.engines.flow import FlowPath, Source, Travel, checked_start, drive_numbers

_BUDGET = 20000  # steps of a call, a fifth of a second or less, after which the keyboard is heard
_ROWS = (LEVEL, AMPLITUDE, FREQUENCY, PHASE)  # of the numbers bias, amplitude, frequency and phase of a drive


def flow_by_core(
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
        RuntimeError: the model has no header, or it cannot be compiled on this machine.
    """
    core = load_core(path.problem.model)
    if core is None:
        raise RuntimeError(f"the model {path.problem.model.MODEL} has no header beside its module")
    state, times, tangent, sources = checked_start(path, state, times, tangent, sources)
    drive_numbers(path.problem)  # refuses what is neither constant nor a sine
    rows = [(-1, -1) if source is None else (source.place, _ROWS[source.number]) for source in sources]
    call = core.tangent(
        parameter_rows(path.problem)[:, 0].copy(),
        state,
        piece_rows(path.problem, [(float(times[0]), float(times[-1]))])[0, :, :, 0].copy(),
        np.array(times, dtype=float),
        np.ascontiguousarray(tangent.T),
        np.array(rows, dtype=np.int64).reshape(len(rows), 2),
        weights=np.array(path.weights, dtype=float),
        tolerance=path.tolerance,
        smallest=path.limits.smallest_stretch,
        largest=path.limits.largest_stretch,
        normalise=bool(normalise),
    )
    budget = max(1, _BUDGET // (1 + len(rows) // 8))
    while call.go_on(budget):
        pass
    return _travel(call)


def _travel(call: TangentCall) -> Travel:
    outcome = call.outcome
    return Travel(
        state=outcome.states,
        tangent=outcome.last_columns.T.copy(),
        growth=outcome.growth,
        divergence=outcome.divergence,
        maximum=outcome.maximum,
        minimum=outcome.minimum,
        status=int(known_status(np.array(call.job.status))),
        status_time=float(call.job.status_time),
        steps=int(call.job.steps),
    )
