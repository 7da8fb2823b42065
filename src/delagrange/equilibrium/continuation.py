"""Branches of solutions of n equations in n unknowns and a parameter, followed by pseudo-arclength continuation.

A vector x, (n + 1,), holds the unknowns and, last, the parameter. All lengths and angles are those of x over its
`scale`, so that unknowns and parameter count alike. Tangent predictor, Newton's corrector in the plane across the
tangent: Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems, in Applications of
Bifurcation Theory, Academic Press, 359-384.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

_MOST_ITERATIONS = 12
_GOOD_ITERATIONS = 4  # of the corrector: with fewer the step grows, with more it shrinks
_FASTEST_CHANGE = 2.0  # of the step from one point to the next
_LARGEST_CORRECTION = 0.5  # of the step: farther from the predicted point may be another branch
_CLOSE = 0.1  # of the chord: the start lies on it, but for the curvature
_CLOSE_AGREEMENT = 1e-6  # scaled distance between the start and what a correction near it finds


class Lost(Exception):
    """The equations cannot be evaluated, or cannot be solved; the text says why."""


@dataclass(frozen=True)
class Evaluation:
    """The equations at a point."""

    residual: np.ndarray  # (n,)
    slopes: np.ndarray  # (n, n + 1), derivative of the residual by x
    payload: object = None  # whatever else was found on the way


Residual = Callable[[np.ndarray], Evaluation]  # of x, (n + 1,); raises Lost where it cannot be evaluated


@dataclass(frozen=True)
class Point:
    """A solution, and the direction of its branch."""

    x: np.ndarray  # (n + 1,)
    tangent: np.ndarray  # (n + 1,), of unit length in scaled variables, in the direction of travel
    payload: object = None


@dataclass(frozen=True)
class SolutionBranch:
    """Points in the order of travel, and why there are no more."""

    points: tuple[Point, ...]
    ending: str
    beyond: Point | None = None  # where `inside` ended it: the first point that was not inside


@dataclass(frozen=True)
class ContinuationSettings:
    """Steps are lengths of arc in scaled variables."""

    first_step: float = 0.01
    smallest_step: float = 1e-9
    largest_step: float = 0.1
    most_points: int = 2000
    tolerance: float = 1e-12  # the last correction of x, scaled, is at most this
    largest_angle: float = 0.2  # [rad], between neighbouring tangents


class Solution(NamedTuple):
    """Where Newton's method ended: the last step is at most the tolerance and is in `x` already."""

    x: np.ndarray
    evaluation: Evaluation  # at x but for the last step
    iterations: int


@dataclass(frozen=True)
class _Follower:
    """What stays the same along a branch."""

    residual: Residual
    scale: np.ndarray
    settings: ContinuationSettings
    inside: Callable[[np.ndarray], str | None] = field(default=lambda x: None)

    def distance(self, one: np.ndarray, other: np.ndarray) -> float:
        return float(np.linalg.norm((one - other) / self.scale))

    def corrected(self, x: np.ndarray, normal: np.ndarray, forward: np.ndarray) -> tuple[Point, int]:
        """The solution in the plane through `x` across `normal`, and how many iterations it took."""
        found = _newton(self.residual, x, self.scale, self.settings.tolerance, normal)
        tangent = _tangent(found.evaluation.slopes * self.scale, forward)
        return Point(found.x, tangent, found.evaluation.payload), found.iterations


def solve(residual: Residual, x: np.ndarray, scale: np.ndarray, tolerance: float) -> Solution:
    """Newton's method at the parameter that `x`, (n + 1,), has.

    Raises:
        Lost: it does not converge, or the equations cannot be evaluated on the way.
    """
    at_parameter = np.zeros(len(x))
    at_parameter[-1] = 1.0
    return _newton(
        residual, np.array(x, dtype=float), np.asarray(scale, dtype=float), tolerance, at_parameter
    )


