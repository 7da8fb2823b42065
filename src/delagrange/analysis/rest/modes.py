"""Natural frequencies and modes of vibration about an equilibrium, and how they move with what is varied."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.rest.arguments import (
    FROZEN_MEANING,
    RELAXED_MEANING,
    Cases,
    make_cases,
)
from delagrange.analysis.rest.modes_dataset import modes_variables
from delagrange.common import checks
from delagrange.drives.inputs import CURRENT_DENSITY, Inputs
from delagrange.equilibrium.branches import connected_pieces
from delagrange.equilibrium.continuation import Lost
from delagrange.equilibrium.pieces import FOLD, Piece, point_at
from delagrange.equilibrium.statics import Statics
from delagrange.equilibrium.vibration import (
    Spectrum,
    growing_directions,
    relaxing_vibration,
    stability_name,
    vibration,
)
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import FROZEN, RELAXED, is_damped
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits
from delagrange.run.run_dataset import variable

_UNDAMPED = "a parallel dashpot or the medium damps: the frequencies are those without that damping"


def modes(
    model: str | ModuleType,
    *,
    force: float | np.ndarray = 0.0,
    inputs: Inputs | None = None,
    field: float | np.ndarray | None = None,
    dashpots: str = "frozen",
    held_stretch: float | np.ndarray | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    limits: Limits | None = None,
    **material_changes: float | np.ndarray,
) -> xr.Dataset:
    """Natural frequencies about the equilibrium that the unloaded membrane reaches under force, then field.

    Each of force, field, held stretch and material may be a one-dimensional array, and is then a dimension
    (the field the last).

    Args:
        force: on each loaded edge [N].
        inputs: of any other input but the field by its name, as {"force_2": 0.3}, numbers or arrays; each grows
            from zero before the field, in the order of the model's inputs. Also the charge or current of a model
            that is driven by one, instead of a field, as for `equilibria`; it is the last dimension.
        field: constant nominal field [V/m], zero if left out; its sign does not matter.
        dashpots: "frozen", as in the reference state or `initial_state`: no damping at all; or "relaxed", the
            equilibrium has relaxed and the dashpots flow as the membrane vibrates, which damps it. Under a current
            the charge flows in either case, and all that damps is counted.
        others: as in `equilibria`.

    Returns:
        Dataset over (the arrays given, `mode`): `frequency` [Hz], ascending; `resonant_field_frequency` [Hz], of
        a field without bias that excites the mode (or `resonant_charge_frequency`, `resonant_current_frequency`);
        `shape` (`coordinate`, `mode`); `growth_rate` [1/s] where a mode grows instead; with relaxed dashpots
        `decay_rate` [1/s], and `relaxation_rate` of what decays without vibrating. The state variables and `status`
        say about which equilibrium, or why there is none (NaN).

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    checks.choice("dashpots", dashpots, (FROZEN, RELAXED))
    values = {"force": force, "held_stretch": held_stretch, **material_changes}
    cases = make_cases(
        model, formulation, lateral_dashpot, parameters, initial_state, limits, values, inputs, ("field", field)
    )
    electrical, given = cases.electrical, cases.given
    fields = 0.0 if given.values is None else given.values
    fields = np.asarray(checks.finite(given.name, fields, electrical.unit), dtype=float)
    if fields.ndim:
        fields = checks.distinct(given.name, fields, electrical.unit)
    damped = dashpots == RELAXED or electrical is CURRENT_DENSITY
    spectra = [
        spectrum
        for problem in cases.problems()
        for spectrum in _spectra(cases, problem, dashpots, np.atleast_1d(fields))
    ]
    over = (electrical.argument,) if fields.ndim else ()
    dimensions = (*cases.grid.axes, *over)
    along = variable(over, fields, electrical.unit, electrical.long_name, electrical.symbol)
    return xr.Dataset(
        modes_variables(cases.model, spectra, dimensions, (*cases.grid.shape, *fields.shape), damped),
        coords=cases.coordinates() | {electrical.argument: along},
        attrs=cases.attributes(dashpots)
        | {"dashpots_meaning": f"{FROZEN_MEANING}; {RELAXED_MEANING}, and flow as the membrane vibrates"}
        | ({"damping_meaning": _UNDAMPED} if not damped and is_damped(cases.first_problem()) else {}),
    )


def _spectra(cases: Cases, problem: Problem, dashpots: str, fields: np.ndarray) -> list[Spectrum]:
    """The spectrum at each field, or charge or current."""
    largest = float(np.max(np.abs(fields)))
    statics = cases.statics(problem, dashpots, largest)
    try:
        piece = connected_pieces(statics, largest)[0]
    except Lost as reason:
        return [_nothing(statics, f"no equilibrium: {reason}")] * len(fields)
    return [_spectrum(statics, piece, float(field)) for field in fields]


def _spectrum(statics: Statics, piece: Piece, field: float) -> Spectrum:
    if not piece.covers(abs(field)):
        what = "beyond the limit point" if piece.upper_end == FOLD else piece.upper_end
        return _nothing(statics, f"no equilibrium: {what} at {piece.high:.7g} {statics.electrical.unit}")
    x = point_at(statics, piece, abs(field)).x
    count, states = statics.problem.model.COORDINATE_COUNT, len(statics.rest)
    relaxation = np.full(states, np.nan)
    if statics.flowing.size:
        vibrating, real = relaxing_vibration(statics, x)
        relaxation[: len(real)] = real
    else:
        vibrating = vibration(statics, x)
    rates = np.full(count, np.nan + 0j)
    shapes = np.full((count, count), np.nan)
    rates[: len(vibrating.rates)] = vibrating.rates
    shapes[:, : len(vibrating.rates)] = vibrating.shapes
    status = stability_name(statics, growing_directions(statics, x))
    return Spectrum(status, statics.signed_state(x, field), rates, shapes, relaxation)


def _nothing(statics: Statics, status: str) -> Spectrum:
    count, states = statics.problem.model.COORDINATE_COUNT, len(statics.rest)
    return Spectrum(
        status,
        np.full(states, np.nan),
        np.full(count, np.nan + 0j),
        np.full((count, count), np.nan),
        np.full(states, np.nan),
    )
