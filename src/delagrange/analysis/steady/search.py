"""All branches of periodic motions that can be found: from starts over the range, and where branches cross."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from delagrange.analysis.steady import floquet
from delagrange.analysis.steady.floquet import Bifurcation
from delagrange.analysis.steady.shooting import Shooting
from delagrange.common.units import with_unit
from delagrange.drives.inputs import ElectricalInput, electrical_input
from delagrange.drives.sines import LOAD_UNITS
from delagrange.equilibrium.continuation import (
    ContinuationSettings,
    Lost,
    Point,
    SolutionBranch,
    continue_branch,
    locate,
    parameter_of,
)

_ON_BRANCH = 0.1  # of the chord between neighbours: nearer to it, a solution is on their branch
_AT_LEAST = 1e-7  # scaled distance below which two solutions are one, however near the neighbours are
_IN_A_ROW = 4  # points on another branch, after which it is that branch
_SWITCH_STEP = 2e-3  # scaled, onto a branch that crosses
LEFT = "left the range of"


@dataclass(frozen=True)
class Range:
    """The values of the varied number that are wanted, from `start` to `stop`, in its unit."""

    start: float
    stop: float

    @property
    def span(self) -> float:
        return abs(self.stop - self.start)

    def contains(self, value: float) -> bool:
        return min(self.start, self.stop) <= value <= max(self.start, self.stop)

    def evenly(self, count: int) -> np.ndarray:
        """`count` values, the ends included."""
        return np.linspace(self.start, self.stop, count)


@dataclass(frozen=True)
class SteadyBranch:
    """A branch of periodic motions, in the direction of the range where it began."""

    points: tuple[Point, ...]
    endings: tuple[str, str]  # why there is nothing before the first point, and after the last
    bifurcations: tuple[Bifurcation, ...] = ()
    origin: str = ""  # how it was found


@dataclass(frozen=True)
class Search:
    """What is searched, and how closely."""

    shooting: Shooting
    range: Range
    settings: ContinuationSettings
    conservative: bool
    largest_amplitude: float  # [1], of the first coordinate

    @property
    def electrical(self) -> ElectricalInput:
        """The electrical input of the membrane."""
        return electrical_input(self.shooting.path.problem.model)

    @property
    def most_points_ending(self) -> str:
        """How a branch says that it has as many points as are wanted."""
        return f"{self.settings.most_points} points"

    def outside(self, x: np.ndarray) -> str | None:
        """Why a branch ends at x, None where it goes on."""
        name = self.shooting.varied
        if not self.range.contains(x[-1]):
            return f"{LEFT} {name}"
        if not np.isfinite(self.largest_amplitude):
            return None
        try:
            amplitude = self.shooting.amplitude(x)
        except Lost as reason:
            return f"limit: {reason} near {name} = {with_unit(x[-1], LOAD_UNITS[name])}"
        if amplitude > self.largest_amplitude:
            return f"limit: an amplitude beyond {self.largest_amplitude:g}"
        return None

    def branch(
        self, start: Point | np.ndarray, origin: str, others: Sequence[SteadyBranch] = ()
    ) -> SteadyBranch | None:
        """The branch through a solution, both ways, with its bifurcations; None where there is no solution.

        It ends where it runs onto one of the `others`, which then had not been followed so far.
        """
        ways = self._both_ways(start)
        if ways is None:
            return None
        backward, forward = (self._up_to_others(way, others) for way in ways)
        return self._joined(backward, forward, origin)

    def _joined(self, backward: SolutionBranch, forward: SolutionBranch, origin: str) -> SteadyBranch:
        points = tuple(_turned(point) for point in reversed(backward.points[1:])) + forward.points
        points = tuple(self._settled(point) for point in points)
        bifurcations = tuple(
            Bifurcation(kind, self._settled(point)) for kind, point in self._bifurcations(points)
        )
        return SteadyBranch(points, (backward.ending, forward.ending), bifurcations, origin)

    def _settled(self, point: Point) -> Point:
        """The point with its orbit at x itself: Newton's method evaluates it before its last step."""
        try:
            return replace(point, payload=self.shooting.residual(point.x).payload)
        except Lost:
            return point

    def _both_ways(self, start: Point | np.ndarray) -> tuple[SolutionBranch, SolutionBranch] | None:
        direction = 1 if self.range.stop >= self.range.start else -1
        residual, scale = self.shooting.residual, self.shooting.scale
        forward = continue_branch(residual, start, direction, scale, self.settings, self.outside)
        if not forward.points:
            return None
        if forward.ending == "closed on itself":
            return SolutionBranch((), forward.ending), forward
        back_from = _turned(forward.points[0])
        backwards = int(np.sign(back_from.tangent[-1])) or 1
        backward = continue_branch(residual, back_from, backwards, scale, self.settings, self.outside)
        return self._up_to_the_end(backward), self._up_to_the_end(forward)

    def _up_to_the_end(self, branch: SolutionBranch) -> SolutionBranch:
        """The branch with the point at which it leaves the range."""
        if not branch.points or branch.beyond is None or not branch.ending.startswith(LEFT):
            return branch
        last, beyond = branch.points[-1], branch.beyond
        above = beyond.x[-1] > max(self.range.start, self.range.stop)
        end = (max if above else min)(self.range.start, self.range.stop)
        if last.x[-1] == end:
            return branch
        point = self._located(last, beyond, lambda at: parameter_of(at) - end)
        if point is None:
            return branch
        point = replace(point, x=np.append(point.x[:-1], end))
        return replace(branch, points=(*branch.points, point))

    def _up_to_others(self, way: SolutionBranch, others: Sequence[SteadyBranch]) -> SolutionBranch:
        """The branch up to where several points in a row lie on another one: a crossing has no more than one."""
        row = 0
        for place, point in enumerate(way.points if others else ()):
            onto = self._place_of(point.x, others)
            row = 0 if onto is None else row + 1
            if row == _IN_A_ROW:
                return SolutionBranch(way.points[: place - row + 2], f"runs onto branch {onto}")
        return way

    def _located(self, before: Point, after: Point, test) -> Point | None:
        try:
            shooting = self.shooting
            return locate(shooting.residual, before, after, test, shooting.scale, self.settings.tolerance)
        except (Lost, ValueError):
            return None

    def _bifurcations(self, points: tuple[Point, ...]) -> list[Bifurcation]:
        return floquet.bifurcations(
            self.shooting.residual, points, self.conservative, self.shooting.scale, self.settings.tolerance
        )

    def crossings(self, points: Iterable[Point], value: float) -> Iterator[Point]:
        """Where a branch passes a value of its parameter."""
        for before, after in pairwise(points):
            if before.x[-1] == value:
                yield before
            elif (before.x[-1] - value) * (after.x[-1] - value) < 0:
                point = self._located(before, after, lambda at: parameter_of(at) - value)
                if point is not None:
                    yield point

    def known(self, x: np.ndarray, branches: Sequence[SteadyBranch]) -> bool:
        """Whether the motion of x, or the same some forcing periods later, lies on a branch already found."""
        return self._place_of(x, branches) is not None

    def _place_of(self, x: np.ndarray, branches: Sequence[SteadyBranch]) -> int | None:
        """Which of the branches the motion of x lies on."""
        scale = self.shooting.scale
        for moved in self._shifted(x):
            for place, branch in enumerate(branches):
                if _on_branch(moved / scale, branch, scale):
                    return place
        return None

    def _shifted(self, x: np.ndarray) -> Iterator[np.ndarray]:
        """x at the beginning of every forcing period of the motion."""
        yield x
        single = replace(self.shooting, multiple=1)
        for _ in range(self.shooting.multiple - 1):
            try:
                travel, _, _ = single.travel(x, with_tangent=False)
            except Lost:
                return
            x = single.x_of(travel.state[-1], x[-1])
            yield x

    def crossing_branch(self, at: Bifurcation) -> SteadyBranch | None:
        """The other branch through a bifurcation, of the period of this search.

        Its direction is that of the null space of the slopes which is not the branch's own.
        Seydel (2010), Practical Bifurcation and Stability Analysis, 3rd ed., Springer, Sec. 5.6.
        """
        try:
            evaluation = self.shooting.residual(at.point.x)
        except Lost:
            return None
        direction = _across(evaluation.payload.slopes, at.point.tangent)
        careful = replace(self.settings, first_step=_SWITCH_STEP)
        start = Point(at.point.x, direction, evaluation.payload)
        ways = replace(self, settings=careful)._both_ways(start)
        if ways is None:
            return None
        branch = self._joined(self._not_twice(*ways, at.kind), ways[1], f"crossing at a {at.kind}")
        return self._without(branch, at.point.x)

    def _not_twice(self, backward: SolutionBranch, forward: SolutionBranch, kind: str) -> SolutionBranch:
        """The way back; nothing of it where it is the way forth, some forcing periods later."""
        middle = backward.points[len(backward.points) // 2 :][:1]
        there = SteadyBranch(forward.points, ("", ""))
        if middle and len(forward.points) > 1 and self.known(middle[0].x, [there]):
            return SolutionBranch((), f"begins at a {kind}")
        return backward

    def _without(self, branch: SteadyBranch, crossing: np.ndarray) -> SteadyBranch:
        """The branch without the bifurcation at its crossing, which the other branch has already."""
        scale = self.shooting.scale
        kept = (
            at for at in branch.bifurcations
            if np.linalg.norm((at.point.x - crossing) / scale) > _SWITCH_STEP
        )  # fmt: skip
        return replace(branch, bifurcations=tuple(kept))


def _turned(point: Point) -> Point:
    return replace(point, tangent=-point.tangent)


def _across(slopes: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """Of the two directions, (n + 1,), in which scaled slopes, (n, n + 1), vanish, the part across `tangent`."""
    plane = np.linalg.svd(slopes)[2][-2:]
    own = plane @ tangent
    across = np.array([-own[1], own[0]]) @ plane
    return across / np.linalg.norm(across)


def _on_branch(x: np.ndarray, branch: SteadyBranch, scale: np.ndarray) -> bool:
    """Whether x, scaled, lies on the chord between two neighbours, but for the curvature of the branch."""
    points = np.array([point.x for point in branch.points]) / scale
    starts, chords = points[:-1], np.diff(points, axis=0)
    if np.any(np.linalg.norm(points - x, axis=1) < _AT_LEAST):
        return True
    if not len(chords):
        return False
    lengths = np.maximum(np.linalg.norm(chords, axis=1), 1e-300)
    along = np.clip(np.einsum("ij,ij->i", x - starts, chords) / lengths**2, 0.0, 1.0)
    apart = np.linalg.norm(x - starts - along[:, None] * chords, axis=1)
    return bool(np.any(apart < np.maximum(_ON_BRANCH * lengths, _AT_LEAST)))
