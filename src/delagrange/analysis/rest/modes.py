"""Natural frequencies and modes of vibration about an equilibrium, and how they move with what is varied."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange import checks
from delagrange.analysis.continuation import Lost
from delagrange.analysis.rest.arguments import FROZEN_MEANING, RELAXED_MEANING, Cases, make_cases
from delagrange.analysis.rest.branches import connected_pieces
from delagrange.analysis.rest.modes_dataset import modes_variables
from delagrange.analysis.rest.pieces import FOLD, Piece, point_at
from delagrange.analysis.rest.statics import Statics, make_statics
from delagrange.analysis.rest.vibration import (
    growing_directions,
    relaxing_vibration,
    stability_name,
    vibration,
)
from delagrange.dashpots import FROZEN, RELAXED
from delagrange.dataset import variable
from delagrange.loss import Limits
from delagrange.parameters import SHENG_2015, Parameters
from delagrange.problem import Problem


@dataclass(frozen=True)
class Spectrum:
    """What is known of the vibrations about one equilibrium; NaN where there is none."""

    status: str
    state: np.ndarray  # (n_state,)
    rates: np.ndarray  # (n_coordinates,) of complex [1/s]
    shapes: np.ndarray  # (n_coordinates, n_coordinates), of each mode in a column
    relaxation: np.ndarray  # (n_state,), real rates [1/s]


def modes(
    model: str | ModuleType,
    *,
    force: float | np.ndarray = 0.0,
    field: float | np.ndarray = 0.0,
    dashpots: str = "frozen",
    held_stretch: float | np.ndarray | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters = SHENG_2015,
    initial_state: Mapping[str, float] | None = None,
    limits: Limits | None = None,
    **material_changes: float | np.ndarray,
) -> xr.Dataset:
    """Natural frequencies about the equilibrium that the unloaded membrane reaches under force, then field.

    Each of force, field, held stretch and material may be a one-dimensional array, and is then a dimension
    (the field the last).

    Args:
        force: on each loaded edge [N].
        field: constant nominal field [V/m]; its sign does not matter.
        dashpots: "frozen", as in the reference state or `initial_state`: no damping at all; or "relaxed", the
            equilibrium has relaxed and the dashpots flow as the membrane vibrates, which damps it.
        others: as in `equilibria`.

    Returns:
        Dataset over (the arrays given, `mode`): `frequency` [Hz], ascending; `resonant_field_frequency` [Hz], of
        a field without bias that excites the mode; `shape` (`coordinate`, `mode`); `growth_rate` [1/s] where a
        mode grows instead; with relaxed dashpots `decay_rate` [1/s], and `relaxation_rate` of what decays without
        vibrating. The state variables and `status` say about which equilibrium, or why there is none (NaN).

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    limits = Limits() if limits is None else limits
    checks.choice("dashpots", dashpots, (FROZEN, RELAXED))
    values = {"force": force, "held_stretch": held_stretch, **material_changes}
    cases = make_cases(model, formulation, lateral_dashpot, parameters, initial_state, limits, values)
    fields = np.asarray(checks.finite("field", field, "V/m"), dtype=float)
    if fields.ndim:
        fields = checks.distinct("field", fields, "V/m")
    spectra = [
        spectrum
        for problem in cases.problems()
        for spectrum in _spectra(cases, problem, dashpots, np.atleast_1d(np.abs(fields)))
    ]
    dimensions = (*cases.grid.axes, *(("field",) if fields.ndim else ()))
    along_field = variable("field" if fields.ndim else (), fields, "V/m", "nominal electric field", "E")
    return xr.Dataset(
        modes_variables(
            cases.model, spectra, dimensions, (*cases.grid.shape, *fields.shape), dashpots == RELAXED
        ),
        coords=cases.coordinates() | {"field": along_field},
        attrs=cases.attributes(dashpots)
        | {"dashpots_meaning": f"{FROZEN_MEANING}; {RELAXED_MEANING}, and flow as the membrane vibrates"},
    )


def _spectra(cases: Cases, problem: Problem, dashpots: str, fields: np.ndarray) -> list[Spectrum]:
    """The spectrum at each field."""
    statics = make_statics(problem, dashpots, cases.initial_state, cases.limits)
    try:
        piece = connected_pieces(statics, float(np.max(fields)))[0]
    except Lost as reason:
        return [_nothing(statics, f"no equilibrium: {reason}")] * len(fields)
    return [_spectrum(statics, piece, float(field)) for field in fields]


def _spectrum(statics: Statics, piece: Piece, field: float) -> Spectrum:
    if not piece.covers(field):
        what = "beyond the limit point" if piece.upper_end == FOLD else piece.upper_end
        return _nothing(statics, f"no equilibrium: {what} at {piece.high:.7g} V/m")
    x = point_at(statics, piece, field).x
    count, states = statics.problem.model.COORDINATE_COUNT, len(statics.rest)
    relaxation = np.full(states, np.nan)
    if statics.relaxed:
        vibrating, real = relaxing_vibration(statics, x)
        relaxation[: len(real)] = real
    else:
        vibrating = vibration(statics, x)
    rates = np.full(count, np.nan + 0j)
    shapes = np.full((count, count), np.nan)
    rates[: len(vibrating.rates)] = vibrating.rates
    shapes[:, : len(vibrating.rates)] = vibrating.shapes
    status = stability_name(statics, growing_directions(statics, x))
    return Spectrum(status, statics.state(x), rates, shapes, relaxation)


def _nothing(statics: Statics, status: str) -> Spectrum:
    count, states = statics.problem.model.COORDINATE_COUNT, len(statics.rest)
    return Spectrum(
        status,
        np.full(states, np.nan),
        np.full(count, np.nan + 0j),
        np.full((count, count), np.nan),
        np.full(states, np.nan),
    )
