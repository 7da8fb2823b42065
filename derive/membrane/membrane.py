"""The full membrane, before any load case: its body with its energies and what dissipates.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, start from the motion of Eq. (1), the
kinetic energy integral of Eq. (3), the energies that make up the potential of Eq. (4), and a
Newtonian dashpot (the law behind Eqs. (5)-(6)). Only those starting points are written here, for any
body, any strain energies, any number of Maxwell branches and what else a description holds; what they lead to is
computed. The paper's membrane is one case.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.membrane.body import Body, kinetic_energy, potential_of_forces, volume_of
from delagrange.derive.membrane.description import Attachment, Description
from delagrange.derive.membrane.dissipation import (
    Dashpot,
    RayleighTerm,
    dashpot,
    elastic_stretches,
    medium_drag,
    parallel_dashpot,
)
from delagrange.derive.membrane.electrostatics import (
    ChargeBalance,
    Electrodes,
    charge_balance,
    electrodes,
    electrostatic_energy_density,
    input_of,
)
from delagrange.derive.membrane.energies import Energies, EnergyPart
from delagrange.derive.membrane.strain_energy import StrainEnergy, Stretches
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.notation.time_derivative import time_derivative


@dataclass(frozen=True)
class Membrane:
    """A viscoelastic dielectric body with all of its stretches free.

    All expressions use the symbols of `coordinates`, `internals`, `forces` and the field.
    """

    body: Body
    internals: tuple[TimeDependent, ...]  # inelastic stretches, one a coordinate, branch by branch
    field: Quantity  # what drives the electrodes: E, the nominal charge density, or the current with leakage
    parameters: tuple[Quantity, ...]
    springs: tuple[tuple[str, StrainEnergy], ...]  # what each is called, in parallel and in the branches
    volume: sp.Expr  # of the body [m^3]
    kinetic_energy: sp.Expr  # T [J]
    energies: Energies  # parts of Pi [J]
    dashpots: tuple[Dashpot, ...]  # one a branch
    rayleigh: tuple[RayleighTerm, ...]  # what else dissipates
    validity: tuple[sp.Expr, ...]  # [1], each positive where a strain energy holds
    electrodes: Electrodes
    charge_balance: ChargeBalance | None = None  # of a membrane that leaks

    @property
    def coordinates(self) -> tuple[TimeDependent, ...]:
        """lambda_1, lambda_2 of a membrane with two axes."""
        return self.body.coordinates

    @property
    def forces(self) -> tuple[Quantity, ...]:
        """One a coordinate, in their order: P_1, P_2."""
        return self.body.forces

    @property
    def principal_stretches(self) -> Stretches:
        return self.body.principal_stretches

    @property
    def dashpot_rates(self) -> tuple[sp.Expr, ...]:
        """d xi/dt [1/s] of the internals, in their order."""
        return tuple(rate for each in self.dashpots for rate in each.rates)


# --- what is attached ----------------------------------------------------------------------------


def attached_kinetic_energy(attachments: tuple[Attachment, ...], body: Body) -> sp.Expr:
    """Kinetic energy [J] of the masses on the edges, one on each."""
    return sp.Add(
        *(
            each.mass.symbol / 2 * time_derivative(edge, body.coordinates) ** 2
            for each in attachments
            if each.mass is not None
            for edge in body.edges[each.axis]
        )
    )


def edge_spring_energy(attachments: tuple[Attachment, ...], body: Body) -> sp.Expr:
    """Energy [J] of the springs on the edges, relaxed in the reference state."""
    at_rest = {coordinate.value.symbol: 1 for coordinate in body.coordinates}
    return sp.Add(
        *(
            each.stiffness.symbol / 2 * sp.factor(edge - edge.subs(at_rest)) ** 2
            for each in attachments
            if each.stiffness is not None
            for edge in body.edges[each.axis]
        )
    )


# --- all together ----------------------------------------------------------------------------------


def branch_internals(count: int, axes: int) -> tuple[tuple[TimeDependent, ...], ...]:
    """Inelastic stretches of each of `count` branches, one along each of the first `axes` axes."""
    if count == 1 and axes == 2:
        return ((s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2),)
    return tuple(
        tuple(
            m.inelastic_stretch(number if count > 1 else None, axis if axes > 1 else None)
            for axis in range(1, axes + 1)
        )
        for number in range(1, count + 1)
    )


def membrane(description: Description) -> Membrane:
    """Put the full membrane of a description together."""
    body, dielectric, branches = description.body, description.dielectric, description.branches
    stretches, volume = body.principal_stretches, volume_of(body)
    internals = branch_internals(len(branches), len(body.coordinates))
    strained = [stretches, *(elastic_stretches(body, own) for own in internals)]
    energies = [description.equilibrium_spring, *(branch.energy for branch in branches)]
    springs = tuple(zip(energies, strained, strict=True))
    return Membrane(
        body=body,
        internals=tuple(internal for own in internals for internal in own),
        field=input_of(dielectric),
        parameters=parameters_of(description),
        springs=tuple(zip(_spring_names(len(branches)), energies, strict=True)),
        volume=volume,
        kinetic_energy=kinetic_energy(body) + attached_kinetic_energy(description.attachments, body),
        energies=_energies(description, [volume * energy.density(at) for energy, at in springs], volume),
        dashpots=tuple(dashpot(branch, body, own) for branch, own in zip(branches, internals, strict=True)),
        rayleigh=_rayleigh(description, volume),
        validity=tuple(energy.validity(at) for energy, at in springs if energy.validity is not None),
        electrodes=electrodes(stretches, dielectric),
        charge_balance=charge_balance(stretches, dielectric),
    )


def parameters_of(description: Description) -> tuple[Quantity, ...]:
    """What the membrane is made of, each once: body, dielectric, springs with their dashpots, the rest."""
    dielectric = description.dielectric
    listed = [*description.body.parameters, *dielectric.permittivity.parameters]
    listed += [] if dielectric.leakage is None else [dielectric.leakage]
    listed += description.equilibrium_spring.parameters
    for branch in description.branches:
        listed += [*branch.energy.parameters, branch.viscosity]
    optional = [description.parallel_viscosity, description.medium_damping]
    optional += [part for each in description.attachments for part in (each.mass, each.stiffness)]
    return tuple(dict.fromkeys([*listed, *(quantity for quantity in optional if quantity is not None)]))


def _spring_names(branches: int) -> tuple[str, ...]:
    numbers = [f" of branch {number}" if branches > 1 else "" for number in range(1, branches + 1)]
    return ("spring α", *(f"spring β{which}" for which in numbers))


def _energies(description: Description, of_springs: list[sp.Expr], volume: sp.Expr) -> Energies:
    """The parts of the potential [J], in the order in which Eq. (4) lists them."""
    branches = len(of_springs) - 1
    keys = [f"spring_beta_{number}" if branches > 1 else "spring_beta" for number in range(1, branches + 1)]
    springs = zip(["spring_alpha", *keys], _spring_names(branches), of_springs, strict=True)
    parts = [EnergyPart(*each) for each in springs]
    body = description.body
    parts.append(EnergyPart("forces", "the applied forces", potential_of_forces(body)))
    density = electrostatic_energy_density(body.principal_stretches, description.dielectric)
    parts.append(EnergyPart("electrostatic", "the Maxwell stress", volume * density))
    springs = edge_spring_energy(description.attachments, body)
    if springs != 0:
        parts.append(EnergyPart("edge_springs", "the springs on the edges", springs))
    return Energies(tuple(parts))


def _rayleigh(description: Description, volume: sp.Expr) -> tuple[RayleighTerm, ...]:
    terms = []
    if description.parallel_viscosity is not None:
        terms.append(parallel_dashpot(description.parallel_viscosity, description.body, volume))
    if description.medium_damping is not None:
        terms.append(medium_drag(description.medium_damping, description.body))
    return tuple(terms)
