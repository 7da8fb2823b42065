"""What a sine drives in a sweep: the field, or the charge or current of a model that has no field."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

from delagrange.common.units import shown
from delagrange.drives.inputs import (
    CHARGE_DENSITY,
    CURRENT_DENSITY,
    ELECTRIC_FIELD,
    ElectricalInput,
    Inputs,
    has_input,
    is_zero_number,
    named_inputs,
)

ELECTRICAL_INPUTS = (ELECTRIC_FIELD, CHARGE_DENSITY, CURRENT_DENSITY)


def phase_name(electrical: ElectricalInput) -> str:
    """Name of the phase of the sine of an electrical input."""
    return f"{electrical.stem}_phase"


def sine_names(electrical: ElectricalInput) -> tuple[str, str, str]:
    """Names of the amplitude, the bias and the phase of the sine of an electrical input."""
    return electrical.amplitude, electrical.bias, phase_name(electrical)


def sine_text(electrical: ElectricalInput) -> str:
    """The sine as a formula of these names."""
    amplitude, bias, phase = sine_names(electrical)
    return f"{bias} + {amplitude} * sin(2 pi frequency t + {phase})"


def sine_long_names(electrical: ElectricalInput) -> dict[str, str]:
    """Long names of amplitude, bias, phase and frequency, by their names."""
    of = electrical.long_name.replace("nominal ", "")
    amplitude, bias, phase = sine_names(electrical)
    return {
        amplitude: f"amplitude of the {electrical.long_name}",
        bias: f"bias of the {electrical.long_name}",
        phase: f"phase of the {of} at t = 0",
        "frequency": f"frequency of the {of}",
    }


def driven_sine(
    model: ModuleType, given: Mapping[ElectricalInput, tuple[object, ...]], inputs: Inputs | None
) -> tuple[ElectricalInput, dict[str, object]]:
    """What the sine drives, and its amplitude, bias and phase by name.

    Where the charge or current of a model is among its `inputs`, or a field of zero is given to it, there is no sine;
    it then counts as one of no field.

    given: amplitude (None: left out), bias and phase of every sine

    Raises:
        ValueError: a number of another sine, other than zero, or no amplitude of this one.
    """
    own = next((each for each in ELECTRICAL_INPUTS if has_input(model, each.name)), ELECTRIC_FIELD)
    _refuse_foreign(model, own, given)
    if own is not ELECTRIC_FIELD and not any(map(_acts, given[own])):
        without = given[ELECTRIC_FIELD][0] is not None and given[own][0] is None
        if without or own.name in named_inputs(model, inputs):
            return ELECTRIC_FIELD, dict.fromkeys(sine_names(ELECTRIC_FIELD), 0.0)
    if given[own][0] is None:
        raise ValueError(f"{own.amplitude} must be a number in {own.unit}, got none")
    return own, dict(zip(sine_names(own), given[own]))


def _refuse_foreign(
    model: ModuleType, own: ElectricalInput, given: Mapping[ElectricalInput, tuple[object, ...]]
) -> None:
    for each, values in given.items():
        for name, value in zip(sine_names(each), values):
            if each is not own and _acts(value):
                raise ValueError(
                    f"{name} given as {shown(value)}, but {model.MODEL} has no input {each.name}; "
                    f"give {', '.join(sine_names(own))} in {own.unit} and rad"
                )


def _acts(value: object) -> bool:
    """Whether a number is given that is not zero, or an array."""
    return value is not None and not is_zero_number(value)
