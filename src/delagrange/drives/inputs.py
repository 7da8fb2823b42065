"""What drives the inputs of a model: force and field by arguments of their own, any other input by its name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.units import shown
from delagrange.drives.drive import Constant, Drive, Sine, Values, as_drive

FORCE, FIELD, CHARGE = "force", "nominal_electric_field", "nominal_charge_density"
_ARGUMENTS = {FORCE: "force", FIELD: "field"}  # input of a model -> what a user calls it

Inputs = Mapping[str, Drive | Values]


@dataclass(frozen=True)
class ElectricalInput:
    """What drives the electrodes of a model, and how it is called."""

    name: str  # of the model's input
    argument: str  # what a user calls it, and results after it
    stem: str  # of the amplitude and the bias of its sine
    unit: str
    long_name: str
    symbol: str

    @property
    def amplitude(self) -> str:
        """Name of the amplitude of its sine."""
        return f"{self.stem}_amplitude"

    @property
    def bias(self) -> str:
        """Name of the bias of its sine."""
        return f"{self.stem}_bias"

    @property
    def text(self) -> str:
        """In sentences: `field`, or `nominal charge density`."""
        return self.argument.replace("_", " ")


ELECTRIC_FIELD = ElectricalInput(FIELD, "field", "field", "V/m", "nominal electric field", "E")
CHARGE_DENSITY = ElectricalInput(CHARGE, CHARGE, "charge", "C/m^2", "nominal charge density", "D")
CURRENT_DENSITY = ElectricalInput(
    "nominal_current_density", "nominal_current_density", "current", "A/m^2", "nominal current density", "i"
)  # of a membrane whose charge is part of its state
ELECTRICAL = {each.name: each for each in (ELECTRIC_FIELD, CHARGE_DENSITY)}


def electrical_input(model: ModuleType) -> ElectricalInput:
    """The electrical input of a model: its field under voltage control, its charge under charge control.

    Raises:
        ValueError: it has neither.
    """
    names = [entry.name for entry in model.INPUTS]
    for name, electrical in ELECTRICAL.items():
        if name in names:
            return electrical
    wanted = " or ".join(f"{each.name} [{each.unit}]" for each in ELECTRICAL.values())
    fed = CURRENT_DENSITY.name in names
    why = "; under a current its charge is part of the state, and cannot be given" if fed else ""
    raise ValueError(
        f"the model {model.MODEL} has no input {wanted}; it has {', '.join(names) or 'none'}{why}"
    )


def input_name(name: str) -> str:
    """What a user calls the model's input `name`: `nominal_electric_field` is given as `field`."""
    return _ARGUMENTS.get(name, name)


def has_input(model: ModuleType, name: str) -> bool:
    """Whether the model has an input of that name."""
    return any(entry.name == name for entry in model.INPUTS)


def drives_of(
    model: ModuleType, force: Drive | Values, field: Drive | Values, inputs: Inputs | None
) -> tuple[Drive, ...]:
    """The drive of every input of the model; one that nobody gives is zero.

    Raises:
        ValueError: an input that the model does not have (unless it is zero), one that is given twice, or a value
            that is neither a drive nor a finite number.
    """
    drives = {FORCE: as_drive("force", force, "N"), FIELD: as_drive("field", field, "V/m")}
    _refuse_unused(model, drives)
    for name, given in named_inputs(model, inputs).items():
        if name in drives and not _is_zero(drives[name]):
            raise ValueError(f"{input_name(name)} is given as {drives[name]} and in inputs as well; give one")
        drives[name] = as_drive(f"inputs {name}", given, _units(model)[name])
    return tuple(drives.get(entry.name, Constant(0.0)) for entry in model.INPUTS)


def named_inputs(model: ModuleType, inputs: Inputs | None) -> dict[str, Drive | Values]:
    """What is given by name, in the order of the model's inputs and by their own names.

    Raises:
        ValueError: not a mapping, or a name that is no input of the model.
    """
    if inputs is None:
        return {}
    units = _units(model)
    known = ", ".join(f"{input_name(name)} [{unit}]" for name, unit in units.items()) or "none"
    if not isinstance(inputs, Mapping):
        raise ValueError(
            f"inputs must map names of inputs to values or drives, got {shown(inputs)}; {model.MODEL} has {known}"
        )
    names = {name: name for name in units} | {input_name(name): name for name in units}
    for name in inputs:
        if name not in names:
            near = checks.did_you_mean(name, names)
            raise ValueError(f"unknown input {shown(name)} in inputs{near}; {model.MODEL} has {known}")
    given = {names[name]: value for name, value in inputs.items()}
    return {name: given[name] for name in units if name in given}


def constant_inputs(model: ModuleType, inputs: Inputs | None, purpose: str) -> dict[str, float]:
    """The numbers given by name, for a `purpose` that takes no drives.

    Raises:
        ValueError: as `named_inputs`; anything but a single finite number.
    """
    numbers = {}
    for name, value in named_inputs(model, inputs).items():
        if isinstance(value, Drive):
            raise ValueError(f"inputs {name} must be a single number for {purpose}, got {value}")
        unit = _units(model)[name]
        numbers[name] = checks.scalar(f"inputs {name}", checks.finite(f"inputs {name}", value, unit), unit)
    return numbers


def _units(model: ModuleType) -> dict[str, str]:
    return {entry.name: entry.unit for entry in model.INPUTS}


def _refuse_unused(model: ModuleType, drives: Mapping[str, Drive]) -> None:
    """Refuse a force or field (other than zero) for which the model has no input."""
    known = [entry.name for entry in model.INPUTS]
    others = [name for name in known if name not in drives]
    hint = f"; give {', '.join(others)} by inputs={{...}} (--input on the command line)" if others else ""
    for name, drive in drives.items():
        if name not in known and not _is_zero(drive):
            raise ValueError(
                f"{input_name(name)} given as {drive}, but {model.MODEL} has no such input; "
                f"it has {', '.join(map(input_name, known))}{hint}"
            )


def is_zero_number(value: object) -> bool:
    """Whether a value is the single number zero."""
    return np.ndim(value) == 0 and value == 0


def _is_zero(drive: Drive) -> bool:
    match drive:
        case Constant():
            return bool(np.all(np.asarray(drive.value) == 0))
        case Sine():
            return bool(np.all(np.asarray(drive.amplitude) == 0) and np.all(np.asarray(drive.bias) == 0))
    return False
