"""Dynamic pull-in: the field, or charge, that, applied suddenly, a membrane at rest does not stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.rest.arguments import FROZEN_MEANING, Cases, first_coordinate, make_cases
from delagrange.analysis.rest.criteria import material
from delagrange.analysis.rest.energy_barrier import barrier_at_start_energy
from delagrange.analysis.rest.sudden_field import ATOL, FINEST, RTOL, Bracket, bracket_by_integration
from delagrange.common import checks
from delagrange.drives.inputs import CURRENT_DENSITY, ELECTRIC_FIELD, Inputs
from delagrange.engines.engines import AUTO, ENGINES
from delagrange.equilibrium.branches import at_zero_field, connected_pieces
from delagrange.equilibrium.continuation import Lost, parameter_of
from delagrange.equilibrium.pieces import FOLD, Piece, point_at
from delagrange.equilibrium.statics import Statics
from delagrange.equilibrium.vibration import vibration
from delagrange.model.load import check_offers
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import EVOLVING, FROZEN, RELAXED, is_damped, leak_rate
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits
from delagrange.problem.tolerances import check_duration
from delagrange.run.run_dataset import variable

REFERENCE, EQUILIBRIUM = "reference", "equilibrium"
_PERIODS = 200  # of the slowest vibration at the start
_FEW_PERIODS = 20  # where the integration only says what becomes of a membrane that passes the barrier
_FINE, _COARSE = (
    1e-7,
    1e-2,
)  # resolutions that a map takes: of what integration gives, and of what energy gives
_LEAKING = 20.0  # times in which a charge leaks to 1/e, after which it rests
_MOST_LEAKING = 50.0  # of the time for the vibration
_BEYOND = 1.05  # of the static pull-in: there nothing holds the membrane
ENERGY, INTEGRATION = "energy", "integration"
FOUND, SNAP, NO_BARRIER, NOT_LOST, FORCE_ALONE, NO_START = (
    "dynamic pull-in", "dynamic snap-through", "no barrier", "not lost up to the largest field",
    "lost under the force alone", "no equilibrium without field",
)  # fmt: skip
_STATUS_MEANING = (
    f"{FOUND}: between the fields of the bracket; {SNAP}: the barrier is passed at the field by energy, and the "
    f"solution is not lost; {NO_BARRIER}: there is no unstable equilibrium to climb, and "
    "from the field of the bracket on a stretch passes its limit, or a strain energy comes so near its own that "
    f"no step resolves the motion; {NOT_LOST}: within the duration; "
    f"{FORCE_ALONE}: without any field; {NO_START}: there is nothing to start from"
)
_METHOD_MEANING = (
    f"{ENERGY}: with one coordinate and frozen dashpots the energy is kept, and the membrane turns back before "
    f"the unstable equilibrium exactly as long as that lies higher than the start; {INTEGRATION}: with two "
    "coordinates the barrier is a pass, and only a motion that finds it goes over, so that energy gives a "
    "lower bound alone; with evolving dashpots energy is lost"
)


@dataclass(frozen=True)
class _Integration:
    """What was chosen of the runs."""

    dashpots: str
    start: str
    duration: float | None  # [s]
    resolution: float | None
    engine: str

    def width(self, exact: bool) -> float:
        """Resolution of the bracket, where energy gives the field exactly or does not."""
        if self.resolution is not None:
            return self.resolution
        return _COARSE if exact else _FINE

    def periods(self, exact: bool) -> int:
        """Periods of the slowest vibration that a run lasts, where no duration is given."""
        return _FEW_PERIODS if exact and self.resolution is None else _PERIODS


@dataclass(frozen=True)
class Critical:
    """The critical field of one case, or charge [C/m^2] under charge control; NaN where there is none."""

    status: str
    method: str
    field_by_energy: float  # [V/m]
    stretch: float  # first coordinate [1] of the unstable equilibrium at the critical field
    static_field: float  # [V/m]
    duration: float  # [s]
    bracket: Bracket

    @property
    def field(self) -> float:
        """By energy where that is exact, else by integration."""
        return self.field_by_energy if self.method == ENERGY else self.bracket.middle


def dynamic_pull_in(
    model: str | ModuleType,
    *,
    force: float | np.ndarray = 0.0,
    inputs: Inputs | None = None,
    dashpots: str = "frozen",
    start: str = "reference",
    duration: float | None = None,
    resolution: float | None = FINEST,
    held_stretch: float | np.ndarray | None = None,
    engine: str = AUTO,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    limits: Limits | None = None,
    **material_changes: float | np.ndarray,
) -> xr.Dataset:
    """The critical field of dynamic pull-in: a constant field applied at t = 0 to a membrane at rest.

    With one coordinate and frozen dashpots the energy gives it exactly. In any case it is found by integration:
    the smallest field, of a grid refined again and again, at which the solution is lost within the duration.
    Each of force, held stretch and material may be a one-dimensional array, and is then a dimension.

    Args:
        force: on each loaded edge [N], applied together with the field, or there before it.
        inputs: of any other input but the field by its name, as {"force_2": 0.3}, numbers or arrays; each grows
            from zero before the field, in the order of the model's inputs. The electrical input is what varies.
        dashpots: "frozen" as in the reference state or `initial_state`; or "evolving" from there (or from rest
            with start "equilibrium"): by integration alone.
        start: "reference", in the reference state or `initial_state`; or "equilibrium", under the force alone.
        duration: of each run [s]; left out, 200 periods of the slowest vibration at the start, and long enough for a
            charge that a current feeds to come to rest.
        resolution: width of the bracket of the integration over the field in it, 1e-11 to 1e-2. None, as a map
            has it: 1e-7, and where energy gives the field 1e-2 with runs of 20 periods, which tell what becomes of
            a membrane that passes the barrier and no more.
        engine: of the integration, as in `frequency_response`.
        others: as in `pull_in`.

    Returns:
        Dataset over the arrays given: `field` [V/m]; `stretch` of the unstable equilibrium there (dashpots as at
        the start), which a motion of one coordinate reaches exactly and has to pass; `method`;
        `field_by_energy` (one coordinate) or `field_by_energy_bound`, below which no motion gets over the
        barrier (two coordinates); `field_by_integration` with `bracket_width`; `static_field`; `found`. A charge
        [C/m^2] or current [A/m^2] that drives a model stands for the field: `nominal_charge_density`,
        `nominal_charge_density_by_integration`, `static_nominal_charge_density` and so on, and there is no voltage;
        a current gives no energy.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    checks.choice("dashpots", dashpots, (FROZEN, EVOLVING))
    checks.choice("start", start, (REFERENCE, EQUILIBRIUM))
    checks.choice("engine", engine, (AUTO, *ENGINES))
    duration = None if duration is None else check_duration(duration)
    if resolution is not None:
        resolution = checks.within("resolution", resolution, "1", FINEST, 1e-2)
    values = {"force": force, "held_stretch": held_stretch, **material_changes}
    cases = make_cases(model, formulation, lateral_dashpot, parameters, initial_state, limits, values, inputs)
    check_offers(cases.model, ("potential_energy",), "dynamic pull-in")
    integration = _Integration(dashpots, start, duration, resolution, engine)
    found = [_critical(cases, problem, integration) for problem in cases.problems()]
    attributes = cases.attributes(dashpots) | {
        "definition": "constant field applied at t = 0 to the membrane at rest",
        "start": start,
        "dashpots_meaning": f"{FROZEN_MEANING}; evolving: they flow as the membrane moves",
        "rtol": RTOL,
        "atol": ATOL,
        "integration_engine": found[0].bracket.engine,
    }
    return xr.Dataset(_variables(cases, found, dashpots), coords=cases.coordinates(), attrs=attributes)


