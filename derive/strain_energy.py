"""Strain-energy densities of incompressible elastomers, as functions of the principal stretches.

A density takes three stretches as if they were independent; incompressibility is put in by whoever
knows the motion. That lets one density give both an energy and the principal stresses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from delagrange.derive.symbols import Quantity

Stretches = tuple[sp.Expr, sp.Expr, sp.Expr]


@dataclass(frozen=True)
class StrainEnergy:
    """A strain-energy density [J/m^3] of the three principal stretches [1]."""

    name: str
    parameters: tuple[Quantity, ...]
    density: Callable[[Stretches], sp.Expr]
    source: str

    def cauchy_stresses(self, stretches: Stretches) -> Stretches:
        """Principal Cauchy stresses [Pa] up to a pressure, sigma_i = lambda_i dW/dlambda_i."""
        independent = sp.symbols("stretch_a stretch_b stretch_c", positive=True)
        density = self.density(independent)
        at = dict(zip(independent, stretches, strict=True))
        first, second, third = (
            (stretch * density.diff(stretch)).subs(at, simultaneous=True) for stretch in independent
        )
        return first, second, third


def _first_invariant(stretches: Stretches) -> sp.Expr:
    return sum((stretch**2 for stretch in stretches), sp.Integer(0))


def _second_invariant(stretches: Stretches) -> sp.Expr:
    return sum((stretch**-2 for stretch in stretches), sp.Integer(0))


def neo_hookean(shear_modulus: Quantity) -> StrainEnergy:
    """Neo-Hookean density mu/2 (I_1 - 3) [J/m^3]. Treloar (1943), Trans. Faraday Soc. 39, 241."""

    def density(stretches: Stretches) -> sp.Expr:
        return shear_modulus.symbol / 2 * (_first_invariant(stretches) - 3)

    return StrainEnergy(
        "neo-Hookean", (shear_modulus,), density, "Treloar (1943), Trans. Faraday Soc. 39, 241"
    )


def mooney_rivlin(first_modulus: Quantity, second_modulus: Quantity) -> StrainEnergy:
    """Mooney-Rivlin density mu_1/2 (I_1 - 3) + mu_2/2 (I_2 - 3) [J/m^3]. Mooney (1940), J. Appl. Phys. 11, 582."""

    def density(stretches: Stretches) -> sp.Expr:
        return first_modulus.symbol / 2 * (_first_invariant(stretches) - 3) + second_modulus.symbol / 2 * (
            _second_invariant(stretches) - 3
        )

    return StrainEnergy(
        "Mooney-Rivlin", (first_modulus, second_modulus), density, "Mooney (1940), J. Appl. Phys. 11, 582"
    )


def gent(shear_modulus: Quantity, locking: Quantity) -> StrainEnergy:
    """Gent density -mu J_m/2 log(1 - (I_1 - 3)/J_m) [J/m^3]. Gent (1996), Rubber Chem. Technol. 69, 59, Eq. (4)."""

    def density(stretches: Stretches) -> sp.Expr:
        mu, limit = shear_modulus.symbol, locking.symbol
        return -mu * limit / 2 * sp.log(1 - (_first_invariant(stretches) - 3) / limit)

    return StrainEnergy(
        "Gent", (shear_modulus, locking), density, "Gent (1996), Rubber Chem. Technol. 69, 59, Eq. (4)"
    )
