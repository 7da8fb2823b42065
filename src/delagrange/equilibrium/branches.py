"""All branches of equilibria over field or charge: the one from the unloaded membrane, and whatever else there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.drives.inputs import input_name
from delagrange.equilibrium.continuation import Lost, Point, parameter_of
from delagrange.equilibrium.pieces import FOLD, Piece, locate_on, point_at, trace
from delagrange.equilibrium.seeds import equilibria_at, same
from delagrange.equilibrium.statics import Statics, typical_electrical, unloaded
from delagrange.equilibrium.vibration import growing_directions, stability_margin

_FARTHEST = 20.0  # typical fields, or charges: as far as a curve is followed, to see where it ends
_SEED_FIELDS = {1: 9, 2: 5}  # at which equilibria are looked for, by the number of coordinates

PULL_IN, SNAP_THROUGH, SNAP_BACK, TURNING = "pull-in", "snap-through", "snap-back", "turning point"
LIMIT_MEANING = (
    f"{PULL_IN}: a stable branch ends at a maximum of the electrical input, beyond which it has nowhere to go; "
    f"{SNAP_THROUGH}: it ends at a maximum, and another stable branch goes on beyond; "
    f"{SNAP_BACK}: a stable branch ends at a minimum of the electrical input; "
    f"{TURNING}: an unstable branch turns back"
)


@dataclass(frozen=True)
class LimitPoint:
    """A fold: two equilibria meet there."""

    point: Point
    kind: str


def range_of_input(statics: Statics, largest: float) -> float:
    """Up to which field [V/m], or charge [C/m^2], curves are followed: `largest`, or far beyond all that happens."""
    return max(largest, _FARTHEST * typical_electrical(statics))


def acting_forces(statics: Statics) -> dict[str, float]:
    """Every input but the electrical one that is not zero, by name, in the model's order."""
    entries = zip(statics.problem.model.INPUTS, statics.inputs)
    return {
        entry.name: float(value)
        for entry, value in entries
        if entry.name != statics.electrical.name and value != 0
    }


def at_zero_field(statics: Statics) -> np.ndarray:
    """x under the forces alone, reached from the unloaded membrane as each grows from zero, in the model's order.

    Raises:
        Lost: the membrane does not stand them.
    """
    x, growing = unloaded(statics), acting_forces(statics)
    grown = {statics.electrical.name: 0.0} | dict.fromkeys(growing, 0.0)
    for name, value in growing.items():
        x = _grown(statics.varying(name, **grown), x, value)
        grown[name] = value
    return np.append(x[:-1], 0.0)


def _grown(statics: Statics, x: np.ndarray, value: float) -> np.ndarray:
    """x at a value of the varied input, reached from x without it as it grows from zero."""
    x = np.append(x[:-1], 0.0)
    for piece in trace(statics, x, min(value, 0.0), max(value, 0.0)):
        if piece.covers(0.0) and piece.covers(value) and same(point_at(statics, piece, 0.0).x, x):
            return point_at(statics, piece, value).x
    name, unit = input_name(statics.name), statics.problem.model.INPUTS[statics.varied].unit
    without = f"no equilibrium without {statics.electrical.text} is reached"
    raise Lost(f"{without} as the {name} grows from 0 {unit} to {value:g} {unit}")


def connected_pieces(statics: Statics, largest: float) -> list[Piece]:
    """The curve of the membrane under its force as field or charge grows from zero; the first piece begins there.

    Raises:
        Lost: no equilibrium without it.
    """
    electrical_varies = statics.varying(statics.electrical.name)
    return trace(electrical_varies, at_zero_field(statics), 0.0, range_of_input(statics, largest))


def all_pieces(statics: Statics, largest: float) -> list[Piece]:
    """Every piece found from 0 to `largest` [V/m], or [C/m^2] of charge, the one from the unloaded membrane first."""
    try:
        pieces = connected_pieces(statics, largest)
    except Lost:
        pieces = []
    count = _SEED_FIELDS.get(statics.problem.model.COORDINATE_COUNT, 3)
    for value in np.linspace(0.0, largest, count) if largest > 0 else [0.0]:
        for x in equilibria_at(statics, float(value)):
            if not any(_holds(statics, piece, x) for piece in pieces):
                pieces += trace(statics, x, 0.0, range_of_input(statics, largest))
    return pieces


def why_not_from_unloaded(statics: Statics) -> str | None:
    """Why no branch begins at the unloaded membrane; None where one does."""
    try:
        at_zero_field(statics)
    except Lost as reason:
        return str(reason)
    return None


def limit_points(statics: Statics, pieces: list[Piece]) -> list[LimitPoint]:
    """Every fold of the pieces, in order, with what happens there."""
    found: list[LimitPoint] = []
    for piece in pieces:
        for end, point in ((piece.lower_end, piece.points[0]), (piece.upper_end, piece.points[-1])):
            if end == FOLD and not any(_is_at(limit.point, point) for limit in found):
                found.append(LimitPoint(point, _kind(statics, pieces, point)))
    return found


def stable_until(statics: Statics, piece: Piece) -> Point | None:
    """Where a piece that begins stable ceases to be so before its end; None where it does not."""
    inner = piece.points[:-1] if piece.upper_end == FOLD else piece.points
    if all(growing_directions(statics, point.x) == 0 for point in inner):
        return None
    crossings = locate_on(statics, piece, lambda x: stability_margin(statics, x))
    return crossings[0] if crossings else piece.points[0]


def _holds(statics: Statics, piece: Piece, x: np.ndarray) -> bool:
    return piece.covers(x[-1]) and same(point_at(statics, piece, float(x[-1])).x, x)


def _is_at(one: Point, other: Point) -> bool:
    return np.array_equal(one.x, other.x)


def _kind(statics: Statics, pieces: list[Piece], fold: Point) -> str:
    above = [piece for piece in pieces if piece.upper_end == FOLD and _is_at(piece.points[-1], fold)]
    below = [piece for piece in pieces if piece.lower_end == FOLD and _is_at(piece.points[0], fold)]
    if not any(_stable_beside(statics, piece, fold) for piece in above + below):
        return TURNING
    if below:
        return SNAP_BACK
    value = parameter_of(fold)
    others = [piece for piece in pieces if piece.covers(value) and piece not in above]
    onwards = any(growing_directions(statics, point_at(statics, piece, value).x) == 0 for piece in others)
    return SNAP_THROUGH if onwards else PULL_IN


def _stable_beside(statics: Statics, piece: Piece, fold: Point) -> bool:
    beside = piece.points[-2] if _is_at(piece.points[-1], fold) else piece.points[1]
    return growing_directions(statics, beside.x) == 0
