"""When a solution counts as lost, and how that is called."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.common import checks

STATUS = ("completed", "collapsed", "diverged", "interrupted", "locked")
COMPLETED, COLLAPSED, DIVERGED, INTERRUPTED, LOCKED = range(5)  # compiled kernels count the same way
STATUS_MEANING = (
    "completed: the whole duration was integrated; "
    "collapsed: a principal stretch fell below the smallest allowed (pulled in); "
    "diverged: an in-plane stretch passed the largest allowed, or the solution ceased to be finite or "
    "to be resolved by the step; "
    "interrupted: not computed; "
    "locked: the strain energy ceased to hold, or the solution to be resolved at that limit (a spring locks)"
)

AT_THE_LOCK = (
    1e-6  # of the validity at rest: what is left where a spring counts as locked once no step is resolved
)
SMALLEST_STEP = 1e-16  # of the duration; near t = 0 double precision would let a hopeless run crawl for ever


@dataclass(frozen=True)
class Limits:
    """Principal stretches [1] outside of which a solution counts as lost.

    Raises:
        ValueError: not 0 < smallest_stretch < 1 < largest_stretch.
    """

    smallest_stretch: float = 1e-3
    largest_stretch: float = 100.0

    def __post_init__(self) -> None:
        for name in ("smallest_stretch", "largest_stretch"):
            value = checks.scalar(name, checks.positive(name, getattr(self, name), "1"), "1")
            object.__setattr__(self, name, value)
        if not self.smallest_stretch < 1 < self.largest_stretch:
            raise ValueError(
                "limits must have smallest_stretch below 1 and largest_stretch above 1, "
                f"got {self.smallest_stretch:g} and {self.largest_stretch:g}"
            )


def checked_limits(limits: Limits | None) -> Limits:
    """The limits given, or those that hold where none are.

    Raises:
        ValueError: something else is given.
    """
    return Limits() if limits is None else checks.instance("limits", limits, Limits)


def margin(principal: np.ndarray, limits: Limits, validity: np.ndarray | None = None) -> np.ndarray:
    """Distance [1] from loss: positive while all is well, negative once lost, continuous between.

    principal: (3, ...) [1] -> (...); validity: (...), positive where the energies hold; None where they always do
    """
    kept = np.minimum(_above_smallest(principal, limits), _below_largest(principal, limits))
    return kept if validity is None else np.minimum(kept, validity)


def kind_of_loss(principal: np.ndarray, limits: Limits, validity: np.ndarray | None = None) -> np.ndarray:
    """LOCKED where the energies hold least, DIVERGED where the upper limit is the nearer one, else COLLAPSED.

    principal: (3, ...) [1] -> (...) of int; validity: as for `margin`
    """
    above, below = _above_smallest(principal, limits), _below_largest(principal, limits)
    kind = np.where(below < above, DIVERGED, COLLAPSED)
    if validity is None:
        return kind
    return np.where(~(validity > np.minimum(above, below)), LOCKED, kind)


def _above_smallest(principal: np.ndarray, limits: Limits) -> np.ndarray:
    smallest = np.minimum(np.minimum(principal[0], principal[1]), principal[2])
    return smallest / limits.smallest_stretch - 1


def _below_largest(principal: np.ndarray, limits: Limits) -> np.ndarray:
    return 1 - np.maximum(principal[0], principal[1]) / limits.largest_stretch
