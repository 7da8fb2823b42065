"""The load of `delagrange response`: force, field or charge and frequency, one of them a range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from delagrange.cli import quantities
from delagrange.common.units import unit_name
from delagrange.drives.inputs import CHARGE_DENSITY, ELECTRIC_FIELD, ELECTRICAL, ElectricalInput

LOAD_UNITS = {
    "force": "N",
    **{name: each.unit for each in ELECTRICAL.values() for name in (each.amplitude, each.bias)},
    "frequency": "Hz",
}
_FIELD = (ELECTRIC_FIELD.amplitude, ELECTRIC_FIELD.bias)
_CHARGE = (CHARGE_DENSITY.amplitude, CHARGE_DENSITY.bias)  # of the load, where they are given
_STEPS = 500  # of the transient amplitude over a range without a step


@dataclass(frozen=True)
class Span:
    """A range as typed: START:STOP or START:STOP:STEP."""

    start: float
    stop: float
    step: float | None

    def values(self) -> np.ndarray:
        """Increasing, both ends included as far as steps land on them."""
        low, high = sorted((self.start, self.stop))
        step = (high - low) / _STEPS if self.step is None else self.step
        return low + step * np.arange(int((high - low) / step + 1e-9) + 1)


def load_given(options: Mapping[str, str | None]) -> dict[str, float | Span]:
    """The load that the options, by name, say; a charge only where it is given.

    Raises:
        ValueError: one says neither a number nor a range.
    """
    return {
        name: _value(name, options[name])
        for name in LOAD_UNITS
        if name not in _CHARGE or options[name] is not None
    }


def _value(name: str, text: str | None) -> float | Span:
    """The number or the range that an option says.

    Raises:
        ValueError: it says neither.
    """
    unit = LOAD_UNITS[name]
    if text is None:
        return 0.0
    parts = [quantities.number(name, part, unit) for part in text.split(":")]
    if len(parts) == 1:
        return parts[0]
    finite = bool(np.all(np.isfinite(parts)))
    if len(parts) > 3 or not finite or parts[0] == parts[1] or (len(parts) == 3 and parts[2] <= 0):
        raise ValueError(
            f"{name} must be a number or START:STOP or START:STOP:STEP in {unit_name(unit)} with two distinct finite "
            f"ends and STEP > 0, got {text!r}"
        )
    return Span(parts[0], parts[1], parts[2] if len(parts) == 3 else None)


def electrical_load(
    load: Mapping[str, float | Span], electrical: ElectricalInput, model: str
) -> dict[str, float | Span]:
    """The load with the electrical input that the model has.

    Raises:
        ValueError: another one is given, or its amplitude is not.
    """
    unused = {name for name in (*_CHARGE, *_FIELD) if name not in (electrical.amplitude, electrical.bias)}
    for name in unused & set(load):
        if isinstance(load[name], Span) or load[name] != 0:
            raise ValueError(
                f"--{name.replace('_', '-')} changes nothing: {model} has the input {electrical.name}"
            )
    option = f"--{electrical.amplitude.replace('_', '-')}"
    if load.get(electrical.amplitude, 0.0) == 0.0:
        raise ValueError(f"{option} [{electrical.unit}] must be given and positive, got 0 {electrical.unit}")
    return {name: value for name, value in load.items() if name not in unused}


def varied_name(load: Mapping[str, float | Span]) -> str:
    """The one quantity of the load that is a range.

    Raises:
        ValueError: none is, or several are.
    """
    spans = [name for name, value in load.items() if isinstance(value, Span)]
    if len(spans) != 1:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in load)
        raise ValueError(f"exactly one of {options} must be a range START:STOP, got {len(spans)}")
    return spans[0]