def continue_branch(
    residual: Residual,
    start: Point | np.ndarray,
    direction: int,
    scale: np.ndarray,
    settings: ContinuationSettings,
    inside: Callable[[np.ndarray], str | None],
) -> SolutionBranch:
    """Follow the branch through `start`, first towards larger (+1) or smaller (-1) values of the parameter.

    Args:
        start: a point of the branch, or x near one, corrected at its parameter.
        scale: (n + 1,), typical sizes of the unknowns and of the parameter, each in its unit.
        inside: of x, None while the branch is wanted, else why it ends there. The first point that is not
            inside is not among the points; the branch keeps it as `beyond`.

    Returns:
        The branch. It ends as `inside` says, or "closed on itself" (the start is then its last point
        too), "<most_points> points", or "lost: <reason> near parameter <value>"; it has all points found
        until then, none where already the start cannot be solved for.
    """
    follower = _Follower(residual, np.asarray(scale, dtype=float), settings, inside)
    try:
        first = _first_point(follower, start, direction)
    except Lost as reason:
        place = start.x[-1] if isinstance(start, Point) else start[-1]
        return SolutionBranch((), _lost(reason, place))
    outside = inside(first.x)
    return SolutionBranch((), outside, first) if outside else _follow(follower, first)


def locate(
    residual: Residual,
    before: Point,
    after: Point,
    test: Callable[[Point], float],
    scale: np.ndarray,
    tolerance: float,
) -> Point:
    """The point between two neighbours of a branch at which `test` vanishes: Brent's method along the chord.

    Every trial is corrected onto the branch in the plane across the chord.

    Raises:
        ValueError: the test has the same sign at both.
        Lost: a trial cannot be corrected.
    """
    first, last = test(before), test(after)
    if first == 0 or last == 0:
        return before if first == 0 else after
    if first * last > 0:
        raise ValueError(
            f"the test must have two signs at the two points, got {first:g} at parameter {before.x[-1]:g} "
            f"and {last:g} at {after.x[-1]:g}"
        )
    follower = _Follower(residual, np.asarray(scale, dtype=float), ContinuationSettings(tolerance=tolerance))
    chord = after.x - before.x
    normal = chord / follower.scale
    normal = normal / np.linalg.norm(normal)

    def at(fraction: float) -> Point:
        return follower.corrected(before.x + fraction * chord, normal, before.tangent)[0]

    def value(fraction: float) -> float:
        return {0.0: first, 1.0: last}[fraction] if fraction in (0.0, 1.0) else test(at(fraction))

    return at(brentq(value, 0.0, 1.0, xtol=1e-15, rtol=8.9e-16))


def parameter_of(point: Point) -> float:
    """The parameter at a point."""
    return float(point.x[-1])


def turning(point: Point) -> float:
    """A test for `locate`: it vanishes at a fold, where the parameter turns back."""
    return float(point.tangent[-1])


def _newton(
    residual: Residual, x: np.ndarray, scale: np.ndarray, tolerance: float, normal: np.ndarray
) -> Solution:
    """Newton's method with corrections across `normal`, (n + 1,) in scaled variables."""
    before = np.inf
    for iteration in range(1, _MOST_ITERATIONS + 1):
        evaluation = residual(x)
        step = _correction(evaluation, scale, normal)
        length = float(np.linalg.norm(step))
        x = x + scale * step
        if length <= tolerance:
            return Solution(x, evaluation, iteration)
        if iteration > 2 and length > 2 * before:
            raise Lost(f"Newton's method diverges, with a correction of {length:.2g}")
        before = length
    raise Lost(
        f"Newton's method still corrects by {before:.2g}, more than {tolerance:.2g}, "
        f"after {_MOST_ITERATIONS} iterations"
    )


def _correction(evaluation: Evaluation, scale: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Newton's step in scaled variables, from the bordered system; rows are scaled to length one."""
    matrix = np.vstack([evaluation.slopes * scale, normal])
    right = np.append(-np.asarray(evaluation.residual, dtype=float), 0.0)
    if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(right))):
        raise Lost("the equations or their slopes are not finite")
    lengths = np.linalg.norm(matrix, axis=1)
    lengths = np.where(lengths > 0, lengths, 1.0)
    try:
        return np.linalg.solve(matrix / lengths[:, None], right / lengths)
    except np.linalg.LinAlgError:
        raise Lost("the slopes of the equations are singular") from None


