"""The course of a search for periodic motions: starts over the range, beyond folds and ends, and across crossings."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from delagrange.analysis.steady.floquet import BRANCH_POINT, FOLD
from delagrange.analysis.steady.search import LEFT, Search, SteadyBranch
from delagrange.analysis.steady.starts import Equilibria, equilibria_of, starts
from delagrange.common.progress import Progress
from delagrange.equilibrium.statics import Statics

_BEYOND = 0.004  # of the span: how far behind a fold or an end a further start is made
FINISHED, INTERRUPTED, ENOUGH = "finished", "interrupted", "ended at the most branches"
_NEAR = 0.5  # of that: a start so near an earlier one is not made


@dataclass
class Findings:
    """What a search has found so far, and where it has still to look."""

    branches: list[SteadyBranch] = field(default_factory=list)
    to_try: deque[float] = field(default_factory=deque)
    tried: list[float] = field(default_factory=list)
    search: str = FINISHED

    def add(self, search: Search, branch: SteadyBranch) -> None:
        self.branches.append(branch)
        self.to_try.extend(behind(search, branch))


def find_branches(
    search: Search, statics: Statics, values: np.ndarray, most_branches: int, progress: Progress
) -> Findings:
    """All branches found from starts at `values` of the varied number, and from what these lead to.

    Interrupted from the keyboard, what is found so far, and `search` says so.
    """
    findings = Findings(to_try=deque(float(value) for value in values))
    try:
        _from_starts(search, equilibria_of(statics), findings, most_branches, progress)
        _across_branch_points(search, findings, most_branches)
    except KeyboardInterrupt:
        findings.search = INTERRUPTED
    return findings


def _from_starts(
    search: Search, equilibria: Equilibria, findings: Findings, most_branches: int, progress: Progress
) -> None:
    apart = _NEAR * _BEYOND * search.range.span
    while findings.to_try:
        value = findings.to_try.popleft()
        if any(abs(value - other) < apart for other in findings.tried):
            continue
        findings.tried.append(value)
        for start in starts(search, equilibria, value):
            if len(findings.branches) >= most_branches:
                findings.search = ENOUGH
                return
            if search.known(start.x, findings.branches):
                continue
            branch = search.branch(start.x, start.origin, findings.branches)
            if branch is not None:
                findings.add(search, branch)
        progress.advance_to(min(len(findings.tried), most_branches))


def behind(search: Search, branch: SteadyBranch) -> Iterator[float]:
    """Values just behind the folds of a branch and around its ends, where another may run.

    Not around an end at the most points: there the branch itself goes on.
    """
    step = _BEYOND * search.range.span
    for bifurcation in branch.bifurcations:
        if bifurcation.kind == FOLD:
            yield from _inside(
                search, _behind_fold(branch, bifurcation.point.x) * step, bifurcation.point.x[-1]
            )
    for point, ending in zip((branch.points[0], branch.points[-1]), branch.endings):
        if not (ending.startswith(LEFT) or ending == search.most_points_ending):
            yield from _inside(search, step, point.x[-1])
            yield from _inside(search, -step, point.x[-1])


def _inside(search: Search, step: float, value: float) -> Iterator[float]:
    if search.range.contains(value + step):
        yield float(value + step)


def _behind_fold(branch: SteadyBranch, fold: np.ndarray) -> int:
    """+1 where the varied number is largest at the fold, -1 where it is smallest."""
    nearest = min(branch.points, key=lambda point: float(np.sum((point.x - fold) ** 2)))
    return 1 if nearest.x[-1] <= fold[-1] else -1


def _across_branch_points(search: Search, findings: Findings, most_branches: int) -> None:
    """The branches that cross those found, and those that cross them."""
    place = 0
    while place < len(findings.branches):
        for bifurcation in findings.branches[place].bifurcations:
            if bifurcation.kind != BRANCH_POINT:
                continue
            if len(findings.branches) >= most_branches:
                findings.search = ENOUGH
                return
            branch = search.crossing_branch(bifurcation)
            if branch is not None and not _already(search, branch, findings.branches):
                findings.branches.append(branch)
        place += 1


def _already(search: Search, branch: SteadyBranch, others: list[SteadyBranch]) -> bool:
    """Whether a branch is another one found from elsewhere: a point amidst each half of it is known."""
    size = len(branch.points)
    return all(search.known(branch.points[place].x, others) for place in (size // 4, (3 * size) // 4))
