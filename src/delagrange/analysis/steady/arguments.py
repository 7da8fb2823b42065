"""The arguments of the periodic response, checked."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from delagrange.analysis.steady.load import LOAD_UNITS
from delagrange.analysis.steady.search import Range
from delagrange.common import checks
from delagrange.common.units import shown, with_unit
from delagrange.drives.inputs import ELECTRICAL, ElectricalInput, electrical_input
from delagrange.model.material import Material

_MOST_VIBRATIONS = 10_000


def electrical_numbers(model: ModuleType, **given: object) -> tuple[ElectricalInput, dict[str, object]]:
    """The electrical input of a model, and the amplitude and the bias of its sine by their names.

    given: field_amplitude, field_bias, charge_amplitude, charge_bias; None: left out

    Raises:
        ValueError: those of the other input are given, or the amplitude of this one is not.
    """
    electrical = electrical_input(model)
    for name in (name for each in ELECTRICAL.values() for name in (each.amplitude, each.bias)):
        foreign = name not in (electrical.amplitude, electrical.bias)
        if foreign and given[name] is not None and not (np.ndim(given[name]) == 0 and given[name] == 0):
            raise ValueError(
                f"{name} given as {shown(given[name])}, but the electrical input of {model.MODEL} is "
                f"{electrical.name} [{electrical.unit}]; give {electrical.amplitude} and {electrical.bias}"
            )
    if given[electrical.amplitude] is None:
        raise ValueError(f"{electrical.amplitude} [{electrical.unit}] must be given, got none")
    bias = 0.0 if given[electrical.bias] is None else given[electrical.bias]
    return electrical, {electrical.amplitude: given[electrical.amplitude], electrical.bias: bias}


def varied_load(
    given: Mapping[str, object], electrical: ElectricalInput
) -> tuple[str, Range, dict[str, float]]:
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
    name = electrical.amplitude
    if varied != name and load[name] == 0:
        raise ValueError(
            f"{name} must be positive, got 0 {electrical.unit}: without it nothing drives a periodic motion"
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
    if name.endswith("_amplitude") and number < 0:
        raise ValueError(f"{name} must not be negative, got {with_unit(number, unit)}")
    return number


def check_frequencies(lowest: float, fastest: float) -> None:
    """Refuse a period of the drive in which the membrane would vibrate for ever.

    lowest: of field or charge [Hz]; fastest: small vibration of the membrane [Hz]

    Raises:
        ValueError: more than 10000 vibrations in a period.
    """
    least = fastest / _MOST_VIBRATIONS
    if lowest < least:
        raise ValueError(
            f"frequency must be at least {least:.3g} Hz, {_MOST_VIBRATIONS:g} small vibrations a period, "
            f"got {lowest:g} Hz; what is so slow is in equilibrium at all times, see equilibria"
        )


def single_material(changes: Mapping[str, object], material: Material) -> dict[str, float]:
    """Single values of the material by name.

    Raises:
        ValueError: an unknown name, or not a single positive number.
    """
    material.check_names(changes)
    return {
        name: checks.scalar(name, material.checked(name, value), material.units[name])
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
