"""Largest and smallest value of each coordinate over a step of many lanes.

"dense" finds them inside the step by its interpolant, "samples" takes the interpolant at the quarters
of the step (as MATLAB's `ode45` with `Refine` 4 does), "steps" takes the ends of steps only.
"""

from __future__ import annotations

import numpy as np

from delagrange.engines.interpolation import evaluate, largest_value, trial_polynomial
from delagrange.engines.lanes import RunSettings, Trial
from delagrange.problem.problem import Problem

EXTREMA = ("dense", "samples", "steps")
_QUARTERS = np.array([0.25, 0.5, 0.75])
_BEND_MARGIN = 1.5  # the largest second derivative may lie between the stages


def widen(problem: Problem, trial: Trial, settings: RunSettings) -> tuple[np.ndarray, np.ndarray]:
    """Maximum and minimum of each coordinate with the trial's step taken in, each (n_coordinates, n_lanes).

    Rejected lanes keep theirs.
    """
    before = trial.before
    if settings.extrema == "none":
        return before.maximum, before.minimum
    ends = trial.state[: len(before.maximum)]
    maximum = np.where(trial.accepted, np.maximum(before.maximum, ends), before.maximum)
    minimum = np.where(trial.accepted, np.minimum(before.minimum, ends), before.minimum)
    if settings.extrema == "samples":
        _widen_by_samples(problem, trial, settings, maximum, minimum)
    if settings.extrema == "dense":
        _widen_by_peaks(problem, trial, settings, maximum, minimum)
    return maximum, minimum


def _widen_by_samples(
    problem: Problem, trial: Trial, settings: RunSettings, maximum: np.ndarray, minimum: np.ndarray
) -> None:
    """Take in the values at the quarters of the accepted steps, into `maximum` and `minimum`."""
    places = np.flatnonzero(trial.accepted)
    if len(places) == 0:
        return
    polynomial = trial_polynomial(problem, trial, settings, places, len(maximum))
    quarters = _QUARTERS[:, None] * trial.fraction[places]
    values = evaluate(polynomial[:, None], quarters[:, None])
    maximum[:, places] = np.maximum(maximum[:, places], values.max(axis=0))
    minimum[:, places] = np.minimum(minimum[:, places], values.min(axis=0))


def _widen_by_peaks(
    problem: Problem, trial: Trial, settings: RunSettings, maximum: np.ndarray, minimum: np.ndarray
) -> None:
    """Take in the extrema inside the steps that may hold one, into `maximum` and `minimum`."""
    rising, falling = _candidates(trial, maximum, minimum)
    places = np.flatnonzero((rising | falling).any(axis=0))
    if len(places) == 0:
        return
    polynomial = trial_polynomial(problem, trial, settings, places, len(maximum))
    fraction = np.broadcast_to(trial.fraction[places], polynomial.shape[1:])
    high, low = np.nonzero(rising[:, places]), np.nonzero(falling[:, places])
    curves = np.concatenate([polynomial[:, *high], -polynomial[:, *low]], axis=1)
    tops = largest_value(curves, np.concatenate([fraction[high], fraction[low]]))
    split = len(high[0])
    high, low = (high[0], places[high[1]]), (low[0], places[low[1]])
    maximum[high] = np.maximum(maximum[high], tops[:split])
    minimum[low] = np.minimum(minimum[low], -tops[split:])


def _candidates(trial: Trial, maximum: np.ndarray, minimum: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where a coordinate may pass its maximum, or its minimum, inside the step.

    Between its ends a coordinate rises above them by at most h^2/8 times its largest downward second
    derivative (the remainder of linear interpolation), which the stages have sampled.
    Both are (n_coordinates, n_lanes) of bool.
    """
    coordinates = len(maximum)
    first, last = trial.before.state[:coordinates], trial.state[:coordinates]
    accelerations = trial.stages[:, coordinates : 2 * coordinates]
    reach = _BEND_MARGIN / 8 * trial.step**2
    rise = reach * np.maximum(0.0, -accelerations.min(axis=0))
    fall = reach * np.maximum(0.0, accelerations.max(axis=0))
    rising = trial.accepted & (np.maximum(first, last) + rise > maximum)
    falling = trial.accepted & (np.minimum(first, last) - fall < minimum)
    return rising, falling
