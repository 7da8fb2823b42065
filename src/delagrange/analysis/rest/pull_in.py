"""Static pull-in: the field or charge at which the equilibrium of the unloaded membrane ceases to be."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.rest.arguments import (
    FROZEN_MEANING,
    RELAXED_MEANING,
    Cases,
    make_cases,
    resting_variables,
)
from delagrange.analysis.rest.criteria import (
    BREAKDOWN_DEFINITION,
    Criteria,
    breakdown_margin,
    material,
    negligible_force,
    tension_margin,
    true_field,
)
from delagrange.common import checks
from delagrange.drives.inputs import ELECTRIC_FIELD, ElectricalInput, Inputs
from delagrange.equilibrium.branches import LIMIT_MEANING, connected_pieces, limit_points, stable_until
from delagrange.equilibrium.continuation import Lost, Point, parameter_of
from delagrange.equilibrium.pieces import FOLD, Piece, locate_on
from delagrange.equilibrium.statics import Statics
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import FROZEN, RELAXED
from delagrange.problem.status import Limits
from delagrange.run.run_dataset import variable

NO_LIMIT = "no limit point up to the limits"
NO_EQUILIBRIUM = "no equilibrium without field"  # or charge
UNSTABLE = "loses stability before a limit point"
_TENSION, _BREAKDOWN, _NONE = "loss of tension", "electrical breakdown", "none"
_STATUS_MEANING = (
    f"{LIMIT_MEANING}; {NO_LIMIT}: the equilibrium stays stable until a stretch passes its limit, or as far as it was "
    "followed, to many times what would strain the membrane by 1, were it linear; "
    f"{UNSTABLE}: another branch crosses; "
    f"{NO_EQUILIBRIUM}: the membrane does not stand the force, or only with stretches beyond the limits"
)


@dataclass(frozen=True)
class Limit:
    """Where the branch of the unloaded membrane ends to be stable, and what happens before. NaN: nowhere."""

    status: str
    point: Point | None
    highest_field: float  # [V/m] that the branch reaches; a charge [C/m^2] under charge control, as all here
    loss_of_tension_field: float  # [V/m]
    breakdown_field: float  # [V/m], nominal

    @property
    def field(self) -> float:
        """Nominal field, or charge, of the limit."""
        return np.nan if self.point is None else parameter_of(self.point)

    @property
    def first(self) -> str:
        """What comes first as the field, or the charge, grows."""
        fields = {
            self.status: self.field,
            _TENSION: self.loss_of_tension_field,
            _BREAKDOWN: self.breakdown_field,
        }
        reached = {name: field for name, field in fields.items() if np.isfinite(field)}
        return min(reached, key=reached.get) if reached else _NONE


def pull_in(
    model: str | ModuleType,
    *,
    force: float | np.ndarray = 0.0,
    inputs: Inputs | None = None,
    dashpots: str = "frozen",
    held_stretch: float | np.ndarray | None = None,
    breakdown_field: float | None = None,
    breakdown_exponent: float = 0.0,
    smallest_tension: float = 0.0,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    limits: Limits | None = None,
    **material_changes: float | np.ndarray,
) -> xr.Dataset:
    """The critical field of static pull-in: a limit point of the equilibrium over a slowly growing field, or charge.

    Each of force, held stretch and material may be a one-dimensional array, and is then a dimension.

    Args:
        force: on each loaded edge [N], there before the field.
        inputs: of any other input but the field by its name, as {"force_2": 0.3}, numbers or arrays; each grows
            from zero before the field, in the order of the model's inputs. The electrical input is what varies.
        dashpots: "frozen", as in the reference state or `initial_state`: the field grows fast against relaxation,
            and slowly against vibration; or "relaxed", it grows slowly against both.
        breakdown_field, breakdown_exponent, smallest_tension: as in `equilibria`.
        others: as in `equilibria`.

    Returns:
        Dataset over the arrays given: `field` [V/m], `voltage`, `stretch` and the state variables at the limit
        point (NaN without one), `true_field`; `found`, the kind of limit or why there is none; `highest_field`,
        up to which the equilibrium goes; `loss_of_tension_field` and `breakdown_field_nominal`, the fields at which
        those happen on the way (NaN: not before); `first_limit`, whichever comes first. A charge [C/m^2] or current
        [A/m^2] that drives a model stands for the field: `nominal_charge_density`,
        `highest_nominal_charge_density`, `loss_of_tension_nominal_charge_density`,
        `breakdown_nominal_charge_density`; and there is no voltage. A current grows slowly against its leak, too.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    values = {"force": force, "held_stretch": held_stretch, **material_changes}
    cases = make_cases(model, formulation, lateral_dashpot, parameters, initial_state, limits, values, inputs)
    criteria = Criteria(breakdown_field, breakdown_exponent, smallest_tension)
    checks.choice("dashpots", dashpots, (FROZEN, RELAXED))
    found = []
    for problem in cases.problems():
        statics = cases.statics(problem, dashpots)
        found.append((statics, find_limit(statics, criteria)))
    return xr.Dataset(
        _variables(cases, found), coords=cases.coordinates(), attrs=_attributes(cases, dashpots, criteria)
    )


