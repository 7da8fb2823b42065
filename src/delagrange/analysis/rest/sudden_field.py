"""Dynamic pull-in by integration: many fields or charges at once, again between the last stood and the first not."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from delagrange.drives.drive import Constant
from delagrange.drives.inputs import electrical_input
from delagrange.engines.engines import ENGINES, resolve_numerics
from delagrange.engines.lanes import Outcome, RunSettings
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits
from delagrange.run.sweep import make_settings

_LANES = 64
_ROUNDS = 8
RTOL, ATOL = 1e-12, 1e-14
FINEST = 1e-11  # resolution of the field: about what the tolerance of the integration gives


@dataclass(frozen=True)
class Bracket:
    """A field, or charge, that the membrane stands over the whole duration, and a larger one that it does not."""

    safe: float  # [V/m], or [C/m^2]
    lost: float  # likewise; NaN where nothing up to the largest field is lost
    engine: str

    @property
    def middle(self) -> float:
        """The critical value."""
        return (self.safe + self.lost) / 2

    @property
    def width(self) -> float:
        """By which it is uncertain."""
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
        problem: with frozen dashpots or not; its electrical input is not looked at.
        start: (n_state,)
        largest: field [V/m], or charge [C/m^2], up to which to look.
        duration: of each run [s].
    """
    numerics = resolve_numerics("DOP853", engine, None, "dense", problem.model)
    settings = make_settings(duration, None, RTOL, ATOL, numerics, limits)
    safe, lost = 0.0, np.nan
    fields = np.linspace(0.0, largest, _LANES)
    for _ in range(_ROUNDS):
        failed = np.flatnonzero(~_stood(problem, start, fields, settings, numerics.engine))
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


def _stood(
    problem: Problem, start: np.ndarray, fields: np.ndarray, settings: RunSettings, engine: str
) -> np.ndarray:
    """At which fields the membrane stands the whole duration within the limits, (n_fields,) of bool."""
    electrical = electrical_input(problem.model).name
    drives = tuple(
        Constant(fields) if entry.name == electrical else drive
        for entry, drive in zip(problem.model.INPUTS, problem.drives)
    )
    states = np.repeat(start[:, None], len(fields), axis=1)
    outcome = ENGINES[engine].integrate(replace(problem, drives=drives), states, settings)
    return (outcome.status == loss.COMPLETED) & _within_limits(problem, states, outcome, settings.limits)


def _within_limits(problem: Problem, states: np.ndarray, outcome: Outcome, limits: Limits) -> np.ndarray:
    """Whether the largest and the smallest value of each coordinate are within the limits, (n_runs,) of bool.

    The engines look at the limits at the ends of steps: an excursion beyond that turns back inside of one step is
    in the extrema alone. With two coordinates, which have their extrema at different times, those of the in-plane
    stretches count, and the thickness is looked at at the ends of steps.
    """
    count = len(outcome.maximum)
    within = np.ones(states.shape[1], dtype=bool)
    for extreme in (outcome.maximum, outcome.minimum):
        with np.errstate(all="ignore"):  # a lost run may have gone beyond double precision
            principal = problem.principal_stretches(0.0, np.concatenate([extreme, states[count:]]))
        stretches = np.array(np.broadcast_to(principal, (3, states.shape[1])))
        if count > 1:
            stretches[2] = 1.0
        within &= loss.margin(stretches, limits) > 0
    return within
