"""The arguments of the periodic response, checked."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from delagrange import checks
from delagrange.analysis.steady.search import Range
from delagrange.analysis.steady.shooting import LOAD_UNITS
from delagrange.parameters import CHANGEABLE_UNITS, check_material_names
from delagrange.units import shown, with_unit

_MOST_VIBRATIONS = 10_000


def varied_load(given: Mapping[str, object]) -> tuple[str, Range, dict[str, float]]:
    """Name and range of what is varied, and the load at its start.

    Raises:
        ValueError: not exactly one pair, or a bad number.
    """
    pairs = [name for name, value in given.items() if np.ndim(value) > 0]
    if len(pairs) != 1:
        raise ValueError(
            f"exactly one of {', '.join(given)} must be a pair (start, stop), got {len(pairs)} pairs"
            f"{': ' + ', '.join(pairs) if pairs else ''}"
        )
    varied = pairs[0]
    load = {name: load_number(name, value) for name, value in given.items() if name != varied}
    ends = _ends(varied, given[varied])
    load[varied] = ends[0]
    if varied != "field_amplitude" and load["field_amplitude"] == 0:
        raise ValueError(
            "field_amplitude must be positive, got 0 V/m: without it nothing drives a periodic motion"
        )
    return varied, Range(*ends), load


def _ends(name: str, value: object) -> tuple[float, float]:
    if np.shape(value) != (2,):
        raise ValueError(f"{name} must be a number or a pair (start, stop), got {shown(value)}")
    start, stop = (load_number(name, end) for end in value)
    if start == stop:
        unit = LOAD_UNITS[name]
        raise ValueError(f"{name} must go from start to another stop, got {with_unit(start, unit)} twice")
    return start, stop


def load_number(name: str, value: object) -> float:
    """One number of the load, in its unit.

    Raises:
        ValueError: not a single finite number, a frequency that is not positive, or a negative amplitude.
    """
    unit = LOAD_UNITS[name]
    check = checks.positive if name == "frequency" else checks.finite
    number = checks.scalar(name, check(name, value, unit), unit)
    if name == "field_amplitude" and number < 0:
        raise ValueError(f"field_amplitude must not be negative, got {number:g} V/m")
    return number


def check_frequencies(lowest: float, fastest: float) -> None:
    """Refuse a period of the field in which the membrane would vibrate for ever.

    lowest: of the field [Hz]; fastest: small vibration of the membrane [Hz]

    Raises:
        ValueError: more than 10000 vibrations in a period.
    """
    least = fastest / _MOST_VIBRATIONS
    if lowest < least:
        raise ValueError(
            f"frequency must be at least {least:.3g} Hz, {_MOST_VIBRATIONS:g} small vibrations a period, "
            f"got {lowest:g} Hz; what is so slow is in equilibrium at all times, see equilibria"
        )


def single_material(changes: Mapping[str, object]) -> dict[str, float]:
    """Single values of the material by name.

    Raises:
        ValueError: an unknown name, or not a single positive number.
    """
    check_material_names(changes)
    return {
        name: checks.scalar(
            name, checks.positive(name, value, CHANGEABLE_UNITS[name]), CHANGEABLE_UNITS[name]
        )
        for name, value in changes.items()
    }


def seed_values(whole: Range, seeds: int | np.ndarray, varied: str) -> np.ndarray:
    """The values of the varied number from which branches are looked for.

    Raises:
        ValueError: no number of them, or values outside of the range.
    """
    if np.ndim(seeds) == 0:
        return whole.evenly(checks.count("seeds", seeds, 2, 10000))
    values = np.asarray(checks.finite("seeds", seeds, LOAD_UNITS[varied]), dtype=float)
    if values.ndim != 1 or not values.size:
        raise ValueError(
            f"seeds must be a count, or a one-dimensional array of values of {varied} in "
            f"{LOAD_UNITS[varied]}, got {shown(seeds)}"
        )
    for value in values:
        if not whole.contains(value):
            unit = LOAD_UNITS[varied]
            raise ValueError(
                f"seeds must lie in the range of {varied}, {with_unit(whole.start, unit)} to "
                f"{with_unit(whole.stop, unit)}, got {with_unit(value, unit)}"
            )
    return values