def find_limit(statics: Statics, criteria: Criteria) -> Limit:
    """The end of the branch of the unloaded membrane, and what happens on the way there."""
    try:
        pieces = connected_pieces(statics, 0.0)
    except Lost:
        return Limit(NO_EQUILIBRIUM, None, np.nan, np.nan, np.nan)
    first = pieces[0]
    status, point = _end(statics, pieces)
    until = first.high if point is None else parameter_of(point)
    tension = _reached(
        statics,
        first,
        until,
        lambda x: tension_margin(statics, x, criteria),
        2 * negligible_force(statics, first.points[0].x),
    )
    breakdown = _reached(statics, first, until, lambda x: breakdown_margin(statics, x, criteria))
    return Limit(status, point, until, tension, breakdown)


def _end(statics: Statics, pieces: list[Piece]) -> tuple[str, Point | None]:
    first = pieces[0]
    unstable = stable_until(statics, first)
    if unstable is not None:
        return UNSTABLE, unstable
    if first.upper_end == FOLD:
        kinds = {parameter_of(limit.point): limit.kind for limit in limit_points(statics, pieces)}
        return kinds[first.high], first.points[-1]
    return (first.upper_end if first.upper_end.startswith("lost") else NO_LIMIT), None


def _reached(
    statics: Statics,
    piece: Piece,
    until: float,
    margin: Callable[[np.ndarray], float],
    negligible: float = 0.0,
) -> float:
    """The smallest field up to `until` at which a margin is used up [V/m]; NaN where it is not.

    A margin that is negligible at the start, and then used up, has been so from the start.
    """
    first = margin(piece.points[0].x)
    if first <= 0 or (first <= negligible and len(piece.points) > 1 and margin(piece.points[1].x) < 0):
        return piece.low
    if not np.isfinite(first):
        return np.nan
    fields = [parameter_of(point) for point in locate_on(statics, piece, margin)]
    return min((field for field in fields if field <= until), default=np.nan)


def critical_names(electrical: ElectricalInput) -> dict[str, str]:
    """Names in the result of the largest value reached, and of those at loss of tension and at breakdown."""
    name = electrical.argument
    breakdown = "breakdown_field_nominal" if electrical is ELECTRIC_FIELD else f"breakdown_{name}"
    return {"highest": f"highest_{name}", "tension": f"loss_of_tension_{name}", "breakdown": breakdown}


def _measures(electrical: ElectricalInput) -> dict[str, tuple[str, str]]:
    """Unit and long name of every number of a limit, by its name."""
    name, unit, text = electrical.argument, electrical.unit, electrical.long_name
    nominal = text.replace("electric ", "")
    of = critical_names(electrical)
    voltage = {"voltage": ("V", "voltage at the limit")} if electrical is ELECTRIC_FIELD else {}
    return {
        name: (unit, f"{text} at the limit"),
        **voltage,
        "true_field": ("V/m", "true electric field at the limit"),
        of["highest"]: (unit, f"largest {nominal} that the stable branch reaches"),
        of["tension"]: (unit, f"{nominal} at which tension is lost before"),
        of["breakdown"]: (unit, f"{nominal} of electrical breakdown before"),
    }


def _variables(cases: Cases, found: list[tuple[Statics, Limit]]) -> dict[str, tuple]:
    dimensions, shape = tuple(cases.grid.axes), cases.grid.shape
    limits, electrical = [limit for _, limit in found], cases.electrical
    of = critical_names(electrical)

    def numbers(values: list[float]) -> np.ndarray:
        return np.array(values, dtype=float).reshape(shape)

    columns = {
        electrical.argument: [limit.field for limit in limits],
        "voltage": [
            limit.field * 2 * material(statics.problem, "half_thickness") for statics, limit in found
        ],
        "true_field": [_at(limit, lambda x, of=statics: true_field(of, x)) for statics, limit in found],
        of["highest"]: [limit.highest_field for limit in limits],
        of["tension"]: [limit.loss_of_tension_field for limit in limits],
        of["breakdown"]: [limit.breakdown_field for limit in limits],
    }
    data = {
        name: variable(dimensions, numbers(columns[name]), unit, long_name)
        for name, (unit, long_name) in _measures(electrical).items()
    }
    nowhere = np.full(len(cases.model.STATE), np.nan)
    states = [nowhere if limit.point is None else statics.state(limit.point.x) for statics, limit in found]
    data |= resting_variables(cases.model, dimensions, np.array(states).T.reshape(-1, *shape))
    texts = {
        "found": ([limit.status for limit in limits], "what ends the branch", {"meaning": _STATUS_MEANING}),
        "first_limit": (
            [limit.first for limit in limits],
            f"what comes first as the {electrical.text} grows",
            {},
        ),
    }
    for name, (values, long_name, more) in texts.items():
        array = np.array(values, dtype=object).reshape(shape)
        data[name] = dimensions, array, {"long_name": long_name} | more
    return data


def _at(limit: Limit, value: Callable[[np.ndarray], float]) -> float:
    return np.nan if limit.point is None else float(value(limit.point.x))


def _attributes(cases: Cases, dashpots: str, criteria: Criteria) -> dict[str, object]:
    return cases.attributes(dashpots) | {
        "definition": "limit point of the equilibrium of the unloaded membrane as the force and then the "
        f"{cases.electrical.text} grow",
        "dashpots_meaning": f"{FROZEN_MEANING}; {RELAXED_MEANING}",
        "breakdown_field": np.inf if criteria.breakdown_field is None else criteria.breakdown_field,
        "breakdown_field_units": "V/m",
        "breakdown_exponent": criteria.breakdown_exponent,
        "breakdown_definition": BREAKDOWN_DEFINITION,
        "smallest_tension": criteria.smallest_tension,
        "smallest_tension_units": "Pa",
    }
