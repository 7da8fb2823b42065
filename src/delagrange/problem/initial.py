"""The state at t = 0: by the names of the state variables, or the loaded equilibrium."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.units import shown
from delagrange.model.variables import sign_of

PREFIX = "initial_"  # of the names of a grid that are values of the state at t = 0
EQUILIBRIUM = "equilibrium"
EQUILIBRIUM_MEANING = (
    "loaded equilibrium: at rest, dashpots relaxed, under the forces at t = 0 (the bias of a sine) and without "
    "field, charge or current"
)


def initial_units(model: ModuleType) -> dict[str, str]:
    """Unit of the initial value of every state variable, by the name it has in a grid."""
    return {PREFIX + entry.name: entry.unit for entry in model.STATE}


def checked_initial(model: ModuleType, given: Mapping[str, object] | None) -> dict[str, float | np.ndarray]:
    """The values given, in the order of the state, by the names they have in a grid.

    Raises:
        ValueError: not a mapping, an unknown name, a value that is not finite, a stretch that is not
            positive.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ValueError(
            f"initial_state must map names of state variables to values, got {shown(given)}; "
            f"{model.MODEL} has {_known(model)}"
        )
    names = [entry.name for entry in model.STATE]
    for name in given:
        if name not in names:
            raise ValueError(
                f"unknown state variable {name!r} in initial_state{checks.did_you_mean(name, names)}; "
                f"{model.MODEL} has {_known(model)}"
            )
    return {
        PREFIX + entry.name: _checked(entry, given[entry.name])
        for entry in model.STATE
        if entry.name in given
    }


def single_initial(model: ModuleType, given: Mapping[str, object] | None) -> dict[str, float]:
    """As `checked_initial`, of single numbers alone.

    Raises:
        ValueError: an array, or as `checked_initial`.
    """
    units = initial_units(model)
    return {
        name: checks.scalar(f"initial_state {name.removeprefix(PREFIX)}", value, units[name])
        for name, value in checked_initial(model, given).items()
    }


def start_attributes(model: ModuleType, given: object) -> dict[str, str]:
    """What a result says of where it started, if that is the loaded equilibrium."""
    return {"initial_state": EQUILIBRIUM_MEANING} if is_equilibrium(model, given) else {}


def state_at_start(model: ModuleType, reference: np.ndarray, values: Mapping[str, object]) -> np.ndarray:
    """The state at t = 0, (n_state, n_lanes): the values of a grid, and the reference state for the rest."""
    state = np.array(reference)
    for place, entry in enumerate(model.STATE):
        if PREFIX + entry.name in values:
            state[place] = values[PREFIX + entry.name]
    return state


def is_equilibrium(model: ModuleType, given: object) -> bool:
    """Whether the loaded equilibrium is asked for as the state at t = 0.

    Raises:
        ValueError: another text.
    """
    if isinstance(given, str) and given != EQUILIBRIUM:
        raise ValueError(
            f"initial_state must be {EQUILIBRIUM!r} or map names of state variables to values, got {given!r}; "
            f"{model.MODEL} has {_known(model)}"
        )
    return isinstance(given, str)


def _checked(entry: object, value: object) -> float | np.ndarray:
    return checks.signed(f"initial_state {entry.name}", value, entry.unit, sign_of(entry))


def _known(model: ModuleType) -> str:
    return ", ".join(f"{entry.name} [{entry.unit}]" for entry in model.STATE)
