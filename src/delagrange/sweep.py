"""A sweep: a model over a grid of values, integrated chunk by chunk."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import ModuleType

import numpy as np

from delagrange import checks, loss
from delagrange.drive import Drive, Sine
from delagrange.ensemble import Report, integrate_lanes
from delagrange.extrema import EXTREMA
from delagrange.grid import Grid, make_grid
from delagrange.lanes import Interrupted, Outcome, Settings, empty_outcome
from delagrange.loss import Limits
from delagrange.oracle import integrate_one_by_one
from delagrange.parameters import CHANGEABLE_UNITS, Parameters, check_material_names
from delagrange.problem import Problem, make_problem
from delagrange.progress import Progress, progress_bar
from delagrange.step_control import STEP_CONTROLS, step_control
from delagrange.tableau import tableau
from delagrange.tolerances import check_duration, check_tolerances, check_window

INPUT_UNITS: Mapping[str, str] = {"force": "N", "field_amplitude": "V/m", "field_bias": "V/m"}
POSITIVE_UNITS: Mapping[str, str] = {"held_stretch": "1", **CHANGEABLE_UNITS, "frequency": "Hz"}
LARGEST_INPUT = 1e15  # [N] or [V/m]; beyond, squares leave double precision and a run would never end
SWEEP_UNITS: Mapping[str, str] = {**INPUT_UNITS, **POSITIVE_UNITS}


@dataclass(frozen=True)
class Engine:
    """A way to integrate lanes, and how many of them it should be given at a time."""

    integrate: Callable[[Problem, np.ndarray, Settings, Report], Outcome]
    chunk: int  # for "numpy" long enough to spread the cost of a call, short enough for the cache


ENGINES: Mapping[str, Engine] = {
    "numpy": Engine(integrate_lanes, 4096),
    "scipy": Engine(integrate_one_by_one, 4096),
}


@dataclass(frozen=True)
class Sweep:
    """A sweep, ready to run."""

    model: ModuleType
    parameters: Parameters
    grid: Grid
    force_drive: Drive | None  # the force, where it is a drive and not values of the grid
    settings: Settings
    engine: Engine

    def problem(self, lanes: slice) -> Problem:
        """The problem of some of the lanes."""
        values = self.grid.lane_values(lanes)
        force = values.pop("force", self.force_drive)
        field = Sine(values.pop("field_amplitude"), values.pop("frequency"), values.pop("field_bias"))
        held_stretch = values.pop("held_stretch", None)
        return make_problem(self.model, self.parameters, values, held_stretch, force, field)


def make_sweep(
    model: ModuleType,
    parameters: Parameters,
    values: Mapping[str, object],
    settings: Settings,
    engine: str,
) -> Sweep:
    """A sweep over `values`: inputs, held stretch (or None), material and frequency by name.

    Raises:
        ValueError: an unknown name, a value that is not finite or positive as it must be, a grid that is
            not in order, or a force or held stretch that the model has no place for.
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
    grid = make_grid({name: _checked(name, value) for name, value in given.items()}, SWEEP_UNITS, "frequency")
    sweep = Sweep(model, parameters, grid, force_drive, settings, ENGINES[engine])
    for entry, drive in zip(model.INPUTS, sweep.problem(slice(0, 1)).drives):
        drive.check_window(entry.name, 0.0, settings.duration)
    return sweep


_NO_MATERIAL = (*INPUT_UNITS, "held_stretch", "frequency")


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
    method: str,
    engine: str,
    control: str,
    extrema: str,
    limits: Limits,
) -> Settings:
    """The numerics of a sweep, checked.

    Raises:
        ValueError: a value out of range, or choices that do not go together.
    """
    if not isinstance(limits, Limits):
        raise ValueError(f"limits must be a delagrange.Limits, got {limits!r}")
    duration = check_duration(duration)
    rtol, atol = check_tolerances(rtol, atol)
    checks.choice("method", method, ("DOP853", "RK45"))
    checks.choice("engine", engine, tuple(ENGINES))
    checks.choice("step_control", control, STEP_CONTROLS)
    checks.choice("extrema", extrema, EXTREMA)
    if control == "ode45" and method != "RK45":
        raise ValueError(f"step_control 'ode45' belongs to method 'RK45', got method {method!r}")
    if engine == "scipy" and (control, extrema) != ("scipy", "dense"):
        raise ValueError(
            f"engine 'scipy' has step_control 'scipy' and extrema 'dense' only, got {control!r}, {extrema!r}"
        )
    pair = tableau("RK45_MATLAB" if control == "ode45" else method)
    controller = step_control(control, rtol, atol, duration)
    return Settings(pair, controller, duration, check_window(window, duration), limits, extrema)


def run_sweep(sweep: Sweep, progress: bool) -> Outcome:
    """Integrate all lanes; interrupted from the keyboard, warn and return what is done so far."""
    size, model = sweep.grid.size, sweep.model
    outcome = empty_outcome(np.empty((len(model.STATE), size)), model.COORDINATE_COUNT, loss.INTERRUPTED)
    with progress_bar(progress, f"{model.MODEL} response", size, "runs") as bar:
        try:
            for lanes in _chunks(size, sweep.engine.chunk):
                outcome.place_into(lanes, _integrated(sweep, lanes, bar))
                bar.advance_to(lanes.stop)
        except Interrupted as stopped:
            outcome.place_into(lanes, stopped.outcome)
            left = int(np.sum(outcome.status == loss.INTERRUPTED))
            warnings.warn(
                f"interrupted: {left} of {size} runs not computed, as their status says", stacklevel=3
            )
    return outcome


def _integrated(sweep: Sweep, lanes: slice, bar: Progress) -> Outcome:
    problem, state = _chunk(sweep, lanes)
    return sweep.engine.integrate(
        problem, state, sweep.settings, lambda done: bar.advance_to(lanes.start + done)
    )


def _chunks(size: int, length: int) -> Iterator[slice]:
    """Slices of equal length, as far as that goes, that cover `size` lanes."""
    count = -(-size // length)
    bounds = [size * place // count for place in range(count + 1)]
    return (slice(start, stop) for start, stop in pairwise(bounds))


def _chunk(sweep: Sweep, lanes: slice) -> tuple[Problem, np.ndarray]:
    """The problem of some of the lanes and their initial state, (n_state, n_lanes)."""
    problem = sweep.problem(lanes)
    state = np.asarray(sweep.model.reference_state(problem.parameters), dtype=float)
    state = state.reshape(len(state), -1)
    return problem, np.array(np.broadcast_to(state, (len(state), lanes.stop - lanes.start)))
