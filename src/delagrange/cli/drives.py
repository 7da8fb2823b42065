"""Force, field and charge over time, from the options that say how they are driven."""

from __future__ import annotations

from dataclasses import dataclass

from delagrange.cli import values
from delagrange.cli.options import Given, flag_of
from delagrange.drives.drive import Constant, Drive, Ramp, Sine, Step, Tabulated
from delagrange.drives.inputs import CHARGE_DENSITY, ELECTRIC_FIELD, Inputs


@dataclass(frozen=True)
class Driven:
    """An input, and the names of the options for its value and its frequency; others begin with its stem."""

    stem: str
    unit: str
    value: str  # amplitude of a sine, else a constant
    frequency: str


_FORCE = Driven("force", "N", "force", "force_frequency")
_FIELD, _CHARGE = (
    Driven(each.stem, each.unit, each.amplitude, "frequency") for each in (ELECTRIC_FIELD, CHARGE_DENSITY)
)
_OF_A_FIELD = ("field_amplitude", "field_bias", "field_phase")  # which a charge takes the place of


def force_drive(given: Given) -> Drive:
    """The force; zero at all times where nothing was said.

    Raises:
        ValueError: options that contradict each other, or a bad value in one.
    """
    return _drive(given, _FORCE)


def electrical_drives(given: Given, inputs: Inputs | None) -> dict[str, Drive | Inputs | None]:
    """The field beside the inputs by name, or among these the charge where that is given instead.

    Raises:
        ValueError: as `force_drive`; the electrodes are driven by a field and a charge, or the charge is given twice.
    """
    if not any(given.get(f"{_CHARGE.stem}_{part}") is not None for part in ("amplitude", "bias")):
        return {"field": _drive(given, _FIELD), "inputs": inputs}
    for name in _OF_A_FIELD:
        if given.get(name) is not None:
            raise ValueError(
                f"the electrodes are driven by {flag_of(name)} and {flag_of(_CHARGE.value)} at once; give one"
            )
    if CHARGE_DENSITY.name in (inputs or {}):
        raise ValueError(
            f"{CHARGE_DENSITY.name} is given by {flag_of(_CHARGE.value)} and by --input; give one"
        )
    return {"inputs": {**(inputs or {}), CHARGE_DENSITY.name: _drive(given, _CHARGE)}}


def _drive(given: Given, driven: Driven) -> Drive:
    stem = driven.stem
    value, frequency = given.get(driven.value), given.get(driven.frequency)
    bias, phase, begin, ramp, table = (
        given.get(f"{stem}_{part}") for part in ("bias", "phase", "step_time", "ramp", "csv")
    )
    _refuse_two(given, driven)
    _refuse_idle(given, driven)
    if table is not None:
        return Tabulated(*values.table(stem, table, driven.unit))
    if ramp is not None:
        return Ramp(*ramp)
    if frequency is not None:
        return Sine(value, frequency, bias or 0.0, phase or 0.0)
    if begin is not None:
        return Step(value, begin)
    return Constant(value or 0.0)


def _refuse_two(given: Given, driven: Driven) -> None:
    """Refuse two ways to drive one input."""
    stem = driven.stem
    for names in ((driven.value, f"{stem}_ramp", f"{stem}_csv"), (driven.frequency, f"{stem}_step_time")):
        said = [flag_of(name) for name in names if given.get(name) is not None]
        if len(said) > 1:
            raise ValueError(f"{stem} [{driven.unit}] is driven by {' and '.join(said)} at once; give one")


def _refuse_idle(given: Given, driven: Driven) -> None:
    """Refuse what would change nothing: it was meant to."""
    dependent = (
        (driven.frequency, "Hz", driven.value),
        (f"{driven.stem}_step_time", "s", driven.value),
        (f"{driven.stem}_bias", driven.unit, driven.frequency),
        (f"{driven.stem}_phase", "rad", driven.frequency),
    )
    for name, unit, needed in dependent:
        number = given.get(name)
        if number is not None and given.get(needed) is None:
            raise ValueError(
                f"{flag_of(name)} {number:g} {unit} changes nothing without {flag_of(needed)}; give that, too"
            )
