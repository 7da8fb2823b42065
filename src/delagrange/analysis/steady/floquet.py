"""Stability of periodic motions from their Floquet multipliers, and where along a branch it changes.

Multipliers are the eigenvalues of the monodromy matrix M, by which a small disturbance at phase 0 is multiplied in a
period. Source: Seydel (2010), Practical Bifurcation and Stability Analysis, 3rd ed., Springer, Ch. 7. Where M is
ill-conditioned, as with strong instability or damping, its small eigenvalues are lost in it, and the multipliers are
found from the tangent over parts of the period instead, see `periodic_qr`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from delagrange.analysis.steady.periodic_qr import product_logarithms
from delagrange.analysis.steady.shooting import Orbit, Parts
from delagrange.equilibrium.continuation import Lost, Point, Residual, locate, turning

STABLE, NEUTRAL, UNSTABLE, MARGINAL = "stable", "neutral", "unstable", "marginal"
STABILITY_MEANING = (
    "neutral: no damping, and all multipliers on the unit circle: small disturbances stay small to first order and "
    "do not decay; stable: all multipliers inside the unit circle: small disturbances decay; unstable: a "
    "multiplier outside of it: some grow; marginal: the largest is 1 to within what can be computed"
)
FOLD, BRANCH_POINT, PERIOD_DOUBLING, TORUS = "fold", "branch point", "period doubling", "torus"
KIND_MEANING = (
    "fold: the branch turns back (multiplier +1); branch point: another branch crosses (+1, without a fold); period "
    "doubling: a motion of twice the period branches off (-1); torus: a complex pair leaves the unit circle, "
    "without damping by the collision of two pairs (Krein)"
)
NEUTRAL_TOLERANCE = 1e-7  # of mu + 1/mu, which lies in [-2, 2] on the unit circle
MARGINAL_TOLERANCE = 1e-10  # of the largest absolute value
_NODES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(8) + 0.5) / 8)  # of Chebyshev, as fractions of a chord
_REAL = 1e-6  # largest imaginary part [1] of a root that is taken for real
_WELL_CONDITIONED = 1e3  # condition number of a matrix whose eigenvalues are found from itself
_OF_PART = 1e2  # that of the tangent over a part of the period, wanted; accepted up to the one before
_SINGULAR = 1e-10  # of the largest singular value of M, what a smaller one is not known from
_MOST_PARTS = 5000
_COMPLEX = 1e-6  # smallest imaginary part [1] of a pair that is taken for complex at a torus bifurcation

Test = Callable[[Point], float]


class Bifurcation(NamedTuple):
    """Where a branch changes its kind."""

    kind: str
    point: Point


@dataclass(frozen=True)
class Spectrum:
    """The Floquet multipliers of an orbit, the largest first; of conjugates the one with positive imaginary part."""

    orbit: Orbit
    multipliers: np.ndarray  # (n_unknowns,) of complex [1]; zero where below double precision
    logarithms: np.ndarray  # (n_unknowns,) of complex [1], natural, of the multipliers
    divergence: float  # [1], integral of the trace of the Jacobian along with what they were found from
    in_parts: bool  # whether that was the tangent over parts of the period, else the monodromy matrix

    @property
    def product_error(self) -> float:
        """Relative difference of the product of the multipliers from exp(integral of the divergence).

        Liouville's formula: both are det M, found in two ways.
        """
        with np.errstate(over="ignore"):
            return float(abs(np.exp(np.sum(self.logarithms) - self.divergence) - 1))

    def stability(self, conservative: bool) -> str:
        """STABLE, NEUTRAL, UNSTABLE or MARGINAL."""
        if conservative:
            return NEUTRAL if self._on_unit_circle() else UNSTABLE
        excess = float(np.max(np.abs(self.multipliers))) - 1
        if abs(excess) <= MARGINAL_TOLERANCE:
            return MARGINAL
        return STABLE if excess < 0 else UNSTABLE

    def _on_unit_circle(self) -> bool:
        """Whether all multipliers of a conservative motion lie there, to the same tolerance in both ways."""
        if self.in_parts:
            return bool(np.max(np.abs(self.logarithms.real)) <= np.sqrt(NEUTRAL_TOLERANCE))
        return _on_unit_circle(self.orbit.monodromy)


def spectrum(orbit: Orbit) -> Spectrum:
    """The multipliers; from the monodromy matrix itself where it is well-conditioned."""
    parts = None if np.linalg.cond(orbit.monodromy) <= _WELL_CONDITIONED else _parts(orbit)
    if parts is None:
        values = _eigenvalues(orbit.monodromy)
        with np.errstate(divide="ignore"):
            return Spectrum(orbit, values, np.log(values), orbit.divergence, False)
    logarithms = product_logarithms(parts.matrices)
    with np.errstate(over="ignore", under="ignore"):
        return Spectrum(orbit, np.exp(logarithms), logarithms, parts.divergence, True)


def _eigenvalues(monodromy: np.ndarray) -> np.ndarray:
    values = np.linalg.eigvals(monodromy).astype(complex)
    return values[np.lexsort([-values.imag, -values.real, -np.round(np.abs(values), 9)])]


def _parts(orbit: Orbit) -> Parts | None:
    """The tangent over parts of the period so short that each is well-conditioned; None where there is none."""
    if orbit.in_parts is None:
        return None
    count = _count_of_parts(orbit)
    try:
        parts = orbit.in_parts(count)
        while count < _MOST_PARTS and np.max(np.linalg.cond(parts.matrices)) > _WELL_CONDITIONED:
            count *= 2
            parts = orbit.in_parts(count)
    except Lost:
        return None
    return parts


def _count_of_parts(orbit: Orbit) -> int:
    """From how far apart the singular values of M are; those not known from it follow from det M = exp(divergence)."""
    sizes = np.log(np.maximum(np.linalg.svd(orbit.monodromy, compute_uv=False), np.finfo(float).tiny))
    known = sizes - sizes[0] > np.log(_SINGULAR)
    unknown = len(sizes) - np.count_nonzero(known)
    smallest = (orbit.divergence - np.sum(sizes[known])) / unknown if unknown else sizes[-1]
    return int(np.clip(np.ceil((sizes[0] - smallest) / np.log(_OF_PART)), 2, _MOST_PARTS))


def _on_unit_circle(monodromy: np.ndarray) -> bool:
    """Whether all multipliers of a conservative motion lie on the unit circle.

    They come in pairs mu, 1/mu. Near +1 and -1, where pairs meet, mu is as inaccurate as the square root of the
    error of M, its sum with 1/mu as accurate as M; so that sum is looked at, as an eigenvalue of M + M^-1.
    """
    sums = np.linalg.eigvals(monodromy + np.linalg.inv(monodromy))
    return bool(
        np.all(np.abs(sums.imag) <= np.sqrt(NEUTRAL_TOLERANCE))
        and np.all(np.abs(sums.real) <= 2 + NEUTRAL_TOLERANCE)
    )


def branching(point: Point) -> float:
    """Vanishes where another branch crosses: the determinant of the shooting's slopes, bordered by the tangent."""
    return float(np.linalg.det(np.vstack([point.payload.slopes, point.tangent])))


