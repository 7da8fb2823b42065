"""The state in which a run starts: as given by name, or the loaded equilibrium."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from delagrange.drives.drive import Constant, Drive, Sine, Values
from delagrange.drives.inputs import ELECTRICAL
from delagrange.equilibrium.rest_state import resting_state
from delagrange.problem.dashpots import RELAXED, given_state
from delagrange.problem.initial import is_equilibrium
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits


def starting_state(
    problem: Problem, initial_state: Mapping[str, float] | str | None, limits: Limits
) -> np.ndarray:
    """The state at t = 0, (n_state,): as `given_state`, or the loaded equilibrium if that is asked for.

    Raises:
        ValueError: as `given_state`; another text; or forces under which there is no equilibrium.
    """
    if is_equilibrium(problem.model, initial_state):
        return loaded_equilibrium(problem, limits)
    return given_state(problem, initial_state)


def loaded_equilibrium(problem: Problem, limits: Limits) -> np.ndarray:
    """The state, (n_state,), in which a membrane rests before a field, charge or current is switched on.

    Raises:
        ValueError: there is none under these forces; the message names them.
    """
    return resting_state(before_the_field(problem), RELAXED, limits)


def before_the_field(problem: Problem) -> Problem:
    """The problem under its forces as they are at t = 0, without field, charge or current.

    A sine of a force counts with its bias; a step at 0 s counts as made.
    """
    entries = zip(problem.model.INPUTS, problem.drives)
    drives = (0.0 if entry.name in ELECTRICAL else _at_start(drive) for entry, drive in entries)
    return replace(problem, drives=tuple(Constant(value) for value in drives))


def _at_start(drive: Drive) -> Values:
    return drive.bias if isinstance(drive, Sine) else drive.at(0.0)
