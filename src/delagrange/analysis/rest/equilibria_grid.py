"""Equilibria over the fields, or charges, that were asked for, on every branch."""

from __future__ import annotations

import numpy as np

from delagrange.analysis.rest.arguments import resting_variables
from delagrange.analysis.rest.criteria import (
    BREAKDOWN_DEFINITION,
    Criteria,
    breakdown_margin,
    edge_forces,
    material,
    tension_margin,
    thickness_stretch,
    true_field,
)
from delagrange.drives.inputs import ELECTRIC_FIELD, ElectricalInput
from delagrange.equilibrium.pieces import FOLD, Piece, point_at
from delagrange.equilibrium.statics import Statics
from delagrange.equilibrium.vibration import (
    MARGINAL,
    STABILITY_MEANING,
    STABLE,
    growing_directions,
    stability_name,
)
from delagrange.run.run_dataset import variable

NO_EQUILIBRIUM = "no equilibrium"
_MEASURES = {
    "edge_force_1": ("N", "force on an edge of axis 1, pulling if positive", "springs and field at rest"),
    "edge_force_2": ("N", "force on an edge of axis 2, pulling if positive", "springs and field at rest"),
    "thickness_stretch": ("1", "stretch through the thickness", "principal stretch 3"),
    "true_field": ("V/m", "true electric field", "voltage over the thickness as it is"),
}  # fmt: skip
_BY_MARGIN = "upper limit point; NaN without one"
_FLAGS = {
    "tension_lost": "a nominal edge stress is below smallest_tension; the membrane wrinkles",
    "breakdown": BREAKDOWN_DEFINITION,
}


def grid_variables(
    statics: Statics, pieces: list[Piece], criteria: Criteria, fields: np.ndarray, over: tuple[str, ...]
) -> dict[str, tuple]:
    """Variables over (field, branch), or (branch,) where `over` is empty.

    fields: (n_fields,), [V/m], or charges [C/m^2] or currents [A/m^2]
    """
    model, measures = statics.problem.model, _measures(statics.electrical)
    shape = (len(fields), len(pieces))
    values = {entry.name: np.full(shape, np.nan) for entry in model.STATE}
    values |= {name: np.full(shape, np.nan) for name in measures}
    values |= {name: np.zeros(shape, dtype=bool) for name in _FLAGS}
    values["stability"] = np.full(shape, NO_EQUILIBRIUM, dtype=object)
    for place, field in np.ndenumerate(np.broadcast_to(fields[:, None], shape)):
        piece = pieces[place[1]]
        if piece.covers(abs(field)):
            for name, value in _equilibrium(statics, piece, criteria, float(field)).items():
                values[name][place] = value
    squeezed = values if over else {name: array[0] for name, array in values.items()}
    data = _variables(statics, squeezed, (*over, "branch"))
    return data | _field_variables(statics, values["stability"], fields, over)


def _measures(electrical: ElectricalInput) -> dict[str, tuple[str, str, str]]:
    """Unit, long name and definition of what is said of every equilibrium."""
    what = electrical.text
    margins = {
        "margin": (electrical.unit, f"{what} at the limit point of the branch less the {what}", _BY_MARGIN),
        "relative_margin": ("1", f"margin over the {what} at the limit point", _BY_MARGIN),
    }
    return margins | _MEASURES


def _equilibrium(statics: Statics, piece: Piece, criteria: Criteria, field: float) -> dict[str, object]:
    """All that is said of one equilibrium."""
    x = point_at(statics, piece, abs(field)).x
    limit = piece.high if piece.upper_end == FOLD else np.nan
    forces = edge_forces(statics, x)
    names = [entry.name for entry in statics.problem.model.STATE]
    return dict(zip(names, statics.signed_state(x, field))) | {
        "stability": _stability(statics, piece, x),
        "margin": limit - abs(field),
        "relative_margin": (limit - abs(field)) / limit,
        "edge_force_1": forces[0],
        "edge_force_2": forces[1],
        "thickness_stretch": thickness_stretch(statics, x),
        "true_field": true_field(statics, x),
        "tension_lost": tension_margin(statics, x, criteria) < 0,
        "breakdown": breakdown_margin(statics, x, criteria) <= 0,
    }


def _stability(statics: Statics, piece: Piece, x: np.ndarray) -> str:
    """At a fold, where an eigenvalue is zero, its sign would be that of round-off."""
    at_fold = (piece.upper_end == FOLD and x[-1] == piece.high) or (
        piece.lower_end == FOLD and x[-1] == piece.low
    )
    return MARGINAL if at_fold else stability_name(statics, growing_directions(statics, x))


def _variables(
    statics: Statics, values: dict[str, np.ndarray], dimensions: tuple[str, ...]
) -> dict[str, tuple]:
    model = statics.problem.model
    data = resting_variables(model, dimensions, [values[entry.name] for entry in model.STATE])
    for name, (unit, long_name, definition) in _measures(statics.electrical).items():
        data[name] = variable(dimensions, values[name], unit, long_name, definition=definition)
    for name, definition in _FLAGS.items():
        long_name = name.replace("_", " ")
        data[name] = dimensions, values[name], {"long_name": long_name, "definition": definition}
    attributes = {"long_name": "stability of the equilibrium", "meaning": STABILITY_MEANING}
    data["stability"] = dimensions, values["stability"], attributes
    return data


def _field_variables(
    statics: Statics, stability: np.ndarray, fields: np.ndarray, over: tuple[str, ...]
) -> dict[str, tuple]:
    counts = np.sum(stability != NO_EQUILIBRIUM, axis=1), np.sum(stability == STABLE, axis=1)
    count, stable = (values if over else values[0] for values in counts)
    return _voltage(statics, fields, over) | {
        "count": variable(over, count, "1", "number of equilibria found"),
        "stable_count": variable(over, stable, "1", "number of stable equilibria found"),
    }


def _voltage(statics: Statics, fields: np.ndarray, over: tuple[str, ...]) -> dict[str, tuple]:
    if statics.electrical is not ELECTRIC_FIELD:
        return {}
    voltages = fields * 2 * material(statics.problem, "half_thickness")
    definition = "field times 2 half_thickness"
    return {
        "voltage": variable(
            over, voltages if over else voltages[0], "V", "voltage", "U", definition=definition
        )
    }
