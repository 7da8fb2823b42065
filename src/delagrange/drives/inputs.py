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
    def phase(self) -> str:
        """Name of the phase of its sine."""
        return f"{self.stem}_phase"

    @property
    def squared(self) -> str:
        """Name of what enters the energy squared: itself, or the charge that a current feeds."""
        return CHARGE if self.stem == "current" else self.name

    @property
    def text(self) -> str:
        """In sentences: `field`, or `nominal charge density`."""
        return self.argument.replace("_", " ")


ELECTRIC_FIELD = ElectricalInput(FIELD, "field", "field", "V/m", "nominal electric field", "E")
CHARGE_DENSITY = ElectricalInput(CHARGE, CHARGE, "charge", "C/m^2", "nominal charge density", "D")
CURRENT_DENSITY = ElectricalInput(
    "nominal_current_density", "nominal_current_density", "current", "A/m^2", "nominal current density", "i"
)  # of a membrane whose charge is part of its state
ELECTRICAL = {each.name: each for each in (ELECTRIC_FIELD, CHARGE_DENSITY, CURRENT_DENSITY)}


def find_electrical(model: ModuleType) -> ElectricalInput | None:
    """What drives the electrodes of a model: a field, a charge or a current; None where nothing does."""
    return next((each for name, each in ELECTRICAL.items() if has_input(model, name)), None)


def electrical_input(model: ModuleType) -> ElectricalInput:
    """What drives the electrodes of a model.

    Raises:
        ValueError: nothing does.
    """
    electrical = find_electrical(model)
    if electrical is None:
        wanted = " or ".join(f"{each.name} [{each.unit}]" for each in ELECTRICAL.values())
        names = ", ".join(entry.name for entry in model.INPUTS) or "none"
        raise ValueError(f"the model {model.MODEL} has no input {wanted}; it has {names}")
    return electrical


def refuse_other_electrical(model: ModuleType, given: Mapping[str, object], instead: str) -> None:
    """Refuse numbers, but zero, of an electrical input that a model does not have.

    given: by what a user calls them; None: left out

    Raises:
        ValueError: naming the number, and what to give `instead`.
    """
    electrical = find_electrical(model)
    for name, value in given.items():
        if value is not None and not is_zero(value):
            if electrical is None:
                raise ValueError(f"{name} given as {shown(value)}, but {model.MODEL} has no electrical input")
            raise ValueError(
                f"{name} given as {shown(value)}, but the electrical input of {model.MODEL} is "
                f"{electrical.name} [{electrical.unit}]; give {instead}"
            )


@dataclass(frozen=True)
class GivenElectrical:
    """The electrical input of a model, and what is given of it."""

    electrical: ElectricalInput
    name: str  # by which it is given
    values: object  # None: not given


def separate_electrical(
    model: ModuleType, inputs: Inputs | None, argument: str, given: object
) -> tuple[GivenElectrical, dict[str, Values]]:
    """What is given of the electrical input of a model, and the values of the other inputs given by name.

    given: values of the field under an `argument` of their own; None: left out

    Raises:
        ValueError: values of a field to a model that has none, values given twice, drives, or as `named_inputs`.
    """
    electrical, others = electrical_input(model), named_inputs(model, inputs)
    if electrical is not ELECTRIC_FIELD:
        by_name = f'inputs={{"{electrical.name}": values}} (--input on the command line)'
        refuse_other_electrical(model, {argument: given}, by_name)
        given = None
    for name, value in others.items():
        if isinstance(value, Drive):
            raise ValueError(f"inputs {name} must be a number or an array of them here, got {value}")
    if electrical.name not in others:
        argument = argument if electrical is ELECTRIC_FIELD else f"inputs {electrical.name}"
        return GivenElectrical(electrical, argument, given), others
    if given is not None:
        raise given_twice(argument, given)
    return GivenElectrical(electrical, f"inputs {electrical.name}", others.pop(electrical.name)), others


def refuse_searched(model: ModuleType, inputs: Inputs | None) -> ElectricalInput:
    """The electrical input of a model, which an analysis varies by itself, and so does not take by name.

    Raises:
        ValueError: it is given; the model has none; or as `named_inputs`.
    """
    electrical = electrical_input(model)
    if electrical.name in named_inputs(model, inputs):
        raise ValueError(f"{electrical.argument} is what varies here, and is not given by inputs")
    return electrical


def given_twice(argument: str, value: object) -> ValueError:
    """What to raise where an input is given by an argument of its own and among the inputs by name."""
    said = value if isinstance(value, Drive) else shown(value)
    return ValueError(f"{argument} is given as {said} and in inputs as well; give one")


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
        if name in drives and not is_zero(drives[name]):
            raise given_twice(input_name(name), drives[name])
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
        if name not in known and not is_zero(drive):
            raise ValueError(
                f"{input_name(name)} given as {drive}, but {model.MODEL} has no such input; "
                f"it has {', '.join(map(input_name, known))}{hint}"
            )


def is_zero(given: object) -> bool:
    """Whether what is given for an input is the number zero, or a drive that is so at all times."""
    match given:
        case Constant():
            return bool(np.all(np.asarray(given.value) == 0))
        case Sine():
            return bool(np.all(np.asarray(given.amplitude) == 0) and np.all(np.asarray(given.bias) == 0))
        case Drive():
            return False
    return np.ndim(given) == 0 and given == 0
