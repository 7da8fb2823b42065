"""Of what size a coordinate is: the change of it that strains the membrane by about one half.

A stretch is of size one. A coordinate of a user's own relation may be anything, a height of millimetres or an angle.
"""

from __future__ import annotations

import numpy as np

from delagrange.problem.problem import Problem

_STRAIN = 0.5, 1.0  # that the size of a coordinate gives
_TRIALS = 60  # halvings or doublings


def strains_at(problem: Problem, state: np.ndarray, place: int, values: np.ndarray) -> np.ndarray:
    """Logarithms of the principal stretches at values of one coordinate, (3, n_values); NaN where there are none."""
    states = np.repeat(np.asarray(state, dtype=float)[:, None], len(values), axis=1)
    states[place] = values
    with np.errstate(all="ignore"):
        principal = np.asarray(problem.principal_stretches(0.0, states), dtype=float)
        return np.log(np.broadcast_to(principal, (3, len(values))))


def straining_change(problem: Problem, state: np.ndarray, place: int) -> float:
    """The change of a coordinate by which, either way, the larger strain is between one half and one."""
    size = 1.0
    for grows in (False, True):
        for _ in range(_TRIALS):
            strain = _strain_of(problem, state, place, size)
            if (strain >= _STRAIN[0]) if grows else (strain <= _STRAIN[1]):
                break
            size *= 2.0 if grows else 0.5
        else:
            size = 1.0 if grows else size
    return size


def _strain_of(problem: Problem, state: np.ndarray, place: int, size: float) -> float:
    values = state[place] + size * np.array([-1.0, 0.0, 1.0])
    strains = strains_at(problem, state, place, values)
    changes = np.abs(strains[:, [0, 2]] - strains[:, [1]])
    return float(np.max(np.where(np.isfinite(changes), changes, np.inf)))
