"""Periodic motions to start branches from: grown with what drives them, or near rest under its mean square."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from delagrange.analysis.steady.load import forces_of
from delagrange.analysis.steady.search import Range, Search
from delagrange.analysis.steady.shooting import Shooting
from delagrange.equilibrium.continuation import ContinuationSettings, Lost, continue_branch, solve
from delagrange.equilibrium.seeds import equilibria_at
from delagrange.equilibrium.statics import Statics
from delagrange.problem.dashpots import leak_rate

_FARTHEST = 1.5  # of the wanted amplitude of the field: folds back from beyond are followed that far
_GROWTH = ContinuationSettings(
    first_step=0.01, largest_step=0.04, smallest_step=1e-6, most_points=250, tolerance=1e-8, largest_angle=0.3
)


@dataclass(frozen=True)
class Start:
    """A periodic motion, and how it was found."""

    x: np.ndarray  # (n_unknowns + 1,), of the shooting along the range
    origin: str


Equilibria = Callable[
    [float, float], list[np.ndarray]
]  # states, (n_state,), under a force [N] and a field [V/m], or charge [C/m^2]


def equilibria_of(statics: Statics) -> Equilibria:
    """Every equilibrium found under a constant load, each load looked at once."""

    @cache
    def found(force: float, field: float) -> list[np.ndarray]:
        loaded = statics.varying(statics.electrical.name, **forces_of(statics.problem, {"force": force}))
        return [loaded.state(x) for x in equilibria_at(loaded, field)]

    return found


def starts(search: Search, equilibria: Equilibria, value: float) -> Iterator[Start]:
    """Periodic motions at a value of the varied number; the same one may come more than once."""
    load, electrical = search.shooting.at(value), search.electrical
    for rest in equilibria(load["force"], load[electrical.bias]):
        for state in _grown(search, rest, load):
            yield Start(
                search.shooting.x_of(state, value), f"grown with the {electrical.stem} from an equilibrium"
            )
    for rest in equilibria(load["force"], _root_mean_square(search, load)):
        yield from _solved(search, rest, value)


def _root_mean_square(search: Search, load: Mapping[str, float]) -> float:
    """The constant field, charge or current whose square is the mean of that of field or charge.

    The charge of a sine of current lags behind it: all of it would flow only if it leaked fast against the sine.
    """
    electrical, leak = search.electrical, leak_rate(search.shooting.path.problem)
    squared = load[electrical.amplitude] ** 2 / 2
    if leak > 0:
        squared /= 1 + (2 * np.pi * load["frequency"] / leak) ** 2
    return float(np.sqrt(load[electrical.bias] ** 2 + squared))


def _grown(search: Search, state: np.ndarray, load: dict[str, float]) -> Iterator[np.ndarray]:
    """States at phase 0, at the wanted amplitude of field or charge, of what grows with it from an equilibrium."""
    name = search.electrical.amplitude
    target = load[name]
    if target == 0:
        yield state
        return
    shooting = search.shooting.varying(name, target, **load)
    growth = Search(
        shooting, Range(0.0, _FARTHEST * target), _GROWTH, search.conservative, search.largest_amplitude
    )
    start = shooting.x_of(state, 0.0)
    branch = continue_branch(shooting.residual, start, 1, shooting.scale, _GROWTH, growth.outside)
    for point in growth.crossings(branch.points, target):
        yield shooting.state(point.x)


def _solved(search: Search, state: np.ndarray, value: float) -> Iterator[Start]:
    shooting: Shooting = search.shooting
    try:
        found = solve(
            shooting.residual, shooting.x_of(state, value), shooting.scale, search.settings.tolerance
        )
    except Lost:
        return
    if search.outside(found.x) is None:
        stem = search.electrical.stem
        yield Start(found.x, f"found near the equilibrium under the mean square of the {stem}")
