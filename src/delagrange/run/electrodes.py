"""What the electrodes carry along a run: the nominal field and the nominal charge density, and their powers."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from delagrange.drives.inputs import CHARGE_DENSITY, ELECTRIC_FIELD
from delagrange.problem.problem import Problem
from delagrange.run.run_dataset import variable

_CARRIED = (ELECTRIC_FIELD, CHARGE_DENSITY)  # in the order in which a module gives them
_POWERS = {
    "source_power": ("W", "power put in by the source of the current", ""),
    "leakage_power": ("W", "power dissipated by the leakage", ""),
}


def electrode_variables(problem: Problem, state: np.ndarray, inputs: list[np.ndarray]) -> dict[str, tuple]:
    """Field and charge density as far as they are neither input nor state of the model.

    None for a module that does not say what its electrodes carry. `state`: (n_state, n_times); `inputs`: each
    (n_times,).
    """
    model = problem.model
    if not hasattr(model, "electrodes"):
        return {}
    carried = zip(_CARRIED, model.electrodes(state, inputs, problem.parameters))
    known = [entry.name for entry in (*model.STATE, *model.INPUTS)]
    return {
        entry.name: variable("time", values, entry.unit, entry.long_name, entry.symbol)
        for entry, values in carried
        if entry.name not in known
    }


def powers_of(model: ModuleType) -> dict[str, tuple[str, str, str]]:
    """Unit, meaning and symbol of the electrical powers that the module offers, by name."""
    return {name: told for name, told in _POWERS.items() if hasattr(model, name)}
