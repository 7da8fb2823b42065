"""A model with its drives and parameters: what an integrator integrates, and how it is put together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import log10
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.units import shown, with_unit
from delagrange.drives.drive import Drive, Values
from delagrange.drives.inputs import Inputs, drives_of, input_name
from delagrange.model.load import load_model
from delagrange.model.material import Material, defaults_of, held_stretch_name, value_of
from delagrange.model.parameters import Parameters, material_of
from delagrange.problem import status as loss
from delagrange.problem.status import Limits


@dataclass(frozen=True)
class Problem:
    """The equations of one run, or of many lanes at once where numbers are arrays of one value a lane."""

    model: ModuleType
    drives: tuple[Drive, ...]  # one for each of model.INPUTS
    parameters: tuple[Values, ...]  # one for each of model.PARAMETERS
    source: str = ""  # of the single-valued parameters

    def inputs(self, time: Values) -> tuple[Values, ...]:
        """Values of the model's inputs at `time` [s].

        In NumPy's floats: a power of one that is too large is infinite, where Python's would raise.
        """
        return tuple(np.asarray(drive.at(time), dtype=float)[()] for drive in self.drives)

    def rhs(self, time: Values, state: np.ndarray) -> np.ndarray:
        """Rate of change of the state, (n_state, ...) [unit of the state / s]."""
        return self.model.rhs(state, self.inputs(time), self.parameters)

    def jacobian(self, time: float, state: np.ndarray) -> np.ndarray:
        """Derivative of `rhs` by the state, (n_state, n_state, ...)."""
        return self.model.jacobian(state, self.inputs(time), self.parameters)

    def principal_stretches(self, time: Values, state: np.ndarray) -> np.ndarray:
        """λ_1, λ_2, λ_3, (3, ...) [1]."""
        return self.model.principal_stretches(state, self.inputs(time), self.parameters)

    def validity(self, time: Values, state: np.ndarray) -> Values | None:
        """Positive where the energies of the model hold, (...); None for a model that sets no limit."""
        if not hasattr(self.model, "validity"):
            return None
        return self.model.validity(state, self.inputs(time), self.parameters)

    def margin(self, time: Values, state: np.ndarray, limits: Limits) -> np.ndarray:
        """Distance from loss, (...): positive while all is well."""
        return loss.margin(self.principal_stretches(time, state), limits, self.validity(time, state))

    def kind_of_loss(self, time: Values, state: np.ndarray, limits: Limits) -> np.ndarray:
        """Place in `delagrange.problem.status.STATUS` of what is lost there, (...) of int."""
        return loss.kind_of_loss(self.principal_stretches(time, state), limits, self.validity(time, state))

    def kind_of_failure(self, time: Values, state: np.ndarray) -> np.ndarray:
        """Place in `delagrange.problem.status.STATUS` of a run that no step resolves any more, (...) of int.

        LOCKED where next to nothing is left to where the energies hold: a spring that locks stops the membrane within
        less than double precision can tell; else DIVERGED.
        """
        validity = self.validity(time, state)
        if validity is None:
            return np.full(np.shape(state)[1:], loss.DIVERGED)
        reference = np.asarray(self.model.reference_state(self.parameters), dtype=float)
        at_rest = self.model.validity(reference, self.inputs(0.0), self.parameters)
        return np.where(validity < loss.AT_THE_LOCK * at_rest, loss.LOCKED, loss.DIVERGED)

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


@dataclass(frozen=True)
class Specimen:
    """A model with its material, before anything of it is changed or loaded."""

    model: ModuleType
    material: Material

    def problem(
        self,
        changes: Mapping[str, Values],
        held_stretch: Values | None,
        force: Drive | Values,
        field: Drive | Values,
        inputs: Inputs | None = None,
    ) -> Problem:
        """Put a problem together, checking that the model has what is given and is given what it has.

        Args:
            changes: of the material, by name.
            inputs: drives or values of inputs by name, those of `model.INPUTS`; one that is not given is zero.

        Raises:
            ValueError: a bad value, an unknown parameter, a force, field or held stretch that the model
                has no place for, a held stretch missing, or values with which double precision cannot
                compute the equations.
        """
        values = self.material.changed(changes) | _held(self.model, held_stretch)
        problem = Problem(
            self.model,
            drives_of(self.model, force, field, inputs),
            tuple(value_of(self.model, variable.name, values) for variable in self.model.PARAMETERS),
            self.material.changed_source({name: value for name, value in changes.items() if np.ndim(value) == 0}),
        )
        _check_computable(problem)
        return problem

    def single_problem(
        self,
        changes: Mapping[str, float],
        held_stretch: float | None,
        force: Drive | float,
        field: Drive | float,
        inputs: Inputs | None = None,
    ) -> Problem:
        """As `problem`, of single values alone.

        Raises:
            ValueError: arrays, or as `problem`.
        """
        problem = self.problem(changes, held_stretch, force, field, inputs)
        for name, value in changes.items():
            checks.scalar(name, value, self.material.units[name])
        entries = zip(
            (*self.model.PARAMETERS, *self.model.INPUTS), (*problem.parameters, *problem.inputs(0.0))
        )
        for entry, value in entries:
            checks.scalar(input_name(entry.name), value, entry.unit)
        return problem


def make_specimen(
    model: str | ModuleType,
    formulation: str | None,
    lateral_dashpot: str | None,
    parameters: Parameters | None,
) -> Specimen:
    """The model that is named, or is given itself, with the material that `parameters` and its defaults make.

    Raises:
        ValueError: as `delagrange.load_model` and `delagrange.model.parameters.material_of`.
    """
    module = load_model(model, formulation, lateral_dashpot)
    return Specimen(module, material_of(module, parameters))


def make_problem(model: ModuleType, parameters: Parameters | None, *given: object) -> Problem:
    """The problem of a loaded model; the other arguments are those of `Specimen.problem`.

    Raises:
        ValueError: as `Specimen.problem`.
    """
    return Specimen(model, material_of(model, parameters)).problem(*given)


def _check_computable(problem: Problem) -> None:
    """Refuse numbers of which the equations at rest overflow.

    Lanes that vary may do so: each is lost on its own, and its status says so.
    """
    lanes = any(map(np.ndim, (*problem.parameters, *problem.inputs(0.0))))
    try:
        computable = bool(np.all(np.isfinite(_at_rest(problem.take(slice(0, 1)))))) or lanes
    except (OverflowError, ZeroDivisionError):  # of Python's floats, which all lanes have in common
        computable = False
    if not computable:
        raise ValueError(
            f"the equations of {problem.model.MODEL} are beyond double precision with {_most_extreme(problem)}; "
            "allowed are values of which no product or power in them overflows"
        )


def _at_rest(problem: Problem) -> np.ndarray:
    """Rates and reactions in the reference state at t = 0, one after the other."""
    model = problem.model
    state = np.asarray(model.reference_state(problem.parameters), dtype=float)
    arguments = state, problem.inputs(0.0), problem.parameters
    with np.errstate(all="ignore"):
        reactions = model.reaction_forces(*arguments) if hasattr(model, "reaction_forces") else ()
        return np.concatenate([np.ravel(values) for values in (model.rhs(*arguments), reactions)])


def _most_extreme(problem: Problem) -> str:
    """The single number that is farthest from 1 in its SI unit, with its name."""
    entries = [
        *zip(problem.model.PARAMETERS, problem.parameters),
        *zip(problem.model.INPUTS, problem.inputs(0.0)),
    ]
    single = [(entry, float(value)) for entry, value in entries if np.ndim(value) == 0 and value != 0]
    entry, value = max(single, key=lambda pair: abs(log10(abs(pair[1]))))
    return f"{input_name(entry.name)} = {with_unit(value, entry.unit)}"


def _held(model: ModuleType, held_stretch: Values | None) -> dict[str, Values]:
    needed = held_stretch_name(model)
    held_stretch = defaults_of(model).get(needed) if held_stretch is None else held_stretch
    if needed and held_stretch is None:
        raise ValueError(f"held_stretch [1] is missing: {model.MODEL} needs it, positive and finite")
    if not needed and held_stretch is not None:
        raise ValueError(
            f"held_stretch {shown(held_stretch)} [1] given, but {model.MODEL} holds no stretch; leave it out"
        )
    return {needed: checks.positive("held_stretch", held_stretch, "1")} if needed else {}