def _critical(cases: Cases, problem: Problem, how: _Integration) -> Critical:
    frozen = cases.statics(problem, FROZEN)
    conservative = how.dashpots == FROZEN and not is_damped(frozen.problem)
    exact = conservative and cases.model.COORDINATE_COUNT == 1
    method = ENERGY if exact else INTEGRATION
    try:
        state = _start_state(cases, problem, frozen, how)
        frozen = replace(frozen, rest=state)
        pieces = connected_pieces(frozen, 0.0)
    except Lost:
        nothing = Bracket(np.nan, np.nan, "")
        return Critical(NO_START, method, np.nan, np.nan, np.nan, np.nan, nothing)
    barrier = barrier_at_start_energy(frozen, pieces, state) if conservative else None
    duration = how.duration or _default_duration(frozen, state, how.periods(exact))
    runs = frozen.problem if how.dashpots == FROZEN else problem
    largest = _BEYOND * pieces[0].high
    width = how.width(exact)
    bracket = bracket_by_integration(runs, state, largest, duration, cases.limits, how.engine, width)
    energy = np.nan if barrier is None else parameter_of(barrier)
    stretch = _barrier_stretch(frozen, pieces, energy if exact else bracket.middle)
    static = pieces[0].high if pieces[0].upper_end == FOLD else np.nan
    status = _status(bracket, exact, barrier is not None)
    return Critical(status, method, energy, stretch, static, duration, bracket)


