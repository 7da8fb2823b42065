"""How the unknowns of a membrane at rest are measured: stretches by their logarithms, all else by a size of its own.

A stretch is positive, and its logarithm is a strain. A coordinate that is no stretch may be zero or negative. It is
measured from the reference state by the change that strains the membrane by about one half, through the inverse
hyperbolic sine: in proportion to that change while it is small, and like a logarithm where it is large.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.model.variables import is_stretch
from delagrange.problem.coordinate_size import straining_change, strains_at, typical_sizes
from delagrange.problem.dashpots import charge_place
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits

_FARTHEST = 20.0  # of the inverse hyperbolic sine: 2e8 sizes
_SAMPLES = 400  # of the way to a limit


@dataclass(frozen=True)
class Chart:
    """What stands for values of the unknowns, (n_unknowns, ...), in a vector x."""

    logarithmic: np.ndarray  # (n_unknowns,) of bool: a stretch
    origin: np.ndarray  # (n_unknowns,), where x is zero of what is no stretch
    size: np.ndarray  # (n_unknowns,), in the unit of the unknown

    def x_of(self, values: np.ndarray) -> np.ndarray:
        """x of values, (n_unknowns, ...)."""
        x = np.array(values, dtype=float)
        x[self.logarithmic] = np.log(x[self.logarithmic])
        other = ~self.logarithmic
        x[other] = np.arcsinh((x[other] - _along(self.origin[other], x)) / _along(self.size[other], x))
        return x

    def values(self, x: np.ndarray) -> np.ndarray:
        """Values at x, (n_unknowns, ...)."""
        values = np.array(x, dtype=float)
        values[self.logarithmic] = np.exp(values[self.logarithmic])
        other = ~self.logarithmic
        values[other] = _along(self.origin[other], x) + _along(self.size[other], x) * np.sinh(values[other])
        return values

    def slopes(self, values: np.ndarray) -> np.ndarray:
        """Derivatives of the values by x, there, (n_unknowns, ...)."""
        slopes = np.array(values, dtype=float)
        other = ~self.logarithmic
        slopes[other] = np.hypot(
            _along(self.size[other], slopes), slopes[other] - _along(self.origin[other], slopes)
        )
        return slopes

    def moved(self, values: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Values after a step of x, (n_unknowns, ...)."""
        if np.all(self.logarithmic):
            return values * np.exp(step)
        return self.values(self.x_of(values) + step)


def make_chart(problem: Problem, unknowns: np.ndarray) -> Chart:
    """The chart of the unknowns at these places of the state."""
    reference = np.asarray(problem.model.reference_state(problem.parameters), dtype=float)
    entries = problem.model.STATE
    logarithmic = np.array(
        [is_stretch(entries[place]) and reference[place] > 0 for place in unknowns], dtype=bool
    )
    sizes = [
        1.0 if known else _size(problem, reference, int(place))
        for place, known in zip(unknowns, logarithmic)
    ]
    return Chart(logarithmic, reference[unknowns], np.array(sizes, dtype=float))


def _size(problem: Problem, reference: np.ndarray, place: int) -> float:
    """Of an unknown that is no stretch."""
    if place == charge_place(problem.model):
        return float(typical_sizes(problem)[place])
    return straining_change(problem, reference, place)


def within_limits(problem: Problem, rest: np.ndarray, place: int, count: int, limits: Limits) -> np.ndarray:
    """Values of the coordinate at `place`, (count,), that is no stretch, evenly by strain over what limits allow."""
    reference = np.asarray(problem.model.reference_state(problem.parameters), dtype=float)[place]
    size = straining_change(problem, rest, place)
    ends = [_farthest(problem, rest, place, reference, sign * size, limits) for sign in (-1.0, 1.0)]
    near = np.geomspace(1e-9, 0.5, _SAMPLES)
    ways = np.concatenate([[0.0], near, 1 - near[::-1], [1.0]])
    values = np.unique(np.concatenate([reference + (end - reference) * ways for end in ends]))
    strains = np.abs(np.diff(strains_at(problem, rest, place, values), axis=1))
    travelled = np.append(0.0, np.cumsum(np.max(np.nan_to_num(strains, posinf=0.0), axis=0)))
    return np.interp(np.linspace(0.0, travelled[-1], count), travelled, values)


def _along(numbers: np.ndarray, like: np.ndarray) -> np.ndarray:
    """Numbers of unknowns, (n,), beside an array (n_unknowns, ...)."""
    return numbers.reshape(-1, *(1,) * (np.ndim(like) - 1))


def _farthest(
    problem: Problem, rest: np.ndarray, place: int, start: float, step: float, limits: Limits
) -> float:
    """How far a coordinate goes from its start, to one side, before a limit is passed for the first time."""
    x = np.linspace(0.0, _FARTHEST, 40 * _SAMPLES)
    values = start + step * np.sinh(x)
    states = np.repeat(np.asarray(rest, dtype=float)[:, None], len(values), axis=1)
    states[place] = values
    with np.errstate(all="ignore"):
        lost = ~(problem.margin(0.0, states, limits) > 0)
    return float(values[max(int(np.argmax(lost)) - 1, 0)] if np.any(lost) else values[-1])
