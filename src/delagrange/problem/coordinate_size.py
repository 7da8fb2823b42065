"""Of what size a coordinate is, and with it the state: the change of it that strains the membrane by about one half.

A stretch is of size one. A coordinate of a user's own relation may be anything, a height of millimetres or an angle.
"""

from __future__ import annotations

import numpy as np

from delagrange.model.variables import is_stretch
from delagrange.problem.dashpots import charge_place
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


def typical_sizes(problem: Problem) -> np.ndarray:
    """(n_state,), each in its unit: of what size the state variables are, were a stretch to change by one.

    1 for stretches, and the change that strains the membrane by one half or more for a coordinate that is none; for
    their rates that times the angular frequency of the fastest small vibration [1/s]; for a charge density that is
    part of the state the one whose attraction would hold such a change [C/m^2]. All that is about the reference
    state, under the loads at t = 0.
    """
    model = problem.model
    reference = np.asarray(model.reference_state(problem.parameters), dtype=float)
    count = model.COORDINATE_COUNT
    slopes = problem.jacobian(0.0, reference)[count : 2 * count, :count]
    fastest = np.sqrt(np.max(np.abs(np.linalg.eigvals(slopes)), initial=0.0))
    sizes = np.ones(len(model.STATE))
    for place, entry in enumerate(model.STATE[:count]):
        sizes[place] = 1.0 if is_stretch(entry) else straining_change(problem, reference, place)
    sizes[count : 2 * count] = sizes[:count] * (fastest if fastest > 0 else 1.0)
    charge = charge_place(model)
    if charge is not None:
        sizes[charge] = _straining_charge(problem, reference, charge, fastest, sizes[:count])
    return sizes


def _straining_charge(
    problem: Problem, reference: np.ndarray, place: int, fastest: float, sizes: np.ndarray
) -> float:
    """Charge density D [C/m^2] whose acceleration is that of a spring strained by one; 1 if none is.

    sizes: of the coordinates; in them, such a spring accelerates by fastest^2 [1/s^2].

    The energy of a charge grows with its square: an acceleration of k D^2 has the slope 2 k at a D of 1 C/m^2.
    """
    count = problem.model.COORDINATE_COUNT
    charged = np.array(reference)
    charged[place] = 1.0
    slope = np.max(np.abs(problem.jacobian(0.0, charged)[count : 2 * count, place]) / sizes, initial=0.0)
    size = fastest * np.sqrt(2.0 / slope) if 0 < slope < np.inf else 0.0
    return float(size) if size > 0 else 1.0
