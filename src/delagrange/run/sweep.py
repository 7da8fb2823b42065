"""A sweep: a model over a grid of values, integrated chunk by chunk."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.memory import check_memory, lanes_at_a_time
from delagrange.common.progress import Progress, progress_bar
from delagrange.drives.drive import Drive, Sine
from delagrange.drives.inputs import (
    ELECTRIC_FIELD,
    ELECTRICAL,
    FIELD,
    FORCE,
    ElectricalInput,
    Inputs,
    given_twice,
    has_input,
    input_name,
    is_zero,
    named_inputs,
)
from delagrange.drives.sines import PHASE_UNITS, SIZE_UNITS, frequency_axis, sine_names
from delagrange.engines import engines
from delagrange.engines.engines import Engine, Numerics
from delagrange.engines.lanes import Interrupted, Outcome, RunSettings, Sampling, empty_outcome
from delagrange.engines.step_control import step_control
from delagrange.engines.tableau import Tableau, tableau
from delagrange.equilibrium.start import before_the_field, loaded_equilibrium
from delagrange.model.material import Material
from delagrange.model.parameters import CHANGEABLE_UNITS
from delagrange.problem import status as loss
from delagrange.problem.initial import (
    PREFIX,
    checked_initial,
    initial_units,
    is_equilibrium,
    state_at_start,
)
from delagrange.problem.problem import Problem, Specimen
from delagrange.problem.status import Limits
from delagrange.problem.tolerances import check_duration, check_tolerances, check_window
from delagrange.run.grid import Grid, make_grid
from delagrange.run.measures import Measures
from delagrange.run.sampling import make_sampling

INPUT_UNITS: Mapping[str, str] = {"force": "N", **SIZE_UNITS}
POSITIVE_UNITS: Mapping[str, str] = {"held_stretch": "1", **CHANGEABLE_UNITS, "frequency": "Hz"}
LARGEST_INPUT = 1e15  # [N] or [V/m]; beyond, squares leave double precision and a run would never end
SWEEP_UNITS: Mapping[str, str] = {**INPUT_UNITS, **PHASE_UNITS, **POSITIVE_UNITS}


@dataclass(frozen=True)
class Sweep:
    """A sweep, ready to run."""

    specimen: Specimen
    grid: Grid
    drives: Mapping[str, Drive]  # of inputs by name, where they are drives and not values of the grid
    measures: Measures
    settings: RunSettings
    engine: Engine
    electrical: ElectricalInput = ELECTRIC_FIELD  # which the sine drives
    equilibria: np.ndarray | None = None  # (n_state, *grid.shape but 1 where nothing depends on the axis)

    @property
    def model(self) -> ModuleType:
        """The model of all runs."""
        return self.specimen.model

    @property
    def sample_count(self) -> int:
        """Samples of the state that are kept of every run."""
        return self.measures.sample_count(self.settings.duration)

    def problem(self, lanes: slice) -> Problem:
        """The problem of some of the lanes."""
        lane_values = self.grid.lane_values(lanes)
        values = {name: value for name, value in lane_values.items() if not name.startswith(PREFIX)}
        names = [entry.name for entry in self.model.INPUTS]
        others = {name: values.pop(name) for name in names if name in values and name != FORCE}
        force = self.drives.get(FORCE, values.pop(FORCE, 0.0))
        others |= {name: drive for name, drive in self.drives.items() if name != FORCE}
        amplitude, bias, phase = (values.pop(name) for name in sine_names(self.electrical))
        field = Sine(amplitude, values.pop("frequency"), bias, phase)
        if self.electrical is not ELECTRIC_FIELD:
            field, others = 0.0, others | {self.electrical.name: field}
        held_stretch = values.pop("held_stretch", None)
        return self.specimen.problem(values, held_stretch, force, field, others)

    def sampling(self, lanes: slice) -> Sampling | None:
        """When the state of some of the lanes is kept, or None where it is not."""
        values = self.grid.lane_values(lanes)
        return make_sampling(
            self.measures, self.settings.duration, values["frequency"], values[self.electrical.phase]
        )

    def initial_state(self, lanes: slice, problem: Problem) -> np.ndarray:
        """State of some of the lanes, those of `problem`, at t = 0, (n_state, n_lanes)."""
        if self.equilibria is not None:
            places = np.unravel_index(np.arange(lanes.start, lanes.stop), self.grid.shape)
            along = zip(places, self.equilibria.shape[1:])
            return self.equilibria[:, *(place if length > 1 else 0 * place for place, length in along)]
        state = np.asarray(self.model.reference_state(problem.parameters), dtype=float)
        state = state.reshape(len(state), -1)
        reference = np.broadcast_to(state, (len(state), lanes.stop - lanes.start))
        return state_at_start(self.model, reference, self.grid.lane_values(lanes))

    def field_sampling(self) -> tuple[dict[str, int], Sampling | None]:
        """The samples over the axes of the sine alone, on which their times depend, with the axes' lengths."""
        name = self.electrical.phase
        axes = {name: self.grid.axes[name] for name in (name, "frequency") if name in self.grid.axes}
        phase = axes.get(name, self.grid.single.get(name))
        phases, frequencies = (
            along.ravel() for along in np.meshgrid(phase, axes["frequency"], indexing="ij")
        )
        sampling = make_sampling(self.measures, self.settings.duration, frequencies, phases)
        return {name: len(values) for name, values in axes.items()}, sampling


