"""The equations of a membrane at rest: where its springs, forces and field, or charge, balance.

The unknowns are the logarithms of the stretches: all are positive, and a step is a strain. A coordinate that is no
stretch is measured as `chart` says. Under a current the charge is one more unknown: at rest as much leaks as is fed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from delagrange.common import checks
from delagrange.common.roles import Role
from delagrange.drives.inputs import (
    CURRENT_DENSITY,
    ELECTRIC_FIELD,
    ElectricalInput,
    electrical_input,
)
from delagrange.equilibrium.chart import Chart, make_chart
from delagrange.equilibrium.continuation import ContinuationSettings, Evaluation, Lost, solve
from delagrange.model.load import check_offers
from delagrange.model.variables import named
from delagrange.problem import status as loss
from delagrange.problem.dashpots import (
    FROZEN,
    RELAXED,
    charge_place,
    coordinate_places,
    dashpot_count,
    dashpot_places,
    frozen,
    given_state,
    leak_rate,
    rate_places,
)
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits

_NEEDED = ("jacobian", "input_jacobian", "mass_matrix", "edge_forces")
_NEEDED_WITHOUT_FIELD = ("electrodes",)  # which know how the permittivity depends on the stretches
ENDLESS_CHARGE = "its charge does not leak, and under a constant current grows without end"
TOLERANCE = 1e-11  # of the last Newton correction of the strains; the error is its square, down to round-off
_LARGEST_STRAIN = 50.0  # of the logarithms on the way; powers of stretches beyond are no numbers
STEPS = ContinuationSettings(
    first_step=0.01, largest_step=0.03, smallest_step=1e-8, most_points=8000, tolerance=TOLERANCE
)


@dataclass(frozen=True)
class Statics:
    """A membrane at rest while one of its inputs varies.

    A vector x, (n_unknowns + 1,), holds what stands for the unknowns in the chart, the logarithms of stretches, and
    the varied input last.
    """

    problem: Problem  # of single values; infinite viscosity where the dashpots are frozen
    rest: np.ndarray  # (n_state,), whose inelastic stretches stay where dashpots are frozen
    inputs: np.ndarray  # (n_inputs,), of those that do not vary
    varied: int  # place of the input that varies
    unknowns: np.ndarray  # places in the state
    rows: np.ndarray  # of the right-hand side that vanish at rest
    chart: Chart  # of the unknowns
    limits: Limits

    @cached_property
    def electrical(self) -> ElectricalInput:
        """What drives the electrodes."""
        return electrical_input(self.problem.model)

    @cached_property
    def scale(self) -> np.ndarray:
        """(n_unknowns + 1,): strains of order one, and the input that strains the membrane so much."""
        electric = self.name == self.electrical.name
        size = typical_electrical(self) if electric else typical_input(self, self.name)
        return np.append(np.ones(len(self.unknowns)), size)

    @cached_property
    def typical_force(self) -> float:
        """The force [N] that would strain the membrane by 1 in the reference state, were it linear."""
        forces = named(self.problem.model.INPUTS, Role.FORCE)
        sizes = [typical_input(self, name) for name in forces]
        return min(sizes, default=1.0)

    @property
    def name(self) -> str:
        """Name of the varied input."""
        return self.problem.model.INPUTS[self.varied].name

    @property
    def flowing(self) -> np.ndarray:
        """Places in the state of what flows until it rests: inelastic stretches that are not frozen, a charge."""
        return self.unknowns[self.problem.model.COORDINATE_COUNT :]

    @property
    def moving(self) -> np.ndarray:
        """Places in the state of all that moves about an equilibrium."""
        return np.concatenate([np.arange(2 * self.problem.model.COORDINATE_COUNT), self.flowing])

    @property
    def relaxed(self) -> bool:
        """Whether there are dashpots, and they are at rest, too."""
        dashpots = dashpot_places(self.problem.model)
        return dashpots.stop > dashpots.start and dashpots.start in self.flowing

    @property
    def charge(self) -> int | None:
        """Place in the state of a charge that leaks; None where there is none."""
        place = charge_place(self.problem.model)
        return place if place in self.flowing else None

    def varying(self, name: str, **values: float) -> Statics:
        """The same membrane with the input `name` varied and other inputs set."""
        inputs = self.inputs.copy()
        for input_name, value in values.items():
            inputs[input_place(self.problem, input_name)] = value
        return replace(self, inputs=inputs, varied=input_place(self.problem, name))

    def state(self, x: np.ndarray) -> np.ndarray:
        """(n_state,)"""
        state = self.rest.copy()
        state[self.unknowns] = self.chart.values(x[:-1])
        return state

    def signed_state(self, x: np.ndarray, value: float) -> np.ndarray:
        """(n_state,) at a value of the electrical input whose size x has: the charge alone knows its sign."""
        state = self.state(x)
        if self.charge is not None:
            state[self.charge] = np.copysign(state[self.charge], value)
        return state

    def without_electricity(self, x: np.ndarray) -> np.ndarray:
        """x with the stretches as they are, and no field or charge."""
        without = x.copy()
        without[-1] = 0.0
        without[:-1][self.unknowns == self.charge] = 0.0
        return without

    def x_of(self, state: np.ndarray, value: float) -> np.ndarray:
        """The vector of a state and a value of the varied input."""
        return np.append(self.chart.x_of(state[self.unknowns]), value)

    def arguments(self, x: np.ndarray) -> tuple:
        """State, inputs and parameters, as the functions of a model want them."""
        inputs = self.inputs.copy()
        inputs[self.varied] = x[-1]
        return self.state(x), tuple(inputs), self.problem.parameters

    def residual(self, x: np.ndarray) -> Evaluation:
        """The rates that vanish at rest, with their slopes.

        Raises:
            Lost: the strains are beyond double precision.
        """
        if not np.all(np.abs(x[:-1]) < _LARGEST_STRAIN):
            raise Lost("a strain is beyond double precision")
        model, arguments = self.problem.model, self.arguments(x)
        with np.errstate(all="ignore"):
            rates = model.rhs(*arguments)[self.rows]
            slopes = model.jacobian(*arguments)[np.ix_(self.rows, self.unknowns)]
            by_input = model.input_jacobian(*arguments)[self.rows, self.varied]
        along = self.chart.slopes(arguments[0][self.unknowns])
        return Evaluation(rates, np.column_stack([slopes * along, by_input]))

    def outside(self, x: np.ndarray) -> str | None:
        """Why a branch ends at x: a principal stretch beyond the limits; None where all are within."""
        model, arguments = self.problem.model, self.arguments(x)
        with np.errstate(all="ignore"):
            principal = model.principal_stretches(*arguments)
            validity = model.validity(*arguments) if hasattr(model, "validity") else None
        if np.all(np.isfinite(principal)) and loss.margin(principal, self.limits, validity) > 0:
            return None
        kind = loss.kind_of_loss(principal, self.limits, validity)
        if kind == loss.LOCKED:
            return "limit: the strain energy ceases to hold"
        if kind == loss.DIVERGED:
            return f"limit: a stretch beyond {self.limits.largest_stretch:g}"
        return f"limit: a principal stretch below {self.limits.smallest_stretch:g}"


def make_statics(
    problem: Problem, dashpots: str, initial_state: Mapping[str, float] | None, limits: Limits
) -> Statics:
    """The membrane of `problem`, whose drives are constant, at rest while its electrical input varies.

    Raises:
        ValueError: dashpots neither frozen nor relaxed, a model without what is needed, a bad initial state.
    """
    model = problem.model
    checks.choice("dashpots", dashpots, (FROZEN, RELAXED))
    checks.instance("limits", limits, Limits)
    electrical = electrical_input(model)  # which is what varies
    without_field = () if electrical is ELECTRIC_FIELD else _NEEDED_WITHOUT_FIELD
    check_offers(model, (*_NEEDED, *without_field), "an equilibrium")
    if electrical is CURRENT_DENSITY and charge_place(model) is None:
        raise ValueError(f"the model {model.MODEL} has a current, and no charge in its state that it feeds")
    places, relaxed = np.arange(len(model.STATE)), dashpots == RELAXED
    flowing = [*(places[dashpot_places(model)] if relaxed else ()), *_leaking_charge(problem)]
    flowing = np.array(flowing, dtype=int)
    unknowns = np.concatenate([places[coordinate_places(model)], flowing])
    return Statics(
        problem=problem if relaxed else frozen(problem),
        rest=at_rest(problem, initial_state),
        inputs=np.array(problem.inputs(0.0), dtype=float),
        varied=input_place(problem, electrical.name),
        unknowns=unknowns,
        rows=np.concatenate([places[rate_places(model)], flowing]),
        chart=make_chart(problem, unknowns),
        limits=limits,
    )


def _leaking_charge(problem: Problem) -> tuple[int, ...]:
    """Place in the state of a charge that leaks; one that does not may be any, and is not looked for."""
    return (charge_place(problem.model),) if leak_rate(problem) > 0 else ()


def is_endless(statics: Statics, value: float) -> bool:
    """Whether there is no rest at a value of the electrical input because `ENDLESS_CHARGE`."""
    return value != 0 and statics.electrical is CURRENT_DENSITY and statics.charge is None


def refuse_endless(statics: Statics, value: float, what: str) -> None:
    """Refuse a value of the electrical input at which there is no rest because `ENDLESS_CHARGE`; it has no `what`.

    Raises:
        ValueError: in one line.
    """
    if is_endless(statics, value):
        raise ValueError(f"{statics.problem.model.MODEL} has no {what} under a current: {ENDLESS_CHARGE}")


def at_rest(problem: Problem, initial_state: Mapping[str, float] | None) -> np.ndarray:
    """The given state, (n_state,), whose rates are zero.

    Raises:
        ValueError: a rate that is given and is not zero, or as `delagrange.problem.dashpots.given_state`.
    """
    state = given_state(problem, initial_state)
    for place in range(*rate_places(problem.model).indices(len(state))):
        if state[place] != 0:
            name = problem.model.STATE[place].name
            raise ValueError(
                f"initial_state {name} must be 0 1/s for a membrane at rest, got {state[place]:g} 1/s"
            )
    return state


def input_place(problem: Problem, name: str) -> int:
    """Where an input stands among those of the model.

    Raises:
        ValueError: the model has no such input.
    """
    names = [entry.name for entry in problem.model.INPUTS]
    if name not in names:
        raise ValueError(f"the model {problem.model.MODEL} has no input {name}; it has {', '.join(names)}")
    return names.index(name)


def unloaded(statics: Statics) -> np.ndarray:
    """x at rest without force and field, or charge, nearest the reference state.

    Raises:
        Lost: Newton's method does not find it within the limits; where it begins outside of them, as in a membrane
            that is held beyond what its energies allow, that is the reason.
    """
    alone = statics.varying(
        statics.electrical.name, **{entry.name: 0.0 for entry in statics.problem.model.INPUTS}
    )
    start = alone.x_of(with_relaxed_dashpots(alone, alone.rest[:, None])[:, 0], 0.0)
    begins_outside = alone.outside(start)
    try:
        x = solve(alone.residual, start, alone.scale, TOLERANCE).x
    except Lost as reason:
        where = f"{begins_outside}, in the unloaded state from which it is looked for"
        raise Lost(where if begins_outside else str(reason)) from None
    if (outside := alone.outside(x)) is not None:
        raise Lost(f"{outside}, in the unloaded state")
    return x


def with_relaxed_dashpots(statics: Statics, states: np.ndarray) -> np.ndarray:
    """(n_state, n_lanes): each unknown inelastic stretch begins as the stretch along its axis.

    There spring β is free of stress, whatever its energy, where it is isotropic.
    """
    model, states = statics.problem.model, np.array(states, dtype=float)
    if statics.relaxed:
        principal = model.principal_stretches(states, tuple(statics.inputs), statics.problem.parameters)
        places = np.arange(len(model.STATE))[dashpot_places(model)]
        axes = max(1, len(places) // max(1, dashpot_count(model)))  # in which each dashpot flows
        for order, place in enumerate(places):
            states[place] = principal[order % min(axes, len(principal))]
    return states


def typical_input(statics: Statics, name: str) -> float:
    """The value of an input that would strain the membrane by 1 in the reference state, were it linear."""
    strain = _reference_strain(statics, name)
    return 1 / strain if strain > 0 else 1.0


def with_leaking_charge(statics: Statics, states: np.ndarray, inputs: tuple) -> np.ndarray:
    """(n_state, n_lanes): a charge that leaks begins where as much leaks as the current feeds."""
    if statics.charge is None:
        return states
    states, place = states.copy(), statics.charge
    states[place] = 0.0
    arguments = states, inputs, statics.problem.parameters
    model = statics.problem.model
    states[place] = -model.rhs(*arguments)[place] / model.jacobian(*arguments)[place, place]
    return states


def typical_electrical(statics: Statics) -> float:
    """The field [V/m], or charge [C/m^2], that would strain the membrane by 1 in the reference state, were it
    linear but for E^2, or D^2; or the current [A/m^2] that holds a typical charge.
    """
    if statics.electrical is CURRENT_DENSITY:
        of_charge = statics.chart.size[statics.unknowns == statics.charge]
        return float(of_charge[0] * leak_rate(statics.problem)) if of_charge.size else 1.0
    strain = _reference_strain(statics, statics.electrical.name)
    return float(np.sqrt(2 / strain)) if strain > 0 else 1.0


def _reference_strain(statics: Statics, name: str) -> float:
    """Size of the slopes of all strains by an input, per unit of it, in the reference state.

    The membrane is as stiff as without load there; what enters squared has the slope that it has at 1 unit.
    """
    model, parameters = statics.problem.model, statics.problem.parameters
    place = input_place(statics.problem, name)
    state, without = np.asarray(model.reference_state(parameters), dtype=float), np.zeros(len(model.INPUTS))
    slopes = model.jacobian(state, tuple(without), parameters)[np.ix_(statics.rows, statics.unknowns)]
    slopes = slopes * statics.chart.slopes(state[statics.unknowns])
    one = without.copy()
    one[place] = 1.0
    by_input = model.input_jacobian(state, tuple(one), parameters)[statics.rows, place]
    sizes = np.linalg.norm(slopes, axis=1)
    sizes = np.where(sizes > 0, sizes, 1.0)
    return float(np.linalg.norm(np.linalg.lstsq(slopes / sizes[:, None], by_input / sizes)[0]))
