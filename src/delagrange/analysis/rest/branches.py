"""All branches of equilibria over the field: the one from the unloaded membrane, and whatever else there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.analysis.continuation import Lost, Point, parameter_of
from delagrange.analysis.rest.pieces import FOLD, Piece, locate_on, point_at, trace
from delagrange.analysis.rest.seeds import equilibria_at, same
from delagrange.analysis.rest.statics import FIELD, FORCE, Statics, typical_field, unloaded
from delagrange.analysis.rest.vibration import growing_directions, stability_margin

_FARTHEST = 20.0  # typical fields: as far as a curve is followed, to see where it ends
_SEED_FIELDS = {1: 9, 2: 5}  # at which equilibria are looked for, by the number of coordinates

PULL_IN, SNAP_THROUGH, SNAP_BACK, TURNING = "pull-in", "snap-through", "snap-back", "turning point"
LIMIT_MEANING = (
    f"{PULL_IN}: a stable branch ends at a maximum of the field, beyond which it has nowhere to go; "
    f"{SNAP_THROUGH}: it ends at a maximum, and another stable branch goes on beyond; "
    f"{SNAP_BACK}: a stable branch ends at a minimum of the field; "
    f"{TURNING}: an unstable branch turns back"
)


@dataclass(frozen=True)
class LimitPoint:
    """A fold: two equilibria meet there."""

    point: Point
    kind: str


def range_of_field(statics: Statics, largest: float) -> float:
    """Up to which field [V/m] curves are followed: `largest`, or far beyond where anything happens."""
    return max(largest, _FARTHEST * typical_field(statics))


def at_zero_field(statics: Statics) -> np.ndarray:
    """x under the force alone, reached from the unloaded membrane as the force grows from zero.

    Raises:
        Lost: the membrane does not stand that force.
    """
    x = unloaded(statics)
    names = [entry.name for entry in statics.problem.model.INPUTS]
    force = statics.inputs[names.index(FORCE)] if FORCE in names else 0.0
    if force == 0:
        return x
    under_force = statics.varying(FORCE, **{FIELD: 0.0})
    for piece in trace(under_force, x, min(force, 0.0), max(force, 0.0)):
        if piece.covers(0.0) and piece.covers(force) and same(point_at(under_force, piece, 0.0).x, x):
            return np.append(point_at(under_force, piece, force).x[:-1], 0.0)
    raise Lost(f"no equilibrium without field is reached as the force grows from 0 N to {force:g} N")


def connected_pieces(statics: Statics, largest: float) -> list[Piece]:
    """The curve of the membrane under its force as the field grows from zero; the first piece begins there.

    Raises:
        Lost: no equilibrium without field.
    """
    field_varies = statics.varying(FIELD)
    return trace(field_varies, at_zero_field(statics), 0.0, range_of_field(statics, largest))


def all_pieces(statics: Statics, largest: float) -> list[Piece]:
    """Every piece found over fields from 0 to `largest` [V/m], the one from the unloaded membrane first."""
    try:
        pieces = connected_pieces(statics, largest)
    except Lost:
        pieces = []
    count = _SEED_FIELDS.get(statics.problem.model.COORDINATE_COUNT, 3)
    for value in np.linspace(0.0, largest, count) if largest > 0 else [0.0]:
        for x in equilibria_at(statics, float(value)):
            if not any(_holds(statics, piece, x) for piece in pieces):
                pieces += trace(statics, x, 0.0, range_of_field(statics, largest))
    return pieces


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
