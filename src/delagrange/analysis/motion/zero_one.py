"""0-1 test for chaos: does the sum of what is observed, turned by a fixed angle each time, walk or stay?

Gottwald & Melbourne (2009), SIAM J. Appl. Dyn. Syst. 8, 129: correlation method with the modified mean square
displacement; the median over many angles.
"""

from __future__ import annotations

import numpy as np

_ANGLES = 100
_SEED = 2009
_RANGE = (np.pi / 5, 4 * np.pi / 5)  # away from resonances with the sampling
_SHARE = 10  # displacements are followed over a tenth of the record
FEWEST = 200  # points of which the test says anything
MOST = 3000  # more do not change what it says


def zero_one(points: np.ndarray, smallest: float = 0.0) -> float:
    """K of a scalar seen once in a period, (n_points,): near 1 for chaos, near 0 for a regular motion.

    NaN with fewer than 200 points; 0 where they differ by no more than `smallest`, in their unit: a point
    that stays walks nowhere, and its rounding means nothing.
    """
    points = np.asarray(points, dtype=float)[:MOST]
    if len(points) < FEWEST:
        return float("nan")
    if np.ptp(points) <= smallest:
        return 0.0
    angles = np.random.default_rng(_SEED).uniform(*_RANGE, _ANGLES)
    times = np.arange(1, len(points) // _SHARE + 1)
    displacement = _mean_square_displacement(points, angles, times)
    ranks = [np.corrcoef(times, row)[0, 1] for row in displacement]
    return float(np.median(ranks))


def _mean_square_displacement(points: np.ndarray, angles: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Of the walk, (n_angles, n_times), less the part that oscillates for a mean that is not zero."""
    numbers = np.arange(1, len(points) + 1)
    walk = np.cumsum(points * np.exp(1j * angles[:, None] * numbers), axis=1)
    kept = len(points) - times[-1]
    displacement = np.stack(
        [np.mean(np.abs(walk[:, n : n + kept] - walk[:, :kept]) ** 2, axis=1) for n in times], axis=1
    )
    oscillating = np.mean(points) ** 2 * (1 - np.cos(np.outer(angles, times))) / (1 - np.cos(angles))[:, None]
    return displacement - oscillating
