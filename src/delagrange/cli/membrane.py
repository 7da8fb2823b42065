"""The membrane that a command is about: its model, loaded once, and what all analyses take of it."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from delagrange.cli.options import Given, flag_of
from delagrange.cli.values import Values, by_name
from delagrange.common.checks import scalar
from delagrange.model.load import load_model
from delagrange.model.parameters import CHANGEABLE_UNITS, material_of
from delagrange.problem.initial import EQUILIBRIUM
from delagrange.problem.status import Limits

Start = dict[str, Values] | str | None


def loaded(given: Given) -> ModuleType:
    """The model.

    Raises:
        ValueError: there is none of that name and formulation.
    """
    return load_model(given.model, given.formulation, given.lateral_dashpot)


def arguments(given: Given, module: ModuleType, start: Start) -> dict[str, Any]:
    """What every analysis takes: held stretch, state at t = 0, inputs by name, material.

    Raises:
        ValueError: as `inputs_given` and `material_given`.
    """
    return {
        "held_stretch": given.held_stretch,
        "initial_state": start,
        "inputs": inputs_given(given, module),
        **material_given(given, module),
    }


def limits_given(given: Given) -> Limits:
    """The stretches beyond which a run is lost.

    Raises:
        ValueError: they leave no room about 1.
    """
    return Limits(**given.some("smallest_stretch", "largest_stretch"))


def inputs_given(given: Given, module: ModuleType) -> dict[str, Values] | None:
    """The inputs of the model that --input gives, each a number or many; None where it gives none.

    Raises:
        ValueError: another form, no input of the model, or values that are no numbers or ranges.
    """
    units = {entry.name: entry.unit for entry in module.INPUTS}
    return by_name("--input", given.input, units, "input of the model") or None


def material_given(given: Given, module: ModuleType) -> dict[str, Values]:
    """The parameters of the model that options of their own or --parameter give.

    Raises:
        ValueError: another form, no parameter of the model, values that are no numbers or ranges, or one twice.
    """
    own = given.some(*CHANGEABLE_UNITS)
    units = material_of(module, None).units
    named = by_name("--parameter", given.parameter, units, "parameter of the model")
    for name in named:
        if name in own:
            raise ValueError(f"{name} is given by {flag_of(name)} and by --parameter; give one")
    return own | named


def refuse_many(taken: dict[str, Any], module: ModuleType, but: str | None = None) -> None:
    """Refuse many values of an input or a parameter in a command that takes one of each, of all but one name.

    taken: as `arguments` gives it

    Raises:
        ValueError: naming the first, with its values.
    """
    units = {entry.name: entry.unit for entry in module.INPUTS} | material_of(module, None).units
    for name, value in {**taken, **(taken["inputs"] or {})}.items():
        if name in units and name != but and value is not None:
            scalar(name, value, units[name])


def state_given(given: Given, module: ModuleType) -> dict[str, Values] | None:
    """All values of each state variable at t = 0, by name; None where the reference state is meant.

    Raises:
        ValueError: another form, an unknown name, or values that are no numbers or ranges.
    """
    units = {entry.name: entry.unit for entry in module.STATE}
    return by_name("--initial", given.initial, units, "state variable") or None


def start_given(given: Given, module: ModuleType) -> Start:
    """As `state_given`, or the loaded equilibrium where that is typed instead.

    Raises:
        ValueError: as `state_given`; or values beside the equilibrium.
    """
    texts = given.initial or ()
    if EQUILIBRIUM not in texts:
        return state_given(given, module)
    for text in texts:
        if text != EQUILIBRIUM:
            raise ValueError(
                f"initial {EQUILIBRIUM!r} says the whole state, and {text!r} is given as well; give one"
            )
    return EQUILIBRIUM


def single_start(given: Given, module: ModuleType) -> Start:
    """As `start_given`, of a single run.

    Raises:
        ValueError: as `start_given`; or many values of one state variable.
    """
    start = start_given(given, module)
    if isinstance(start, dict):
        units = {entry.name: entry.unit for entry in module.STATE}
        return {name: scalar(f"initial {name}", value, units[name]) for name, value in start.items()}
    return start
