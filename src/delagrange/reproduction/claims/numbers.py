"""Each printed peak beside ours: accurate, with its error stated, and in numerics like the paper's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import RESPONSES, CurveLoad, ResponseFigure
from delagrange.reproduction.runs.numerics import PAPER_LIKE
from delagrange.reproduction.runs.processes import side_by_side
from delagrange.reproduction.runs.published_numbers import PEAKS, Peak
from delagrange.reproduction.runs.responses import curve
from delagrange.reproduction.runs.runs import formulations
from delagrange.run.frequency_response import frequency_response

SAME_AMPLITUDE = (
    0.01  # relative: "agrees" in the table means within this and within one grid step in frequency
)
_WITNESS_RTOL, _WITNESS_ATOL = 1e-12, 1e-14


@dataclass(frozen=True)
class Found:
    """The largest amplitude on a computed curve."""

    frequency: float  # [Hz]
    amplitude: float  # [1]
    grid: float  # spacing of the frequencies [Hz]
    lost: int  # points of the curve at which the solution was lost


@dataclass(frozen=True)
class Comparison:
    """A printed peak beside the computed ones."""

    peak: Peak
    model: str
    formulation: str | None
    accurate: Found
    accurate_error: float  # of the amplitude at that frequency, against an independent integration [1]
    paper_numerics: Found


@dataclass(frozen=True)
class PeakTask:
    """A printed peak with the computed ones, its witness still to be integrated."""

    figure: ResponseFigure
    formulation: str | None
    peak: Peak
    accurate: Found
    paper_numerics: Found


def found_peak(response: xr.Dataset, load: CurveLoad) -> Found:
    """The peak of one curve, among the points at which the solution was not lost."""
    one = curve(response, load)
    frequency, amplitude = one["frequency"].values, one["amplitude"].values
    place = int(np.nanargmax(amplitude))
    return Found(
        float(frequency[place]),
        float(amplitude[place]),
        float(frequency[1] - frequency[0]),
        int(np.isnan(amplitude).sum()),
    )


def amplitude_error(figure: ResponseFigure, formulation: str | None, load: CurveLoad, found: Found) -> float:
    """Difference to SciPy's scalar DOP853 at rtol 1e-12, extrema from its own dense output [1]."""
    witness = frequency_response(
        figure.model,
        formulation=formulation,
        force=load.force,
        field_amplitude=load.field_amplitude,
        held_stretch=load.held_stretch,
        frequency=[found.frequency],
        duration=figure.window,
        engine="scipy",
        rtol=_WITNESS_RTOL,
        atol=_WITNESS_ATOL,
    )
    return abs(float(witness["amplitude"][0]) - found.amplitude)


def compare_peaks(runs: Runs, processes: int = 2) -> tuple[Comparison, ...]:
    """Every printed peak, in both formulations where there are two; the witnesses integrate side by side."""
    figures = {figure.number: figure for figure in RESPONSES}
    tasks = [
        PeakTask(figures[peak.figure], formulation, peak, *_both(runs, peak, formulation))
        for peak in PEAKS
        for formulation in formulations(figures[peak.figure].model)
    ]
    compared = dict(side_by_side(compare, tasks, processes))
    return tuple(compared[task] for task in tasks)


def _both(runs: Runs, peak: Peak, formulation: str | None) -> tuple[Found, Found]:
    return (
        found_peak(runs.response(peak.figure, formulation), peak.load),
        found_peak(runs.response(peak.figure, formulation, PAPER_LIKE.name), peak.load),
    )


def compare(task: PeakTask) -> Comparison:
    """Measure the error of the accurate peak, and put everything side by side."""
    error = amplitude_error(task.figure, task.formulation, task.peak.load, task.accurate)
    return Comparison(
        task.peak, task.figure.model, task.formulation, task.accurate, error, task.paper_numerics
    )


def agreement(peak: Peak, found: Found) -> str:
    """What a person would say of a computed peak beside the printed one."""
    frequency = abs(found.frequency - peak.frequency) <= found.grid
    if peak.amplitude is None:
        return "frequency agrees" if frequency else "differs"
    amplitude = abs(found.amplitude / peak.amplitude - 1) <= SAME_AMPLITUDE
    words = {(True, True): "agrees", (True, False): "frequency agrees", (False, True): "amplitude agrees"}
    return words.get((frequency, amplitude), "differs")
