"""Where a membrane rests under constant force and field, charge or current: all branches, and where they end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.rest.arguments import (
    FROZEN_MEANING,
    RELAXED_MEANING,
    Cases,
    make_cases,
    single_case,
)
from delagrange.analysis.rest.criteria import Criteria, material
from delagrange.analysis.rest.equilibria_dataset import branch_variables, curve_variables, limit_variables
from delagrange.analysis.rest.equilibria_grid import grid_variables
from delagrange.common import checks
from delagrange.drives.inputs import ELECTRIC_FIELD, Inputs
from delagrange.equilibrium.branches import all_pieces, limit_points, why_not_from_unloaded
from delagrange.equilibrium.pieces import Piece
from delagrange.equilibrium.statics import Statics
from delagrange.model.parameters import Parameters
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits
from delagrange.run.run_dataset import variable


@dataclass(frozen=True)
class Found:
    """All that was found of the equilibria of a membrane."""

    statics: Statics
    pieces: list[Piece]
    criteria: Criteria


def equilibria(
    model: str | ModuleType,
    *,
    force: float = 0.0,
    inputs: Inputs | None = None,
    field: float | np.ndarray | None = None,
    voltage: float | np.ndarray | None = None,
    dashpots: str = "relaxed",
    breakdown_field: float | None = None,
    breakdown_exponent: float = 0.0,
    smallest_tension: float = 0.0,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    held_stretch: float | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    limits: Limits | None = None,
    **material_changes: float,
) -> xr.Dataset:
    """Every equilibrium of a membrane under a constant force, over the field, or the charge or current that drives it.

    Curves are followed by pseudo-arclength continuation from the unloaded membrane and from whatever Newton's
    method finds from a grid of stretches at several fields from zero to the largest. A `branch` is a part of a
    curve between two limit points, so that it has one equilibrium at most at each field; branch 0 is the one
    that the unloaded membrane reaches under the force alone. The field enters squared: its sign does not matter. Under
    a current the charge flows until as much leaks as the current feeds; stability is that under the same current.
    Edge forces are those of springs and field as they are: with the formulation "as_printed", whose potential is
    another, they do not balance the applied force.

    Args:
        force: on each loaded edge [N].
        inputs: of any other input but the field by its name, as {"force_2": 0.3}; each grows from zero before
            the field, in the order of the model's inputs. Also the charge or current of a model that is driven by
            one, instead of a field: {"nominal_charge_density": values} [C/m^2] or {"nominal_current_density":
            values} [A/m^2], a number or an increasing array.
        field: nominal, voltage over reference thickness [V/m]; a number or an increasing array, also none.
        voltage: instead of the field, [V].
        dashpots: "relaxed", at rest as well; or "frozen", as in the reference state or `initial_state`.
        breakdown_field: true field [V/m] that the undeformed material stands; no breakdown if left out.
        breakdown_exponent: the strength grows with the thickness stretch to the power -exponent / 2, that is
            with the equal-biaxial stretch to the power of the exponent.
        smallest_tension: nominal stress [Pa] on an edge below which tension counts as lost (wrinkles).
        formulation, lateral_dashpot, held_stretch, parameters, initial_state, limits, material_changes: as in
            `frequency_response`, single numbers. Beyond the limits no equilibrium is looked for.

    Returns:
        Dataset over (`field`, `branch`): the state variables (NaN where the branch has no equilibrium) and
        `stretch`; `stability`; `margin` [V/m] and `relative_margin` to the branch's limit point; edge forces,
        `true_field`, `tension_lost`, `breakdown`. Over `field`: `count`, `stable_count`, `voltage`. Over
        `branch`: why it ends at either end. The curves themselves over `point`, limit points over
        `limit_point`. A single field has no dimension. No equilibrium at all is an answer: no branch, or NaN.
        Where no branch begins at the unloaded membrane, the attribute `unloaded_lost` says why.
        A charge or current stands for the field in all these names, as `nominal_charge_density` and
        `limit_nominal_charge_density` [C/m^2], and there are no voltages.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    values = {"force": force, "held_stretch": held_stretch, **material_changes}
    given = ("field", field) if voltage is None else ("voltage", voltage)
    cases = make_cases(
        model, formulation, lateral_dashpot, parameters, initial_state, limits, values, inputs, given
    )
    problem = single_case(cases, "equilibria").first_problem()
    criteria = Criteria(breakdown_field, breakdown_exponent, smallest_tension)
    fields = _fields(cases, problem, field, voltage)
    largest = float(np.max(np.abs(fields)))
    statics = cases.statics(problem, dashpots, largest)
    found = Found(statics, all_pieces(statics, largest), criteria)
    return _dataset(found, fields, cases.coordinates(), cases.attributes(dashpots))


def _fields(cases: Cases, problem: Problem, field: object, voltage: object) -> np.ndarray:
    """Values of the electrical input, fields [V/m], charges [C/m^2] or currents [A/m^2], of no or one dimension.

    Raises:
        ValueError: none given, or field and voltage, or values that are not finite and increasing.
    """
    electrical, name, values = cases.electrical, cases.given.name, cases.given.values
    if electrical is ELECTRIC_FIELD and (values is None or (field is not None and voltage is not None)):
        given = "neither" if values is None else "both"
        raise ValueError(f"either field [V/m] or voltage [V] must be given, got {given}")
    if values is None:
        raise ValueError(f"{name} [{electrical.unit}] must be given, got none")
    if name == "voltage":
        return _increasing(name, values, "V") / (2 * material(problem, "half_thickness"))
    return _increasing(name, values, electrical.unit)


def _increasing(name: str, value: object, unit: str) -> np.ndarray:
    values = np.asarray(checks.finite(name, value, unit), dtype=float)
    return checks.increasing(name, values, unit) if values.ndim else values


def _dataset(
    found: Found, fields: np.ndarray, coordinates: dict[str, tuple], attributes: dict[str, object]
) -> xr.Dataset:
    statics, pieces, electrical = found.statics, found.pieces, found.statics.electrical
    dimensions = (electrical.argument,) if fields.ndim else ()
    unreached = why_not_from_unloaded(statics)
    first = f"{'0' if unreached is None else 'none'} begins at the unloaded membrane"
    data = grid_variables(statics, pieces, found.criteria, np.atleast_1d(fields), dimensions)
    data |= branch_variables(pieces, electrical)
    data |= curve_variables(statics, pieces, found.criteria)
    data |= limit_variables(statics, limit_points(statics, pieces))
    coordinates = coordinates | {
        electrical.argument: variable(
            dimensions, fields, electrical.unit, electrical.long_name, electrical.symbol
        ),
        "branch": variable("branch", np.arange(len(pieces)), "1", f"number of the branch; {first}"),
    }
    method = {
        "method": "pseudo-arclength continuation (Keller 1977) of the derived equations at rest",
        "dashpots_meaning": f"{FROZEN_MEANING}; {RELAXED_MEANING}",
        "breakdown_field": np.inf
        if found.criteria.breakdown_field is None
        else found.criteria.breakdown_field,
        "breakdown_field_units": "V/m",
        "breakdown_exponent": found.criteria.breakdown_exponent,
        "smallest_tension": found.criteria.smallest_tension,
        "smallest_tension_units": "Pa",
    }
    method |= {} if unreached is None else {"unloaded_lost": unreached}
    return xr.Dataset(data, coords=coordinates, attrs=attributes | method)
