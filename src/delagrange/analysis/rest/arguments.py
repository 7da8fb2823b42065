"""What the analyses of a membrane at rest have in common: their arguments, checked, and their attributes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.drives.inputs import (
    FORCE,
    ElectricalInput,
    GivenElectrical,
    Inputs,
    Values,
    given_twice,
    has_input,
    is_zero,
    refuse_searched,
    separate_electrical,
)
from delagrange.equilibrium.statics import Statics, make_statics, refuse_endless
from delagrange.model.material import Material
from delagrange.model.parameters import Parameters
from delagrange.model.variables import is_stretch
from delagrange.problem.initial import single_initial
from delagrange.problem.problem import Problem, Specimen, make_specimen
from delagrange.problem.status import Limits, checked_limits
from delagrange.run.grid import Grid, make_grid
from delagrange.run.run_dataset import run_attributes, state_variables, variable

FROZEN_MEANING = "frozen: the dashpots stay as in the reference state or in initial_state"
RELAXED_MEANING = "relaxed: the dashpots are at rest, too"
_UNITS = {"force": "N", "held_stretch": "1"}
_LONG_NAMES = {
    "force": "applied force",
    "held_stretch": "stretch at which axis 2 is held",
}


@dataclass(frozen=True)
class Cases:
    """Problems over a grid of what was given, without the electrical input."""

    specimen: Specimen
    given: GivenElectrical
    grid: Grid
    initial_state: Mapping[str, float] | None
    limits: Limits

    @property
    def model(self) -> ModuleType:
        """The model of all cases."""
        return self.specimen.model

    @property
    def electrical(self) -> ElectricalInput:
        """What drives the electrodes, and varies."""
        return self.given.electrical

    def statics(self, problem: Problem, dashpots: str, largest: float = np.inf) -> Statics:
        """One of the problems at rest, its electrical input from zero to `largest`.

        Raises:
            ValueError: a current feeds a charge that does not leak, or as `make_statics`.
        """
        statics = make_statics(problem, dashpots, self.initial_state, self.limits)
        refuse_endless(statics, largest, "rest")
        return statics

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
            name: variable(dimensions, values, self.grid.units[name], self._long_name(name))
            for name, (dimensions, values) in named.items()
        }

    def _long_name(self, name: str) -> str:
        meanings = {entry.name: entry.meaning for entry in self.model.INPUTS if entry.name != FORCE}
        return (_LONG_NAMES | meanings).get(name, name.replace("_", " "))

    def attributes(self, dashpots: str) -> dict[str, object]:
        """What all cases have in common."""
        source = self.specimen.material.changed_source(self.grid.single)
        common = run_attributes(replace(self.first_problem(), source=source), self.limits)
        for name in (*self.grid.axes, *(f"{name}_units" for name in self.grid.axes)):
            common.pop(name, None)
        for entry in self.model.INPUTS:
            common.pop(f"{entry.name}_drive", None)
        about = {"varied_input": self.electrical.name, "coordinates": coordinates_text(self.model)}
        starts = single_initial(self.model, self.initial_state)
        return common | {"dashpots": dashpots} | starts | about

    def _problem(self, values: dict[str, float]) -> Problem:
        given = dict(values)
        held, force = given.pop("held_stretch", None), given.pop(FORCE, 0.0)
        names = [entry.name for entry in self.model.INPUTS]
        inputs = {name: given.pop(name) for name in names if name in given}
        return self.specimen.problem(given, held, force, 0.0, inputs)


def make_cases(
    model: str | ModuleType,
    formulation: str | None,
    lateral_dashpot: str | None,
    parameters: Parameters | None,
    initial_state: Mapping[str, float] | None,
    limits: Limits | None,
    values: Mapping[str, object],
    inputs: Inputs | None = None,
    field: tuple[str, object] | None = None,
) -> Cases:
    """The cases over `values`, each a number or a one-dimensional array: force, held stretch (or None), material.

    inputs: values of inputs by name, numbers or arrays as well
    field: what is given of the field by an argument of its own, and the argument; None: the electrical input is what
        the analysis looks for, and is not given

    Raises:
        ValueError: an unknown name, a bad value, or values that the model has no place for.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    module, material = specimen.model, specimen.material
    limits = checked_limits(limits)
    if field is None:
        refuse_searched(module, inputs)
    electrical, others = separate_electrical(module, inputs, *(field or ("field", None)))
    material.check_names({name: value for name, value in values.items() if name not in _UNITS})
    checked = {
        name: _checked(name, value, material)
        for name, value in values.items()
        if name != "held_stretch" or value is not None
    }
    material.check_grid(checked)
    single_initial(module, initial_state)
    units = {entry.name: entry.unit for entry in module.INPUTS} | _UNITS | dict(material.units)
    checked = _with_inputs(module, checked, others, units)
    cases = Cases(specimen, electrical, make_grid(checked, units, ""), initial_state, limits)
    cases.first_problem()
    return cases


def _with_inputs(
    model: ModuleType, checked: dict[str, Values], others: Mapping[str, Values], units: Mapping[str, str]
) -> dict[str, Values]:
    """The values with those of inputs given by name before them.

    Raises:
        ValueError: a value that is not finite, or the force twice.
    """
    force = checked[FORCE]
    if FORCE in others and not is_zero(force):
        raise given_twice(FORCE, force)
    if FORCE in others or (is_zero(force) and not has_input(model, FORCE)):
        del checked[FORCE]
    return {name: checks.finite(name, value, units[name]) for name, value in others.items()} | checked


def single_case(cases: Cases, purpose: str) -> Cases:
    """The cases, if there is but one.

    Raises:
        ValueError: a value that is an array.
    """
    for name, values in cases.grid.axes.items():
        raise ValueError(
            f"{name} must be a single number for {purpose}, got {len(values)} values in {cases.grid.units[name]}"
        )
    return cases


def resting_variables(
    model: ModuleType,
    dimensions: str | tuple[str, ...],
    states: Iterable[np.ndarray],
    where: str = "",
    prefix: str = "",
) -> dict[str, tuple]:
    """As `delagrange.run.run_dataset.state_variables`; a first coordinate that is a stretch goes as `stretch`, too."""
    data = state_variables(model, dimensions, states, where, prefix)
    return data | {prefix + first_coordinate(model): data[prefix + model.STATE[0].name]}


def first_coordinate(model: ModuleType) -> str:
    """`stretch`, or the name of the first coordinate where that is none."""
    first = model.STATE[0]
    return "stretch" if is_stretch(first) else first.name


def coordinates_text(model: ModuleType) -> str:
    """The names of the coordinates in one line."""
    return ", ".join(entry.name for entry in model.STATE[: model.COORDINATE_COUNT])


def _checked(name: str, value: object, material: Material) -> float | np.ndarray:
    if name in material.units:
        return material.checked(name, value)
    check = checks.finite if name == FORCE else checks.positive
    return check(name, value, _UNITS[name])
