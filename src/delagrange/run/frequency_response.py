"""Frequency response: the amplitude of forced motion over frequency and whatever else varies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.common.progress import working
from delagrange.drives.drive import Drive, Sine
from delagrange.drives.inputs import Inputs
from delagrange.drives.sines import driven_sine, sine_long_names, sine_text, with_drive
from delagrange.engines.engines import resolve_numerics
from delagrange.engines.lanes import Outcome
from delagrange.model.parameters import Parameters
from delagrange.model.user_files import is_users
from delagrange.problem.initial import EQUILIBRIUM_MEANING, PREFIX, is_equilibrium
from delagrange.problem.problem import make_specimen
from delagrange.problem.status import Limits
from delagrange.run.measures import Measures
from delagrange.run.run_dataset import (
    AMPLITUDE_DEFINITION,
    average_variables,
    extrema_variables,
    run_attributes,
    sample_variables,
    state_variables,
    status_time_variable,
    status_variable,
    variable,
)
from delagrange.run.sweep import Sweep, make_settings, make_sweep, run_sweep


def frequency_response(
    model: str | ModuleType,
    *,
    duration: float,
    frequency: np.ndarray | float | None = None,
    drive: Sine | None = None,
    field_amplitude: np.ndarray | float | None = None,
    field_bias: np.ndarray | float = 0.0,
    field_phase: np.ndarray | float = 0.0,
    charge_amplitude: np.ndarray | float | None = None,
    charge_bias: np.ndarray | float = 0.0,
    charge_phase: np.ndarray | float = 0.0,
    current_amplitude: np.ndarray | float | None = None,
    current_bias: np.ndarray | float = 0.0,
    current_phase: np.ndarray | float = 0.0,
    force: Drive | np.ndarray | float = 0.0,
    inputs: Inputs | None = None,
    held_stretch: np.ndarray | float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, np.ndarray | float] | str | None = None,
    window: tuple[float, float] | None = None,
    averages: bool = False,
    final_state: bool = False,
    section_points: int | None = None,
    section_phase: float = 0.0,
    sample_interval: float | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-12,
    method: str = "DOP853",
    engine: str = "auto",
    step_control: str | None = None,
    extrema: str = "dense",
    threads: int | None = None,
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    progress: bool = False,
    **material: np.ndarray | float,
) -> xr.Dataset:
    """Amplitude of the motion under E = bias + amplitude sin(2 pi f t + phase), at each point of a grid.

    `frequency` [Hz] is a strictly increasing array. `force` [N], values of `inputs`, `field_amplitude` and
    `field_bias` [V/m], `field_phase` [rad], `held_stretch` [1], any material parameter (`relaxation_time` [s]
    included) and the values of `initial_state` may be one-dimensional arrays: each gives a dimension of its name,
    in the order force, other inputs, field_amplitude, field_bias, field_phase, held_stretch, material,
    initial_<state variable>, frequency. Single values give scalar coordinates (frequency always a dimension).

    Args:
        duration: of each run [s].
        drive: amplitude, bias, phase and frequency as one `delagrange.Sine`, each a number or an array that makes an
            axis as if given by its own argument; it drives the field, or the charge or current of a model that has
            that. Left out, they are given by
        field_amplitude: which must be given where the model has a field, and the others.
        charge_amplitude, charge_bias, charge_phase: [C/m^2] and [rad] of the same sine of the nominal charge density
            instead, where that drives the model; and
        current_amplitude, current_bias, current_phase: [A/m^2] and [rad] of the nominal current density where
            that does. They give axes in the place of those of the field, and `frequency` is theirs.
        inputs: of any input but the one of the sine, by its name: numbers, arrays or drives, as {"force_2": 0.3}.
            Where no amplitude is given, of a charge or current too, and `frequency` then drives nothing.
        initial_state: values of state variables at t = 0 by name, in the units of `model.STATE`; those left
            out, or all, are as in the reference state, at rest. Or "equilibrium": every run starts at rest where its
            membrane has relaxed under its forces as they are at t = 0 (the bias of a sine, where a ramp begins)
            without field, charge or current, which are then switched on; `initial_<state variable>` in the result.
        window: start and end [s] of the time in which extrema and averages are taken; the whole duration if
            left out.
        averages: give the time average and the root mean square over the window too.
        final_state: give the state at the end of every run, or at its loss, too.
        section_points: give the state at so many last times within the duration at which the argument of the
            sine, 2 pi f t + phase, is `section_phase` [rad] modulo 2 pi; as `stroboscopic_section`, exact.
        sample_interval: give the state at 0 s and every so many seconds up to the duration; not together with
            `section_points`.
        method: "DOP853" or "RK45".
        engine: "compiled" runs all points side by side through machine code on all cores; "numpy" runs them
            side by side through NumPy, on one; "scipy" one by one through `solve_ivp`, slowly, as a witness;
            "auto" chooses the fastest that can do what is asked for, and warns where that is "numpy" because
            compiled code cannot run on this machine. The first use of a model on a machine compiles it,
            which takes seconds. "core" does the same by the integrator in C and the header beside the module,
            with the C compiler of the machine.
            Sweeps are explicit: for relaxation times far below a period of vibration use `simulate` with
            method "auto".
        step_control: "scipy", or "ode45" for the controller of MATLAB's `ode45` (with method "RK45"), both of
            engine "numpy"; "pi" of the compiled engines; left out, the engine's own.
        extrema: "dense" between steps, to the tolerance; "samples" at the quarters of each step, as
            `ode45` plots them; "steps" at the ends of steps.
        threads: how many the compiled engines may use, all cores if left out; the result does not depend on it.
        rtol, atol, limits, formulation, lateral_dashpot, parameters, progress: as in `simulate`.

    Returns:
        Dataset with `amplitude` [1] of the first coordinate (half of peak to peak; NaN where the solution
        was lost), `maximum` and `minimum` (up to the loss), the same for further coordinates as
        `stretch_2_amplitude` and so on, `status` and `status_time`. Where asked for: `mean` and
        `root_mean_square` (named and NaN as the amplitude); `final_<state variable>`;
        `section_<state variable>` over the dimension `period`, with `section_time` [s]; the state variables
        themselves over the dimension `time` [s]. Samples after a loss are NaN. Interrupted from the
        keyboard, it warns and returns what is done; the other points have the status "interrupted".

    Raises:
        ValueError: something given makes no sense, the result would take more than 8 GiB, or a run has no
            equilibrium to start at; the message names it, its value, its unit and what is allowed.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    module = specimen.model
    measures = Measures(averages, final_state, section_points, section_phase, sample_interval)
    with working(progress, f"preparing {module.MODEL}; its first use on a machine takes seconds to compile"):
        numerics = resolve_numerics(method, engine, step_control, extrema, module, [force, *_given(inputs)])
    settings = make_settings(duration, window, rtol, atol, numerics, limits, averages, threads)
    sines = {
        "field_amplitude": field_amplitude, "field_bias": field_bias, "field_phase": field_phase,
        "charge_amplitude": charge_amplitude, "charge_bias": charge_bias, "charge_phase": charge_phase,
        "current_amplitude": current_amplitude, "current_bias": current_bias, "current_phase": current_phase,
    }  # fmt: skip
    if drive is not None:
        frequency, sines = with_drive(module, drive, frequency, sines)
    electrical, sine = driven_sine(module, sines, inputs)
    values = {"force": force, **sine, "held_stretch": held_stretch, **material, "frequency": frequency}
    with working(progress and is_equilibrium(module, initial_state), "finding where the runs start, at rest"):
        sweep = make_sweep(
            specimen, values, settings, numerics.engine, measures, initial_state, inputs, electrical
        )
    outcome = run_sweep(sweep, progress)
    tolerances = {"rtol": settings.control.rtol, "atol": settings.control.atol}
    return _dataset(sweep, outcome, asdict(numerics) | tolerances)


