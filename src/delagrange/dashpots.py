"""What becomes of the dashpots: frozen where they stand, relaxed, or evolving with the motion.

A dashpot of infinite viscosity does not flow. That is how it is frozen, so that every integrator and every
derived equation runs as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType

import numpy as np

from delagrange import checks
from delagrange.initial import checked_initial, initial_units, state_at_start
from delagrange.problem import Problem

FROZEN, RELAXED, EVOLVING = "frozen", "relaxed", "evolving"


def frozen(problem: Problem) -> Problem:
    """The problem with every dashpot frozen."""
    parameters = tuple(
        np.inf if entry.name.startswith("viscosity") else value
        for entry, value in zip(problem.model.PARAMETERS, problem.parameters)
    )
    return replace(problem, parameters=parameters)


def coordinate_places(model: ModuleType) -> slice:
    """Where the coordinates stand in the state."""
    return slice(0, model.COORDINATE_COUNT)


def rate_places(model: ModuleType) -> slice:
    """Where the rates of the coordinates stand in the state."""
    return slice(model.COORDINATE_COUNT, 2 * model.COORDINATE_COUNT)


def dashpot_places(model: ModuleType) -> slice:
    """Where the inelastic stretches of the dashpots stand in the state."""
    return slice(2 * model.COORDINATE_COUNT, len(model.STATE))


def given_state(problem: Problem, initial_state: Mapping[str, float] | None) -> np.ndarray:
    """The reference state, (n_state,), with the values that `initial_state` gives by name.

    Raises:
        ValueError: an unknown name, a value that is not a single finite number, a stretch that is not positive.
    """
    model = problem.model
    units = initial_units(model)
    given = checked_initial(model, initial_state)
    values = {name: checks.scalar(name, value, units[name]) for name, value in given.items()}
    return state_at_start(model, np.array(model.reference_state(problem.parameters), dtype=float), values)
