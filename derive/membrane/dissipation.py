"""What dissipates: the dashpots of Maxwell branches, a Kelvin-Voigt dashpot, the surrounding medium.

A branch's dashpot is Newtonian, the law of which Eqs. (5)-(6) of Sheng et al. (2015), J. Appl. Phys.,
doi:10.1063/1.4913384, are the two in-plane components for neo-Hookean springs: its rate of deformation
is the deviatoric stress over 2 eta. What acts on the stretches themselves has a Rayleigh dissipation
function R, half the power lost, and gives the generalised force -dR/dq' (Rayleigh 1873, Proc. London
Math. Soc. 4, 357).
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.membrane.description import Body, MaxwellBranch
from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent


@dataclass(frozen=True)
class Dashpot:
    """The dashpot of a Maxwell branch."""

    viscosity: Quantity  # [Pa s]
    deviators: Stretches  # deviatoric stresses on it [Pa]
    rates: tuple[sp.Expr, ...]  # d xi_i/dt along axes 1, 2 [1/s]


@dataclass(frozen=True)
class RayleighTerm:
    """A Rayleigh dissipation function, and what it is that dissipates."""

    name: str  # of the force in code
    meaning: str
    function: sp.Expr  # R [W], quadratic in the rates


def elastic_stretches(
    stretches: Stretches,
    internals: tuple[TimeDependent, ...] = (s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2),
) -> Stretches:
    """Stretches of spring beta, lambda_i^e = lambda_i / xi_i, with xi_1 xi_2 xi_3 = 1."""
    xi_1, xi_2 = (internal.value.symbol for internal in internals)
    return stretches[0] / xi_1, stretches[1] / xi_2, stretches[2] * xi_1 * xi_2


def deviators(stresses: Stretches) -> Stretches:
    """Deviatoric stresses [Pa], which no pressure changes."""
    mean = sum(stresses) / 3
    first, second, third = (stress - mean for stress in stresses)
    return first, second, third


def dashpot_strain_rates(stresses: Stretches, viscosity: Quantity = s.VISCOSITY) -> Stretches:
    """Rate of deformation [1/s] of a Newtonian dashpot, deviatoric stress over 2 eta."""
    first, second, third = (deviator / (2 * viscosity.symbol) for deviator in deviators(stresses))
    return first, second, third


def dashpot(branch: MaxwellBranch, stretches: Stretches, internals: tuple[TimeDependent, ...]) -> Dashpot:
    """The dashpot of a branch whose inelastic stretches are `internals`."""
    stresses = branch.energy.cauchy_stresses(elastic_stretches(stretches, internals))
    strain_rates = dashpot_strain_rates(stresses, branch.viscosity)
    rates = tuple(
        internal.value.symbol * rate for internal, rate in zip(internals, strain_rates[:2], strict=True)
    )
    return Dashpot(branch.viscosity, deviators(stresses), rates)


def parallel_dashpot(
    viscosity: Quantity, stretches: Stretches, rates: tuple[sp.Expr, ...], volume: sp.Expr
) -> RayleighTerm:
    """Kelvin-Voigt: R = eta V sum of d_i^2 with the rates of deformation d_i = lambda_i'/lambda_i.

    The stress is 2 eta d_i, as in the dashpots of the branches.
    """
    deformation = [rate / stretch for rate, stretch in zip(rates, stretches, strict=True)]
    power = sum((rate**2 for rate in deformation), sp.Integer(0))
    return RayleighTerm("parallel_dashpot", "the parallel dashpot", viscosity.symbol * volume * power)


def medium_drag(damping: Quantity, rates: tuple[sp.Expr, ...], body: Body) -> RayleighTerm:
    """A medium on both faces: traction c v against the velocity v of each point, per area of reference.

    R = c/2 times the integral of v^2 over both faces, with v = (lambda_1' X, lambda_2' Y, lambda_3' H).
    """
    length_1, length_2 = body.half_length_1.symbol, body.half_length_2.symbol
    mean_squares = (length_1**2 / 3, length_2**2 / 3, body.half_thickness.symbol**2)
    square = sum((mean * rate**2 for mean, rate in zip(mean_squares, rates, strict=True)), sp.Integer(0))
    faces = 2 * (2 * length_1) * (2 * length_2)
    return RayleighTerm("medium", "the surrounding medium", damping.symbol / 2 * faces * square)
