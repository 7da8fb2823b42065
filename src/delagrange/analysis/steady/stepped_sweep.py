"""What an experimenter's sweep sees: the frequency stepped up or down, the motion carried on from step to step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.steady.arguments import TOLERANCE_RANGE, load_number, make_forced
from delagrange.analysis.steady.load import forces_of, under_load
from delagrange.common import checks
from delagrange.common.progress import Progress, progress_bar
from delagrange.drives.inputs import Inputs, electrical_input
from delagrange.drives.sines import LOAD_UNITS, frequency_axis, sine_long_names, sine_text
from delagrange.engines.flow import Flow, FlowPath
from delagrange.engines.flows import resolve_flow
from delagrange.equilibrium.seeds import equilibria_at
from delagrange.equilibrium.statics import Statics, make_statics, refuse_endless
from delagrange.equilibrium.vibration import growing_directions
from delagrange.model.parameters import Parameters
from delagrange.problem import status as loss
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import FROZEN, RELAXED, given_state, is_damped
from delagrange.problem.problem import Problem
from delagrange.problem.status import COMPLETED, INTERRUPTED, Limits
from delagrange.run.run_dataset import (
    coordinate_variables,
    run_attributes,
    state_variables,
    status_time_variable,
    status_variable,
    variable,
)

_LAST = "half of peak to peak over the last {measure} periods of the {stem} at each frequency, after {settle} to settle"


@dataclass(frozen=True)
class _Sweep:
    """A sweep, ready to run."""

    path: FlowPath
    flow: Flow
    load: Mapping[str, float]
    settle: int
    measure: int

    def at(self, frequency: float) -> FlowPath:
        load = {**self.load, "frequency": frequency}
        return replace(self.path, problem=under_load(self.path.problem, load))


@dataclass
class _Found:
    """What came out at every frequency."""

    maximum: np.ndarray  # (n_coordinates, n_frequencies) [1]
    minimum: np.ndarray
    state: np.ndarray  # (n_state, n_frequencies), at the end of the dwell, phase 0 of the field
    status: np.ndarray
    status_time: np.ndarray  # [s] since the beginning of the sweep


def stepped_sweep(
    model: str | ModuleType,
    *,
    frequency: np.ndarray,
    field_amplitude: float | None = None,
    charge_amplitude: float | None = None,
    current_amplitude: float | None = None,
    force: float = 0.0,
    inputs: Inputs | None = None,
    field_bias: float = 0.0,
    charge_bias: float = 0.0,
    current_bias: float = 0.0,
    dashpots: str = RELAXED,
    settle: int = 200,
    measure: int = 20,
    held_stretch: float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    tolerance: float = 1e-10,
    engine: str = "auto",
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    progress: bool = False,
    **material: float,
) -> xr.Dataset:
    """Amplitude under E = bias + amplitude sin(2 pi f t) while f is stepped through `frequency`, up or down.

    Every step lasts whole periods of the field, so that its phase is continuous, and begins with the state in
    which the one before ended. With dashpots that relax faster than `settle` periods the motion settles on a
    stable branch and jumps where that ends. With frozen dashpots nothing decays: every step adds a free vibration
    that stays, and the amplitude depends on the whole history of the sweep.

    Args:
        frequency: [Hz], strictly increasing or strictly decreasing.
        field_amplitude, field_bias: [V/m]; force: [N].
        charge_amplitude, charge_bias: of the nominal charge density [C/m^2], instead of those of the field, where
            that drives the model; current_amplitude, current_bias: of the nominal current density [A/m^2].
        inputs: constant values of any other input by its name.
        dashpots: "relaxed": they begin in equilibrium and then flow; "frozen".
        settle, measure: periods of the field at each frequency before the amplitude is taken, and while it is.
        initial_state: where the motion, and frozen dashpots, begin, by name, the rest as in the reference state;
            left out, at rest in the stable equilibrium under force and bias that is nearest the reference state.
        tolerance: of the flow, 1e-14 to 1e-6, in units of typical sizes of the state.
        engine, limits, model, held_stretch, formulation, lateral_dashpot, parameters, progress, material: as in
            `steady_response`.

    Returns:
        Dataset over `frequency`: `amplitude`, `maximum`, `minimum` [1] of the first stretch, of a second one as
        `stretch_2_amplitude` and so on, the state at the end of each step as `final_<state variable>`, `status`
        and `status_time` [s] since the beginning. After a loss, or an interruption from the keyboard, the
        other steps have the status "interrupted" and no amplitude.

    Raises:
        ValueError: something given makes no sense, or there is no stable equilibrium to begin from.
    """
    frequencies = frequency_axis(frequency, or_decreasing=True)
    sines = {
        "field_amplitude": field_amplitude, "field_bias": field_bias,
        "charge_amplitude": charge_amplitude, "charge_bias": charge_bias,
        "current_amplitude": current_amplitude, "current_bias": current_bias,
    }  # fmt: skip
    forced = make_forced(
        model, formulation, lateral_dashpot, parameters, sines, inputs, held_stretch, material, "a stepped sweep"
    )
    module, bias = forced.specimen.model, forced.electrical.bias
    load = {name: load_number(name, value) for name, value in {"force": force, **forced.sine}.items()}
    driven = forced.driven({**load, "frequency": frequencies[0]})
    resting = forced.problem(load["force"], load[bias])
    statics = make_statics(resting, dashpots, _standing(initial_state, module), limits)
    refuse_endless(statics, load[bias], "rest to begin from")
    start = _start(statics, load) if initial_state is None else given_state(resting, initial_state)
    problem = replace(statics.problem, drives=driven.drives)
    sweep = _Sweep(
        path=FlowPath(
            problem, typical_sizes(problem), checks.within("tolerance", tolerance, "1", *TOLERANCE_RANGE), limits
        ),
        flow=resolve_flow(problem, engine),
        load=load,
        settle=checks.count("settle", settle, 0, 10_000_000),
        measure=checks.count("measure", measure, 1, 10_000_000),
    )  # fmt: skip
    with progress_bar(progress, f"{module.MODEL} stepped sweep", len(frequencies), "frequencies") as bar:
        found = _run(sweep, frequencies, start, bar)
    about = run_attributes(driven, limits)
    return _dataset(sweep, problem, frequencies, found, about | _attributes(sweep, dashpots))


def _standing(initial_state: Mapping[str, float] | None, module: ModuleType) -> Mapping[str, float] | None:
    """Of the initial state what a membrane at rest can have: not its rates."""
    if not isinstance(initial_state, Mapping):
        return initial_state
    rates = {entry.name for entry in module.STATE[module.COORDINATE_COUNT : 2 * module.COORDINATE_COUNT]}
    return {name: value for name, value in initial_state.items() if name not in rates}


def _start(statics: Statics, load: Mapping[str, float]) -> np.ndarray:
    """The stable equilibrium nearest the reference state, (n_state,)."""
    electrical = statics.electrical
    resting = statics.varying(electrical.name, **forces_of(statics.problem, load))
    bias = load[electrical.bias]
    stable = [x for x in equilibria_at(resting, abs(bias)) if growing_directions(resting, x) == 0]
    if not stable:
        raise ValueError(
            f"no stable equilibrium under force = {load['force']:g} N and {electrical.bias} = "
            f"{bias:g} {electrical.unit} "
            "to begin from; give initial_state"
        )
    return resting.signed_state(min(stable, key=lambda x: float(np.sum(x[:-1] ** 2))), bias)


def _run(sweep: _Sweep, frequencies: np.ndarray, state: np.ndarray, bar: Progress) -> _Found:
    coordinates, count = sweep.path.problem.model.COORDINATE_COUNT, len(frequencies)
    found = _Found(
        maximum=np.full((coordinates, count), np.nan),
        minimum=np.full((coordinates, count), np.nan),
        state=np.full((len(state), count), np.nan),
        status=np.full(count, INTERRUPTED),
        status_time=np.full(count, np.nan),
    )
    elapsed = 0.0
    try:
        for place, frequency in enumerate(frequencies):
            state, elapsed = _dwell(sweep, frequency, state, found, place, elapsed)
            bar.advance_to(place + 1)
            if found.status[place] != COMPLETED:
                break
    except KeyboardInterrupt:
        pass
    return found


def _dwell(
    sweep: _Sweep, frequency: float, state: np.ndarray, found: _Found, place: int, elapsed: float
) -> tuple[np.ndarray, float]:
    """One step of the sweep: the state and the time at its end."""
    path = sweep.at(frequency)
    for periods in (sweep.settle, sweep.measure):
        if periods == 0:
            continue
        travel = sweep.flow(path, state, np.array([0.0, periods / frequency]))
        found.status[place], found.status_time[place] = travel.status, elapsed + travel.status_time
        if travel.status != loss.COMPLETED:
            return state, elapsed
        state, elapsed = travel.state[-1], elapsed + periods / frequency
    found.maximum[:, place], found.minimum[:, place] = travel.maximum, travel.minimum
    found.state[:, place] = state
    return state, elapsed


def _dataset(
    sweep: _Sweep, problem: Problem, frequencies: np.ndarray, found: _Found, attributes: dict[str, object]
) -> xr.Dataset:
    model, amplitude = problem.model, (found.maximum - found.minimum) / 2
    measured = {"amplitude": amplitude, "maximum": found.maximum, "minimum": found.minimum}
    about = {what: {"definition": _definition(sweep)} for what in measured}
    data = coordinate_variables(model, "frequency", measured, about)
    data |= state_variables(model, "frequency", found.state, "at the end of the step", "final_")
    data["status"] = status_variable("frequency", found.status)
    data["status_time"] = status_time_variable("frequency", found.status_time)
    long_name = sine_long_names(electrical_input(model))["frequency"]
    coordinate = variable("frequency", frequencies, "Hz", long_name, "f")
    return xr.Dataset(data, coords={"frequency": coordinate}, attrs=attributes)


def _definition(sweep: _Sweep) -> str:
    stem = electrical_input(sweep.path.problem.model).stem
    return _LAST.format(measure=sweep.measure, settle=sweep.settle, stem=stem)


def _attributes(sweep: _Sweep, dashpots: str) -> dict[str, object]:
    electrical = electrical_input(sweep.path.problem.model)
    note = (
        "nothing damps: every step adds a free vibration that stays"
        if dashpots == FROZEN and not is_damped(sweep.path.problem)
        else "dashpots, the medium or a leak damp"
    )
    return {
        f"{electrical.name}_drive": sine_text(electrical, phase=False),
        "varied_input": electrical.name,
        **{name: value for name, value in sweep.load.items()},
        **{f"{name}_units": LOAD_UNITS[name] for name in sweep.load},
        "dashpots": dashpots,
        "dashpots_note": note,
        "definition": _definition(sweep),
        "settle_periods": sweep.settle,
        "measure_periods": sweep.measure,
        "tolerance": sweep.path.tolerance,
    }
