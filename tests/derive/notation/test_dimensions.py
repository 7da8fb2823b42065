"""Dimensions: their algebra, units read, and the term that breaks one."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from delagrange.common.dimension import Dimension
from delagrange.derive.notation import symbols as sym
from delagrange.derive.notation.dimensions import (
    DimensionError,
    check_terms,
    dimension_of,
    symbol_dimensions,
)
from delagrange.derive.notation.symbols import Quantity, TimeDependent

QUANTITIES = tuple(
    quantity
    for each in vars(sym).values()
    if isinstance(each, Quantity | TimeDependent)
    for quantity in ((each,) if isinstance(each, Quantity) else (each.value, each.rate, each.acceleration))
)
DIMENSIONS = symbol_dimensions(QUANTITIES)
RATIONALS = st.fractions(min_value=-4, max_value=4, max_denominator=6)
ANY_DIMENSION = st.builds(Dimension, RATIONALS, RATIONALS, RATIONALS, RATIONALS)

rho, L, H = (quantity.symbol for quantity in (sym.DENSITY, sym.HALF_LENGTH, sym.HALF_THICKNESS))
rate = sym.STRETCH_1.rate.symbol
stretch = sym.STRETCH_1.value.symbol
epsilon, E, mu = (quantity.symbol for quantity in (sym.PERMITTIVITY, sym.FIELD, sym.SHEAR_MODULUS_ALPHA))


def _unit(text: str) -> Dimension:
    return Dimension.of_unit(text)


@pytest.mark.parametrize(
    ("unit", "text"),
    [
        ("1", "1"), ("m", "m"), ("s", "s"), ("1/s", "s^-1"), ("1/s^2", "s^-2"), ("kg/m^3", "kg m^-3"),
        ("F/m", "kg^-1 m^-3 s^4 A^2"), ("V/m", "kg m s^-3 A^-1"), ("Pa", "kg m^-1 s^-2"),
        ("Pa s", "kg m^-1 s^-1"), ("N", "kg m s^-2"), ("J", "kg m^2 s^-2"), ("W", "kg m^2 s^-3"),
        ("J/m^3", "kg m^-1 s^-2"), ("N m", "kg m^2 s^-2"), ("m^-2", "m^-2"),
    ],
)  # fmt: skip
def test_unit_is_read(unit: str, text: str) -> None:
    assert str(_unit(unit)) == text


def test_units_that_are_names_of_one_another() -> None:
    assert _unit("J") == _unit("N m") == _unit("W s") == _unit("Pa m^3") == _unit("C V")
    assert _unit("F") == _unit("C/V")
    assert _unit("F/m") * _unit("V/m") ** 2 == _unit("Pa")


@pytest.mark.parametrize(
    "unit", ["", "furlong", "kg/", "/m", "N/m s", "kg/m/s", "m^", "m^x", "m^0.5", "m^²", "Pa*s"]
)
def test_bad_unit_is_named(unit: str) -> None:
    with pytest.raises(ValueError, match="is not understood") as caught:
        _unit(unit)
    assert repr(unit) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_every_unit_of_the_symbol_table_is_read() -> None:
    assert set(DIMENSIONS) == {quantity.symbol for quantity in QUANTITIES}


@given(ANY_DIMENSION, ANY_DIMENSION, ANY_DIMENSION)
def test_dimensions_are_an_abelian_group(a: Dimension, b: Dimension, c: Dimension) -> None:
    one = Dimension()
    assert (a * b) * c == a * (b * c)
    assert a * b == b * a
    assert a * one == a
    assert a / a == one
    assert (a / b) * b == a


@given(ANY_DIMENSION, RATIONALS, RATIONALS)
def test_powers_add_and_multiply(a: Dimension, p: Fraction, q: Fraction) -> None:
    assert a**p * a**q == a ** (p + q)
    assert (a**p) ** q == a ** (p * q)


def test_fractional_exponent_is_printed_in_brackets() -> None:
    assert str(_unit("m") ** Fraction(1, 2)) == "m^(1/2)"


def test_kinetic_energy_is_an_energy() -> None:
    energy = sp.Rational(8, 3) * rho * L**4 * H * rate**2 + 16 * rho * L**2 * H**3 * rate**2 / stretch**6
    assert dimension_of(energy, DIMENSIONS) == _unit("J")
    assert all(term.ok for term in check_terms(energy, DIMENSIONS))


def test_term_that_breaks_the_unit_is_named() -> None:
    odd = epsilon * E * stretch  # the field should be squared
    pressure = mu * stretch**2 + mu / stretch**4 + odd
    with pytest.raises(DimensionError) as caught:
        dimension_of(pressure, DIMENSIONS)
    assert caught.value.terms == (odd,)
    assert str(odd) in str(caught.value)
    assert str(_unit("Pa")) in str(caught.value)
    assert "\n" not in str(caught.value)
    assert [term.term for term in check_terms(pressure, DIMENSIONS) if not term.ok] == [odd]


def test_broken_sum_inside_a_term_is_found() -> None:
    with pytest.raises(DimensionError):
        check_terms(rho + rho * (L + stretch), DIMENSIONS)


def test_a_tie_is_decided_by_the_first_term() -> None:
    found = check_terms(sp.Add(L, mu, evaluate=False), DIMENSIONS)
    assert [term.ok for term in found] == [True, False]


@given(st.integers(min_value=-6, max_value=6), st.integers(min_value=1, max_value=5))
def test_power_of_a_symbol(numerator: int, denominator: int) -> None:
    power = sp.Rational(numerator, denominator)
    assert dimension_of(rho**power, DIMENSIONS) == _unit("kg/m^3") ** power


def test_root_function_and_exponent_of_pure_numbers() -> None:
    assert dimension_of(sp.sqrt(mu / rho), DIMENSIONS) == _unit("m/s")
    assert dimension_of(mu * sp.log(1 - stretch), DIMENSIONS) == _unit("Pa")
    assert dimension_of(stretch ** (stretch + 1), DIMENSIONS) == _unit("1")


@pytest.mark.parametrize(
    "expression", [sp.log(rho), sp.exp(L * stretch), sp.sin(E), stretch**L, rho**stretch, 2**mu]
)
def test_argument_or_exponent_with_a_unit_is_refused(expression: sp.Expr) -> None:
    with pytest.raises(DimensionError):
        dimension_of(expression, DIMENSIONS)


def test_unknown_symbol_is_named() -> None:
    with pytest.raises(ValueError, match="symbol zeta has no dimension"):
        dimension_of(sp.Symbol("zeta") * L, DIMENSIONS)


def test_construct_without_rule_is_named() -> None:
    with pytest.raises(ValueError, match="Integral has no rule"):
        dimension_of(sp.Integral(L, (L, 0, stretch)), DIMENSIONS)
