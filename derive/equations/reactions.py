"""Forces on the edges: those of what holds an axis, and those that balance springs and field at rest."""

from __future__ import annotations

import sympy as sp

from delagrange.derive.membrane.constraint import (
    Substitution,
    constrain,
    euler_lagrange,
    kinematics,
    loads,
    tidy,
)
from delagrange.derive.membrane.energies import Energies
from delagrange.derive.membrane.load_case import LoadCase
from delagrange.derive.membrane.membrane import Membrane
from delagrange.derive.notation.symbols import Quantity, TimeDependent


def _held_axes(load_case: LoadCase) -> tuple[tuple[int, Quantity], ...]:
    """Axes whose force is a reaction, with that reaction."""
    return tuple(
        (axis, reaction)
        for axis, force in enumerate(load_case.forces)
        for reaction in load_case.reactions
        if reaction.symbol in force.free_symbols
    )


def dissipative_residuals(model: Membrane) -> tuple[sp.Expr, ...]:
    """d/dt(dl/dq') - dl/dq + dR/dq' of the unconstrained membrane, one a stretch [J]."""
    lossless = euler_lagrange(model.kinetic_energy - model.energies.total, model.coordinates)
    lost = sp.Add(*(term.function for term in model.rayleigh))
    return tuple(
        residual + lost.diff(stretch.rate.symbol)
        for residual, stretch in zip(lossless, model.coordinates, strict=True)
    )


def reaction_forces(model: Membrane, load_case: LoadCase) -> tuple[sp.Expr, ...]:
    """The force on each held axis that makes its own Euler-Lagrange equation true on the constraint [N]."""
    residuals = dissipative_residuals(model)
    substitution = kinematics(model, load_case) | loads(model, load_case)
    found = []
    for axis, reaction in _held_axes(load_case):
        residual = constrain(residuals[axis], substitution)
        slope = residual.diff(reaction.symbol)
        found.append(tidy(-residual.subs(reaction.symbol, 0) / slope))
    return tuple(found)


def edge_forces(model: Membrane, substitution: Substitution) -> tuple[sp.Expr, ...]:
    """The force on each coordinate that balances springs and field at rest: applied, or of what holds the axis.

    From the full membrane, whatever the formulation of the load case: of the virtual work along one axis,
    d(Pi without the forces)/d lambda_i = P_i times the lever of the force.
    """
    forces = model.energies["forces"]
    inner = model.energies.total - forces

    def balancing(stretch: sp.Symbol, force: sp.Symbol) -> sp.Expr:
        lever = -forces.diff(stretch, force)
        return tidy(constrain(inner.diff(stretch) / lever, substitution))

    pairs = zip(model.coordinates, model.forces, strict=True)
    return tuple(balancing(coordinate.value.symbol, force.symbol) for coordinate, force in pairs)


def at_rest(expression: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> sp.Expr:
    """The static part: all rates and accelerations zero."""
    moving = {symbol: 0 for c in coordinates for symbol in (c.rate.symbol, c.acceleration.symbol)}
    return expression.subs(moving)


def with_reaction_in_potential(
    energies: Energies, model: Membrane, load_case: LoadCase, substitution: Substitution
) -> Energies:
    """Eq. (20): the static reaction inserted into the potential, each of its parts beside its like.

    At rest the force on a held axis balances the slope of every other part of the potential, so that each
    part brings its own share of the reaction.
    """

    def with_share(name: str, part: sp.Expr) -> sp.Expr:
        if name == "forces":
            return part.subs({reaction.symbol: 0 for reaction in load_case.reactions})
        share = sp.S.Zero
        for axis, reaction in _held_axes(load_case):
            stretch, force = model.coordinates[axis].value.symbol, model.forces[axis].symbol
            lever = model.energies["forces"].diff(stretch, force)
            slope = constrain(model.energies[name].diff(stretch), substitution)
            share -= energies["forces"].diff(reaction.symbol) * slope / lever
        return tidy(part + share)

    return energies.mapped(with_share)