def _barrier_stretch(statics: Statics, pieces: list[Piece], field: float) -> float:
    """The first stretch of the unstable equilibrium that meets the stable one at pull-in [1]; NaN without one."""
    if len(pieces) < 2 or not pieces[1].covers(field):
        return np.nan
    return float(statics.state(point_at(statics, pieces[1], field).x)[0])


def _start_state(cases: Cases, problem: Problem, frozen: Statics, how: _Integration) -> np.ndarray:
    """(n_state,), at rest."""
    if how.start == REFERENCE:
        return frozen.rest
    flows = cases.statics(problem, RELAXED)
    statics = flows if how.dashpots == EVOLVING else frozen
    return statics.state(at_zero_field(statics))


def _default_duration(statics: Statics, state: np.ndarray, periods: int) -> float:
    """So many periods of the slowest vibration, and until a charge that a current feeds has come to rest.

    Raises:
        ValueError: that takes far longer.
    """
    rates = vibration(statics, statics.x_of(state, 0.0)).rates
    vibrating = float(periods * 2 * np.pi / np.min(np.abs(rates)))
    if statics.charge is None:
        return vibrating
    leak = leak_rate(statics.problem)
    if _LEAKING / leak > _MOST_LEAKING * vibrating:
        raise ValueError(
            f"duration [s] must be given: the charge leaks within {1 / leak:.3g} s, far slower than the membrane "
            "vibrates, so that no current is sudden and pull_in says what it stands"
        )
    return max(vibrating, _LEAKING / leak)


def _status(bracket: Bracket, exact: bool, barrier: bool) -> str:
    if np.isnan(bracket.safe):
        return FORCE_ALONE
    if np.isnan(bracket.lost):
        return SNAP if exact and barrier else NOT_LOST
    return NO_BARRIER if exact and not barrier else FOUND


def _variables(cases: Cases, found: list[Critical], dashpots: str) -> dict[str, tuple]:
    dimensions, shape = tuple(cases.grid.axes), cases.grid.shape
    columns = _critical_numbers(cases, found) | _numbers_about(cases, found)
    if dashpots == FROZEN and cases.electrical is not CURRENT_DENSITY:
        columns |= _energy_numbers(cases, found)
    data = {
        name: variable(dimensions, np.array(values, dtype=float).reshape(shape), unit, long_name)
        for name, (unit, long_name, values) in columns.items()
    }
    for name, values, meaning in (
        ("method", [critical.method for critical in found], _METHOD_MEANING),
        ("found", [critical.status for critical in found], _STATUS_MEANING),
    ):
        array = np.array(values, dtype=object).reshape(shape)
        data[name] = dimensions, array, {"long_name": name, "meaning": meaning}
    return data


_Columns = dict[str, tuple[str, str, list[float] | np.ndarray]]  # unit, long name and values by name


def _critical_numbers(cases: Cases, found: list[Critical]) -> _Columns:
    electrical = cases.electrical
    fields = np.array([critical.field for critical in found])
    data = {electrical.argument: (electrical.unit, f"critical {electrical.text} of dynamic pull-in", fields)}
    if electrical is ELECTRIC_FIELD:
        thickness = 2 * np.array([material(problem, "half_thickness") for problem in cases.problems()])
        data["voltage"] = ("V", "critical voltage of dynamic pull-in", fields * thickness)
    return data


def _numbers_about(cases: Cases, found: list[Critical]) -> _Columns:
    electrical, first = cases.electrical, first_coordinate(cases.model)
    name, text, unit = electrical.argument, electrical.text, electrical.unit
    return {
        first: (
            "1",
            f"{first.replace('_', ' ')} of the unstable equilibrium at it",
            [critical.stretch for critical in found],
        ),
        f"{name}_by_integration": (
            unit,
            f"critical {text} by integration",
            [critical.bracket.middle for critical in found],
        ),
        "bracket_width": (unit, "width of its bracket", [critical.bracket.width for critical in found]),
        "duration": ("s", "duration of the runs", [critical.duration for critical in found]),
        f"static_{name}": (
            unit,
            f"{text} of static pull-in",
            [critical.static_field for critical in found],
        ),
    }


def _energy_numbers(cases: Cases, found: list[Critical]) -> _Columns:
    electrical = cases.electrical
    bound = "" if cases.model.COORDINATE_COUNT == 1 else "_bound"
    name = f"{electrical.argument}_by_energy{bound}"
    return {name: (electrical.unit, name.replace("_", " "), [critical.field_by_energy for critical in found])}
