"""Natural frequencies and modes as variables of a Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType

import numpy as np

from delagrange.analysis.rest.arguments import resting_variables
from delagrange.drives.inputs import ELECTRICAL, ElectricalInput, electrical_input
from delagrange.equilibrium.vibration import STABILITY_MEANING, Spectrum
from delagrange.run.run_dataset import variable

_DOUBLING = (
    "the {squared} enters squared, and ({E} sin 2 pi f t)^2 = {E}^2 (1 - cos 4 pi f t) / 2: a {text} at f without bias "
    "drives at 2 f, so that a mode of frequency f_n resonates at f = f_n / 2; beside a bias B the {squared} has the "
    "part 2 B {E} sin 2 pi f t too, which drives at f, and f = f_n resonates as well, as it does for a force"
)
_ROUND_OFF = "to about 1e-15 of 2 pi times the highest natural frequency"


def modes_variables(
    model: ModuleType,
    spectra: Sequence[Spectrum],
    dimensions: tuple[str, ...],
    shape: tuple[int, ...],
    damped: bool,
) -> dict[str, tuple]:
    """Variables over `dimensions` of `shape`, from one spectrum for each place, the last dimension fastest."""
    rates = np.array([spectrum.rates for spectrum in spectra]).reshape(*shape, -1)
    vibrates = rates.imag > 0
    frequency = np.where(vibrates, rates.imag, np.nan) / (2 * np.pi)
    data = _frequencies(frequency, (*dimensions, "mode"), electrical_input(model))
    data |= _rates(rates, vibrates, (*dimensions, "mode"), damped)
    data |= _shapes(model, spectra, dimensions, shape)
    if damped:
        data["relaxation_rate"] = _relaxation(spectra, dimensions, shape)
    return data | _equilibrium(model, spectra, dimensions, shape)


def _frequencies(
    frequency: np.ndarray, dimensions: tuple[str, ...], electrical: ElectricalInput
) -> dict[str, tuple]:
    stem, squared = electrical.stem, ELECTRICAL[electrical.squared]
    explanation = _DOUBLING.format(text=stem, squared=squared.stem, E=squared.symbol)
    return {
        "frequency": variable(dimensions, frequency, "Hz", "natural frequency", "f_n"),
        f"resonant_{stem}_frequency": variable(
            dimensions, frequency / 2, "Hz", f"frequency of a {stem} without bias that excites the mode",
            definition="frequency / 2", explanation=explanation,
        ),
    }  # fmt: skip


def _rates(
    rates: np.ndarray, vibrates: np.ndarray, dimensions: tuple[str, ...], damped: bool
) -> dict[str, tuple]:
    grows = np.where(np.isfinite(rates.real) & ~vibrates, np.abs(rates.real), np.nan)
    data = {"growth_rate": variable(dimensions, grows, "1/s", "rate at which an unstable mode grows")}
    if damped:
        decays = np.where(vibrates, -rates.real, np.nan)
        data["decay_rate"] = variable(
            dimensions, decays, "1/s", "rate at which the dashpots damp the vibration", accuracy=_ROUND_OFF
        )
    return data


def _shapes(
    model: ModuleType, spectra: Sequence[Spectrum], dimensions: tuple[str, ...], shape: tuple[int, ...]
) -> dict[str, tuple]:
    count = model.COORDINATE_COUNT
    values = np.array([spectrum.shapes for spectrum in spectra]).reshape(*shape, count, count)
    names = np.array([entry.name for entry in model.STATE[:count]], dtype=object)
    long_name = "stretches of the mode, of unit length, the largest positive"
    return {
        "shape": variable((*dimensions, "coordinate", "mode"), values, "1", long_name),
        "coordinate": ("coordinate", names, {"long_name": "coordinate of the shape"}),
        "mode": variable("mode", np.arange(1, count + 1), "1", "number of the mode, by ascending frequency"),
    }


def _relaxation(spectra: Sequence[Spectrum], dimensions: tuple[str, ...], shape: tuple[int, ...]) -> tuple:
    values = np.array([spectrum.relaxation for spectrum in spectra])
    used = max(int(np.sum(np.isfinite(values), axis=1).max(initial=0)), 1)
    values = -values[:, :used].reshape(*shape, used)
    long_name = "rate at which what does not vibrate relaxes; negative: it grows"
    return variable((*dimensions, "relaxation"), values, "1/s", long_name)


def _equilibrium(
    model: ModuleType, spectra: Sequence[Spectrum], dimensions: tuple[str, ...], shape: tuple[int, ...]
) -> dict[str, tuple]:
    states = np.array([spectrum.state for spectrum in spectra]).T.reshape(-1, *shape)
    data = resting_variables(model, dimensions, states, "at rest")
    statuses = np.array([spectrum.status for spectrum in spectra], dtype=object).reshape(shape)
    attributes = {
        "long_name": "stability of the equilibrium, or why there is none",
        "meaning": STABILITY_MEANING,
    }
    return data | {"status": (dimensions, statuses, attributes)}
