"""What a sine drives in a sweep or a response: the field, or the charge or current of a model that has no field."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.units import shown
from delagrange.drives.drive import Sine
from delagrange.drives.inputs import (
    ELECTRIC_FIELD,
    ELECTRICAL,
    ElectricalInput,
    Inputs,
    electrical_input,
    find_electrical,
    is_zero,
    named_inputs,
    refuse_other_electrical,
)

SIZE_UNITS: Mapping[str, str] = {
    name: each.unit for each in ELECTRICAL.values() for name in (each.amplitude, each.bias)
}  # of the sines of all electrical inputs
PHASE_UNITS: Mapping[str, str] = {each.phase: "rad" for each in ELECTRICAL.values()}
LOAD_UNITS: Mapping[str, str] = {"force": "N", **SIZE_UNITS, "frequency": "Hz"}  # of a periodic response


def sine_names(electrical: ElectricalInput) -> tuple[str, str, str]:
    """Names of the amplitude, the bias and the phase of the sine of an electrical input."""
    return electrical.amplitude, electrical.bias, electrical.phase


def sine_text(electrical: ElectricalInput, phase: bool = True) -> str:
    """The sine as a formula of these names."""
    lag = f" + {electrical.phase}" if phase else ""
    return f"{electrical.bias} + {electrical.amplitude} * sin(2 pi frequency t{lag})"


def sine_long_names(electrical: ElectricalInput) -> dict[str, str]:
    """Long names of amplitude, bias, phase and frequency, by their names."""
    of = electrical.long_name.replace("nominal ", "")
    return {
        electrical.amplitude: f"amplitude of the {electrical.long_name}",
        electrical.bias: f"bias of the {electrical.long_name}",
        electrical.phase: f"phase of the {of} at t = 0",
        "frequency": f"frequency of the {of}",
    }


def frequency_axis(values: object, or_decreasing: bool = False) -> np.ndarray:
    """Frequencies [Hz] over which a sweep goes, (n,): positive, strictly increasing or, where it may, decreasing.

    Raises:
        ValueError: they are not.
    """
    return checks.positive("frequency", checks.increasing("frequency", values, "Hz", or_decreasing), "Hz")


def own_sine(
    model: ModuleType, electrical: ElectricalInput, given: Mapping[str, object]
) -> dict[str, object]:
    """Of the numbers of sines those that are of the `electrical` input of a model, by name.

    given: amplitude, bias and, where there is one, phase of the sine of every electrical input; None: left out

    Raises:
        ValueError: a number of another sine, other than zero, or no amplitude of this one.
    """
    own = {name: given[name] for name in sine_names(electrical) if name in given}
    others = {name: value for name, value in given.items() if name not in own}
    refuse_other_electrical(model, others, ", ".join(own))
    if own[electrical.amplitude] is None:
        raise ValueError(f"{electrical.amplitude} must be a number in {electrical.unit}, got none")
    return own


def driven_sine(
    model: ModuleType, given: Mapping[str, object], inputs: Inputs | None
) -> tuple[ElectricalInput, dict[str, object]]:
    """What the sine of a sweep drives, and its amplitude, bias and phase by name.

    Where the charge or current of a model is among its `inputs`, or a field of zero is given to it, there is no sine;
    it then counts as one of no field.

    Raises:
        ValueError: as `own_sine`.
    """
    own = find_electrical(model) or ELECTRIC_FIELD
    acts = any(given[name] is not None and not is_zero(given[name]) for name in sine_names(own))
    if own is not ELECTRIC_FIELD and not acts:
        without = given[ELECTRIC_FIELD.amplitude] is not None and given[own.amplitude] is None
        if without or own.name in named_inputs(model, inputs):
            own_sine(model, own, {**given, own.amplitude: 0.0})  # refuses numbers of another
            return ELECTRIC_FIELD, dict.fromkeys(sine_names(ELECTRIC_FIELD), 0.0)
    return own, own_sine(model, own, given)


def with_drive(
    model: ModuleType, drive: object, frequency: object, given: Mapping[str, object]
) -> tuple[object, dict[str, object]]:
    """Frequency and numbers of sines where those of one stand in a `drive`, whose numbers may be arrays.

    given: as for `own_sine`; it is returned with the numbers of the drive as those of the model's electrical input

    Raises:
        ValueError: no sine, numbers beside it, or a model without an electrical input.
    """
    if not isinstance(drive, Sine):
        raise ValueError(f"drive must be a delagrange.Sine, got {shown(drive)}")
    for name, value in {"frequency": frequency, **given}.items():
        of_drive = name == "frequency" or name.endswith("_amplitude")
        if value is not None and (of_drive or not is_zero(value)):
            raise ValueError(f"{name} is given as {shown(value)} and in drive as well; give one")
    names = sine_names(electrical_input(model))
    return drive.frequency, {**given, **dict(zip(names, (drive.amplitude, drive.bias, drive.phase)))}
