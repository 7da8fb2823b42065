"""What the paper says of its amplitude-frequency curves, as tests on computed ones."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import xarray as xr

from delagrange.analysis.rest.modes import modes
from delagrange.model.load import load_model
from delagrange.model.parameters import SHENG_2015
from delagrange.problem.dashpots import FROZEN
from delagrange.reproduction.claims import measures
from delagrange.reproduction.claims.claim import Claim
from delagrange.reproduction.claims.numbers import Found, found_peak
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import RESPONSES, CurveLoad, Panel
from delagrange.reproduction.runs.responses import curve

_RESPONSE = {figure.model: figure for figure in RESPONSES}


def _panel_peaks(runs: Runs, model: str, formulation: str | None, letter: str) -> list[Found]:
    response = runs.response(_RESPONSE[model].number, formulation)
    return [found_peak(response, load) for load in _panel(model, letter).loads]


def _panel(model: str, letter: str) -> Panel:
    return next(panel for panel in _RESPONSE[model].panels if panel.letter == letter)


def rising(values: list[float]) -> bool:
    """Never falling, and higher at the end; a step may be lost in the grid of the frequencies."""
    return values[-1] > values[0] and all(b >= a for a, b in pairwise(values))


def _peaks_text(peaks: list[Found]) -> str:
    return ", ".join(f"{peak.amplitude:.4g} at {peak.frequency:g} Hz" for peak in peaks)


def resonance(model: str, letter: str, *, rises: bool) -> Claim:
    """The resonant frequency rises, or falls, along the curves of a panel."""

    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        peaks = _panel_peaks(runs, model, formulation, letter)
        holds = rising([peak.frequency if rises else -peak.frequency for peak in peaks])
        return holds, f"{_peaks_text(peaks)}; {_small_vibration_text(model, formulation, letter)}"

    return test


def _small_vibration_text(model: str, formulation: str | None, letter: str) -> str:
    """Where small vibrations under the mean load are in resonance, mode by mode along the curves of a panel."""
    halves = np.transpose(
        [small_vibration_resonances(model, formulation, load) for load in _panel(model, letter).loads]
    )
    each = " and ".join(", ".join(f"{half:.4g}" for half in mode) for mode in halves)
    return f"small vibrations: f_n/2 = {each} Hz"


def small_vibration_resonances(model: str, formulation: str | None, load: CurveLoad) -> np.ndarray:
    """Halves of the natural frequencies [Hz] under the force and the mean square of the field, dashpots frozen."""
    found = modes(
        model,
        formulation=formulation,
        force=load.force,
        field=load.field_amplitude / np.sqrt(2),
        held_stretch=load.held_stretch,
        dashpots=FROZEN,
    )
    return found["frequency"].values / 2


def peak_rises(model: str, letter: str) -> Claim:
    """The peak amplitude rises along the curves of a panel."""

    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        peaks = _panel_peaks(runs, model, formulation, letter)
        return rising([peak.amplitude for peak in peaks]), _peaks_text(peaks)

    return test


def field_moves_resonance_less(model: str) -> Claim:
    """The resonance shifts less over the fields of panel b than over the forces of panel a."""

    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        shift = [
            abs(peaks[-1].frequency - peaks[0].frequency)
            for peaks in (_panel_peaks(runs, model, formulation, letter) for letter in "ab")
        ]
        return shift[1] < shift[0], f"by {shift[1]:g} Hz over the fields, {shift[0]:g} Hz over the forces"

    return test


def many_modes(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """Every curve has more than one peak that stands out by a tenth of the curve's range."""
    figure = _RESPONSE["uniaxial"]
    response = runs.response(figure.number, formulation)
    counts = [measures.mode_count(curve(response, load)["amplitude"].values) for load in figure.loads]
    return min(
        counts
    ) > 1, f"{min(counts)} to {max(counts)} peaks a curve (prominence over 10 % of its range)"


def grows_large(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """The largest field more than doubles the peak of the smallest."""
    peaks = _panel_peaks(runs, "pure_shear", formulation, "b")
    return peaks[-1].amplitude > 2 * peaks[0].amplitude, _peaks_text(peaks)


def _away_from_resonance(response: xr.Dataset, load: CurveLoad) -> float:
    """Median amplitude further than 20 % from the resonant frequency."""
    one = curve(response, load)
    resonance = found_peak(response, load).frequency
    away = one.where(np.abs(one["frequency"] - resonance) > 0.2 * resonance, drop=True)
    return float(away["amplitude"].median())


def held_stretch_reduces_away(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """Away from resonance the amplitude falls with the held stretch."""
    figure = _RESPONSE["pure_shear"]
    response = runs.response(figure.number, formulation)
    loads = _panel("pure_shear", "c").loads
    values = [_away_from_resonance(response, load) for load in loads]
    text = ", ".join(f"{value:.3g}" for value in values)
    return rising([-value for value in values]), f"median amplitude {text} at held stretches 2, 3, 4"


def reaction_grows(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """Static reaction at the reference state of each held stretch, no field."""
    model = load_model("pure_shear", formulation)
    values = []
    for held in (2.0, 3.0, 4.0):
        parameters = [
            held if v.name == "held_stretch" else getattr(SHENG_2015, v.name) for v in model.PARAMETERS
        ]
        values.append(
            float(model.reaction_forces(model.reference_state(parameters), (0.1, 0.0), parameters)[0])
        )
    return rising(values), f"{', '.join(f'{value:.3g}' for value in values)} N at held stretches 2, 3, 4"
