"""The full membrane, before any load case: motion, energies and what dissipates.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, start from the motion of Eq. (1), the
kinetic energy integral of Eq. (3), the energies that make up the potential of Eq. (4), and a
Newtonian dashpot (the law behind Eqs. (5)-(6)). Only those starting points are written here, for any
strain energies, any number of Maxwell branches and what else a description holds; what they lead to is
computed. The paper's membrane is one case.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.membrane.description import (
    EQUAL_BIAXIAL,
    Attachment,
    Body,
    Description,
    Load,
    MaxwellBranch,
)
from delagrange.derive.membrane.dissipation import (
    Dashpot,
    RayleighTerm,
    dashpot,
    dashpot_strain_rates,
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

__all__ = [
    "Membrane", "dashpot_strain_rates", "described_membrane", "elastic_stretches", "integrate_over_body",
    "membrane", "motion", "principal_stretches", "time_derivative",
]  # fmt: skip

COORDINATES = (s.STRETCH_1, s.STRETCH_2)
INTERNALS = (s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2)
FORCES = (s.FORCE_1, s.FORCE_2)
_PLACE = (s.MATERIAL_X.symbol, s.MATERIAL_Y.symbol, s.MATERIAL_Z.symbol)


@dataclass(frozen=True)
class Membrane:
    """A viscoelastic dielectric membrane with both in-plane stretches free.

    All expressions use the symbols of `coordinates`, `internals`, `forces` and the field.
    """

    coordinates: tuple[TimeDependent, ...]  # lambda_1, lambda_2
    internals: tuple[TimeDependent, ...]  # xi_1, xi_2 of each branch, branch by branch
    forces: tuple[Quantity, ...]  # P_1, P_2
    field: Quantity  # what drives the electrodes: E, the nominal charge density, or the current with leakage
    parameters: tuple[Quantity, ...]
    springs: tuple[tuple[str, StrainEnergy], ...]  # what each is called, in parallel and in the branches
    principal_stretches: Stretches
    volume: sp.Expr  # of the body [m^3]
    kinetic_energy: sp.Expr  # T [J]
    energies: Energies  # parts of Pi [J]
    dashpots: tuple[Dashpot, ...]  # one a branch
    rayleigh: tuple[RayleighTerm, ...]  # what else dissipates
    validity: tuple[sp.Expr, ...]  # [1], each positive where a strain energy holds
    electrodes: Electrodes
    charge_balance: ChargeBalance | None = None  # of a membrane that leaks

    @property
    def dashpot_rates(self) -> tuple[sp.Expr, ...]:
        """d xi/dt [1/s] of the internals, in their order."""
        return tuple(rate for each in self.dashpots for rate in each.rates)


def time_derivative(expression: sp.Expr, moving: tuple[TimeDependent, ...]) -> sp.Expr:
    """Total time derivative by the chain rule, for expressions of values and rates."""
    return sum(
        (
            expression.diff(each.value.symbol) * each.rate.symbol
            + expression.diff(each.rate.symbol) * each.acceleration.symbol
            for each in moving
        ),
        sp.Integer(0),
    )


def principal_stretches() -> Stretches:
    """In-plane stretches and the thickness stretch of an incompressible membrane [1]."""
    in_plane = [coordinate.value.symbol for coordinate in COORDINATES]
    return in_plane[0], in_plane[1], 1 / (in_plane[0] * in_plane[1])


def motion(stretches: Stretches) -> tuple[sp.Expr, ...]:
    """Place (x, y, z) [m] of the material point (X, Y, Z), homogeneous deformation, Eq. (1)."""
    return tuple(stretch * material for stretch, material in zip(stretches, _PLACE, strict=True))


def _extents(body: Body) -> tuple[tuple[sp.Symbol, sp.Symbol], ...]:
    """Material coordinate and half extent [m] along each axis."""
    halves = (body.half_length_1, body.half_length_2, body.half_thickness)
    return tuple((material, half.symbol) for material, half in zip(_PLACE, halves, strict=True))


def integrate_over_body(density: sp.Expr, place: tuple[sp.Expr, ...], body: Body | None = None) -> sp.Expr:
    """Integral of a density over the deformed body, carried back to the reference body by its Jacobian.

    `body`: the paper's square membrane where none is given.
    """
    volume_ratio = sp.Matrix(place).jacobian(_PLACE).det()
    integral = sp.expand(density * sp.cancel(volume_ratio))
    for material, half_extent in _extents(body or Body()):
        integral = sp.integrate(integral, (material, -half_extent, half_extent))
    return sp.expand(integral)


def kinetic_energy(place: tuple[sp.Expr, ...], body: Body) -> sp.Expr:
    """Kinetic energy T [J], the integral of rho v^2 / 2 over the body, Eq. (3)."""
    velocity = [time_derivative(component, COORDINATES) for component in place]
    density = body.density.symbol / 2 * sum((component**2 for component in velocity), sp.Integer(0))
    return integrate_over_body(density, place, body)


def work_of_forces(place: tuple[sp.Expr, ...], body: Body) -> sp.Expr:
    """Potential [J] of the dead loads: each pair of forces pulls two opposite edges apart."""
    edges = zip(FORCES, place[:2], _extents(body)[:2], strict=True)
    return -sum(
        (
            force.symbol * (x.subs(material, half_extent) - x.subs(material, -half_extent))
            for force, x, (material, half_extent) in edges
        ),
        sp.Integer(0),
    )


# --- what is attached ----------------------------------------------------------------------------


def _edge(attachment: Attachment, body: Body) -> tuple[TimeDependent, sp.Symbol]:
    """The stretch that moves the edges of an attachment, and their distance from the middle [m]."""
    at = attachment.axis - 1
    return COORDINATES[at], (body.half_length_1, body.half_length_2)[at].symbol


def attached_kinetic_energy(attachments: tuple[Attachment, ...], body: Body) -> sp.Expr:
    """Kinetic energy [J] of the masses on the edges, one on each of two opposite edges."""
    total = sp.Integer(0)
    for attachment in attachments:
        stretch, half = _edge(attachment, body)
        if attachment.mass is not None:
            total += attachment.mass.symbol * (half * stretch.rate.symbol) ** 2
    return total


def edge_spring_energy(attachments: tuple[Attachment, ...], body: Body) -> sp.Expr:
    """Energy [J] of the springs on the edges, relaxed in the reference state."""
    total = sp.Integer(0)
    for attachment in attachments:
        stretch, half = _edge(attachment, body)
        if attachment.stiffness is not None:
            total += attachment.stiffness.symbol * (half * (stretch.value.symbol - 1)) ** 2
    return total


# --- all together ----------------------------------------------------------------------------------


def membrane(spring_alpha: StrainEnergy, spring_beta: StrainEnergy) -> Membrane:
    """The square membrane of the paper from the strain energies of its two springs."""
    branch = MaxwellBranch(spring_beta, s.VISCOSITY)
    return described_membrane(Description("membrane", "", Load(EQUAL_BIAXIAL), spring_alpha, (branch,)))


def branch_internals(count: int) -> tuple[tuple[TimeDependent, TimeDependent], ...]:
    """Inelastic stretches along axes 1 and 2 of each branch; with one branch, those of the paper."""
    if count == 1:
        return (INTERNALS,)
    return tuple(
        (m.inelastic_stretch(number, 1), m.inelastic_stretch(number, 2)) for number in range(1, count + 1)
    )


def described_membrane(description: Description) -> Membrane:
    """Put the full membrane of a description together."""
    body, stretches = description.body, principal_stretches()
    place = motion(stretches)
    volume = integrate_over_body(sp.Integer(1), place, body)
    pairs = branch_internals(len(description.branches))
    attached = attached_kinetic_energy(description.attachments, body)
    return Membrane(
        coordinates=COORDINATES,
        internals=tuple(internal for pair in pairs for internal in pair),
        forces=FORCES,
        field=input_of(description.dielectric),
        parameters=parameters_of(description),
        springs=tuple(zip(_spring_names(description), _strain_energies(description), strict=True)),
        principal_stretches=stretches,
        volume=volume,
        kinetic_energy=kinetic_energy(place, body) + attached,
        energies=_energies(description, stretches, volume),
        dashpots=tuple(
            dashpot(branch, stretches, pair) for branch, pair in zip(description.branches, pairs, strict=True)
        ),
        rayleigh=_rayleigh(description, stretches, volume),
        validity=_validity(description, stretches),
        electrodes=electrodes(stretches, description.dielectric),
        charge_balance=charge_balance(stretches, description.dielectric, place),
    )


def parameters_of(description: Description) -> tuple[Quantity, ...]:
    """What the membrane is made of, each once: body, dielectric, springs with their dashpots, the rest."""
    body, dielectric = description.body, description.dielectric
    listed = [body.half_length_1, body.half_length_2, body.half_thickness, body.density]
    listed += dielectric.permittivity.parameters
    listed += [] if dielectric.leakage is None else [dielectric.leakage]
    listed += description.equilibrium_spring.parameters
    for branch in description.branches:
        listed += [*branch.energy.parameters, branch.viscosity]
    optional = [description.parallel_viscosity, description.medium_damping]
    optional += [part for each in description.attachments for part in (each.mass, each.stiffness)]
    return tuple(dict.fromkeys([*listed, *(quantity for quantity in optional if quantity is not None)]))


def _strain_energies(description: Description) -> tuple[StrainEnergy, ...]:
    return (description.equilibrium_spring, *(branch.energy for branch in description.branches))


def _spring_names(description: Description) -> tuple[str, ...]:
    count = len(description.branches)
    numbers = [f" of branch {number}" if count > 1 else "" for number in range(1, count + 1)]
    return ("spring α", *(f"spring β{which}" for which in numbers))


def _strained(description: Description, stretches: Stretches) -> tuple[tuple[StrainEnergy, Stretches], ...]:
    """Each spring with the stretches that it has: all of the membrane's, or the elastic ones of its branch."""
    count = len(description.branches)
    elastic = (elastic_stretches(stretches, pair) for pair in branch_internals(count)[:count])
    return tuple(zip(_strain_energies(description), (stretches, *elastic), strict=True))


