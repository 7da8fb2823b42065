"""The arguments of the periodic response, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from delagrange.analysis.steady.load import sine_of
from delagrange.analysis.steady.search import Range
from delagrange.common import checks
from delagrange.common.units import shown, with_unit
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import ElectricalInput, Inputs, constant_inputs, refuse_searched
from delagrange.drives.sines import LOAD_UNITS, own_sine
from delagrange.model.parameters import Parameters
from delagrange.problem.problem import Problem, Specimen, make_specimen

TOLERANCE_RANGE = (1e-14, 1e-6)  # of the flow
_MOST_VIBRATIONS = 10_000


@dataclass(frozen=True)
class Forced:
    """A membrane under a constant force and a sine of what drives its electrodes, as far as that does not vary."""

    specimen: Specimen
    electrical: ElectricalInput
    sine: Mapping[str, object]  # its amplitude and bias as given
    constant: Mapping[str, float]  # other inputs, by name
    held_stretch: float | None
    material: Mapping[str, float]  # what is changed of it

    def problem(self, force: float, drive: Drive | float) -> Problem:
        """Under a force [N] and a drive of the electrodes, or their constant value."""
        inputs = {**self.constant, self.electrical.name: drive}
        return self.specimen.single_problem(self.material, self.held_stretch, force, 0.0, inputs)

    def driven(self, load: Mapping[str, float]) -> Problem:
        """Under a load."""
        return self.problem(load["force"], sine_of(load, self.electrical))


def make_forced(
    model: str | ModuleType,
    formulation: str | None,
    lateral_dashpot: str | None,
    parameters: Parameters | None,
    sines: Mapping[str, object],
    inputs: Inputs | None,
    held_stretch: float | None,
    material: Mapping[str, float],
    purpose: str,
) -> Forced:
    """The forced membrane, for a `purpose` that errors name.

    sines: amplitude and bias of every electrical input by name; an amplitude of None: left out

    Raises:
        ValueError: those of another input than that of the model, no amplitude, or inputs that are no single numbers.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    electrical = refuse_searched(specimen.model, inputs)
    sine = own_sine(specimen.model, electrical, sines)
    constant = constant_inputs(specimen.model, inputs, purpose)
    specimen.material.check_names(material)
    return Forced(specimen, electrical, sine, constant, held_stretch, material)


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
