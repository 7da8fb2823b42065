"""The Euler-Lagrange operator, and the equations of motion of a membrane under a load case.

Eq. (2) of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, for any number of coordinates,
with the sign that makes the mass matrix positive: d/dt(dl/dq') - dl/dq = 0, l = T - Pi.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import sympy as sp

from delagrange.derive.load_cases import REACTION_IN_POTENTIAL, LoadCase
from delagrange.derive.membrane import Energies, Membrane, time_derivative
from delagrange.derive.symbols import VISCOSITY, Quantity, TimeDependent

Substitution = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class ForceTerm:
    """One physical origin of the generalised force, so that emitted code can name it."""

    name: str
    meaning: str
    vector: sp.ImmutableMatrix  # (n_coordinates, 1)  [J]


@dataclass(frozen=True)
class Dissipation:
    """What the dashpots lose: deviatoric stresses [Pa] times strain rates [1/s], over the volume.

    A dashpot that flows has its deviatoric stress over 2 eta as its strain rate, one whose inelastic stretch
    is held has none; the third follows from incompressibility.
    """

    deviators: tuple[sp.Expr, sp.Expr, sp.Expr]
    flowing: tuple[bool, bool]  # along axes 1, 2

    def strain_rates(self, deviators: tuple[sp.Expr, ...]) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """Strain rates in terms of deviatoric stresses, given as expressions or as names."""
        flow = [deviator / (2 * VISCOSITY.symbol) for deviator in deviators]
        if all(self.flowing):
            return flow[0], flow[1], flow[2]
        first, second = (
            rate if moves else sp.S.Zero for rate, moves in zip(flow, self.flowing, strict=False)
        )
        return first, second, -first - second

    def power(self, volume: sp.Expr) -> sp.Expr:
        pairs = zip(self.deviators, self.strain_rates(self.deviators), strict=True)
        return volume * sp.Add(*(deviator * rate for deviator, rate in pairs))


@dataclass(frozen=True)
class EquationsOfMotion:
    """Everything that the Euler-Lagrange operator gives for one membrane and load case.

    The equations of motion are M q'' = F and xi' = internal_rates; `state` orders coordinates, their
    rates and the internal variables. Generalised forces are in J, since stretches are pure numbers.
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
    edge_forces: tuple[sp.Expr, sp.Expr]  # on axes 1 and 2, what balances springs and field at rest [N]
    force_power: sp.Expr  # power of the applied forces [W]
    dissipation: Dissipation  # in the dashpots
    unbalanced_jacobian: sp.ImmutableMatrix  # d(F - M q'')/d state at fixed q'', (n_coordinates, n_state) [J]
    jacobian: sp.ImmutableMatrix  # of the first-order system, in the state, the inputs and q''
    unbalanced_input_jacobian: sp.ImmutableMatrix  # d(F - M q'')/d inputs, (n_coordinates, n_inputs)
    input_jacobian: sp.ImmutableMatrix  # of the first-order system by the inputs, (n_state, n_inputs)

    @property
    def potential_energy(self) -> sp.Expr:
        return self.energies.total

    @property
    def dashpot_power(self) -> sp.Expr:
        """Power that the dashpots dissipate [W]."""
        return self.dissipation.power(self.membrane.volume)

    @property
    def force_vector(self) -> sp.ImmutableMatrix:
        total = sp.zeros(self.mass_matrix.rows, 1)
        for term in self.force_terms:
            total += term.vector
        return sp.ImmutableMatrix(total)

    @property
    def state(self) -> tuple[Quantity, ...]:
        return state_of(self.load_case)

    @property
    def acceleration(self) -> sp.ImmutableMatrix:
        """q'' = adj(M) F / det(M)  [1/s^2]."""
        return sp.ImmutableMatrix(self.mass_matrix.adjugate() * self.force_vector / self.mass_matrix.det())


def state_of(load_case: LoadCase) -> tuple[Quantity, ...]:
    """Coordinates, then their rates, then the internal variables."""
    return (
        *(coordinate.value for coordinate in load_case.coordinates),
        *(coordinate.rate for coordinate in load_case.coordinates),
        *(internal.value for internal in load_case.internals),
    )


