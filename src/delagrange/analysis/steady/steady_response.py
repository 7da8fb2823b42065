"""The periodic response to a sine of field, charge or current, stable or not, along a number of the load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.forcing import enters_squared, fastest_vibration
from delagrange.analysis.steady.arguments import (
    TOLERANCE_RANGE,
    check_frequencies,
    make_forced,
    seed_values,
    varied_load,
)
from delagrange.analysis.steady.branches import find_branches
from delagrange.analysis.steady.response_dataset import PERIODIC_AMPLITUDE, steady_dataset
from delagrange.analysis.steady.search import Range, Search
from delagrange.analysis.steady.shooting import Shooting
from delagrange.common import checks
from delagrange.common.progress import progress_bar, working
from delagrange.drives.drive import Constant
from delagrange.drives.inputs import ELECTRICAL, FORCE, Inputs, has_input
from delagrange.drives.sines import sine_text
from delagrange.engines.flow import FlowPath
from delagrange.engines.flows import resolve_flow
from delagrange.equilibrium.continuation import ContinuationSettings
from delagrange.equilibrium.statics import Statics, input_place, make_statics, refuse_endless
from delagrange.model.parameters import Parameters
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import FROZEN, is_damped
from delagrange.problem.initial import single_initial
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits
from delagrange.run.run_dataset import run_attributes

_TOLERANCE = 1e-8  # of Newton's last correction, scaled; the error after it is about its square
_FIRST, _SMALLEST = 0.3, 1e-8  # of the largest step, and scaled


def steady_response(
    model: str | ModuleType,
    *,
    frequency: tuple[float, float] | float,
    field_amplitude: tuple[float, float] | float | None = None,
    charge_amplitude: tuple[float, float] | float | None = None,
    current_amplitude: tuple[float, float] | float | None = None,
    force: tuple[float, float] | float = 0.0,
    inputs: Inputs | None = None,
    field_bias: tuple[float, float] | float = 0.0,
    charge_bias: tuple[float, float] | float = 0.0,
    current_bias: tuple[float, float] | float = 0.0,
    dashpots: str = FROZEN,
    held_stretch: float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    period_multiple: int = 1,
    seeds: int | np.ndarray = 9,
    largest_amplitude: float | None = None,
    most_points: int = 400,
    most_branches: int = 30,
    resolution: int = 200,
    tolerance: float = 1e-12,
    engine: str = "auto",
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    progress: bool = False,
    **material: float,
) -> xr.Dataset:
    """Branches of periodic motions under E = bias + amplitude sin(2 pi f t) and a constant force.

    Exactly one of `frequency` [Hz], `force` [N], `field_amplitude` and `field_bias` [V/m] is a pair (start, stop):
    along it branches are continued by pseudo-arclength, through folds and past losses of stability. The field
    enters squared: without bias the membrane is forced at twice the frequency of the field, with period 1/(2 f),
    else with period 1/f. A branch starts wherever a periodic motion is found that is on no branch yet: at `seeds`
    values over the range, and behind every fold and end, motions are grown with the amplitude of the field from
    every equilibrium without it, through folds, and searched near every equilibrium under its mean square; and
    where branches cross, the other one is followed. So are those found that no sweep reaches; that none is
    missing cannot be promised.

    Args:
        inputs: constant values of any other input but the field by its name, as {"force_2": 0.3}.
        charge_amplitude, charge_bias: [C/m^2] of the nominal charge density, numbers or one of them a pair, instead
            of those of the field, where that drives the model; and
        current_amplitude, current_bias: [A/m^2] of the nominal current density where that does; the result names
            them so. The charge that a current feeds flows with the motion, and its leak damps.
        dashpots: "frozen": they stand at the reference or at `initial_state`, nothing damps, and the peak of a
            resonance has no top: its sides rise to a limit. "relaxed": they flow, and are periodic with the motion.
        initial_state: where frozen dashpots stand, by name of the state variable.
        period_multiple: periods of the forcing in a period of the motion; 2 finds motions of doubled period too.
        seeds: how many values, evenly over the range, or the values themselves.
        largest_amplitude: [1] of the first stretch, at which branches end; without it only `limits` end them.
        most_points: of a branch, each way from its start.
        most_branches: after so many the search ends.
        resolution: at least so many points over the range, and over a change of the state by its typical size.
        tolerance: of the flow, 1e-14 to 1e-6, in units of typical sizes of the state.
        engine: "compiled", "core" (in C), "scipy" (slow, a witness), or "auto" for the faster that can run.
        limits: stretches beyond which a motion counts as lost.
        model, held_stretch, formulation, lateral_dashpot, parameters, progress, material: as in `simulate`.

    Returns:
        Dataset over `point`, the branches one after the other: `frequency`, `force`, `field_amplitude`,
        `field_bias`, `branch_number`; `amplitude`, `maximum`, `minimum` [1] of the first stretch, of a second one
        as `stretch_2_amplitude` and so on; the state at phase 0 of the field by its names, `period` [s],
        `stability`, `multiplier_real` and `multiplier_imag` (over `multiplier`), `multiplier_logarithm` of the
        modulus (where the multiplier itself underflows), `divergence`, `product_error`, `closure_error`.
        Over `bifurcation`: `bifurcation_kind`, `bifurcation_frequency`, `bifurcation_amplitude` and so on. Over
        `branch` (and `end`): `ending`, `origin`. Interrupted from the keyboard, what is found so far, with the
        attribute `search` saying so.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is allowed.
    """
    sines = {
        "field_amplitude": field_amplitude, "field_bias": field_bias,
        "charge_amplitude": charge_amplitude, "charge_bias": charge_bias,
        "current_amplitude": current_amplitude, "current_bias": current_bias,
    }  # fmt: skip
    forced = make_forced(
        model, formulation, lateral_dashpot, parameters, sines, inputs, held_stretch, material, "a steady response"
    )
    module, electrical = forced.specimen.model, forced.electrical
    varied, whole, load = varied_load({"force": force, **forced.sine, "frequency": frequency}, electrical)
    for value in (whole.start, whole.stop):  # both ends must be computable
        problem = forced.driven({**load, varied: value})
    resting = forced.problem(load["force"], 0.0)
    statics = make_statics(resting, dashpots, initial_state, limits)
    refuse_endless(statics, np.inf, "periodic motion of its own")
    settings = _settings(resolution, most_points)
    lowest = min(whole.start, whole.stop) if varied == "frequency" else load["frequency"]
    check_frequencies(lowest, fastest_vibration(_unloaded(statics.problem), statics.rest))
    shooting = _shooting(statics, varied, whole, load, period_multiple, tolerance, engine, progress)
    ceiling = (
        np.inf if largest_amplitude is None else checks.positive("largest_amplitude", largest_amplitude, "1")
    )
    conservative = dashpots == FROZEN and not is_damped(resting)
    search = Search(shooting, whole, settings, conservative, checks.scalar("largest_amplitude", ceiling, "1"))
    values = seed_values(whole, seeds, varied)
    with progress_bar(progress, f"{module.MODEL} steady response", len(values), "starts") as bar:
        findings = find_branches(
            search, statics, values, checks.count("most_branches", most_branches, 1), bar
        )
    about = run_attributes(problem, limits) | single_initial(module, initial_state)
    return steady_dataset(search, findings, about | _attributes(search, dashpots, findings.search))


def _unloaded(problem: Problem) -> Problem:
    return replace(problem, drives=tuple(Constant(0.0) for _ in problem.drives))


def _settings(resolution: int, most_points: int) -> ContinuationSettings:
    step = 1 / checks.count("resolution", resolution, 10, 100000)
    return ContinuationSettings(
        first_step=_FIRST * step,
        largest_step=step,
        smallest_step=_SMALLEST,
        most_points=checks.count("most_points", most_points, 2),
        tolerance=_TOLERANCE,
    )


def _shooting(
    statics: Statics,
    varied: str,
    whole: Range,
    load: Mapping[str, float],
    multiple: int,
    tolerance: float,
    engine: str,
    progress: bool,
) -> Shooting:
    problem = statics.problem
    tolerance = checks.within("tolerance", tolerance, "1", *TOLERANCE_RANGE)
    with working(
        progress, f"preparing {problem.model.MODEL}; its first use on a machine takes seconds to compile"
    ):
        flow = resolve_flow(problem, engine)
    return Shooting(
        path=FlowPath(problem, typical_sizes(problem), tolerance, statics.limits),
        flow=flow,
        rest=statics.rest,
        unknowns=statics.moving,
        load=dict(load),
        varied=varied,
        size=whole.span,
        per_sine=2 if _doubles(statics, varied, load) else 1,
        multiple=checks.count("period_multiple", multiple, 1, 1000),
    )


def _doubles(statics: Statics, varied: str, load: Mapping[str, float]) -> bool:
    """Whether the membrane is forced at twice the frequency of the field, or charge."""
    electrical = statics.electrical
    biased = varied == electrical.bias or load[electrical.bias] != 0
    place = input_place(statics.problem, electrical.name)
    return not biased and enters_squared(statics.problem, place, statics.rest)


def _attributes(search: Search, dashpots: str, ending: str) -> dict[str, object]:
    shooting = search.shooting
    electrical = search.electrical
    sines = (
        f"1/(2 f): the {electrical.stem} enters squared, without bias" if shooting.per_sine == 2 else "1/f"
    )
    return {
        f"{electrical.name}_drive": sine_text(electrical, phase=False),
        "varied_input": electrical.name,
        **({"force_drive": "Constant(force)"} if has_input(shooting.path.problem.model, FORCE) else {}),
        "varied": shooting.varied,
        "forcing_period": sines,
        "period_multiple": shooting.multiple,
        "dashpots": dashpots,
        "definition": PERIODIC_AMPLITUDE,
        "explanation": _explanation(search, dashpots),
        "method": "shooting with the variational equations, pseudo-arclength continuation",
        "tolerance": shooting.path.tolerance,
        "search": ending,
    }


def _explanation(search: Search, dashpots: str) -> str:
    stem, squared = search.electrical.stem, ELECTRICAL[search.electrical.squared].stem
    if search.shooting.per_sine == 2:
        text = f"The {stem} enters squared: its sine of frequency f forces at 2 f; a mode f_n resonates at f = f_n/2. "
    elif squared != stem:
        text = f"The {squared} that the {stem} feeds enters squared: it forces at 2 f, with a bias at f as well. "
    else:
        text = f"With a bias the {stem} forces at f and 2 f; a mode f_n resonates at f = f_n and at f_n/2. "
    if dashpots == FROZEN and not search.conservative:
        return text + "Dashpots frozen; a parallel dashpot, the medium or a leak damps, and stable motions attract."
    if dashpots == FROZEN:
        return (
            text + "Dashpots frozen: nothing damps, neutral motions attract nothing, resonances have no top."
        )
    return text + "Dashpots flow and are periodic with the motion: they damp, and stable motions attract."