def _energies(description: Description, stretches: Stretches, volume: sp.Expr) -> Energies:
    """The parts of the potential [J], in the order in which Eq. (4) lists them."""
    count = len(description.branches)
    numbers = [f"_{number}" if count > 1 else "" for number in range(1, count + 1)]
    keys = ("spring_alpha", *(f"spring_beta{number}" for number in numbers))
    densities = (energy.density(at) for energy, at in _strained(description, stretches))
    parts = [
        EnergyPart(key, name, volume * density)
        for key, name, density in zip(keys, _spring_names(description), densities, strict=True)
    ]
    place = motion(stretches)
    parts.append(EnergyPart("forces", "the applied forces", work_of_forces(place, description.body)))
    density = electrostatic_energy_density(stretches, description.dielectric)
    parts.append(EnergyPart("electrostatic", "the Maxwell stress", volume * density))
    springs = edge_spring_energy(description.attachments, description.body)
    if springs != 0:
        parts.append(EnergyPart("edge_springs", "the springs on the edges", springs))
    return Energies(tuple(parts))


def _rayleigh(description: Description, stretches: Stretches, volume: sp.Expr) -> tuple[RayleighTerm, ...]:
    rates = tuple(time_derivative(stretch, COORDINATES) for stretch in stretches)
    terms = []
    if description.parallel_viscosity is not None:
        terms.append(parallel_dashpot(description.parallel_viscosity, stretches, rates, volume))
    if description.medium_damping is not None:
        terms.append(medium_drag(description.medium_damping, rates, description.body))
    return tuple(terms)


def _validity(description: Description, stretches: Stretches) -> tuple[sp.Expr, ...]:
    springs = _strained(description, stretches)
    return tuple(energy.validity(at) for energy, at in springs if energy.validity is not None)
