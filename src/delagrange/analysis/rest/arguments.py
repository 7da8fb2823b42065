"""What the analyses of a membrane at rest have in common: their arguments, checked, and their attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import (
    CHARGE_DENSITY,
    ELECTRIC_FIELD,
    FORCE,
    ElectricalInput,
    Inputs,
    electrical_input,
    has_input,
    is_zero_number,
    named_inputs,
)
from delagrange.model.load import load_model
from delagrange.model.material import Material
from delagrange.model.parameters import Parameters, material_of
from delagrange.model.variables import is_stretch
from delagrange.problem.initial import PREFIX, checked_initial
from delagrange.problem.problem import Problem, make_problem
from delagrange.problem.status import Limits
from delagrange.run.grid import Grid, make_grid
from delagrange.run.run_dataset import run_attributes, variable

FROZEN_MEANING = "frozen: the dashpots stay as in the reference state or in initial_state"
RELAXED_MEANING = "relaxed: the dashpots are at rest, too"
_UNITS = {"force": "N", "held_stretch": "1"}
_LONG_NAMES = {
    "force": "applied force",
    "held_stretch": "stretch at which axis 2 is held",
}


@dataclass(frozen=True)
class Cases:
    """Problems over a grid of what was given."""

    model: ModuleType
    parameters: Parameters | None
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
            name: variable(dimensions, values, self.grid.units[name], self._long_name(name))
            for name, (dimensions, values) in named.items()
        }

    def _long_name(self, name: str) -> str:
        meanings = {entry.name: entry.meaning for entry in self.model.INPUTS if entry.name != FORCE}
        return (_LONG_NAMES | meanings).get(name, name.replace("_", " "))

    def attributes(self, dashpots: str) -> dict[str, object]:
        """What all cases have in common."""
        common = run_attributes(self.first_problem(), material_of(self.model, self.parameters), self.limits)
        for name in (*self.grid.axes, *(f"{name}_units" for name in self.grid.axes)):
            common.pop(name, None)
        for entry in self.model.INPUTS:
            common.pop(f"{entry.name}_drive", None)
        starts = {PREFIX + name: float(value) for name, value in (self.initial_state or {}).items()}
        about = {
            "varied_input": electrical_input(self.model).name,
            "coordinates": coordinates_text(self.model),
        }
        return common | {"dashpots": dashpots} | starts | about

    def _problem(self, values: dict[str, float]) -> Problem:
        given = dict(values)
        held, force = given.pop("held_stretch", None), given.pop(FORCE, 0.0)
        names = [entry.name for entry in self.model.INPUTS]
        inputs = {name: given.pop(name) for name in names if name in given}
        return make_problem(self.model, self.parameters, given, held, force, 0.0, inputs)


def make_cases(
    model: str | ModuleType,
    formulation: str | None,
    lateral_dashpot: str | None,
    parameters: Parameters | None,
    initial_state: Mapping[str, float] | None,
    limits: Limits,
    values: Mapping[str, object],
    inputs: Inputs | None = None,
) -> Cases:
    """The cases over `values`, each a number or a one-dimensional array: force, held stretch (or None), material.

    inputs: values of inputs other than the electrical one by name, numbers or arrays as well

    Raises:
        ValueError: an unknown name, a bad value, or values that the model has no place for.
    """
    module = load_model(model, formulation, lateral_dashpot)
    checks.instance("limits", limits, Limits)
    material = material_of(module, parameters)
    given = {name: value for name, value in values.items() if name != "held_stretch" or value is not None}
    others = _other_inputs(module, inputs, given[FORCE])
    material.check_names({name: value for name, value in given.items() if name not in _UNITS})
    checked = {name: _checked(name, value, material) for name, value in given.items()}
    material.check_grid(checked)
    checked_initial(module, initial_state)
    if FORCE in others or (is_zero_number(checked[FORCE]) and not has_input(module, FORCE)):
        del checked[FORCE]
    units = {entry.name: entry.unit for entry in module.INPUTS} | _UNITS | dict(material.units)
    checked = {name: checks.finite(name, value, units[name]) for name, value in others.items()} | checked
    single = {name: _one_number(name, value) for name, value in (initial_state or {}).items()}
    cases = Cases(module, parameters, make_grid(checked, units, ""), single, limits)
    cases.first_problem()
    return cases


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


def without_electrical(model: ModuleType, inputs: Inputs | None) -> tuple[Inputs | None, object]:
    """The other inputs given by name, and the values of the charge among them; None where it is not.

    Raises:
        ValueError: the field, which has an argument of its own; a drive; a model without such an input; or as
            `delagrange.drives.inputs.named_inputs`.
    """
    given, electrical = named_inputs(model, inputs), electrical_input(model)
    if electrical is ELECTRIC_FIELD and electrical.name in given:
        raise ValueError(f"{electrical.argument} is what varies here, and is not given by inputs")
    value = given.pop(electrical.name, None)
    if isinstance(value, Drive):
        raise ValueError(f"inputs {electrical.name} must be a number or an array of them here, got {value}")
    return (None if inputs is None else given), value


def refuse_electrical(model: ModuleType, inputs: Inputs | None) -> None:
    """Refuse the electrical input where an analysis looks for its value.

    Raises:
        ValueError: it is given; or as `without_electrical`.
    """
    _, value = without_electrical(model, inputs)
    if value is not None:
        raise ValueError(f"{electrical_input(model).name} is what varies here, and is not given by inputs")


def electrical_name(model: ModuleType, field: object) -> ElectricalInput:
    """The electrical input of a model.

    Raises:
        ValueError: a field that is given to a model under charge control; or it has no electrical input.
    """
    electrical = electrical_input(model)
    if electrical is CHARGE_DENSITY and field is not None and not is_zero_number(field):
        raise ValueError(
            f"the model {model.MODEL} is under charge control and has no field; "
            f'give inputs={{"{electrical.name}": values in {electrical.unit}}} (--input on the command line)'
        )
    return electrical


def stretch_alias(model: ModuleType) -> dict[str, str]:
    """`{"stretch": name}` where the first coordinate is a stretch with another name."""
    first = model.STATE[0]
    return {"stretch": first.name} if first.name != "stretch" and is_stretch(first) else {}


def first_coordinate(model: ModuleType) -> str:
    """`stretch`, or the name of the first coordinate where that is none."""
    first = model.STATE[0]
    return "stretch" if is_stretch(first) else first.name


def coordinates_text(model: ModuleType) -> str:
    """The names of the coordinates in one line."""
    return ", ".join(entry.name for entry in model.STATE[: model.COORDINATE_COUNT])


def _other_inputs(model: ModuleType, inputs: Inputs | None, force: object) -> dict[str, object]:
    """The inputs given by name.

    Raises:
        ValueError: a drive; the electrical input; or the force twice.
    """
    refuse_electrical(model, inputs)
    given = named_inputs(model, inputs)
    for name, value in given.items():
        if isinstance(value, Drive):
            raise ValueError(f"inputs {name} must be a number or an array of them here, got {value}")
    if FORCE in given and not is_zero_number(force):
        raise ValueError("force is given by itself and in inputs as well; give one")
    return given


def _checked(name: str, value: object, material: Material) -> float | np.ndarray:
    if name in material.units:
        return material.checked(name, value)
    check = checks.finite if name == FORCE else checks.positive
    return check(name, value, _UNITS[name])


def _one_number(name: str, value: object) -> object:
    if np.ndim(value) != 0:
        raise ValueError(f"initial_state {name} must be a single number, got {np.size(value)} values")
    return value
