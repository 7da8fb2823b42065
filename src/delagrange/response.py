"""Frequency response: the amplitude of forced motion over frequency and whatever else varies."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.dataset import (
    AMPLITUDE_DEFINITION,
    extrema_variables,
    run_attributes,
    status_time_variable,
    status_variable,
    variable,
)
from delagrange.drive import Drive
from delagrange.grid import Grid
from delagrange.lanes import Outcome
from delagrange.loss import Limits
from delagrange.models import load_model
from delagrange.parameters import CHANGEABLE_UNITS, SHENG_2015, Parameters
from delagrange.sweep import SWEEP_UNITS, Sweep, make_settings, make_sweep, run_sweep


def frequency_response(
    model: str | ModuleType,
    *,
    frequency: np.ndarray | float,
    duration: float,
    field_amplitude: np.ndarray | float,
    field_bias: np.ndarray | float = 0.0,
    force: Drive | np.ndarray | float = 0.0,
    held_stretch: np.ndarray | float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters = SHENG_2015,
    window: tuple[float, float] | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-12,
    method: str = "DOP853",
    engine: str = "numpy",
    step_control: str = "scipy",
    extrema: str = "dense",
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    progress: bool = False,
    **material: np.ndarray | float,
) -> xr.Dataset:
    """Amplitude of the motion from rest under E = bias + amplitude sin(2 pi f t), at each point of a grid.

    `frequency` [Hz] is a strictly increasing array. `force` [N], `field_amplitude` and `field_bias` [V/m],
    `held_stretch` [1] and any material parameter (`relaxation_time` [s] included) may be one-dimensional
    arrays: each gives a dimension of its name, in the order force, field_amplitude, field_bias,
    held_stretch, material, frequency. Single values give scalar coordinates (frequency always a dimension).

    Args:
        duration: of each run [s].
        window: start and end [s] of the time in which extrema are taken; the whole duration if left out.
        method: "DOP853" or "RK45".
        engine: "numpy" runs all points side by side; "scipy" one by one through `solve_ivp`, slowly, as a
            witness.
            Sweeps are explicit: for relaxation times far below a period of vibration use `simulate` with
            method "auto".
        step_control: "scipy", or "ode45" for the controller of MATLAB's `ode45` (with method "RK45").
        extrema: "dense" between steps, to the tolerance; "samples" at the quarters of each step, as
            `ode45` plots them; "steps" at the ends of steps.
        rtol, atol, limits, formulation, lateral_dashpot, parameters, progress: as in `simulate`.

    Returns:
        Dataset with `amplitude` [1] of the first coordinate (half of peak to peak; NaN where the solution
        was lost), `maximum` and `minimum` (up to the loss), the same for further coordinates as
        `stretch_2_amplitude` and so on, `status` and `status_time`. Interrupted from the keyboard, it warns
        and returns what is done; the other points have the status "interrupted".

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is
            allowed.
    """
    module = load_model(model, formulation, lateral_dashpot)
    settings = make_settings(duration, window, rtol, atol, method, engine, step_control, extrema, limits)
    values = {
        "force": force,
        "field_amplitude": field_amplitude,
        "field_bias": field_bias,
        "held_stretch": held_stretch,
        **material,
        "frequency": frequency,
    }
    sweep = make_sweep(module, parameters, values, settings, engine)
    outcome = run_sweep(sweep, progress)
    numerics = {"method": method, "engine": engine, "step_control": step_control, "extrema": extrema}
    return _dataset(sweep, outcome, numerics | {"rtol": settings.control.rtol, "atol": settings.control.atol})


def _dataset(sweep: Sweep, outcome: Outcome, numerics: dict[str, object]) -> xr.Dataset:
    grid, settings = sweep.grid, sweep.settings
    dimensions = tuple(grid.axes)
    start, stop = settings.window
    measure = {"definition": AMPLITUDE_DEFINITION, "window_start": start, "window_stop": stop}
    data = extrema_variables(sweep.model, outcome, dimensions, grid.shape, measure)
    data["status"] = status_variable(dimensions, outcome.status.reshape(grid.shape))
    data["status_time"] = status_time_variable(dimensions, outcome.status_time.reshape(grid.shape))
    lengths = {"duration": settings.duration, "duration_units": "s"}
    attributes = _attributes(sweep) | lengths | measure | {"window_units": "s"} | numerics
    return xr.Dataset(data, coords=_coordinates(grid), attrs=attributes)


_LONG_NAMES = {
    "force": "applied force",
    "field_amplitude": "amplitude of the nominal electric field",
    "field_bias": "bias of the nominal electric field",
    "held_stretch": "stretch at which axis 2 is held",
    "frequency": "frequency of the electric field",
}


def _coordinates(grid: Grid) -> dict[str, tuple]:
    def coordinate(dimensions: tuple[str, ...], name: str, values: object) -> tuple:
        long_name = _LONG_NAMES.get(name, name.replace("_", " "))
        return variable(dimensions, values, SWEEP_UNITS[name], long_name)

    axes = {name: coordinate((name,), name, values) for name, values in grid.axes.items()}
    return axes | {name: coordinate((), name, value) for name, value in grid.single.items()}


def _attributes(sweep: Sweep) -> dict[str, object]:
    """What all runs have in common; what varies over the grid is said by its coordinates."""
    single = {name: value for name, value in sweep.grid.single.items() if name in CHANGEABLE_UNITS}
    parameters = sweep.parameters.replace(**single)
    common = run_attributes(sweep.problem(slice(0, 1)), parameters, sweep.settings.limits)
    for name in sweep.grid.axes:
        common.pop(name, None)
        common.pop(f"{name}_units", None)
    common["nominal_electric_field_drive"] = "field_bias + field_amplitude * sin(2 pi frequency t)"
    if sweep.force_drive is None:
        common["force_drive"] = "Constant(force)"
    return common


def peaks(response: xr.Dataset) -> xr.Dataset:
    """Resonance of each curve of a response: where its amplitude is largest among the computed frequencies.

    Returns:
        Dataset with `resonance_frequency` [Hz] and `peak_amplitude` [1] over the other dimensions; NaN for
        a curve of which no point was completed.

    Raises:
        ValueError: the Dataset is not one of `frequency_response`.
    """
    if "amplitude" not in response or "frequency" not in response.dims:
        raise ValueError("peaks needs the Dataset of frequency_response, with `amplitude` over `frequency`")
    amplitude = response["amplitude"]
    known = amplitude.notnull().any("frequency")
    place = amplitude.fillna(-np.inf).argmax("frequency")
    frequency = response["frequency"].isel(frequency=place).where(known).drop_vars("frequency")
    height = amplitude.max("frequency")
    frequency.attrs = {"units": "Hz", "long_name": "resonance frequency, of the largest amplitude"}
    height.attrs = dict(amplitude.attrs)
    return xr.Dataset({"resonance_frequency": frequency, "peak_amplitude": height}, attrs=response.attrs)
