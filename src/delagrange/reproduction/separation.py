"""How fast two neighbouring runs part: in proportion to time, or exponentially."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from delagrange.analysis.sections import stroboscopic_section
from delagrange.models import load_model
from delagrange.parameters import SHENG_2015
from delagrange.reproduction.cases import MotionFigures
from delagrange.reproduction.motions import run_arguments

_START = 1e-7
_POINTS = 200


@dataclass(frozen=True)
class Separation:
    """Distance of two runs in the stretches, from `start` at t = 0 to `duration` later."""

    start: float  # [1]
    duration: float  # [s]
    growth: float  # of the median distance over the last tenth, relative to the start
    power: float  # p of the best fit distance ~ t^p over the last three quarters
    exponential: bool  # an exponential fits better than a power and is above 1/s


def separation(figures: MotionFigures, frequency: float, formulation: str | None = None) -> Separation:
    """Follow two runs whose first stretch differs by 1e-7 at the start, point by point of the Poincaré section."""
    arguments = run_arguments(figures, frequency, formulation)
    model = load_model(figures.model, formulation)
    values = [getattr(SHENG_2015, v.name, figures.load.held_stretch) for v in model.PARAMETERS]
    beside = np.array(model.reference_state(values), dtype=float)
    beside[0] += _START
    runs = [
        stroboscopic_section(figures.model, **arguments, count=_POINTS, initial_state=state)
        for state in (None, beside)
    ]
    stretches = [variable.name for variable in model.STATE[: model.COORDINATE_COUNT]]
    return _fit(runs[0]["time"].values, _distance(runs, stretches))


def _distance(runs: list[xr.Dataset], names: list[str]) -> np.ndarray:
    return np.linalg.norm([runs[1][name].values - runs[0][name].values for name in names], axis=0)


def _fit(time: np.ndarray, distance: np.ndarray) -> Separation:
    late = slice(len(time) // 4, None)
    log_distance = np.log(distance[late])
    power, power_misfit = _line(np.log(time[late]), log_distance)
    exponent, exponential_misfit = _line(time[late], log_distance)
    final = float(np.median(distance[-len(distance) // 10 :]))
    return Separation(
        _START,
        float(time[-1]),
        final / _START,
        power,
        exponential=exponential_misfit < power_misfit and exponent > 1.0 and final > 1e3 * _START,
    )


def _line(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Slope of the straight line through the points, and the mean square distance from it."""
    (slope, _), residual, *_ = np.polyfit(x, y, 1, full=True)
    return float(slope), float(residual[0]) / len(x)
