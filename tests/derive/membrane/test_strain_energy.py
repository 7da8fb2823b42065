"""Strain energies against closed forms written by hand, their limits, and what holds for all of them."""

from __future__ import annotations

from itertools import permutations

import mpmath as mp
import pytest
import sympy as sp

from delagrange.derive.membrane.materials import ALPHA, BETA, MATERIALS
from delagrange.derive.membrane.strain_energy import (
    StrainEnergy,
    inverse_langevin_series,
    mooney_rivlin,
    neo_hookean,
    ogden,
    rest_stresses,
    stress_free_at_rest,
    yeoh,
)
from delagrange.derive.notation import symbols as s

STRETCHES = sp.symbols("l_1 l_2 l_3", positive=True)
TERMS = {"Ogden": 3}
ENERGIES = {name: MATERIALS[name](ALPHA, TERMS.get(name, 1)) for name in MATERIALS}
VALUES = {
    "neo-Hookean": (1.8e4,),
    "Mooney-Rivlin": (1.8e4, 3.1e3),
    "Yeoh": (9e3, -120.0, 4.5),
    "Ogden": (6.3e3, 1.2e2, -1.0e3, 1.3, 5.0, -2.0),
    "Gent": (4.5e4, 80.0),
    "Arruda-Boyce": (1.5e4, 5.99),
}


def _yeoh_factor(i_1, c_1, c_2, c_3):
    return 2 * (c_1 + 2 * c_2 * (i_1 - 3) + 3 * c_3 * (i_1 - 3) ** 2)


def _chain_factor(i_1, mu, locking_stretch):
    """mu L^-1(x) / (3 x) with the first five terms of Kuhn & Gruen's series, as printed in textbooks."""
    x = mp.sqrt(mp.mpf(i_1) / 3) / locking_stretch
    series = 3 * x + mp.mpf(9) / 5 * x**3 + mp.mpf(297) / 175 * x**5
    series += mp.mpf(1539) / 875 * x**7 + mp.mpf(126117) / 67375 * x**9
    return mu * series / (3 * x)


FACTORS = {  # nominal stress over the difference of stretches, of the materials in I_1
    "neo-Hookean": lambda i_1, mu: mu,
    "Yeoh": _yeoh_factor,
    "Gent": lambda i_1, mu, limit: mu * limit / (limit - (i_1 - 3)),
    "Arruda-Boyce": _chain_factor,
}


def uniaxial(name, stretch, values):
    """Nominal stress [Pa] of a bar pulled along one axis."""
    if name in FACTORS:
        return (stretch - stretch**-2) * FACTORS[name](stretch**2 + 2 / stretch, *values)
    if name == "Mooney-Rivlin":
        return (stretch - stretch**-2) * (values[0] + values[1] / stretch)
    pairs = zip(values[:3], values[3:], strict=True)
    return sum(mu * (stretch ** (a - 1) - stretch ** (-a / 2 - 1)) for mu, a in pairs)


def equal_biaxial(name, stretch, values):
    """Nominal stress [Pa] on each edge of a sheet pulled alike along two axes."""
    if name in FACTORS:
        return (stretch - stretch**-5) * FACTORS[name](2 * stretch**2 + stretch**-4, *values)
    if name == "Mooney-Rivlin":
        return (stretch - stretch**-5) * (values[0] + values[1] * stretch**2)
    pairs = zip(values[:3], values[3:], strict=True)
    return sum(mu * (stretch ** (a - 1) - stretch ** (-2 * a - 1)) for mu, a in pairs)


def nominal_stress(energy, values, at):
    """What the energy gives: Cauchy stress without that of the free third axis, over the stretch [Pa]."""
    numbers = dict(zip((parameter.symbol for parameter in energy.parameters), values, strict=True))
    first, _, third = energy.cauchy_stresses(STRETCHES)
    difference = sp.lambdify(STRETCHES, (first - third).subs(numbers), "mpmath")
    return difference(*at) / at[0]


@pytest.mark.parametrize("stretch", [0.6, 1.0, 1.3, 3.0])
@pytest.mark.parametrize("name", MATERIALS)
def test_nominal_stresses_are_the_closed_forms(name, stretch):
    energy, values, one = ENERGIES[name], VALUES[name], mp.mpf(stretch)
    pulled = nominal_stress(energy, values, (one, one**-0.5, one**-0.5))
    assert pulled == pytest.approx(float(uniaxial(name, one, values)), rel=1e-12, abs=1e-8)
    inflated = nominal_stress(energy, values, (one, one, one**-2))
    assert inflated == pytest.approx(float(equal_biaxial(name, one, values)), rel=1e-12, abs=1e-8)


@pytest.mark.parametrize("energy", ENERGIES.values(), ids=ENERGIES)
def test_no_energy_and_no_stress_at_rest(energy):
    assert sp.simplify(energy.density((sp.Integer(1),) * 3)) == 0
    assert stress_free_at_rest(energy)


@pytest.mark.parametrize("energy", ENERGIES.values(), ids=ENERGIES)
def test_axes_are_equals(energy):
    density = energy.density(STRETCHES)
    for order in permutations(STRETCHES):
        assert sp.expand(energy.density(order) - density) == 0


def test_a_stress_at_rest_is_seen():
    pulled = StrainEnergy("one axis only", (), lambda at: s.SHEAR_MODULUS_ALPHA.symbol * at[0] ** 2, "")
    mu = s.SHEAR_MODULUS_ALPHA.symbol
    assert not stress_free_at_rest(pulled)
    assert rest_stresses(pulled) == (4 * mu / 3, -2 * mu / 3, -2 * mu / 3)


