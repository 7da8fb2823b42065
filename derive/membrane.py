"""The full membrane, before any load case: motion, energies and the law of its dashpot.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, start from the motion of Eq. (1), the
kinetic energy integral of Eq. (3), the energies that make up the potential of Eq. (4), and a
Newtonian dashpot (the law behind Eqs. (5)-(6)). Only those starting points are written here; what
they lead to is computed.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive import symbols as s
from delagrange.derive.strain_energy import StrainEnergy, Stretches
from delagrange.derive.symbols import Quantity, TimeDependent

COORDINATES = (s.STRETCH_1, s.STRETCH_2)
INTERNALS = (s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2)
FORCES = (s.FORCE_1, s.FORCE_2)
_BODY = (
    (s.MATERIAL_X.symbol, s.HALF_LENGTH.symbol),
    (s.MATERIAL_Y.symbol, s.HALF_LENGTH.symbol),
    (s.MATERIAL_Z.symbol, s.HALF_THICKNESS.symbol),
)  # material coordinate, half extent


@dataclass(frozen=True)
class Energies:
    """The parts of the potential [J], in the order in which Eq. (4) lists them."""

    spring_alpha: sp.Expr
    spring_beta: sp.Expr
    forces: sp.Expr
    electrostatic: sp.Expr

    @property
    def total(self) -> sp.Expr:
        return self.spring_alpha + self.spring_beta + self.forces + self.electrostatic


@dataclass(frozen=True)
class Membrane:
    """A viscoelastic dielectric membrane with both in-plane stretches free.

    All expressions use the symbols of `coordinates`, `internals`, `forces` and the field.
    """

    coordinates: tuple[TimeDependent, ...]  # lambda_1, lambda_2
    internals: tuple[TimeDependent, ...]  # xi_1, xi_2
    forces: tuple[Quantity, ...]  # P_1, P_2
    field: Quantity  # E
    parameters: tuple[Quantity, ...]
    principal_stretches: Stretches
    volume: sp.Expr  # of the body [m^3]
    kinetic_energy: sp.Expr  # T [J]
    energies: Energies  # parts of Pi [J]
    dashpot_deviators: Stretches  # deviatoric stresses on the dashpot [Pa]
    dashpot_rates: tuple[sp.Expr, ...]  # d xi_i/dt [1/s]


def time_derivative(expression: sp.Expr, moving: tuple[TimeDependent, ...]) -> sp.Expr:
    """Total time derivative by the chain rule, for expressions of values and rates."""
    return sum(
        (
            expression.diff(m.value.symbol) * m.rate.symbol
            + expression.diff(m.rate.symbol) * m.acceleration.symbol
            for m in moving
        ),
        sp.Integer(0),
    )


def principal_stretches() -> Stretches:
    """In-plane stretches and the thickness stretch of an incompressible membrane [1]."""
    in_plane = [coordinate.value.symbol for coordinate in COORDINATES]
    return in_plane[0], in_plane[1], 1 / (in_plane[0] * in_plane[1])


def motion(stretches: Stretches) -> tuple[sp.Expr, ...]:
    """Place (x, y, z) [m] of the material point (X, Y, Z), homogeneous deformation, Eq. (1)."""
    return tuple(stretch * material for stretch, (material, _) in zip(stretches, _BODY, strict=True))


def integrate_over_body(density: sp.Expr, place: tuple[sp.Expr, ...]) -> sp.Expr:
    """Integral of a density over the deformed body, carried back to the reference body by its Jacobian."""
    volume_ratio = sp.Matrix(place).jacobian([material for material, _ in _BODY]).det()
    integral = sp.expand(density * sp.cancel(volume_ratio))
    for material, half_extent in _BODY:
        integral = sp.integrate(integral, (material, -half_extent, half_extent))
    return sp.expand(integral)


def kinetic_energy(place: tuple[sp.Expr, ...]) -> sp.Expr:
    """Kinetic energy T [J], the integral of rho v^2 / 2 over the body, Eq. (3)."""
    velocity = [time_derivative(component, COORDINATES) for component in place]
    density = s.DENSITY.symbol / 2 * sum((component**2 for component in velocity), sp.Integer(0))
    return integrate_over_body(density, place)


def work_of_forces(place: tuple[sp.Expr, ...]) -> sp.Expr:
    """Potential [J] of the dead loads: each pair of forces pulls two opposite edges apart."""
    edges = zip(FORCES, place[:2], _BODY[:2], strict=True)
    return -sum(
        (
            force.symbol * (x.subs(material, half_extent) - x.subs(material, -half_extent))
            for force, x, (material, half_extent) in edges
        ),
        sp.Integer(0),
    )


def electrostatic_energy_density(stretches: Stretches) -> sp.Expr:
    """Electrostatic energy [J/m^3] under voltage control, field in the deformed thickness, with the source's work."""
    true_field = s.FIELD.symbol / stretches[2]
    return -s.PERMITTIVITY.symbol / 2 * true_field**2


def elastic_stretches(stretches: Stretches) -> Stretches:
    """Stretches of spring beta, lambda_i^e = lambda_i / xi_i, with xi_1 xi_2 xi_3 = 1."""
    xi_1, xi_2 = (internal.value.symbol for internal in INTERNALS)
    return stretches[0] / xi_1, stretches[1] / xi_2, stretches[2] * xi_1 * xi_2


def deviators(stresses: Stretches) -> Stretches:
    """Deviatoric stresses [Pa], which no pressure changes."""
    mean = sum(stresses) / 3
    first, second, third = (stress - mean for stress in stresses)
    return first, second, third


def dashpot_strain_rates(stresses: Stretches) -> Stretches:
    """Rate of deformation [1/s] of a Newtonian dashpot, deviatoric stress over 2 eta.

    This is the law of which Eqs. (5)-(6) are the two in-plane components for neo-Hookean springs.
    """
    first, second, third = (deviator / (2 * s.VISCOSITY.symbol) for deviator in deviators(stresses))
    return first, second, third


def membrane(spring_alpha: StrainEnergy, spring_beta: StrainEnergy) -> Membrane:
    """Put the full membrane together from the strain energies of its two springs."""
    stretches = principal_stretches()
    place = motion(stretches)
    volume = integrate_over_body(sp.Integer(1), place)
    elastic = elastic_stretches(stretches)
    stresses = spring_beta.cauchy_stresses(elastic)
    strain_rates = dashpot_strain_rates(stresses)
    return Membrane(
        coordinates=COORDINATES,
        internals=INTERNALS,
        forces=FORCES,
        field=s.FIELD,
        parameters=(
            s.HALF_LENGTH, s.HALF_THICKNESS, s.DENSITY, s.PERMITTIVITY,
            *spring_alpha.parameters, *spring_beta.parameters, s.VISCOSITY,
        ),
        principal_stretches=stretches,
        volume=volume,
        kinetic_energy=kinetic_energy(place),
        energies=Energies(
            spring_alpha=volume * spring_alpha.density(stretches),
            spring_beta=volume * spring_beta.density(elastic),
            forces=work_of_forces(place),
            electrostatic=volume * electrostatic_energy_density(stretches),
        ),
        dashpot_deviators=deviators(stresses),
        dashpot_rates=tuple(
            internal.value.symbol * rate for internal, rate in zip(INTERNALS, strain_rates[:2], strict=True)
        ),
    )  # fmt: skip
