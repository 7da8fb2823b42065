"""A sweep: a model over a grid of values, integrated chunk by chunk."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import ModuleType

import numpy as np

from delagrange import checks, engines, loss
from delagrange.drive import Drive, Sine
from delagrange.engines import Engine, Numerics
from delagrange.grid import Grid, make_grid
from delagrange.initial import PREFIX, checked_initial, initial_units, state_at_start
from delagrange.lanes import Interrupted, Outcome, Sampling, Settings, empty_outcome
from delagrange.loss import Limits
from delagrange.measures import Measures
from delagrange.memory import check_memory, lanes_at_a_time
from delagrange.parameters import CHANGEABLE_UNITS, Parameters, check_material_names
from delagrange.problem import Problem, make_problem
from delagrange.progress import Progress, progress_bar
from delagrange.sampling import make_sampling
from delagrange.step_control import step_control
from delagrange.tableau import Tableau, tableau
from delagrange.tolerances import check_duration, check_tolerances, check_window

INPUT_UNITS: Mapping[str, str] = {"force": "N", "field_amplitude": "V/m", "field_bias": "V/m"}
PHASE_UNITS: Mapping[str, str] = {"field_phase": "rad"}
POSITIVE_UNITS: Mapping[str, str] = {"held_stretch": "1", **CHANGEABLE_UNITS, "frequency": "Hz"}
LARGEST_INPUT = 1e15  # [N] or [V/m]; beyond, squares leave double precision and a run would never end
SWEEP_UNITS: Mapping[str, str] = {**INPUT_UNITS, **PHASE_UNITS, **POSITIVE_UNITS}


@dataclass(frozen=True)
class Sweep:
    """A sweep, ready to run."""

    model: ModuleType
    parameters: Parameters
    grid: Grid
    force_drive: Drive | None  # the force, where it is a drive and not values of the grid
    measures: Measures
    settings: Settings
    engine: Engine

    @property
    def sample_count(self) -> int:
        """Samples of the state that are kept of every run."""
        return self.measures.sample_count(self.settings.duration)

    def problem(self, lanes: slice) -> Problem:
        """The problem of some of the lanes."""
        lane_values = self.grid.lane_values(lanes)
        values = {name: value for name, value in lane_values.items() if not name.startswith(PREFIX)}
        force = values.pop("force", self.force_drive)
        field = Sine(
            values.pop("field_amplitude"),
            values.pop("frequency"),
            values.pop("field_bias"),
            values.pop("field_phase"),
        )
        held_stretch = values.pop("held_stretch", None)
        return make_problem(self.model, self.parameters, values, held_stretch, force, field)

    def sampling(self, lanes: slice) -> Sampling | None:
        """When the state of some of the lanes is kept, or None where it is not."""
        values = self.grid.lane_values(lanes)
        return make_sampling(
            self.measures, self.settings.duration, values["frequency"], values["field_phase"]
        )

    def initial_state(self, lanes: slice, problem: Problem) -> np.ndarray:
        """State of some of the lanes, those of `problem`, at t = 0, (n_state, n_lanes)."""
        state = np.asarray(self.model.reference_state(problem.parameters), dtype=float)
        state = state.reshape(len(state), -1)
        reference = np.broadcast_to(state, (len(state), lanes.stop - lanes.start))
        return state_at_start(self.model, reference, self.grid.lane_values(lanes))

    def field_sampling(self) -> tuple[dict[str, int], Sampling | None]:
        """The samples over the axes of the field alone, on which their times depend, with the axes' lengths."""
        axes = {name: self.grid.axes[name] for name in _TIMING if name in self.grid.axes}
        phase = axes.get("field_phase", self.grid.single.get("field_phase"))
        phases, frequencies = (
            along.ravel() for along in np.meshgrid(phase, axes["frequency"], indexing="ij")
        )
        sampling = make_sampling(self.measures, self.settings.duration, frequencies, phases)
        return {name: len(values) for name, values in axes.items()}, sampling


def make_sweep(
    model: ModuleType,
    parameters: Parameters,
    values: Mapping[str, object],
    settings: Settings,
    engine: str,
    measures: Measures,
    initial: Mapping[str, object] | None = None,
) -> Sweep:
    """A sweep over `values`: inputs, held stretch (or None), material and frequency by name.

    initial: values of the state at t = 0 by name, where they are not those of the reference state

    Raises:
        ValueError: an unknown name, a value that is not finite or positive as it must be, a grid that is
            not in order, a force or held stretch that the model has no place for, or a result that is
            too large.
    """
    given = dict(values)
    if given["held_stretch"] is None:
        del given["held_stretch"]
    force_drive = given.pop("force") if isinstance(given["force"], Drive) else None
    if force_drive is not None and np.ndim(force_drive.at(0.0)) > 0:
        raise ValueError(
            f"force {force_drive} [N] is a drive with arrays; give plain values of force for an axis"
        )
    check_material_names({name: value for name, value in given.items() if name not in _NO_MATERIAL})
    checked = {name: _checked(name, value) for name, value in given.items()}
    frequency = {"frequency": checked.pop("frequency")}  # the last axis
    units = SWEEP_UNITS | initial_units(model)
    grid = make_grid(checked | checked_initial(model, initial) | frequency, units, "frequency")
    sweep = Sweep(model, parameters, grid, force_drive, measures, settings, engines.ENGINES[engine])
    sweep.field_sampling()  # refuses what cannot be sampled, before anything runs
    check_memory(model, grid.size, sweep.sample_count)
    for entry, drive in zip(model.INPUTS, sweep.problem(slice(0, 1)).drives):
        drive.check_window(entry.name, 0.0, settings.duration)
    return sweep


_TIMING = ("field_phase", "frequency")
_NO_MATERIAL = (*INPUT_UNITS, *PHASE_UNITS, "held_stretch", "frequency")


def _checked(name: str, value: object) -> float | np.ndarray:
    if name == "frequency":
        value = checks.increasing(name, value, "Hz")
    check = checks.positive if name in POSITIVE_UNITS else checks.finite
    checked = check(name, value, SWEEP_UNITS[name])
    if name in INPUT_UNITS and np.max(np.abs(checked), initial=0.0) > LARGEST_INPUT:
        allowed = f"from {-LARGEST_INPUT:g} to {LARGEST_INPUT:g} {SWEEP_UNITS[name]}"
        raise ValueError(f"{name} must lie {allowed}, got {np.max(np.abs(checked)):g} {SWEEP_UNITS[name]}")
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
) -> Settings:
    """The settings of a sweep, checked.

    Raises:
        ValueError: a value out of range.
    """
    if not isinstance(limits, Limits):
        raise ValueError(f"limits must be a delagrange.Limits, got {limits!r}")
    duration = check_duration(duration)
    rtol, atol = check_tolerances(rtol, atol)
    return Settings(
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
    """The pair of the method; a compiled kernel carries its own."""
    if numerics.engine == "compiled":
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
