"""Mean and mean square of each coordinate, integrated step by step over the window for many lanes.

The integrals over time that a lane carries are, row by row, those of 1 (the time covered), of each
coordinate and of the square of each coordinate.
"""

from __future__ import annotations

import numpy as np

from delagrange.engines.interpolation import evaluate, trial_polynomial
from delagrange.engines.lanes import RunSettings, Trial
from delagrange.problem.problem import Problem

_POINTS = 8  # of Gauss and Legendre: exact to degree 15, and the square of the interpolant has at most 14
_NODES, _WEIGHTS = ((np.polynomial.legendre.leggauss(_POINTS) + np.array([[1.0], [0.0]])) / 2).tolist()


def widen_integrals(problem: Problem, trial: Trial, settings: RunSettings) -> np.ndarray:
    """The lanes' integrals with the trial's step taken in, (1 + 2 n_coordinates, n_lanes) [s].

    Rejected lanes keep theirs; of a step in which a lane is lost the part before the loss counts.
    """
    before = trial.before
    if not settings.averages:
        return before.integrals
    places = np.flatnonzero(trial.accepted)
    if len(places) == 0:
        return before.integrals
    count = problem.model.COORDINATE_COUNT
    polynomial = trial_polynomial(problem, trial, settings, places, count)
    fraction = trial.fraction[places]
    integrals = before.integrals.copy()
    integrals[:, places] += trial.step[places] * fraction * _unit_integrals(polynomial, fraction)
    return integrals


def _unit_integrals(polynomial: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Averages of 1, the coordinates and their squares over the step up to `fraction`.

    Term by term, so that a lane's result does not depend on the lanes beside it.
    (degree + 1, n_coordinates, n_lanes) -> (1 + 2 n_coordinates, n_lanes)
    """
    count = polynomial.shape[1]
    averages = np.zeros((1 + 2 * count, polynomial.shape[2]))
    averages[0] = 1.0
    for node, weight in zip(_NODES, _WEIGHTS):
        value = evaluate(polynomial, node * fraction)
        averages[1 : 1 + count] += weight * value
        averages[1 + count :] += weight * value**2
    return averages
