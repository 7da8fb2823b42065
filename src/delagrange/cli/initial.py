"""The state at t = 0 as a person types it: NAME=VALUES, as often as needed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from delagrange.checks import did_you_mean
from delagrange.cli import quantities


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