@pytest.mark.parametrize("name", MATERIALS)
def test_shear_modulus_is_the_slope_of_the_uniaxial_stress_over_three(name):
    """Young's modulus of an incompressible solid is three shear moduli; the slope is that of the closed form."""
    energy, values = ENERGIES[name], VALUES[name]
    numbers = dict(zip((parameter.symbol for parameter in energy.parameters), values, strict=True))
    slope = mp.diff(lambda stretch: uniaxial(name, stretch, values), 1)
    assert float(energy.shear_modulus.subs(numbers)) == pytest.approx(float(slope) / 3, rel=1e-10)


def test_gent_without_locking_is_neo_hookean():
    density = MATERIALS["Gent"](BETA).density(STRETCHES)
    limit = sp.limit(density, MATERIALS["Gent"](BETA).parameters[1].symbol, sp.oo)
    assert sp.simplify(limit - neo_hookean(s.SHEAR_MODULUS_BETA).density(STRETCHES)) == 0


def test_arruda_boyce_of_endless_chains_is_neo_hookean():
    energy = ENERGIES["Arruda-Boyce"]
    modulus, locking_stretch = energy.parameters
    limit = sp.limit(energy.density(STRETCHES), locking_stretch.symbol, sp.oo)
    assert sp.simplify(limit - neo_hookean(modulus).density(STRETCHES)) == 0


def test_ogden_with_the_exponent_two_is_neo_hookean():
    mu = s.SHEAR_MODULUS_ALPHA
    assert sp.expand(ogden((mu,), (2,)).density(STRETCHES) - neo_hookean(mu).density(STRETCHES)) == 0


def test_ogden_with_the_exponents_two_and_minus_two_is_mooney_rivlin():
    first, second = MATERIALS["Mooney-Rivlin"](ALPHA).parameters
    density = ogden((first, second), (2, -2)).density(STRETCHES).subs(second.symbol, -second.symbol)
    assert sp.expand(density - mooney_rivlin(first, second).density(STRETCHES)) == 0


def test_yeoh_of_one_term_is_neo_hookean():
    coefficients = ENERGIES["Yeoh"].parameters
    density = yeoh(*coefficients).density(STRETCHES)
    one_term = density.subs({c.symbol: 0 for c in coefficients[1:]})
    mu = s.SHEAR_MODULUS_ALPHA
    expected = neo_hookean(mu).density(STRETCHES).subs(mu.symbol, 2 * coefficients[0].symbol)
    assert sp.expand(one_term - expected) == 0


@pytest.mark.parametrize("terms", [1, 2, 3, 5, 8])
def test_the_series_inverts_the_langevin_function_up_to_its_order(terms):
    """L(series(x)) - x begins with x^(2 terms + 1): halving x divides it by 2 to that power."""
    coefficients = inverse_langevin_series(terms)
    with mp.workdps(80):
        left = []
        for x in (mp.mpf("0.01"), mp.mpf("0.005")):
            b = sum(mp.mpf(c.p) / c.q * x ** (2 * k + 1) for k, c in enumerate(coefficients))
            left.append(mp.coth(b) - 1 / b - x)
        assert left[0] / left[1] == pytest.approx(2 ** (2 * terms + 1), rel=1e-3)
        assert 0 < abs(left[0]) < mp.mpf("0.01") ** (2 * terms + 1)


def test_arruda_boyce_is_the_chain_force_of_the_inverse_langevin_function():
    """Against L^-1 found by mpmath: the series is lacking x^10, and is softer the nearer the chains are to locking."""
    energy, (mu, locking_stretch) = ENERGIES["Arruda-Boyce"], VALUES["Arruda-Boyce"]
    lost = []
    for stretch in (2.0, 4.0, 8.0):
        x = mp.sqrt((stretch**2 + 2 / stretch) / 3) / locking_stretch
        chain_force = mp.findroot(lambda b, x=x: mp.coth(b) - 1 / b - x, 3 * x / (1 - x**2))
        exact = (stretch - stretch**-2) * mu * chain_force / (3 * x)
        ours = nominal_stress(energy, (mu, locking_stretch), (stretch, stretch**-0.5, stretch**-0.5))
        lost.append(1 - ours / exact)
        assert 0 < lost[-1] < x**10
    assert lost == sorted(lost)


def test_only_gent_has_a_limit_of_validity():
    limited = {name for name, energy in ENERGIES.items() if energy.validity is not None}
    assert limited == {"Gent"}


def test_gent_holds_until_the_first_invariant_reaches_its_limit():
    energy = MATERIALS["Gent"](ALPHA)
    locking = energy.parameters[1].symbol
    room = energy.validity((sp.Integer(2), sp.Integer(2), sp.Rational(1, 4)))
    assert sp.simplify(room - (locking - sp.Rational(81, 16))) == 0
    assert (
        energy.density((sp.Integer(2), sp.Integer(2), sp.Rational(1, 4)))
        .subs(locking, sp.Rational(81, 16) + sp.Rational(1, 1000))
        .subs(s.SHEAR_MODULUS_ALPHA.symbol, 1)
        > 0
    )


@pytest.mark.parametrize(
    ("moduli", "exponents", "reason"),
    [
        ((), (), "0 moduli and 0 exponents"),
        ((s.SHEAR_MODULUS_ALPHA,), (2, -2), "1 moduli and 2 exponents"),
        ((s.SHEAR_MODULUS_ALPHA,), (0,), "must not be 0"),
    ],
)
def test_an_ogden_energy_that_is_none_is_refused(moduli, exponents, reason):
    with pytest.raises(ValueError, match=reason):
        ogden(moduli, exponents)
