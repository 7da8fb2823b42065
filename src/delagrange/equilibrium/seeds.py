"""Equilibria at one value of field or charge, wherever they are: Newton's method from a grid of stretches at once."""

from __future__ import annotations

from itertools import product

import numpy as np

from delagrange.equilibrium.chart import within_limits
from delagrange.equilibrium.continuation import Lost, solve
from delagrange.equilibrium.statics import TOLERANCE, Statics, with_leaking_charge, with_relaxed_dashpots
from delagrange.problem import status as loss
from delagrange.problem.dashpots import coordinate_places

_STARTS = {1: 400, 2: 24}  # along each axis, by the number of coordinates
_ITERATIONS = 25  # enough from starts that are less than half a strain apart
_LARGEST_STRAIN = 0.3  # of one step of Newton's method
_SAME = 1e-6  # strain between what is one equilibrium


def equilibria_at(statics: Statics, value: float) -> list[np.ndarray]:
    """Every x found at a value of the varied input, within the limits, in the order of the first stretch.

    With one coordinate the starts are so dense (3 % of stretch apart) that only two equilibria nearer to each
    other than that may be missed; those are joined by a fold, and a curve through one of them leads to the other.
    """
    candidates = _newton_over_lanes(statics, _starts(statics), value)
    found: list[np.ndarray] = []
    for start in _distinct(candidates):
        try:
            x = solve(statics.residual, start, statics.scale, TOLERANCE).x
        except Lost:
            continue
        if statics.outside(x) is None and not any(same(x, other) for other in found):
            found.append(x)
    return sorted(found, key=lambda x: tuple(x))


def same(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two x at the same input are one equilibrium."""
    return bool(np.max(np.abs(one[:-1] - other[:-1])) < _SAME)


def _starts(statics: Statics) -> np.ndarray:
    """States over a grid of the coordinates, (n_state, n_lanes), all within the limits."""
    model, limits = statics.problem.model, statics.limits
    count = model.COORDINATE_COUNT
    grid = np.array(list(product(*(_along(statics, place) for place in range(count))))).T
    states = np.repeat(statics.rest[:, None], grid.shape[1], axis=1)
    states[coordinate_places(model)] = grid
    arguments = states, tuple(statics.inputs), statics.problem.parameters
    with np.errstate(all="ignore"):
        validity = model.validity(*arguments) if hasattr(model, "validity") else None
    kept = loss.margin(model.principal_stretches(*arguments), limits, validity) > 0
    return with_relaxed_dashpots(statics, states[:, kept])


def _along(statics: Statics, place: int) -> np.ndarray:
    """Values of the coordinate at `place`, from one limit to the other."""
    limits, count = statics.limits, _STARTS.get(statics.problem.model.COORDINATE_COUNT, 10)
    if statics.chart.logarithmic[place]:
        return np.geomspace(limits.smallest_stretch, limits.largest_stretch, count)
    return within_limits(statics.problem, statics.rest, place, count, limits)


def _newton_over_lanes(statics: Statics, states: np.ndarray, value: float) -> np.ndarray:
    """x of the lanes that came to rest, (n_found, n_unknowns + 1)."""
    inputs = statics.inputs.copy()
    inputs[statics.varied] = value
    with np.errstate(all="ignore"):
        states = with_leaking_charge(statics, states, tuple(inputs)).copy()
        for _ in range(_ITERATIONS):
            step = _steps(statics, states, tuple(inputs))
            step = np.clip(step, -_LARGEST_STRAIN, _LARGEST_STRAIN)
            states[statics.unknowns] = statics.chart.moved(states[statics.unknowns], step)
    settled = np.max(np.abs(step), axis=0) < _SAME
    strains = statics.chart.x_of(states[statics.unknowns][:, settled])
    return np.column_stack([strains.T, np.full(strains.shape[1], value)])


def _steps(statics: Statics, states: np.ndarray, inputs: tuple) -> np.ndarray:
    """Newton's steps of the strains, (n_unknowns, n_lanes); NaN where there is none."""
    arguments = states, inputs, statics.problem.parameters
    model = statics.problem.model
    lanes, size = states.shape[1], len(statics.unknowns)
    rates = np.broadcast_to(model.rhs(*arguments), states.shape)[statics.rows]
    jacobian = model.jacobian(*arguments)
    jacobian = np.broadcast_to(jacobian, (*jacobian.shape[:2], lanes))[np.ix_(statics.rows, statics.unknowns)]
    slopes = np.moveaxis(jacobian * statics.chart.slopes(states[statics.unknowns]), -1, 0)
    sizes = np.linalg.norm(slopes, axis=2, keepdims=True)
    slopes, right = slopes / sizes, -rates.T[:, :, None] / sizes
    regular = np.all(np.isfinite(slopes), axis=(1, 2)) & np.all(np.isfinite(right), axis=(1, 2))
    slopes[~regular] = np.eye(size)
    regular &= np.abs(np.linalg.det(slopes)) > 1e-14
    slopes[~regular] = np.eye(size)
    steps = np.linalg.solve(slopes, np.where(regular[:, None, None], right, np.nan))
    return steps[:, :, 0].T


def _distinct(candidates: np.ndarray) -> list[np.ndarray]:
    kept: list[np.ndarray] = []
    for x in candidates:
        if not any(np.max(np.abs(x[:-1] - other[:-1])) < 10 * _SAME for other in kept):
            kept.append(x)
    return kept
