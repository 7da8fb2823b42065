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

from delagrange.derive.membrane.body import Body, Face, square
from delagrange.derive.membrane.description import MaxwellBranch
from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent


@dataclass(frozen=True)
class Dashpot:
    """The dashpot of a Maxwell branch."""

    viscosity: Quantity  # [Pa s]
    deviators: Stretches  # deviatoric stresses on it [Pa]
    rates: tuple[sp.Expr, ...]  # d xi_i/dt along the axes of the body's coordinates [1/s]


@dataclass(frozen=True)
class RayleighTerm:
    """A Rayleigh dissipation function, and what it is that dissipates."""

    name: str  # of the force in code
    meaning: str
    function: sp.Expr  # R [W], quadratic in the rates


def elastic_stretches(body: Body, internals: tuple[TimeDependent, ...]) -> Stretches:
    """Stretches of spring beta, lambda_i^e = lambda_i / xi_i; the xi_i are related as the stretches of the body are."""
    inelastic = body.stretches_of(internals)
    first, second, third = (
        stretch / xi for stretch, xi in zip(body.principal_stretches, inelastic, strict=True)
    )
    return first, second, third


def deviators(stresses: Stretches) -> Stretches:
    """Deviatoric stresses [Pa], which no pressure changes."""
    mean = sum(stresses) / 3
    first, second, third = (stress - mean for stress in stresses)
    return first, second, third


def dashpot_strain_rates(stresses: Stretches, viscosity: Quantity = s.VISCOSITY) -> Stretches:
    """Rate of deformation [1/s] of a Newtonian dashpot, deviatoric stress over 2 eta."""
    first, second, third = (deviator / (2 * viscosity.symbol) for deviator in deviators(stresses))
    return first, second, third


def dashpot(branch: MaxwellBranch, body: Body, internals: tuple[TimeDependent, ...]) -> Dashpot:
    """The dashpot of a branch whose inelastic stretches are `internals`."""
    stresses = branch.energy.cauchy_stresses(elastic_stretches(body, internals))
    strain_rates = dashpot_strain_rates(stresses, branch.viscosity)
    rates = tuple(
        internal.value.symbol * rate for internal, rate in zip(internals, strain_rates, strict=False)
    )
    return Dashpot(branch.viscosity, deviators(stresses), rates)


def parallel_dashpot(viscosity: Quantity, body: Body, volume: sp.Expr) -> RayleighTerm:
    """Kelvin-Voigt: R = eta V sum of d_i^2 with the rates of deformation d_i = lambda_i'/lambda_i.

    The stress is 2 eta d_i, as in the dashpots of the branches.
    """
    stretches = body.principal_stretches
    deformation = [rate / stretch for rate, stretch in zip(body.velocity(stretches), stretches, strict=True)]
    return RayleighTerm(
        "parallel_dashpot", "the parallel dashpot", viscosity.symbol * volume * square(deformation)
    )


def medium_drag(damping: Quantity, body: Body) -> RayleighTerm:
    """A medium on the faces: traction c v against the velocity v of each point, per area of reference.

    R = c/2 times the integral of v^2 over all faces.
    """

    def lost(face: Face) -> sp.Expr:
        components = body.velocity(face.place)
        return face.count * sum((face.domain.integral(each**2) for each in components), sp.Integer(0))

    function = damping.symbol / 2 * sum(map(lost, body.faces))
    return RayleighTerm("medium", "the surrounding medium", function)
