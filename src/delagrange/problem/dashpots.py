"""What becomes of the dashpots: frozen where they stand, relaxed, or evolving with the motion.

A dashpot of infinite viscosity does not flow. That is how it is frozen, so that every integrator and every
derived equation runs as it is. The charge of a membrane that leaks is part of the state behind the inelastic
stretches, and no dashpot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType

import numpy as np

from delagrange.common.roles import Role
from delagrange.model.variables import named, role_of
from delagrange.problem.initial import single_initial, state_at_start
from delagrange.problem.problem import Problem

FROZEN, RELAXED, EVOLVING = "frozen", "relaxed", "evolving"


def frozen(problem: Problem) -> Problem:
    """The problem with every dashpot frozen."""
    parameters = tuple(
        np.inf if role_of(entry) is Role.VISCOSITY else value
        for entry, value in zip(problem.model.PARAMETERS, problem.parameters)
    )
    return replace(problem, parameters=parameters)


def is_damped(problem: Problem) -> bool:
    """Whether something damps that no frozen dashpot stops: a dashpot in parallel, the medium, or a leak of charge.

    At rest inertia has no slope by the rates, so that what is there is damping.
    """
    rates = rate_places(problem.model)
    return bool(np.any(_reference_jacobian(problem)[rates, rates] != 0)) or leak_rate(problem) > 0


def leak_rate(problem: Problem) -> float:
    """How fast a charge that is part of the state leaks in the reference state [1/s]; 0 where there is none."""
    charge = charge_place(problem.model)
    return 0.0 if charge is None else -float(_reference_jacobian(problem)[charge, charge])


def _reference_jacobian(problem: Problem) -> np.ndarray:
    return problem.jacobian(0.0, np.array(problem.model.reference_state(problem.parameters), dtype=float))


def dashpot_count(model: ModuleType) -> int:
    """How many dashpots the model has, each of which may flow along several axes."""
    return len(named(model.PARAMETERS, Role.VISCOSITY))


def coordinate_places(model: ModuleType) -> slice:
    """Where the coordinates stand in the state."""
    return slice(0, model.COORDINATE_COUNT)


def rate_places(model: ModuleType) -> slice:
    """Where the rates of the coordinates stand in the state."""
    return slice(model.COORDINATE_COUNT, 2 * model.COORDINATE_COUNT)


def dashpot_places(model: ModuleType) -> slice:
    """Where the inelastic stretches of the dashpots stand in the state."""
    charge = charge_place(model)
    return slice(2 * model.COORDINATE_COUNT, len(model.STATE) if charge is None else charge)


def charge_place(model: ModuleType) -> int | None:
    """Where the nominal charge density stands in the state, last of all; None where no charge is part of it."""
    roles = [role_of(entry) for entry in model.STATE]
    return roles.index(Role.CHARGE_DENSITY) if Role.CHARGE_DENSITY in roles else None


def given_state(problem: Problem, initial_state: Mapping[str, float] | None) -> np.ndarray:
    """The reference state, (n_state,), with the values that `initial_state` gives by name.

    Raises:
        ValueError: an unknown name, a value that is not a single finite number, a stretch that is not positive.
    """
    model = problem.model
    reference = np.array(model.reference_state(problem.parameters), dtype=float)
    return state_at_start(model, reference, single_initial(model, initial_state))