def make_sweep(
    specimen: Specimen,
    values: Mapping[str, object],
    settings: RunSettings,
    engine: str,
    measures: Measures,
    initial: Mapping[str, object] | str | None = None,
    inputs: Inputs | None = None,
    electrical: ElectricalInput = ELECTRIC_FIELD,
) -> Sweep:
    """A sweep over `values`: force and sine, held stretch (or None), material and frequency by name.

    initial: values of the state at t = 0 by name, where they are not those of the reference state, or "equilibrium"
    inputs: values or drives of any other input by name
    electrical: what the sine drives

    Raises:
        ValueError: an unknown name, a value that is not finite or positive as it must be, a grid that is
            not in order, a force or held stretch that the model has no place for, a result that is
            too large, or loads without an equilibrium to start at.
    """
    model, material = specimen.model, specimen.material
    at_rest = is_equilibrium(model, initial)
    given = _with_inputs(model, dict(values), inputs, electrical)
    if given["held_stretch"] is None:
        del given["held_stretch"]
    units = {entry.name: entry.unit for entry in model.INPUTS}
    drives = {name: given.pop(name) for name in (FORCE, *units) if isinstance(given.get(name), Drive)}
    _refuse_arrays(drives, {FORCE: "N", **units})
    others = (*_NO_MATERIAL, *units)
    material.check_names({name: value for name, value in given.items() if name not in others})
    units |= {**SWEEP_UNITS, **material.units, **initial_units(model)}
    checked = {name: _checked(name, value, units[name], material) for name, value in given.items()}
    material.check_grid(checked)
    frequency = {"frequency": checked.pop("frequency")}  # the last axis
    start = {} if at_rest else checked_initial(model, initial)
    grid = make_grid(checked | start | frequency, units, "frequency")
    sweep = Sweep(specimen, grid, drives, measures, settings, engines.ENGINES[engine], electrical)
    sweep.field_sampling()  # refuses what cannot be sampled, before anything runs
    check_memory(model, grid.size, sweep.sample_count)
    for entry, drive in zip(model.INPUTS, sweep.problem(slice(0, 1)).drives):
        drive.check_window(entry.name, 0.0, settings.duration)
    return replace(sweep, equilibria=_equilibria(sweep)) if at_rest else sweep


def _equilibria(sweep: Sweep) -> np.ndarray:
    """The loaded equilibrium at the start of every run, solved once for all runs that have it in common.

    Returns:
        (n_state, *grid.shape), with length 1 along the axes on which it does not depend

    Raises:
        ValueError: there is none; the message names the load.
    """
    idle = {*sine_names(sweep.electrical), "frequency", *ELECTRICAL}
    axes = {name: values if name not in idle else values[:1] for name, values in sweep.grid.axes.items()}
    table = replace(sweep, grid=replace(sweep.grid, axes=axes))
    problem = before_the_field(table.problem(slice(0, table.grid.size)))
    states = [
        loaded_equilibrium(problem.take(lane), sweep.settings.limits) for lane in range(table.grid.size)
    ]
    return np.array(states).T.reshape(-1, *table.grid.shape)


