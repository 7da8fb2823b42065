"""Curves of equilibria over an input, cut at their folds into pieces on each of which the input only grows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from delagrange.drives.inputs import input_name
from delagrange.equilibrium.continuation import (
    Lost,
    Point,
    SolutionBranch,
    continue_branch,
    locate,
    parameter_of,
    solve,
    turning,
)
from delagrange.equilibrium.statics import STEPS, TOLERANCE, Statics

FOLD = "fold"
CLOSED = "closed on itself"
_FINEST = (
    1e-13,
    1e-11,
    1e-9,
)  # of the corrections of a point that is located: the first that round-off allows
_NEAR = 0.5  # of the distance of two neighbours: farther from them another branch was found


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of a curve from one fold or end to the next, in the order of the growing input."""

    points: tuple[Point, ...]  # with tangents towards larger values of the input
    lower_end: str  # why it ends at its smallest value of the input: "fold", or as a branch ends
    upper_end: str  # the same at its largest

    @property
    def low(self) -> float:
        """Smallest value of the input."""
        return parameter_of(self.points[0])

    @property
    def high(self) -> float:
        """Largest value of the input."""
        return parameter_of(self.points[-1])

    def covers(self, value: float) -> bool:
        """Whether the piece reaches a value of the input."""
        return self.low <= value <= self.high


def trace(statics: Statics, start: np.ndarray, low: float, high: float) -> list[Piece]:
    """The whole curve through x near `start`, both ways while the input is from `low` to `high`, in order.

    Empty where `start` leads to no equilibrium.
    """

    def inside(x: np.ndarray) -> str | None:
        if not low <= x[-1] <= high:
            return f"end of the range of the {input_name(statics.name).replace('_', ' ')}"
        return statics.outside(x)

    scale = statics.scale
    upwards = continue_branch(statics.residual, start, +1, scale, STEPS, inside)
    if not upwards.points:
        return []
    forwards = _reaching(statics, upwards, low, high)
    if upwards.ending == CLOSED:
        return _cut(statics, forwards, CLOSED, CLOSED)
    downwards = continue_branch(statics.residual, upwards.points[0], -1, scale, STEPS, inside)
    backwards = [_reversed(point) for point in _reaching(statics, downwards, low, high)[::-1]]
    return _cut(statics, backwards[:-1] + forwards, downwards.ending, upwards.ending)


def point_at(statics: Statics, piece: Piece, value: float) -> Point:
    """The equilibrium of a piece at a value of the input that it covers."""
    values = np.array([parameter_of(point) for point in piece.points])
    place = int(np.clip(np.searchsorted(values, value), 1, max(len(values) - 1, 1)))
    if len(values) == 1 or value in (values[place - 1], values[place]):
        return piece.points[place if len(values) > 1 and value == values[place] else place - 1]
    before, after = piece.points[place - 1], piece.points[place]
    fraction = (value - values[place - 1]) / (values[place] - values[place - 1])
    guess = before.x + fraction * (after.x - before.x)
    guess[-1] = value
    try:
        found = solve(statics.residual, guess, statics.scale, TOLERANCE)
    except Lost:
        found = None
    distance = np.linalg.norm((after.x - before.x) / statics.scale)
    if found is not None and np.linalg.norm((found.x - guess) / statics.scale) < _NEAR * distance:
        return Point(found.x, before.tangent, found.evaluation.payload)
    return _located(statics, before, after, lambda point: parameter_of(point) - value)


def locate_on(statics: Statics, piece: Piece, test: Callable[[np.ndarray], float]) -> list[Point]:
    """Where a function of x changes its sign along a piece, in the order of the growing input."""
    values = [test(point.x) for point in piece.points]
    return [
        _located(statics, before, after, lambda point: test(point.x))
        for before, after, first, last in zip(piece.points, piece.points[1:], values, values[1:])
        if first * last < 0
    ]


def _reaching(statics: Statics, branch: SolutionBranch, low: float, high: float) -> list[Point]:
    """The points, with the one at the very end of the range of the input where the branch goes beyond it."""
    points = list(branch.points)
    if points and branch.beyond is not None:
        for bound in (low, high):
            sides = [parameter_of(point) - bound for point in (points[-1], branch.beyond)]
            if np.sign(sides[0]) * np.sign(sides[1]) < 0:  # their product may underflow
                points.append(_at_bound(statics, points[-1], branch.beyond, bound))
                break
    return points


def _at_bound(statics: Statics, before: Point, beyond: Point, bound: float) -> Point:
    found = _located(statics, before, beyond, lambda point: parameter_of(point) - bound)
    x = found.x.copy()
    x[-1] = bound
    return replace(found, x=x)


def _located(statics: Statics, before: Point, after: Point, test: Callable[[Point], float]) -> Point:
    """Where a test vanishes between two neighbours, as finely as round-off allows; at worst the first of them."""
    for tolerance in _FINEST:
        try:
            return locate(statics.residual, before, after, test, statics.scale, tolerance)
        except Lost:
            continue
    return before


def _reversed(point: Point) -> Point:
    return replace(point, tangent=-point.tangent)


def _cut(statics: Statics, points: list[Point], first_ending: str, last_ending: str) -> list[Piece]:
    """Pieces between neighbouring folds, in the order of travel."""
    pieces, current, ending = [], [points[0]], first_ending
    for before, after in pairwise(points):
        if turning(before) * turning(after) < 0:
            fold = _located(statics, before, after, turning)
            pieces.append(_piece([*current, fold], ending, FOLD))
            current, ending = [fold], FOLD
        current.append(after)
    pieces.append(_piece(current, ending, last_ending))
    return [piece for piece in pieces if len(piece.points) > 1 or len(pieces) == 1]


def _piece(points: list[Point], first_ending: str, last_ending: str) -> Piece:
    """In the order of the growing input."""
    points = [point for place, point in enumerate(points) if place == 0 or point is not points[place - 1]]
    if parameter_of(points[-1]) >= parameter_of(points[0]):
        return Piece(tuple(points), first_ending, last_ending)
    return Piece(tuple(_reversed(point) for point in points[::-1]), last_ending, first_ending)
