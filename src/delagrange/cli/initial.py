"""The state at t = 0 as a person types it: NAME=VALUES, as often as needed, or `equilibrium`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from delagrange.cli import quantities
from delagrange.common.checks import did_you_mean, scalar
from delagrange.problem.initial import EQUILIBRIUM

Start = dict[str, float | np.ndarray] | str | None


def initial_state(texts: list[str] | None, units: Mapping[str, str]) -> dict[str, float | np.ndarray] | None:
    """All values of each state variable, by name; hyphens count as underscores, none at all is None.

    units: of the state variables, by name

    Raises:
        ValueError: another form, an unknown name, or values that are no numbers or ranges.
    """
    if not texts:
        return None
    collected: dict[str, list[str]] = {}
    for text in texts:
        name, values = _parts(text, units)
        collected.setdefault(name, []).append(values)
    return {
        name: quantities.axis(f"initial {name}", values, units[name]) for name, values in collected.items()
    }


def start_given(texts: list[str] | None, units: Mapping[str, str]) -> Start:
    """As `initial_state`, or the loaded equilibrium where that is typed instead.

    Raises:
        ValueError: as `initial_state`; or values beside the equilibrium.
    """
    if EQUILIBRIUM not in (texts or ()):
        return initial_state(texts, units)
    others = [text for text in texts if text != EQUILIBRIUM]
    if others:
        raise ValueError(
            f"initial {EQUILIBRIUM!r} says the whole state, and {others[0]!r} is given as well; give one"
        )
    return EQUILIBRIUM


def single_start(texts: list[str] | None, units: Mapping[str, str]) -> Start:
    """As `start_given`, of a single run.

    Raises:
        ValueError: as `start_given`; or many values of one state variable.
    """
    start = start_given(texts, units)
    if not isinstance(start, dict):
        return start
    return {name: scalar(f"initial {name}", value, units[name]) for name, value in start.items()}


def _parts(text: str, units: Mapping[str, str]) -> tuple[str, str]:
    """Name and values of `NAME=VALUES`."""
    name, equals, values = text.partition("=")
    name = name.strip().replace("-", "_")
    known = ", ".join(f"{variable} [{unit}]" for variable, unit in units.items())
    if not equals:
        raise ValueError(f"initial must be NAME=VALUES with a state variable ({known}), got {text!r}")
    if name not in units:
        raise ValueError(
            f"initial {text!r} names no state variable{did_you_mean(name, units)}; known are {known}"
        )
    return name, values
