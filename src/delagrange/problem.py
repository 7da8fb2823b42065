"""A model with its drives and parameters: what an integrator integrates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np

from delagrange import checks
from delagrange.drive import Constant, Drive, Values, as_drive
from delagrange.parameters import MATERIAL_UNITS, Parameters, material_values


@dataclass(frozen=True)
class Problem:
    """The equations of one run, or of many lanes at once where numbers are arrays of one value a lane."""

    model: ModuleType
    drives: tuple[Drive, ...]  # one for each of model.INPUTS
    parameters: tuple[Values, ...]  # one for each of model.PARAMETERS

    def inputs(self, time: Values) -> tuple[Values, ...]:
        """Values of the model's inputs at `time` [s]."""
        return tuple(drive.at(time) for drive in self.drives)

    def rhs(self, time: Values, state: np.ndarray) -> np.ndarray:
        """Rate of change of the state, (n_state, ...) [unit of the state / s]."""
        return self.model.rhs(state, self.inputs(time), self.parameters)

    def jacobian(self, time: float, state: np.ndarray) -> np.ndarray:
        """Derivative of `rhs` by the state, (n_state, n_state, ...)."""
        return self.model.jacobian(state, self.inputs(time), self.parameters)

    def principal_stretches(self, time: Values, state: np.ndarray) -> np.ndarray:
        """λ_1, λ_2, λ_3, (3, ...) [1]."""
        return self.model.principal_stretches(state, self.inputs(time), self.parameters)

    def breakpoints(self, start: float, stop: float) -> tuple[float, ...]:
        """Times [s] strictly between `start` and `stop` at which a drive is not smooth, increasing."""
        return tuple(sorted({time for drive in self.drives for time in drive.breakpoints(start, stop)}))

    def piece(self, start: float, stop: float) -> Problem:
        """The problem with its drives smooth between two neighbouring breakpoints."""
        return replace(self, drives=tuple(drive.piece(start, stop) for drive in self.drives))

    def take(self, lanes: np.ndarray | slice) -> Problem:
        """The problem of some of the lanes."""
        parameters = tuple(value[lanes] if np.ndim(value) else value for value in self.parameters)
        return replace(self, drives=tuple(drive.take(lanes) for drive in self.drives), parameters=parameters)


def make_problem(
    model: ModuleType,
    parameters: Parameters,
    changes: Mapping[str, Values],
    held_stretch: Values | None,
    force: Drive | Values,
    field: Drive | Values,
) -> Problem:
    """Put a problem together, checking that the model has what is given and is given what it has.

    Raises:
        ValueError: a bad value, an unknown parameter, a force, field or held stretch that the model
            has no place for, or a held stretch missing.
    """
    if not isinstance(parameters, Parameters):
        raise ValueError(f"parameters must be a delagrange.Parameters, got {parameters!r}")
    values = material_values(parameters, changes) | _held(model, held_stretch)
    drives = {
        "force": as_drive("force", force, "N"),
        "nominal_electric_field": as_drive("field", field, "V/m"),
    }
    return Problem(
        model,
        tuple(_drive_of(model, variable.name, drives) for variable in _all_used(model, drives)),
        tuple(_parameter_of(model, variable.name, values) for variable in model.PARAMETERS),
    )


def _held(model: ModuleType, held_stretch: Values | None) -> dict[str, Values]:
    needed = any(variable.name == "held_stretch" for variable in model.PARAMETERS)
    if needed and held_stretch is None:
        raise ValueError(f"held_stretch [1] is missing: {model.MODEL} needs it, positive and finite")
    if not needed and held_stretch is not None:
        raise ValueError(
            f"held_stretch {held_stretch!r} [1] given, but {model.MODEL} holds no stretch; leave it out"
        )
    return {"held_stretch": checks.positive("held_stretch", held_stretch, "1")} if needed else {}


def _all_used(model: ModuleType, drives: Mapping[str, Drive]) -> tuple:
    """The model's inputs, after refusing a drive (other than zero) for which it has none."""
    known = [variable.name for variable in model.INPUTS]
    for name, drive in drives.items():
        if name not in known and not (isinstance(drive, Constant) and np.all(drive.value == 0)):
            raise ValueError(
                f"{name} given as {drive}, but {model.MODEL} has no such input; it has {', '.join(known)}"
            )
    return tuple(model.INPUTS)


def _drive_of(model: ModuleType, name: str, drives: Mapping[str, Drive]) -> Drive:
    if name not in drives:
        raise ValueError(
            f"{model.MODEL} has the input {name!r}, which cannot be driven; known are {', '.join(drives)}"
        )
    return drives[name]


def _parameter_of(model: ModuleType, name: str, values: Mapping[str, Values]) -> Values:
    if name not in values:
        known = ", ".join([*MATERIAL_UNITS, "held_stretch"])
        raise ValueError(f"{model.MODEL} has the parameter {name!r}, which is not known; known are {known}")
    return values[name]
