"""Branches of equilibria, their curves and their limit points as variables of a Dataset."""

from __future__ import annotations

import numpy as np

from delagrange.analysis.rest.arguments import resting_variables
from delagrange.analysis.rest.criteria import Criteria, breakdown_margin, material, tension_margin
from delagrange.drives.inputs import ELECTRIC_FIELD, ElectricalInput
from delagrange.equilibrium.branches import LIMIT_MEANING, LimitPoint
from delagrange.equilibrium.continuation import Point
from delagrange.equilibrium.pieces import FOLD, Piece
from delagrange.equilibrium.statics import Statics
from delagrange.equilibrium.vibration import STABILITY_MEANING, growing_directions, stability_name
from delagrange.run.run_dataset import variable

_ENDING_MEANING = (
    "fold: it turns back there, at a limit point; limit: a stretch beyond the limits; lost: the continuation "
    "could not go on, and says where; else as it says"
)


def branch_variables(pieces: list[Piece], electrical: ElectricalInput) -> dict[str, tuple]:
    """From which field, or charge, to which every branch reaches, and why it ends there."""
    name, text, unit = electrical.argument, electrical.text, electrical.unit

    def texts(values: list[str], long_name: str) -> tuple:
        attributes = {"long_name": long_name, "meaning": _ENDING_MEANING}
        return "branch", np.array(values, dtype=object), attributes

    lowest, highest = [piece.low for piece in pieces], [piece.high for piece in pieces]
    return {
        f"branch_lowest_{name}": variable("branch", lowest, unit, f"smallest {text} of the branch"),
        f"branch_highest_{name}": variable("branch", highest, unit, f"largest {text} of the branch"),
        "branch_lower_end": texts(
            [piece.lower_end for piece in pieces], f"why it ends at its smallest {text}"
        ),
        "branch_upper_end": texts(
            [piece.upper_end for piece in pieces], f"why it ends at its largest {text}"
        ),
    }


def curve_variables(statics: Statics, pieces: list[Piece], criteria: Criteria) -> dict[str, tuple]:
    """Every point of every branch, in the order of the growing field or charge."""
    points = [point for piece in pieces for point in piece.points]
    numbers = [number for number, piece in enumerate(pieces) for _ in piece.points]
    names = [name for piece in pieces for name in _stabilities(statics, piece)]
    attributes = {"long_name": "stability on the branch", "meaning": STABILITY_MEANING}
    slack = np.array([tension_margin(statics, point.x, criteria) < 0 for point in points], dtype=bool)
    broken = np.array([breakdown_margin(statics, point.x, criteria) <= 0 for point in points], dtype=bool)
    return _state_variables(statics, points, "point", "curve_", "on the branch") | {
        "curve_branch": variable("point", np.array(numbers, dtype=int), "1", "branch of the point"),
        "curve_tension_lost": ("point", slack, {"long_name": "tension lost on the branch"}),
        "curve_breakdown": ("point", broken, {"long_name": "breakdown on the branch"}),
        "curve_stability": ("point", np.array(names, dtype=object), attributes),
    }


def _stabilities(statics: Statics, piece: Piece) -> list[str]:
    """Stability at every point of a piece; at a fold, where it changes, as on the rest of the piece."""
    names = [stability_name(statics, growing_directions(statics, point.x)) for point in piece.points]
    if len(names) > 1:
        names[0] = names[1] if piece.lower_end == FOLD else names[0]
        names[-1] = names[-2] if piece.upper_end == FOLD else names[-1]
    return names


def limit_variables(statics: Statics, limits: list[LimitPoint]) -> dict[str, tuple]:
    """The folds of all branches."""
    points = [limit.point for limit in limits]
    kinds = np.array([limit.kind for limit in limits], dtype=object)
    data = _state_variables(statics, points, "limit_point", "limit_", "at the limit point")
    if statics.electrical is ELECTRIC_FIELD:
        fields = np.array([point.x[-1] for point in points])
        voltages = fields * 2 * material(statics.problem, "half_thickness")
        data["limit_voltage"] = variable("limit_point", voltages, "V", "voltage at the limit point", "U")
    data["limit_kind"] = "limit_point", kinds, {"long_name": "kind of limit", "meaning": LIMIT_MEANING}
    return data


def _state_variables(
    statics: Statics, points: list[Point], dimension: str, prefix: str, where: str
) -> dict[str, tuple]:
    """The field, or charge, and the state variables of points, each with a prefix."""
    model, electrical = statics.problem.model, statics.electrical
    states = np.array([statics.state(point.x) for point in points]).reshape(-1, len(model.STATE)).T
    fields = np.array([point.x[-1] for point in points])
    long_name = f"{electrical.long_name} {where}"
    data = {
        prefix + electrical.argument: variable(
            dimension, fields, electrical.unit, long_name, electrical.symbol
        )
    }
    return data | resting_variables(model, dimension, states, where, prefix)
