"""Values by name as a person types them, NAME=VALUES: for what a user's own model has and no option is named after."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from delagrange.cli import quantities
from delagrange.common import checks
from delagrange.common.checks import did_you_mean
from delagrange.model.parameters import CHANGEABLE_UNITS, material_of

Values = float | np.ndarray


def inputs_given(texts: list[str] | None, module: ModuleType) -> dict[str, Values] | None:
    """The inputs of the model that --input gives, each a number or many; None where it gives none.

    Raises:
        ValueError: another form, no input of the model, or values that are no numbers or ranges.
    """
    return named_values("input", texts, {entry.name: entry.unit for entry in module.INPUTS}) or None


def material_given(
    options: Mapping[str, Values | None], texts: list[str] | None, module: ModuleType
) -> dict[str, Values]:
    """The parameters of the model that options of their own or --parameter give.

    options: values of options by the names of parameters, and whatever else; those of None are not given

    Raises:
        ValueError: another form, no parameter of the model, values that are no numbers or ranges, or one twice.
    """
    own = {name: options[name] for name in CHANGEABLE_UNITS if options.get(name) is not None}
    named = named_values("parameter", texts, material_of(module, None).units)
    for name in named:
        if name in own:
            option = f"--{name.replace('_', '-')}"
            raise ValueError(f"{name} is given by {option} and by --parameter; give one")
    return own | named


def refuse_many(given: Mapping[str, object], module: ModuleType, but: str | None = None) -> None:
    """Refuse many values of an input or a parameter in a command that takes one of each, of all but one name.

    given: what `inputs_given` and `material_given` return, or None of it, and whatever else under other names

    Raises:
        ValueError: naming the first, with its values.
    """
    units = {entry.name: entry.unit for entry in module.INPUTS} | material_of(module, None).units
    for name, value in {**given, **(given.get("inputs") or {})}.items():
        if name in units and name != but and value is not None:
            checks.scalar(name, value, units[name])


def named_values(option: str, texts: list[str] | None, units: Mapping[str, str]) -> dict[str, Values]:
    """All values of each name; hyphens count as underscores.

    Raises:
        ValueError: another form, a name without a unit in `units`, or values that are no numbers or ranges.
    """
    collected: dict[str, list[str]] = {}
    for text in texts or ():
        name, equals, values = text.partition("=")
        name = name.strip().replace("-", "_")
        known = ", ".join(f"{key} [{unit}]" for key, unit in units.items()) or "none"
        if not equals:
            raise ValueError(f"{option} must be NAME=VALUES with one of {known}; got {text!r}")
        if name not in units:
            near = did_you_mean(name, units)
            raise ValueError(f"{option} {text!r} names no {option} of the model{near}; known are {known}")
        collected.setdefault(name, []).append(values)
    return {
        name: quantities.axis(f"{option} {name}", values, units[name]) for name, values in collected.items()
    }