def doubling(point: Point) -> float:
    """det(M + I): vanishes at a multiplier -1."""
    monodromy = point.payload.monodromy
    return float(np.linalg.det(monodromy + np.eye(len(monodromy))))


def collision(point: Point) -> float:
    """Vanishes where two pairs of multipliers of a conservative motion meet, not where they only cross.

    The discriminant of the equation for mu + 1/mu that follows from the characteristic polynomial
    mu^4 - a mu^3 + b mu^2 - a mu + 1.
    Broucke (1969), AIAA J. 7, 1003.
    """
    monodromy = point.payload.monodromy
    trace = np.trace(monodromy)
    second = (trace**2 - np.trace(monodromy @ monodromy)) / 2
    return float(trace**2 - 4 * second + 8)


def pair_product(point: Point) -> float:
    """Vanishes where the product of two multipliers is 1: the bialternate product of M with itself has that eigenvalue.

    Kuznetsov (2004), Elements of Applied Bifurcation Theory, 3rd ed., Springer, Sec. 10.2.
    """
    values = np.linalg.eigvals(point.payload.monodromy).astype(complex)
    return float(np.prod([one * other - 1 for one, other in combinations(values, 2)]).real)


def _tests(size: int, conservative: bool) -> dict[str, Test]:
    tests: dict[str, Test] = {FOLD: turning, BRANCH_POINT: branching, PERIOD_DOUBLING: doubling}
    if conservative:
        return tests | ({TORUS: collision} if size == 4 else {})
    return tests | {TORUS: pair_product}