def euler_lagrange(lagrangian: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> tuple[sp.Expr, ...]:
    """Euler-Lagrange expressions d/dt(dl/dq') - dl/dq, one a coordinate, Eq. (2)."""
    return tuple(
        time_derivative(lagrangian.diff(c.rate.symbol), coordinates) - lagrangian.diff(c.value.symbol)
        for c in coordinates
    )


def tidy(expression: sp.Expr) -> sp.Expr:
    """A canonical short form: like terms collected, common factors in front."""
    return sp.factor_terms(sp.expand(expression))


# --- the constraint ------------------------------------------------------------------------------


def kinematics(model: Membrane, load_case: LoadCase) -> dict[sp.Symbol, sp.Expr]:
    """Stretches and inelastic stretches of the full membrane, with their rates, under the constraint."""
    moving = load_case.coordinates + load_case.internals
    full = zip(
        model.coordinates + model.internals, load_case.stretches + load_case.inelastic_stretches, strict=True
    )
    substitution: dict[sp.Symbol, sp.Expr] = {}
    for variable, value in full:
        rate = time_derivative(value, moving)
        substitution[variable.value.symbol] = value
        substitution[variable.rate.symbol] = rate
        substitution[variable.acceleration.symbol] = time_derivative(rate, moving)
    return substitution


def loads(model: Membrane, load_case: LoadCase) -> dict[sp.Symbol, sp.Expr]:
    return {force.symbol: value for force, value in zip(model.forces, load_case.forces, strict=True)}


def _constrain(expression: sp.Expr, substitution: Substitution) -> sp.Expr:
    return expression.subs(substitution, simultaneous=True)


def _map_energies(energies: Energies, function) -> Energies:
    return Energies(**{part.name: function(getattr(energies, part.name)) for part in fields(Energies)})


# --- reactions -------------------------------------------------------------------------------------


def _held_axes(load_case: LoadCase) -> tuple[tuple[int, Quantity], ...]:
    """Axes whose force is a reaction, with that reaction."""
    return tuple(
        (axis, reaction)
        for axis, force in enumerate(load_case.forces)
        for reaction in load_case.reactions
        if force == reaction.symbol
    )


def reaction_forces(model: Membrane, load_case: LoadCase) -> tuple[sp.Expr, ...]:
    """The force on each held axis that makes its own Euler-Lagrange equation true on the constraint [N]."""
    residuals = euler_lagrange(model.kinetic_energy - model.energies.total, model.coordinates)
    substitution = kinematics(model, load_case) | loads(model, load_case)
    found = []
    for axis, reaction in _held_axes(load_case):
        residual = _constrain(residuals[axis], substitution)
        slope = residual.diff(reaction.symbol)
        found.append(tidy(-residual.subs(reaction.symbol, 0) / slope))
    return tuple(found)


def edge_forces(model: Membrane, substitution: Substitution) -> tuple[sp.Expr, sp.Expr]:
    """The force on each edge that balances springs and field at rest [N]: applied, or of what holds the axis.

    From the full membrane, whatever the formulation of the load case: of the virtual work along one axis,
    d(Pi without the forces)/d lambda_i = P_i times the lever of the force.
    """
    inner = model.energies.total - model.energies.forces

    def balancing(axis: int) -> sp.Expr:
        stretch, force = model.coordinates[axis].value.symbol, model.forces[axis].symbol
        lever = -model.energies.forces.diff(stretch, force)
        return tidy(_constrain(inner.diff(stretch) / lever, substitution))

    return balancing(0), balancing(1)


def at_rest(expression: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> sp.Expr:
    """The static part: all rates and accelerations zero."""
    moving = {symbol: 0 for c in coordinates for symbol in (c.rate.symbol, c.acceleration.symbol)}
    return expression.subs(moving)


def _with_reaction_in_potential(
    energies: Energies, model: Membrane, load_case: LoadCase, substitution: Substitution
) -> Energies:
    """Eq. (20): the static reaction inserted into the potential, each of its parts beside its like.

    At rest the force on a held axis balances the slope of every other part of the potential, so that each
    part brings its own share of the reaction.
    """

    def with_share(name: str) -> sp.Expr:
        share = sp.S.Zero
        for axis, reaction in _held_axes(load_case):
            stretch, force = model.coordinates[axis].value.symbol, model.forces[axis].symbol
            lever = model.energies.forces.diff(stretch, force)
            slope = _constrain(getattr(model.energies, name).diff(stretch), substitution)
            share -= energies.forces.diff(reaction.symbol) * slope / lever
        return tidy(getattr(energies, name) + share)

    return Energies(
        spring_alpha=with_share("spring_alpha"),
        spring_beta=with_share("spring_beta"),
        forces=energies.forces.subs({reaction.symbol: 0 for reaction in load_case.reactions}),
        electrostatic=with_share("electrostatic"),
    )


# --- internal variables ----------------------------------------------------------------------------


def _equal(left: sp.Expr, right: sp.Expr) -> bool:
    return sp.simplify(left - right) == 0


def internal_rates(model: Membrane, load_case: LoadCase, substitution: Substitution) -> tuple[sp.Expr, ...]:
    """Flow of the inelastic stretches that the load case lets move [1/s], Eqs. (5)-(6).

    Raises:
        ValueError: the dashpots of two axes ask for different rates of one inelastic stretch, or one has
            no rate at all.
    """
    laws = [tidy(_constrain(rate, substitution)) for rate in model.dashpot_rates]
    rates = tuple(_rate_of(internal, laws, load_case) for internal in load_case.internals)
    flow = {internal.rate.symbol: rate for internal, rate in zip(load_case.internals, rates, strict=True)}
    for law, xi in zip(laws, load_case.inelastic_stretches, strict=True):
        moving = [internal for internal in load_case.internals if xi.has(internal.value.symbol)]
        if moving and not _equal(time_derivative(xi, load_case.internals).subs(flow), law):
            raise ValueError(
                f"load case {load_case.name}: {moving[0].value.name} has two different dashpot rates"
            )
    return rates


def _rate_of(internal: TimeDependent, laws: list[sp.Expr], load_case: LoadCase) -> sp.Expr:
    """From the first axis whose inelastic stretch it alone determines, by the chain rule."""
    others = {other.value.symbol for other in load_case.internals} - {internal.value.symbol}
    for law, xi in zip(laws, load_case.inelastic_stretches, strict=True):
        slope = xi.diff(internal.value.symbol)
        if slope != 0 and not xi.free_symbols & others:
            return tidy(law / slope)
    raise ValueError(f"load case {load_case.name}: {internal.value.name} has no dashpot rate of its own")


def dissipation(model: Membrane, load_case: LoadCase, substitution: Substitution) -> Dissipation:
    internals = {internal.value.symbol for internal in load_case.internals}
    first, second, third = (tidy(_constrain(deviator, substitution)) for deviator in model.dashpot_deviators)
    along_1, along_2 = (bool(xi.free_symbols & internals) for xi in load_case.inelastic_stretches)
    return Dissipation((first, second, third), (along_1, along_2))


# --- the first-order system ------------------------------------------------------------------------


def mass_matrix(residuals: tuple[sp.Expr, ...], coordinates: tuple[TimeDependent, ...]) -> sp.ImmutableMatrix:
    """Coefficients of the accelerations [kg m^2]."""
    accelerations = [c.acceleration.symbol for c in coordinates]
    return sp.ImmutableMatrix(sp.Matrix(residuals).jacobian(accelerations).applyfunc(tidy))


def _generalised_force(potential: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix([tidy(-potential.diff(c.value.symbol)) for c in coordinates])


def force_terms(
    kinetic: sp.Expr, energies: Energies, coordinates: tuple[TimeDependent, ...], remark: str = ""
) -> tuple[ForceTerm, ...]:
    """The generalised force by physical origin [J]; M q'' is their sum.

    `remark` is what must be said of the springs' and the field's share.
    """
    no_acceleration = {c.acceleration.symbol: 0 for c in coordinates}
    inertia = [tidy(-residual.subs(no_acceleration)) for residual in euler_lagrange(kinetic, coordinates)]
    parts = (
        ("inertia_force", "the thickness inertia, quadratic in the rates", sp.ImmutableMatrix(inertia)),
        ("spring_alpha_force", f"spring α{remark}", _generalised_force(energies.spring_alpha, coordinates)),
        ("spring_beta_force", f"spring β{remark}", _generalised_force(energies.spring_beta, coordinates)),
        ("applied_force", "the applied forces", _generalised_force(energies.forces, coordinates)),
        (
            "electric_force",
            f"the Maxwell stress{remark}",
            _generalised_force(energies.electrostatic, coordinates),
        ),
    )
    return tuple(ForceTerm(name, meaning, vector) for name, meaning, vector in parts)


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
    """Jacobian of (q', q'', xi') with respect to state or inputs; q'' stays a symbol.

    From M q'' = F: dq''/dy = M^-1 (dF/dy - dM/dy q''). Only the rows of q'' are not elementary.
    """
    variables = [quantity.symbol for quantity in by]
    velocities = sp.Matrix([c.rate.symbol for c in load_case.coordinates])
    acceleration_rows = mass.adjugate() * unbalanced / mass.det()
    internal_rows = sp.Matrix(rates).jacobian(variables).applyfunc(tidy)
    return sp.ImmutableMatrix(
        sp.Matrix.vstack(velocities.jacobian(variables), acceleration_rows, internal_rows)
    )


def force_power(energies: Energies, coordinates: tuple[TimeDependent, ...]) -> sp.Expr:
    """Power of the applied forces at constant force [W]."""
    return tidy(-time_derivative(energies.forces, coordinates))


# --- all together ----------------------------------------------------------------------------------


def equations_of_motion(model: Membrane, load_case: LoadCase) -> EquationsOfMotion:
    """Constrain the membrane, vary, and collect what follows.

    Raises:
        ValueError: the constraint is at odds with the law of the dashpots.
    """
    substitution = kinematics(model, load_case) | loads(model, load_case)
    coordinates = load_case.coordinates
    kinetic = tidy(_constrain(model.kinetic_energy, substitution))
    with_reactions = _map_energies(model.energies, lambda part: tidy(_constrain(part, substitution)))
    reactions = reaction_forces(model, load_case)
    static = tuple(tidy(at_rest(reaction, coordinates)) for reaction in reactions)
    if load_case.formulation == REACTION_IN_POTENTIAL:
        energies = _with_reaction_in_potential(with_reactions, model, load_case, substitution)
    else:
        workless = {reaction.symbol: 0 for reaction in load_case.reactions}
        energies = _map_energies(with_reactions, lambda part: part.subs(workless))
    residuals = euler_lagrange(kinetic - energies.total, coordinates)
    mass = mass_matrix(residuals, coordinates)
    inserted = load_case.formulation == REACTION_IN_POTENTIAL
    remark = ", with its share of the inserted reaction" if inserted else ""
    forces = force_terms(kinetic, energies, coordinates, remark)
    rates = internal_rates(model, load_case, substitution)
    force = sum((term.vector for term in forces), sp.zeros(len(coordinates), 1))
    state, inputs = state_of(load_case), load_case.inputs
    unbalanced = unbalanced_jacobian(mass, force, load_case, state)
    unbalanced_by_inputs = unbalanced_jacobian(mass, force, load_case, inputs)
    return EquationsOfMotion(
        membrane=model,
        load_case=load_case,
        parameters=model.parameters + load_case.parameters,
        principal_stretches=tuple(_constrain(stretch, substitution) for stretch in model.principal_stretches),
        kinetic_energy=kinetic,
        energies=energies,
        potential_with_reactions=with_reactions.total,
        residuals=residuals,
        mass_matrix=mass,
        force_terms=forces,
        internal_rates=rates,
        reaction_forces=static if load_case.formulation == REACTION_IN_POTENTIAL else reactions,
        static_reaction_forces=static,
        edge_forces=edge_forces(model, substitution),
        force_power=force_power(energies, coordinates),
        dissipation=dissipation(model, load_case, substitution),
        unbalanced_jacobian=unbalanced,
        jacobian=first_order_jacobian(mass, unbalanced, rates, load_case, state),
        unbalanced_input_jacobian=unbalanced_by_inputs,
        input_jacobian=first_order_jacobian(mass, unbalanced_by_inputs, rates, load_case, inputs),
    )
