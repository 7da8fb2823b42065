"""What the analyses of a membrane at rest have in common: their arguments, checked, and their attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from types import ModuleType

import numpy as np

from delagrange import checks
from delagrange.dataset import run_attributes, variable
from delagrange.grid import Grid, make_grid
from delagrange.initial import PREFIX, checked_initial
from delagrange.loss import Limits
from delagrange.models import load_model
from delagrange.parameters import CHANGEABLE_UNITS, Parameters, check_material_names
from delagrange.problem import Problem, make_problem

FROZEN_MEANING = "frozen: the dashpots stay as in the reference state or in initial_state"
RELAXED_MEANING = "relaxed: the dashpots are at rest, too"
_UNITS = {"force": "N", "held_stretch": "1", **CHANGEABLE_UNITS}
_NO_MATERIAL = ("force", "held_stretch")
_LONG_NAMES = {
    "force": "applied force",
    "held_stretch": "stretch at which axis 2 is held",
}


@dataclass(frozen=True)
class Cases:
    """Problems over a grid of what was given."""

    model: ModuleType
    parameters: Parameters
    grid: Grid
    initial_state: Mapping[str, float] | None
    limits: Limits

    def problems(self) -> Iterator[Problem]:
        """One problem of constant inputs for each place in the grid, the last axis fastest."""
        for values in product(*self.grid.axes.values()):
            varied = {name: float(value) for name, value in zip(self.grid.axes, values)}
            yield self._problem(self.grid.single | varied)

    def first_problem(self) -> Problem:
        """The problem at the first place."""
        return next(self.problems())

    def coordinates(self) -> dict[str, tuple]:
        """For a Dataset: each axis with its unit, and single values as scalars."""
        named = {name: ((name,), values) for name, values in self.grid.axes.items()}
        named |= {name: ((), value) for name, value in self.grid.single.items()}
        return {
            name: variable(dimensions, values, _UNITS[name], _LONG_NAMES.get(name, name.replace("_", " ")))
            for name, (dimensions, values) in named.items()
        }

    def attributes(self, dashpots: str) -> dict[str, object]:
        """What all cases have in common."""
        common = run_attributes(self.first_problem(), self.parameters, self.limits)
        for name in (*self.grid.axes, *(f"{name}_units" for name in self.grid.axes)):
            common.pop(name, None)
        common.pop("nominal_electric_field_drive", None)
        common.pop("force_drive", None)
        starts = {PREFIX + name: float(value) for name, value in (self.initial_state or {}).items()}
        return common | {"dashpots": dashpots} | starts

    def _problem(self, values: dict[str, float]) -> Problem:
        given = dict(values)
        held, force = given.pop("held_stretch", None), given.pop("force")
        return make_problem(self.model, self.parameters, given, held, force, 0.0)


def make_cases(
    model: str | ModuleType,
    formulation: str | None,
    lateral_dashpot: str | None,
    parameters: Parameters,
    initial_state: Mapping[str, float] | None,
    limits: Limits,
    values: Mapping[str, object],
) -> Cases:
    """The cases over `values`, each a number or a one-dimensional array: force, held stretch (or None), material.

    Raises:
        ValueError: an unknown name, a bad value, or values that the model has no place for.
    """
    module = load_model(model, formulation, lateral_dashpot)
    checks.instance("limits", limits, Limits)
    checks.instance("parameters", parameters, Parameters)
    given = {name: value for name, value in values.items() if name != "held_stretch" or value is not None}
    check_material_names({name: value for name, value in given.items() if name not in _NO_MATERIAL})
    checked = {name: _checked(name, value) for name, value in given.items()}
    checked_initial(module, initial_state)
    single = {name: _one_number(name, value) for name, value in (initial_state or {}).items()}
    cases = Cases(module, parameters, make_grid(checked, _UNITS, ""), single, limits)
    cases.first_problem()
    return cases


def single_case(cases: Cases, purpose: str) -> Cases:
    """The cases, if there is but one.

    Raises:
        ValueError: a value that is an array.
    """
    for name, values in cases.grid.axes.items():
        raise ValueError(
            f"{name} must be a single number for {purpose}, got {len(values)} values in {_UNITS[name]}"
        )
    return cases


def stretch_alias(model: ModuleType) -> dict[str, str]:
    """`{"stretch": name}` where the first coordinate has another name."""
    name = model.STATE[0].name
    return {} if name == "stretch" else {"stretch": name}


def _checked(name: str, value: object) -> float | np.ndarray:
    check = checks.finite if name == "force" else checks.positive
    return check(name, value, _UNITS[name])


def _one_number(name: str, value: object) -> object:
    if np.ndim(value) != 0:
        raise ValueError(f"initial_state {name} must be a single number, got {np.size(value)} values")
    return value
