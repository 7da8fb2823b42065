"""Dynamic pull-in by integration: many fields at once, and again between the last one stood and the first one not."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from delagrange import loss
from delagrange.analysis.rest.statics import FIELD
from delagrange.drive import Constant
from delagrange.engines import ENGINES, resolve_numerics
from delagrange.lanes import Settings
from delagrange.loss import Limits
from delagrange.problem import Problem
from delagrange.sweep import make_settings

_LANES = 64
_ROUNDS = 8
RTOL, ATOL = 1e-12, 1e-14
FINEST = 1e-11  # resolution of the field: about what the tolerance of the integration gives


@dataclass(frozen=True)
class Bracket:
    """A field that the membrane stands over the whole duration, and a larger one that it does not."""

    safe: float  # [V/m]
    lost: float  # [V/m]; NaN where nothing up to the largest field is lost
    engine: str

    @property
    def middle(self) -> float:
        """The critical field [V/m]."""
        return (self.safe + self.lost) / 2

    @property
    def width(self) -> float:
        """By which it is uncertain [V/m]."""
        return self.lost - self.safe


def bracket_by_integration(
    problem: Problem,
    start: np.ndarray,
    largest: float,
    duration: float,
    limits: Limits,
    engine: str,
    resolution: float = FINEST,
) -> Bracket:
    """The smallest field on a grid at which the solution is lost, refined to `resolution` times its value.

    Args:
        problem: with frozen dashpots or not; its field is not looked at.
        start: (n_state,)
        largest: field [V/m] up to which to look.
        duration: of each run [s].
    """
    numerics = resolve_numerics("DOP853", engine, None, "dense", problem.model)
    settings = make_settings(duration, None, RTOL, ATOL, numerics, limits)
    safe, lost = 0.0, np.nan
    fields = np.linspace(0.0, largest, _LANES)
    for _ in range(_ROUNDS):
        failed = np.flatnonzero(
            _statuses(problem, start, fields, settings, numerics.engine) != loss.COMPLETED
        )
        first = int(failed[0]) if failed.size else len(fields)
        if first == 0:
            return Bracket(np.nan, float(fields[0]), numerics.engine)
        safe = float(fields[first - 1])
        if not failed.size:
            break
        lost = float(fields[first])
        if lost - safe <= resolution * lost:
            break
        fields = np.linspace(safe, lost, _LANES)
    return Bracket(safe, lost, numerics.engine)


def _statuses(
    problem: Problem, start: np.ndarray, fields: np.ndarray, settings: Settings, engine: str
) -> np.ndarray:
    """How a run at each field ends."""
    drives = tuple(
        Constant(fields) if entry.name == FIELD else drive
        for entry, drive in zip(problem.model.INPUTS, problem.drives)
    )
    states = np.repeat(start[:, None], len(fields), axis=1)
    return ENGINES[engine].integrate(replace(problem, drives=drives), states, settings).status
