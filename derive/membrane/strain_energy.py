"""Strain-energy densities of incompressible elastomers, as functions of the principal stretches.

A density takes three stretches as if they were independent; incompressibility is put in by whoever
knows the motion. That lets one density give both an energy and the principal stresses. Constructors
by name, for one spring or another, are in `delagrange.derive.membrane.materials`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.polys.ring_series import rs_series_reversion

from delagrange.derive.notation.symbols import Quantity

Stretches = tuple[sp.Expr, sp.Expr, sp.Expr]

ARRUDA_BOYCE_TERMS = 5
_REST = (sp.Integer(1), sp.Integer(1), sp.Integer(1))


@dataclass(frozen=True)
class StrainEnergy:
    """A strain-energy density [J/m^3] of the three principal stretches [1]."""

    name: str
    parameters: tuple[Quantity, ...]
    density: Callable[[Stretches], sp.Expr]
    source: str
    validity: Callable[[Stretches], sp.Expr] | None = None  # [1], positive where the density holds; None: all

    def cauchy_stresses(self, stretches: Stretches) -> Stretches:
        """Principal Cauchy stresses [Pa] up to a pressure, sigma_i = lambda_i dW/dlambda_i."""
        independent = sp.symbols("stretch_a stretch_b stretch_c", positive=True)
        density = self.density(independent)
        at = dict(zip(independent, stretches, strict=True))
        first, second, third = (
            (stretch * density.diff(stretch)).subs(at, simultaneous=True) for stretch in independent
        )
        return first, second, third

    @property
    def shear_modulus(self) -> sp.Expr:
        """Shear modulus at rest [Pa] in the plane: a quarter of d^2W/dlambda^2 at (lambda, 1/lambda, 1), lambda = 1."""
        stretch = sp.Symbol("stretch_a", positive=True)
        sheared = self.density((stretch, 1 / stretch, sp.Integer(1)))
        return sp.factor_terms(sheared.diff(stretch, 2).subs(stretch, 1) / 4)


def rest_stresses(energy: StrainEnergy) -> Stretches:
    """Principal Cauchy stresses [Pa] at rest that no pressure can balance; all zero where it is stress-free."""
    stresses = energy.cauchy_stresses(_REST)
    mean = sum(stresses, sp.Integer(0)) / 3
    first, second, third = (sp.simplify(stress - mean) for stress in stresses)
    return first, second, third


def stress_free_at_rest(energy: StrainEnergy) -> bool:
    """Whether the principal stresses, known up to a pressure, are equal at rest for all values of the parameters."""
    return all(stress == 0 for stress in rest_stresses(energy))


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
    """Gent density -mu J_m/2 log(1 - (I_1 - 3)/J_m) [J/m^3]. Gent (1996), Rubber Chem. Technol. 69, 59, Eq. (4).

    It holds where J_m - (I_1 - 3) is positive; there the chains reach their full length.
    """

    def density(stretches: Stretches) -> sp.Expr:
        mu, limit = shear_modulus.symbol, locking.symbol
        return -mu * limit / 2 * sp.log(1 - (_first_invariant(stretches) - 3) / limit)

    def room(stretches: Stretches) -> sp.Expr:
        return locking.symbol - (_first_invariant(stretches) - 3)

    return StrainEnergy(
        "Gent", (shear_modulus, locking), density, "Gent (1996), Rubber Chem. Technol. 69, 59, Eq. (4)", room
    )


def yeoh(first: Quantity, second: Quantity, third: Quantity) -> StrainEnergy:
    """Yeoh density C_1 (I_1 - 3) + C_2 (I_1 - 3)^2 + C_3 (I_1 - 3)^3 [J/m^3]; the shear modulus at rest is 2 C_1.

    Yeoh (1993), Rubber Chem. Technol. 66, 754.
    """
    coefficients = (first, second, third)

    def density(stretches: Stretches) -> sp.Expr:
        excess = _first_invariant(stretches) - 3
        return sum((c.symbol * excess**power for power, c in enumerate(coefficients, 1)), sp.Integer(0))

    return StrainEnergy("Yeoh", coefficients, density, "Yeoh (1993), Rubber Chem. Technol. 66, 754")


def ogden(moduli: Sequence[Quantity], exponents: Sequence[Quantity | int | sp.Rational]) -> StrainEnergy:
    """Ogden density, the sum of mu_p/a_p (lambda_1^a_p + lambda_2^a_p + lambda_3^a_p - 3) [J/m^3].

    Ogden (1972), Proc. R. Soc. Lond. A 326, 565. The shear modulus at rest is half the sum of mu_p a_p.

    Args:
        moduli: mu_p, one for each term.
        exponents: a_p, each a parameter or an exact number other than zero.

    Raises:
        ValueError: there is no term, not as many exponents as moduli, or an exponent is zero.
    """
    if not moduli or len(moduli) != len(exponents):
        raise ValueError(
            f"an Ogden energy has as many exponents as moduli, at least one; got {len(moduli)} moduli "
            f"and {len(exponents)} exponents"
        )
    powers = tuple(each.symbol if isinstance(each, Quantity) else sp.Rational(each) for each in exponents)
    if any(power == 0 for power in powers):
        raise ValueError("an exponent of an Ogden energy must not be 0: its term would have no energy")

    def density(stretches: Stretches) -> sp.Expr:
        return sum(
            (
                modulus.symbol / power * (sum(stretch**power for stretch in stretches) - 3)
                for modulus, power in zip(moduli, powers, strict=True)
            ),
            sp.Integer(0),
        )

    variable = tuple(each for each in exponents if isinstance(each, Quantity))
    return StrainEnergy(
        "Ogden", (*moduli, *variable), density, "Ogden (1972), Proc. R. Soc. Lond. A 326, 565"
    )


def inverse_langevin_series(terms: int) -> tuple[sp.Rational, ...]:
    """Coefficients of x, x^3, x^5, ... in the series of the inverse of L(b) = coth b - 1/b.

    The series of L, 2^(2n) B_2n b^(2n-1) / (2n)! with the Bernoulli numbers B, is reverted in exact numbers.
    """
    highest = 2 * terms - 1
    _, b, x = sp.ring("b, x", sp.QQ)
    langevin = sum(
        sp.QQ.convert(4**n * sp.bernoulli(2 * n) / sp.factorial(2 * n)) * b ** (2 * n - 1)
        for n in range(1, terms + 1)
    )
    inverse = rs_series_reversion(langevin, b, highest + 1, x)
    return tuple(sp.QQ.to_sympy(inverse.coeff(x**power)) for power in range(1, highest + 1, 2))


def arruda_boyce(modulus: Quantity, locking_stretch: Quantity) -> StrainEnergy:
    """Arruda-Boyce eight-chain density, five terms of its series in I_1 [J/m^3].

    Arruda & Boyce (1993), J. Mech. Phys. Solids 41, 389. A chain of N = lambda_m^2 links with the stretch
    sqrt(I_1/3) carries the force L^-1(x), x = sqrt(I_1/(3 N)); the density is mu N times the integral of
    L^-1 from x at rest to x, with L^-1 as its series up to x^9:
    mu (1/2 (I_1 - 3) + 1/(20 N) (I_1^2 - 9) + 11/(1050 N^2) (I_1^3 - 27) + ...). mu is the modulus of the
    chains; the shear modulus at rest is larger, mu (1 + 3/(5 N) + ...). The series does not lock: it stays
    finite where the chains reach their full length, I_1 = 3 N, and is then too soft.
    """

    def density(stretches: Stretches) -> sp.Expr:
        mu, links = modulus.symbol, locking_stretch.symbol**2
        first = _first_invariant(stretches)
        coefficients = inverse_langevin_series(ARRUDA_BOYCE_TERMS)
        return sum(
            (
                mu * coefficient / (2 * k * 3**k) / links ** (k - 1) * (first**k - 3**k)
                for k, coefficient in enumerate(coefficients, 1)
            ),
            sp.Integer(0),
        )

    return StrainEnergy(
        "Arruda-Boyce",
        (modulus, locking_stretch),
        density,
        "Arruda & Boyce (1993), J. Mech. Phys. Solids 41, 389, five terms of the series",
    )