def _given(inputs: Inputs | None) -> list[object]:
    return list(inputs.values()) if isinstance(inputs, Mapping) else []


def _dataset(sweep: Sweep, outcome: Outcome, numerics: dict[str, object]) -> xr.Dataset:
    grid, settings = sweep.grid, sweep.settings
    dimensions = tuple(grid.axes)
    start, stop = settings.window
    measure = {"definition": AMPLITUDE_DEFINITION, "window_start": start, "window_stop": stop}
    data = extrema_variables(sweep.model, outcome, dimensions, grid.shape, measure)
    data |= _measured_variables(sweep, outcome, measure)
    data["status"] = status_variable(dimensions, outcome.status.reshape(grid.shape))
    data["status_time"] = status_time_variable(dimensions, outcome.status_time.reshape(grid.shape))
    lengths = {"duration": settings.duration, "duration_units": "s"}
    attributes = _attributes(sweep) | lengths | measure | {"window_units": "s"} | numerics
    return xr.Dataset(data, coords=_coordinates(sweep), attrs=attributes)


def _measured_variables(sweep: Sweep, outcome: Outcome, measure: dict[str, object]) -> dict[str, tuple]:
    """What was asked for besides the extrema."""
    model, measures, shape = sweep.model, sweep.measures, sweep.grid.shape
    dimensions = tuple(sweep.grid.axes)
    data = {}
    if measures.averages:
        data |= average_variables(model, outcome, dimensions, shape, measure)
    if measures.final_state:
        states = outcome.state.reshape(-1, *shape)
        data |= state_variables(model, dimensions, states, "at the end", "final_")
    if measures.section_points is not None:
        data |= sample_variables(model, outcome.samples, (*dimensions, "period"), shape, "section_")
        data["section_time"] = _section_time(sweep)
    if measures.sample_interval is not None:
        data |= sample_variables(model, outcome.samples, (*dimensions, "time"), shape, "")
    return data