def _tangent(slopes: np.ndarray, forward: np.ndarray) -> np.ndarray:
    """Unit vector along the branch, of scaled slopes (n, n + 1), on the side of `forward`."""
    lengths = np.linalg.norm(slopes, axis=1)
    rows = slopes / np.where(lengths > 0, lengths, 1.0)[:, None]
    along = np.linalg.svd(rows)[2][-1]
    return along if along @ forward >= 0 else -along


def _first_point(follower: _Follower, start: Point | np.ndarray, direction: int) -> Point:
    if isinstance(start, Point):
        along = start.tangent * (1.0 if start.tangent[-1] * direction >= 0 else -1.0)
        return Point(start.x, along, start.payload)
    found = solve(follower.residual, start, follower.scale, follower.settings.tolerance)
    forward = np.zeros(len(start))
    forward[-1] = direction
    along = _tangent(found.evaluation.slopes * follower.scale, forward)
    return Point(found.x, along, found.evaluation.payload)


def _follow(follower: _Follower, first: Point) -> SolutionBranch:
    settings = follower.settings
    points, step = [first], settings.first_step
    while len(points) < settings.most_points:
        try:
            point, step = _next(follower, points[-1], step)
        except Lost as reason:
            return SolutionBranch(tuple(points), _lost(reason, parameter_of(points[-1])))
        if len(points) > 2 and _passes(follower, points[-1], point, first):
            return SolutionBranch((*points, first), "closed on itself")
        outside = follower.inside(point.x)
        if outside is not None:
            return SolutionBranch(tuple(points), outside, point)
        points.append(point)
    return SolutionBranch(tuple(points), f"{settings.most_points} points")


def _next(follower: _Follower, point: Point, step: float) -> tuple[Point, float]:
    """The next point, and the step to try after it; halves the step until one succeeds."""
    while True:
        try:
            return _one_step(follower, point, step)
        except Lost as reason:
            step /= 2
            if step < follower.settings.smallest_step:
                raise Lost(f"{reason}, with steps down to {2 * step:.2g}") from None


def _one_step(follower: _Follower, point: Point, step: float) -> tuple[Point, float]:
    settings = follower.settings
    predicted = point.x + step * follower.scale * point.tangent
    found, iterations = follower.corrected(predicted, point.tangent, point.tangent)
    if follower.distance(found.x, predicted) > _LARGEST_CORRECTION * step:
        raise Lost("the nearest solution is far from the predicted one")
    angle = float(np.arccos(np.clip(found.tangent @ point.tangent, -1.0, 1.0)))
    if angle > settings.largest_angle:
        raise Lost(f"the branch turns by {angle:.2g} rad in one step")
    change = min(_GOOD_ITERATIONS / iterations, 0.7 * settings.largest_angle / max(angle, 1e-12))
    change = min(max(change, 1 / _FASTEST_CHANGE), _FASTEST_CHANGE)
    return found, min(settings.largest_step, step * change)


def _passes(follower: _Follower, before: Point, after: Point, first: Point) -> bool:
    """Whether the branch comes by its first point between two others, in the direction in which it left it."""
    chord, there = (after.x - before.x) / follower.scale, (first.x - before.x) / follower.scale
    length = np.linalg.norm(chord)
    fraction = float(there @ chord) / length**2
    if not 0 <= fraction <= 1 or np.linalg.norm(there - fraction * chord) > _CLOSE * length:
        return False
    if after.tangent @ first.tangent < np.cos(2 * follower.settings.largest_angle):
        return False
    nearest = before.x + fraction * (after.x - before.x)
    off_plane = float((first.x - nearest) / follower.scale @ first.tangent)
    try:
        guess = nearest + off_plane * follower.scale * first.tangent
        again, _ = follower.corrected(guess, first.tangent, first.tangent)
    except Lost:
        return False
    return follower.distance(again.x, first.x) <= _CLOSE_AGREEMENT


def _lost(reason: Lost, parameter: float) -> str:
    return f"lost: {reason} near parameter {parameter:.10g}"
