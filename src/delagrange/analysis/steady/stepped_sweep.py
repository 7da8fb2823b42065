"""What an experimenter's sweep sees: the frequency stepped up or down, the motion carried on from step to step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange import checks, loss
from delagrange.analysis.rest.seeds import equilibria_at
from delagrange.analysis.rest.statics import FIELD, FORCE, Statics, make_statics
from delagrange.analysis.rest.vibration import growing_directions
from delagrange.analysis.steady.arguments import load_number, single_material
from delagrange.analysis.steady.shooting import LOAD_UNITS, sine_field
from delagrange.dashpots import FROZEN, RELAXED, given_state
from delagrange.dataset import run_attributes, status_time_variable, status_variable, variable
from delagrange.drive import Constant
from delagrange.flow import Flow, Path, typical_sizes
from delagrange.flows import resolve_flow
from delagrange.loss import COMPLETED, INTERRUPTED, Limits
from delagrange.models import load_model
from delagrange.parameters import SHENG_2015, Parameters
from delagrange.problem import Problem, make_problem
from delagrange.progress import Progress, progress_bar
from delagrange.units import with_unit

_TOLERANCES = (1e-14, 1e-6)
_LAST = "half of peak to peak over the last {measure} periods of the field at each frequency, after {settle} to settle"


@dataclass(frozen=True)
class _Sweep:
    """A sweep, ready to run."""

    path: Path
    flow: Flow
    load: Mapping[str, float]
    settle: int
    measure: int

    def at(self, frequency: float) -> Path:
        drives = {
            FORCE: Constant(self.load["force"]),
            FIELD: sine_field({**self.load, "frequency": frequency}),
        }
        problem = self.path.problem
        drives_in_order = tuple(drives[entry.name] for entry in problem.model.INPUTS)
        return replace(self.path, problem=replace(problem, drives=drives_in_order))


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
    field_amplitude: float,
    force: float = 0.0,
    field_bias: float = 0.0,
    dashpots: str = RELAXED,
    settle: int = 200,
    measure: int = 20,
    held_stretch: float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters = SHENG_2015,
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
    module = load_model(model, formulation, lateral_dashpot)
    frequencies = _frequencies(frequency)
    given = {"force": force, "field_amplitude": field_amplitude, "field_bias": field_bias}
    load = {name: load_number(name, value) for name, value in given.items()}
    material = single_material(material)
    field = sine_field({**load, "frequency": frequencies[0]})
    driven = make_problem(module, parameters, material, held_stretch, load["force"], field)
    resting = make_problem(module, parameters, material, held_stretch, load["force"], load["field_bias"])
    statics = make_statics(resting, dashpots, _standing(initial_state, module), limits)
    start = _start(statics, load) if initial_state is None else given_state(resting, initial_state)
    problem = replace(statics.problem, drives=driven.drives)
    sweep = _Sweep(
        path=Path(problem, typical_sizes(problem), checks.within("tolerance", tolerance, "1", *_TOLERANCES), limits),
        flow=resolve_flow(problem, engine),
        load=load,
        settle=checks.count("settle", settle, 0, 10_000_000),
        measure=checks.count("measure", measure, 1, 10_000_000),
    )  # fmt: skip
    with progress_bar(progress, f"{module.MODEL} stepped sweep", len(frequencies), "frequencies") as bar:
        found = _run(sweep, frequencies, start, bar)
    about = run_attributes(driven, parameters.replace(**material), limits)
    return _dataset(sweep, problem, frequencies, found, about | _attributes(sweep, dashpots))


def _frequencies(given: object) -> np.ndarray:
    values = np.atleast_1d(checks.positive("frequency", given, "Hz"))
    steps = np.diff(values)
    if values.ndim != 1 or not values.size or not (np.all(steps > 0) or np.all(steps < 0)):
        raise ValueError(
            "frequency must be strictly increasing or strictly decreasing, of at least one value, got "
            f"{with_unit(given, 'Hz')}"
        )
    return values


def _standing(initial_state: Mapping[str, float] | None, module: ModuleType) -> Mapping[str, float] | None:
    """Of the initial state what a membrane at rest can have: not its rates."""
    if not isinstance(initial_state, Mapping):
        return initial_state
    rates = {entry.name for entry in module.STATE[module.COORDINATE_COUNT : 2 * module.COORDINATE_COUNT]}
    return {name: value for name, value in initial_state.items() if name not in rates}


def _start(statics: Statics, load: Mapping[str, float]) -> np.ndarray:
    """The stable equilibrium nearest the reference state, (n_state,)."""
    resting = statics.varying(FIELD, force=load["force"])
    stable = [x for x in equilibria_at(resting, load["field_bias"]) if growing_directions(resting, x) == 0]
    if not stable:
        raise ValueError(
            f"no stable equilibrium under force = {load['force']:g} N and field_bias = {load['field_bias']:g} V/m "
            "to begin from; give initial_state"
        )
    return resting.state(min(stable, key=lambda x: float(np.sum(x[:-1] ** 2))))


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
    model, data = problem.model, {}
    amplitude = (found.maximum - found.minimum) / 2
    values = {"amplitude": amplitude, "maximum": found.maximum, "minimum": found.minimum}
    for place, entry in enumerate(model.STATE[: model.COORDINATE_COUNT]):
        for what, numbers in values.items():
            name, long_name = f"{entry.name}_{what}" if place else what, f"{what} of the {entry.meaning}"
            data[name] = variable(
                "frequency",
                numbers[place],
                entry.unit,
                long_name,
                entry.symbol,
                definition=_definition(sweep),
            )
    for entry, numbers in zip(model.STATE, found.state):
        long_name = f"{entry.meaning}, at the end of the step"
        data[f"final_{entry.name}"] = variable("frequency", numbers, entry.unit, long_name, entry.symbol)
    data["status"] = status_variable("frequency", found.status)
    data["status_time"] = status_time_variable("frequency", found.status_time)
    coordinate = variable("frequency", frequencies, "Hz", "frequency of the electric field", "f")
    return xr.Dataset(data, coords={"frequency": coordinate}, attrs=attributes)


def _definition(sweep: _Sweep) -> str:
    return _LAST.format(measure=sweep.measure, settle=sweep.settle)


def _attributes(sweep: _Sweep, dashpots: str) -> dict[str, object]:
    note = (
        "nothing damps: every step adds a free vibration that stays"
        if dashpots == FROZEN
        else "dashpots damp"
    )
    return {
        "nominal_electric_field_drive": "field_bias + field_amplitude * sin(2 pi frequency t)",
        **{name: value for name, value in sweep.load.items()},
        **{f"{name}_units": LOAD_UNITS[name] for name in sweep.load},
        "dashpots": dashpots,
        "dashpots_note": note,
        "definition": _definition(sweep),
        "settle_periods": sweep.settle,
        "measure_periods": sweep.measure,
        "tolerance": sweep.path.tolerance,
    }