def _section_time(sweep: Sweep) -> tuple:
    """When the sections are taken [s]; it depends on the sine's frequency and phase alone."""
    lengths, sampling = sweep.field_sampling()
    times = sampling.times().T.reshape(*lengths.values(), sampling.count)
    phase = sweep.measures.section_phase
    angle = f"2 pi f t + {sweep.electrical.phase}"
    definition = f"the last times in the duration at which {angle} is {phase:g} rad modulo 2 pi"
    more = {"definition": definition, "section_phase": phase, "section_phase_units": "rad"}
    return variable((*lengths, "period"), times, "s", "time of the section", "t", **more)


_LONG_NAMES = {
    "force": "applied force",
    "held_stretch": "stretch at which axis 2 is held",
}


def _coordinates(sweep: Sweep) -> dict[str, tuple]:
    grid = sweep.grid
    starts = {PREFIX + entry.name: f"{entry.meaning} at t = 0" for entry in sweep.model.STATE}
    meanings = {entry.name: entry.meaning for entry in (*sweep.model.INPUTS, *sweep.model.PARAMETERS)}
    own = {name: meaning for name, meaning in meanings.items() if is_users(sweep.model)}
    long_names = own | _LONG_NAMES | sine_long_names(sweep.electrical) | starts

    def coordinate(dimensions: tuple[str, ...], name: str, values: object) -> tuple:
        long_name = long_names.get(name, name.replace("_", " "))
        return variable(dimensions, values, grid.units[name], long_name)

    coordinates = {name: coordinate((name,), name, values) for name, values in grid.axes.items()}
    coordinates |= {name: coordinate((), name, value) for name, value in grid.single.items()}
    coordinates |= _equilibrium_coordinates(sweep, long_names)
    if sweep.measures.sample_interval is not None:
        times = sweep.sampling(slice(0, 1)).times()[:, 0]
        coordinates["time"] = variable("time", times, "s", "time", "t")
    return coordinates


def _equilibrium_coordinates(sweep: Sweep, long_names: Mapping[str, str]) -> dict[str, tuple]:
    """The loaded equilibria at which the runs start, over the axes on which they depend."""
    if sweep.equilibria is None:
        return {}
    shape = sweep.equilibria.shape[1:]
    over = tuple(name for name, length in zip(sweep.grid.axes, shape) if length > 1)
    lengths = tuple(length for length in shape if length > 1)
    names = [PREFIX + entry.name for entry in sweep.model.STATE]
    return {
        name: variable(over, values.reshape(lengths), sweep.grid.units[name], long_names[name])
        for name, values in zip(names, sweep.equilibria)
    }


def _attributes(sweep: Sweep) -> dict[str, object]:
    """What all runs have in common; what varies over the grid is said by its coordinates."""
    common = run_attributes(sweep.problem(slice(0, 1)), sweep.settings.limits)
    for name in sweep.grid.axes:
        common.pop(name, None)
        common.pop(f"{name}_units", None)
    for entry in sweep.model.INPUTS:
        if entry.name == sweep.electrical.name:
            common[f"{entry.name}_drive"] = sine_text(sweep.electrical)
        elif entry.name not in sweep.drives:
            common[f"{entry.name}_drive"] = f"Constant({entry.name})"
    return common if sweep.equilibria is None else common | {"initial_state": EQUILIBRIUM_MEANING}


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
