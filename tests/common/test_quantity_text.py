"""Values with units: converted exactly, refused where the dimension is another."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange.common.dimension import Dimension
from delagrange.common.quantity_text import (
    PREFIXED,
    PREFIXES,
    Unit,
    coherent,
    read_quantity,
    read_with_unit,
)


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        ("42 kPa", "Pa", 4.2e4), ("1.5 mm", "m", 1.5e-3), ("1.2 g/cm^3", "kg/m^3", 1200.0),
        ("5 MV/m", "V/m", 5e6), ("5 V/um", "V/m", 5e6), ("50 µm", "m", 5e-5), ("50 μm", "m", 5e-5),
        ("16.8 MPa s", "Pa s", 1.68e7), ("16.8 kPa*ms", "Pa s", 16.8), ("16.8 Pa·s", "Pa s", 16.8),
        ("61.98 pF/m", "F/m", 6.198e-11), ("1 N/mm^2", "Pa", 1e6), ("3 mC/m^2", "C/m^2", 3e-3), ("2 g", "kg", 2e-3),
        ("42kPa", "Pa", 4.2e4), ("  -1e3 mN ", "N", -1.0), ("3 1/ms", "1/s", 3000.0), ("0.3", "1", 0.3),
        ("3 m/mm", "1", 3000.0), (42, "Pa", 42.0), (4.2e4, "Pa", 4.2e4), ("1 m^-1", "1/m", 1.0),
        ("1 J/m^3", "Pa", 1.0), (".5 kHz", "1/s", 500.0),
    ],
)  # fmt: skip
def test_values_in_si_units(value, unit, expected):
    assert read_quantity("value", value, unit) == expected


@pytest.mark.parametrize(
    ("value", "unit", "message"),
    [
        ("42 kg", "Pa", r"modulus = '42 kg' has a unit of dimension kg; needed is Pa \(kg m\^-1 s\^-2\)"),
        ("42 kPa", "1", "needed is a pure number"),
        ("42", "Pa", "must carry a unit as a text, such as '1.5 Pa'"),
        ("42 kPo", "Pa", "'kPo' is none of"),
        ("42 kkPa", "Pa", "'kkPa' is none of"),
        ("42 mkg", "kg", "'mkg' is none of"),
        ("soft", "Pa", "must be a number in Pa, such as '1.5 Pa', got 'soft'"),
        ("nan Pa", "Pa", "must be a number in Pa"),
        ("inf Pa", "Pa", "must be a number in Pa"),
        ("1e999 Pa", "Pa", "must be finite in Pa"),
        ("1e308 kPa", "Pa", "must be finite in Pa"),
        (10**400, "Pa", "must be finite in Pa"),
        (math.nan, "Pa", "must be finite in Pa"),
        (math.inf, "Pa", "must be finite in Pa"),
        (True, "Pa", "or a text with a unit, got True"),
        ([1.0], "Pa", "or a text with a unit"),
        (None, "Pa", "or a text with a unit"),
        ("1 m/s/s", "m/s", "one '/' is allowed|'s/s' is none of"),
        ("1 m^99999999", "m", "exponent '99999999' is not an integer from -6 to 6"),
        ("1 m^", "m", "exponent '' is not an integer"),
        ("1/2 Pa", "Pa", "one '/' is allowed"),
        ("1,5 Pa", "Pa", "is none of"),
        ("٣ Pa", "Pa", "must be a number in Pa"),
        ("1" * 100 + " Pa", "Pa", "must be a number in Pa"),
        ("3\x00 Pa", "Pa", "is not understood"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(value, unit, message):
    with pytest.raises(ValueError, match=message) as caught:
        read_quantity("modulus", value, unit)
    assert str(caught.value).startswith("modulus") and "\n" not in str(caught.value)


UNITS = st.builds(
    lambda prefix, name, power: f"{prefix}{name}{'' if power == 1 else f'^{power}'}",
    st.sampled_from(["", *sorted(PREFIXES)]),
    st.sampled_from(PREFIXED),
    st.integers(-6, 6).filter(bool),
)


@given(UNITS, UNITS)
def test_units_multiply_and_divide(first, second):
    """A product or quotient of units has the product or quotient of their scales and dimensions."""
    one, other = Unit.of_text(first), Unit.of_text(second)
    assert Unit.of_text(f"{first} {second}") == one * other
    assert Unit.of_text(f"{first}/{second}") == one / other


@given(UNITS, UNITS)
def test_the_coherent_unit_has_the_same_dimension_and_no_prefix(first, second):
    text = f"{first}/{second}"
    assert Unit.of_text(coherent(text)).scale == 1
    assert Dimension.of_unit(coherent(text)) == Unit.of_text(text).dimension


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_a_number_survives_its_text(number):
    assert read_quantity("value", f"{number!r} m", "m") == number
    assert read_quantity("value", number, "m") == number


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("42 kPa", (4.2e4, "Pa")), (0.3, (0.3, "1")), ("0.3", (0.3, "1")), (-2, (-2.0, "1")),
        ("1.2 g/cm^3", (1200.0, "kg/m^3")), ("3 mm", (3e-3, "m")), ("4 kPa ms", (4.0, "Pa s")),
    ],
)  # fmt: skip
def test_a_constant_brings_its_own_unit(value, expected):
    assert read_with_unit("k", value) == expected


@pytest.mark.parametrize("value", ["3 apples", "x", [3], True, "1e999 Pa"])
def test_a_constant_without_a_known_unit_is_refused(value):
    with pytest.raises(ValueError, match=r"^k "):
        read_with_unit("k", value)
