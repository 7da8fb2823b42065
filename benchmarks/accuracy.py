"""Error of amplitudes, and what time a contestant needs for a given one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

EQUAL_ERRORS = (1e-4, 1e-6, 1e-8)  # at which contestants are compared [1]
NOT_REACHED = "not reached"
ALWAYS_BELOW = "series starts below"


@dataclass(frozen=True)
class Point:
    """One contestant at one tolerance."""

    tolerance: float
    rms_error: float  # root mean square over the runs of the amplitude's error [1]; inf where a run was lost
    maximum_error: float  # the largest of them
    times: tuple[float, ...]  # of all runs [s], one a repeat; scaled where a subset was timed

    @property
    def time(self) -> float:
        """The median [s]."""
        return float(np.median(self.times)) if self.times else math.nan


def errors(amplitude: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """Root mean square and largest absolute error [1]; inf where an amplitude is NaN.

    Raises:
        ValueError: the two have different lengths.
    """
    if amplitude.shape != reference.shape:
        raise ValueError(f"amplitudes {amplitude.shape} and reference {reference.shape} differ in shape")
    deviation = np.abs(np.where(np.isnan(amplitude), np.inf, amplitude) - reference)
    return float(np.sqrt(np.mean(deviation**2))), float(deviation.max())


def time_at(points: Sequence[Point], error: float) -> float | str:
    """Time [s] at a root-mean-square error, between neighbouring tolerances in log-log; else why there is none.

    Nothing is extrapolated. Where a series passes the error more than once, the shortest time counts.
    """
    known = sorted((point for point in points if _usable(point)), key=lambda point: -point.tolerance)
    if not known or all(point.rms_error > error for point in known):
        return NOT_REACHED
    crossings = [_between(a, b, error) for a, b in pairwise(known) if _brackets(a, b, error)]
    exact = [point.time for point in known if point.rms_error == error]
    return min(crossings + exact) if crossings or exact else ALWAYS_BELOW


def _usable(point: Point) -> bool:
    return math.isfinite(point.rms_error) and point.rms_error > 0 and point.time > 0


def _brackets(first: Point, second: Point, error: float) -> bool:
    low, high = sorted((first.rms_error, second.rms_error))
    return low < error < high


def _between(first: Point, second: Point, error: float) -> float:
    share = math.log(error / first.rms_error) / math.log(second.rms_error / first.rms_error)
    return first.time * (second.time / first.time) ** share


def ratio(time: float | str, base: float | str) -> float | str:
    """How many times as long as the base; why there is no number, where there is none."""
    if isinstance(time, str):
        return time
    return base if isinstance(base, str) else time / base