def _with_inputs(
    model: ModuleType, given: dict[str, object], inputs: Inputs | None, electrical: ElectricalInput
) -> dict[str, object]:
    """The values with those of the inputs by name behind the force.

    Raises:
        ValueError: as `named_inputs` of drives; the field or what else the sine drives, which has its own arguments.
    """
    others = named_inputs(model, inputs)
    for name in (FIELD, electrical.name):
        if name in others:
            arguments = ", ".join(sine_names(ELECTRIC_FIELD if name == FIELD else electrical))
            raise ValueError(f"{input_name(name)} is given by {arguments} and frequency here, not by inputs")
    if FORCE in others and not is_zero(given[FORCE]):
        raise given_twice(FORCE, given[FORCE])
    force = {FORCE: given.pop(FORCE)}
    if FORCE in others or (is_zero(force[FORCE]) and not has_input(model, FORCE)):
        force = {}
    return force | others | given


def _refuse_arrays(drives: Mapping[str, Drive], units: Mapping[str, str]) -> None:
    for name, drive in drives.items():
        if np.ndim(drive.at(0.0)) > 0:
            raise ValueError(
                f"{name} {drive} [{units[name]}] is a drive with arrays; give plain values of {name} for an axis"
            )


_NO_MATERIAL = (*INPUT_UNITS, *PHASE_UNITS, "held_stretch", "frequency")


def _checked(name: str, value: object, unit: str, material: Material) -> float | np.ndarray:
    if name in material.units:
        return material.checked(name, value)
    if name == "frequency":
        return frequency_axis(value)
    check = checks.positive if name in POSITIVE_UNITS else checks.finite
    checked = check(name, value, unit)
    is_input = name not in POSITIVE_UNITS and name not in PHASE_UNITS
    if is_input and np.max(np.abs(checked), initial=0.0) > LARGEST_INPUT:
        allowed = f"from {-LARGEST_INPUT:g} to {LARGEST_INPUT:g} {unit}"
        raise ValueError(f"{name} must lie {allowed}, got {np.max(np.abs(checked)):g} {unit}")
    return checked


def make_settings(
    duration: float,
    window: tuple[float, float] | None,
    rtol: float,
    atol: float,
    numerics: Numerics,
    limits: Limits,
    averages: bool = False,
    threads: int | None = None,
) -> RunSettings:
    """The settings of a sweep, checked.

    Raises:
        ValueError: a value out of range.
    """
    checks.instance("limits", limits, Limits)
    duration = check_duration(duration)
    rtol, atol = check_tolerances(rtol, atol)
    return RunSettings(
        tableau=_tableau(numerics),
        control=step_control(numerics.step_control, rtol, atol, duration),
        duration=duration,
        window=check_window(window, duration),
        limits=limits,
        extrema=numerics.extrema,
        averages=averages,
        threads=None if threads is None else checks.count("threads", threads, 1),
    )


def _tableau(numerics: Numerics) -> Tableau | None:
    """The pair of the method; compiled code carries its own."""
    if numerics.engine in ("compiled", "core"):
        return None
    return tableau("RK45_MATLAB" if numerics.step_control == "ode45" else numerics.method)


def run_sweep(sweep: Sweep, progress: bool) -> Outcome:
    """Integrate all lanes; interrupted from the keyboard, warn and return what is done so far."""
    size, model, samples = sweep.grid.size, sweep.model, sweep.sample_count
    room = np.broadcast_to(np.nan, (len(model.STATE), size))
    outcome = empty_outcome(room, model.COORDINATE_COUNT, loss.INTERRUPTED, samples)
    with progress_bar(progress, f"{model.MODEL} response", size, "runs") as bar:
        try:
            for lanes in _chunks(size, lanes_at_a_time(model, sweep.engine.chunk, samples)):
                outcome.place_into(lanes, _integrated(sweep, lanes, bar))
                bar.advance_to(lanes.stop)
        except Interrupted as stopped:
            outcome.place_into(lanes, stopped.outcome)
            unfinished = outcome.status == loss.INTERRUPTED
            outcome.samples[..., unfinished] = np.nan  # of lanes that had begun
            warnings.warn(
                f"interrupted: {np.sum(unfinished)} of {size} runs not computed, as their status says",
                stacklevel=3,
            )
    return outcome


def _integrated(sweep: Sweep, lanes: slice, bar: Progress) -> Outcome:
    problem = sweep.problem(lanes)
    return sweep.engine.integrate(
        problem,
        sweep.initial_state(lanes, problem),
        sweep.settings,
        sweep.sampling(lanes),
        lambda done: bar.advance_to(lanes.start + done),
    )


def _chunks(size: int, length: int) -> Iterator[slice]:
    """Slices of equal length, as far as that goes, that cover `size` lanes."""
    count = -(-size // length)
    bounds = [size * place // count for place in range(count + 1)]
    return (slice(start, stop) for start, stop in pairwise(bounds))
