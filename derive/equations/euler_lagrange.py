"""The equations of motion of a membrane under a load case.

Lagrange's equations with Rayleigh's dissipation function, d/dt(dl/dq') - dl/dq + dR/dq' = 0, l = T - Pi;
without R, Eq. (2) of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import sympy as sp

from delagrange.derive.equations.internal_rates import Dissipation, dissipation, internal_rates
from delagrange.derive.equations.reactions import (
    at_rest,
    edge_forces,
    reaction_forces,
    with_reaction_in_potential,
)
from delagrange.derive.membrane.constraint import (
    Substitution,
    constrain,
    euler_lagrange,
    kinematics,
    loads,
    tidy,
)
from delagrange.derive.membrane.description import REACTION_IN_POTENTIAL
from delagrange.derive.membrane.dissipation import RayleighTerm
from delagrange.derive.membrane.electrostatics import ChargeBalance, Electrodes
from delagrange.derive.membrane.energies import Energies, EnergyPart
from delagrange.derive.membrane.load_case import LoadCase
from delagrange.derive.membrane.membrane import Membrane
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.notation.time_derivative import time_derivative

__all__ = ["EquationsOfMotion", "ForceTerm", "equations_of_motion", "euler_lagrange", "kinematics"]

_FORCE_NAMES = {"forces": "applied_force", "electrostatic": "electric_force"}  # of others, the part's name


@dataclass(frozen=True)
class ForceTerm:
    """One physical origin of the generalised force, so that emitted code can name it."""

    name: str
    meaning: str
    vector: sp.ImmutableMatrix  # (n_coordinates, 1)  [J]


@dataclass(frozen=True)
class EquationsOfMotion:
    """Everything that the Euler-Lagrange operator gives for one membrane and load case.

    The equations of motion are M q'' = F, xi' = internal_rates and, of a membrane that leaks, its charge
    balance; `state` orders coordinates, their rates, the internal variables and the charge density.
    Generalised forces are in J, since stretches are pure numbers.
    """

    membrane: Membrane
    load_case: LoadCase
    parameters: tuple[Quantity, ...]
    principal_stretches: tuple[sp.Expr, ...]
    kinetic_energy: sp.Expr  # T [J]
    energies: Energies  # parts of the potential that the variation sees [J]
    potential_with_reactions: sp.Expr  # Pi with the reactions as symbols, as in Eq. (18) [J]
    residuals: tuple[sp.Expr, ...]  # Euler-Lagrange expressions in q, q', q'' [J]
    mass_matrix: sp.ImmutableMatrix  # M  [kg m^2]
    force_terms: tuple[ForceTerm, ...]  # F = their sum
    internal_rates: tuple[sp.Expr, ...]  # d xi/dt [1/s]
    reaction_forces: tuple[sp.Expr, ...]  # in q, q', q'' [N]
    static_reaction_forces: tuple[sp.Expr, ...]  # the same at rest [N]
    edge_forces: tuple[sp.Expr, ...]  # one a coordinate of the body, what balances springs and field at rest
    force_power: sp.Expr  # power of the applied forces [W]
    dissipation: Dissipation  # in the dashpots, and in what has a Rayleigh dissipation function
    validity: tuple[sp.Expr, ...]  # [1], each positive where a strain energy holds
    unbalanced_jacobian: sp.ImmutableMatrix  # d(F - M q'')/d state at fixed q'', (n_coordinates, n_state) [J]
    jacobian: sp.ImmutableMatrix  # of the first-order system, in the state, the inputs and q''
    unbalanced_input_jacobian: sp.ImmutableMatrix  # d(F - M q'')/d inputs, (n_coordinates, n_inputs)
    input_jacobian: sp.ImmutableMatrix  # of the first-order system by the inputs, (n_state, n_inputs)
    electrodes: Electrodes  # nominal field and nominal charge density
    charge_balance: ChargeBalance | None = None  # of a membrane that leaks

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """All that the expressions are written in, each once."""
        return quantities_of(self.membrane, self.load_case)

    @property
    def potential_energy(self) -> sp.Expr:
        return self.energies.total

    @property
    def dashpot_power(self) -> sp.Expr:
        """Power that the dashpots and all else dissipate [W]."""
        return self.dissipation.power(self.membrane.volume)

    @property
    def force_vector(self) -> sp.ImmutableMatrix:
        total = sp.zeros(self.mass_matrix.rows, 1)
        for term in self.force_terms:
            total += term.vector
        return sp.ImmutableMatrix(total)

    @property
    def state(self) -> tuple[Quantity, ...]:
        return state_of(self.load_case, self.charge_balance)

    @property
    def acceleration(self) -> sp.ImmutableMatrix:
        """q'' = adj(M) F / det(M)  [1/s^2]."""
        return sp.ImmutableMatrix(self.mass_matrix.adjugate() * self.force_vector / self.mass_matrix.det())


def state_of(load_case: LoadCase, balance: ChargeBalance | None = None) -> tuple[Quantity, ...]:
    """Coordinates, then their rates, then the internal variables, then the charge density where one leaks."""
    return (
        *(coordinate.value for coordinate in load_case.coordinates),
        *(coordinate.rate for coordinate in load_case.coordinates),
        *(internal.value for internal in load_case.internals),
        *(() if balance is None else (balance.charge,)),
    )


def quantities_of(model: Membrane, load_case: LoadCase) -> tuple[Quantity, ...]:
    """All quantities that the equations of a model are written in, each once."""
    moving = (*load_case.coordinates, *load_case.internals)
    parts = (part for each in moving for part in each.parts)
    balance = model.charge_balance
    charge = () if balance is None else (balance.charge, balance.rate)
    known = (
        *parts, *charge, *load_case.inputs, *model.parameters, *load_case.parameters, *load_case.reactions,
        s.KINETIC_ENERGY, s.POTENTIAL_ENERGY,
    )  # fmt: skip
    return tuple(dict.fromkeys(known))


# --- the first-order system ------------------------------------------------------------------------


def mass_matrix(residuals: tuple[sp.Expr, ...], coordinates: tuple[TimeDependent, ...]) -> sp.ImmutableMatrix:
    """Coefficients of the accelerations [kg m^2]."""
    accelerations = [c.acceleration.symbol for c in coordinates]
    return sp.ImmutableMatrix(sp.Matrix(residuals).jacobian(accelerations).applyfunc(tidy))


def _generalised_force(potential: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix([tidy(-potential.diff(c.value.symbol)) for c in coordinates])


def force_terms(
    kinetic: sp.Expr,
    energies: Energies,
    coordinates: tuple[TimeDependent, ...],
    rayleigh: tuple[RayleighTerm, ...] = (),
    remark: str = "",
) -> tuple[ForceTerm, ...]:
    """The generalised force by physical origin [J]; M q'' is their sum.

    `remark` is what must be said of the springs' and the field's share.
    """
    no_acceleration = {c.acceleration.symbol: 0 for c in coordinates}
    inertia = [tidy(-residual.subs(no_acceleration)) for residual in euler_lagrange(kinetic, coordinates)]
    return (
        ForceTerm(
            "inertia_force", "the thickness inertia, quadratic in the rates", sp.ImmutableMatrix(inertia)
        ),
        *(_conservative_force(part, coordinates, remark) for part in energies.parts),
        *(_dissipative_force(term, coordinates) for term in rayleigh),
    )


def _conservative_force(part: EnergyPart, coordinates: tuple[TimeDependent, ...], remark: str) -> ForceTerm:
    name = _FORCE_NAMES.get(part.name, f"{part.name}_force")
    meaning = part.meaning if part.name == "forces" else f"{part.meaning}{remark}"
    return ForceTerm(name, meaning, _generalised_force(part.expression, coordinates))


def _dissipative_force(term: RayleighTerm, coordinates: tuple[TimeDependent, ...]) -> ForceTerm:
    slopes = [tidy(-term.function.diff(c.rate.symbol)) for c in coordinates]
    return ForceTerm(f"{term.name}_force", term.meaning, sp.ImmutableMatrix(slopes))


def unbalanced_jacobian(
    mass: sp.ImmutableMatrix, force: sp.Matrix, load_case: LoadCase, by: tuple[Quantity, ...]
) -> sp.ImmutableMatrix:
    """Derivative of F - M q'' with respect to state or inputs at fixed q'' [J per unit of `by`]."""
    accelerations = sp.Matrix([c.acceleration.symbol for c in load_case.coordinates])
    variables = [quantity.symbol for quantity in by]
    return sp.ImmutableMatrix((force - mass * accelerations).jacobian(variables).applyfunc(tidy))


def first_order_jacobian(
    mass: sp.ImmutableMatrix,
    unbalanced: sp.ImmutableMatrix,
    rates: tuple[sp.Expr, ...],
    load_case: LoadCase,
    by: tuple[Quantity, ...],
) -> sp.ImmutableMatrix:
    """Jacobian of (q', q'', `rates` of all else) with respect to state or inputs; q'' stays a symbol.

    From M q'' = F: dq''/dy = M^-1 (dF/dy - dM/dy q''). Only the rows of q'' are not elementary.
    """
    variables = [quantity.symbol for quantity in by]
    velocities = sp.Matrix([c.rate.symbol for c in load_case.coordinates])
    acceleration_rows = mass.adjugate() * unbalanced / mass.det()
    rows_of_rates = sp.Matrix(len(rates), 1, list(rates)).jacobian(variables).applyfunc(tidy)
    return sp.ImmutableMatrix(
        sp.Matrix.vstack(velocities.jacobian(variables), acceleration_rows, rows_of_rates)
    )


def force_power(energies: Energies, coordinates: tuple[TimeDependent, ...]) -> sp.Expr:
    """Power of the applied forces at constant force [W]."""
    return tidy(-time_derivative(energies["forces"], coordinates))


# --- all together ----------------------------------------------------------------------------------


def equations_of_motion(model: Membrane, load_case: LoadCase) -> EquationsOfMotion:
    """Constrain the membrane, vary, and collect what follows.

    Raises:
        ValueError: the constraint is at odds with the law of the dashpots.
    """
    substitution = kinematics(model, load_case) | loads(model, load_case)
    coordinates, inserted = load_case.coordinates, load_case.formulation == REACTION_IN_POTENTIAL
    kinetic = tidy(constrain(model.kinetic_energy, substitution))
    with_reactions = model.energies.mapped(lambda _, part: tidy(constrain(part, substitution)))
    reactions = reaction_forces(model, load_case)
    static = tuple(tidy(at_rest(reaction, coordinates)) for reaction in reactions)
    if inserted:
        energies = with_reaction_in_potential(with_reactions, model, load_case, substitution)
    else:
        workless = {reaction.symbol: 0 for reaction in load_case.reactions}
        energies = with_reactions.mapped(lambda _, part: part.subs(workless))
    residuals = euler_lagrange(kinetic - energies.total, coordinates)
    mass = mass_matrix(residuals, coordinates)
    lost = dissipation(model, load_case, substitution)
    remark = ", with its share of the inserted reaction" if inserted else ""
    forces = force_terms(kinetic, energies, coordinates, lost.rayleigh, remark)
    rates = internal_rates(model, load_case, substitution)
    force = sum((term.vector for term in forces), sp.zeros(len(coordinates), 1))
    settled = partial(_settled, substitution=substitution)
    balance = None if model.charge_balance is None else model.charge_balance.mapped(settled)
    flows = rates if balance is None else (*rates, balance.law)
    state, inputs = state_of(load_case, balance), load_case.inputs
    unbalanced = unbalanced_jacobian(mass, force, load_case, state)
    unbalanced_by_inputs = unbalanced_jacobian(mass, force, load_case, inputs)
    return EquationsOfMotion(
        membrane=model,
        load_case=load_case,
        parameters=model.parameters + load_case.parameters,
        principal_stretches=tuple(constrain(stretch, substitution) for stretch in model.principal_stretches),
        kinetic_energy=kinetic,
        energies=energies,
        potential_with_reactions=with_reactions.total,
        residuals=_with_dissipation(residuals, lost.rayleigh, coordinates),
        mass_matrix=mass,
        force_terms=forces,
        internal_rates=rates,
        reaction_forces=static if inserted else reactions,
        static_reaction_forces=static,
        edge_forces=edge_forces(model, substitution),
        force_power=force_power(energies, coordinates),
        dissipation=lost,
        validity=tuple(constrain(limit, substitution) for limit in model.validity),
        unbalanced_jacobian=unbalanced,
        jacobian=first_order_jacobian(mass, unbalanced, flows, load_case, state),
        unbalanced_input_jacobian=unbalanced_by_inputs,
        input_jacobian=first_order_jacobian(mass, unbalanced_by_inputs, flows, load_case, inputs),
        electrodes=model.electrodes.mapped(settled),
        charge_balance=balance,
    )


def _settled(expression: sp.Expr, substitution: Substitution) -> sp.Expr:
    return tidy(constrain(expression, substitution))


def _with_dissipation(
    residuals: tuple[sp.Expr, ...],
    rayleigh: tuple[RayleighTerm, ...],
    coordinates: tuple[TimeDependent, ...],
) -> tuple[sp.Expr, ...]:
    lost = sp.Add(*(term.function for term in rayleigh))
    pairs = zip(residuals, coordinates, strict=True)
    return tuple(residual + lost.diff(c.rate.symbol) for residual, c in pairs)