def bifurcations(
    residual: Residual, points: tuple[Point, ...], conservative: bool, scale: np.ndarray, tolerance: float
) -> list[Bifurcation]:
    """All that is found between neighbours of a branch, in its order.

    Two of the same kind between the same neighbours are not seen.
    """
    if not points:
        return []
    tests = _tests(len(points[0].payload.monodromy), conservative)
    values = {kind: [test(point) for point in points] for kind, test in tests.items()}
    found = []
    for place, (before, after) in enumerate(pairwise(points)):
        for kind, test in tests.items():
            if values[kind][place] * values[kind][place + 1] < 0:
                find = _crossed if kind == BRANCH_POINT else _located
                at = find(residual, before, after, test, scale, tolerance)
                if kind != TORUS or _leaves_circle(at.payload, conservative):
                    found.append(Bifurcation(kind, at))
    return found


def _located(
    residual: Residual, before: Point, after: Point, test: Test, scale: np.ndarray, tolerance: float
) -> Point:
    """Where the test vanishes; the nearer neighbour where that cannot be solved for."""
    try:
        return locate(residual, before, after, test, scale, tolerance)
    except (Lost, ValueError):
        return min(before, after, key=lambda point: abs(test(point)))


def _crossed(
    residual: Residual, before: Point, after: Point, test: Test, scale: np.ndarray, tolerance: float
) -> Point:
    """Where the test vanishes at a crossing of branches, at which the equations are singular.

    Points of the branch on both sides of it are solved for, and a polynomial is laid through them.
    """
    chord = (after.x - before.x) / scale
    fractions, points = [], []
    for fraction in _NODES:
        try:
            points.append(_between(residual, before, after, fraction, chord, scale, tolerance))
        except Lost:
            continue
        fractions.append(fraction)
    degree = len(points) - 1
    if degree < 3:
        return min(before, after, key=lambda point: abs(test(point)))
    x = Polynomial.fit(fractions, [test(point) for point in points], degree).roots()
    real = x[(abs(x.imag) < _REAL) & (x.real >= 0) & (x.real <= 1)].real
    place = float(real[0]) if len(real) else 0.5
    columns = np.array([point.x for point in points]).T
    found = np.array([Polynomial.fit(fractions, column, degree)(place) for column in columns])
    tangent = (1 - place) * before.tangent + place * after.tangent
    return Point(found, tangent / np.linalg.norm(tangent), residual(found).payload)


def _between(
    residual: Residual,
    before: Point,
    after: Point,
    fraction: float,
    chord: np.ndarray,
    scale: np.ndarray,
    tolerance: float,
) -> Point:
    """The point of the branch above a fraction of the chord between two neighbours."""

    def beyond(point: Point) -> float:
        return float((point.x - before.x) / scale @ chord / (chord @ chord)) - fraction

    return locate(residual, before, after, beyond, scale, tolerance)


def _leaves_circle(orbit: Orbit, conservative: bool) -> bool:
    """Whether complex multipliers leave the unit circle, and not real ones whose product is 1."""
    if conservative:
        return bool(abs(np.trace(orbit.monodromy)) < 4)
    values = spectrum(orbit).multipliers
    pairs = [pair for pair in combinations(values, 2) if pair[0].imag > _COMPLEX]
    return any(abs(one * other - 1) < 1e-5 and abs(one - other.conjugate()) < 1e-8 for one, other in pairs)
