"""Dimensions over the SI base units kg, m, s, A."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from numbers import Rational
from operator import mul

_BASE = ("kg", "m", "s", "A")


@dataclass(frozen=True)
class Dimension:
    """A product of powers of kg, m, s and A; `Dimension()` is that of a pure number."""

    kg: Fraction = Fraction(0)
    m: Fraction = Fraction(0)
    s: Fraction = Fraction(0)
    A: Fraction = Fraction(0)

    @classmethod
    def of_unit(cls, unit: str) -> Dimension:
        """The dimension of a unit such as "kg/m^3", "Pa s", "1/s^2" or "1".

        Factors are separated by spaces; one "/" may precede the last factor.

        Raises:
            ValueError: the unit is not written so, or has a name that is not known.
        """
        above, slash, below = unit.partition("/")
        divisors = below.split()
        if not above.split() or len(divisors) != len(slash):
            raise ValueError(f"unit {unit!r} is not understood: one '/' is allowed, before the last factor")
        numerator = reduce(mul, (_unit_factor(factor, unit) for factor in above.split()))
        return numerator / _unit_factor(divisors[0], unit) if divisors else numerator

    @property
    def exponents(self) -> tuple[Fraction, Fraction, Fraction, Fraction]:
        """Exponents of kg, m, s, A."""
        return (self.kg, self.m, self.s, self.A)

    @property
    def is_number(self) -> bool:
        """Whether it is the dimension of a pure number."""
        return not any(self.exponents)

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(*(a + b for a, b in zip(self.exponents, other.exponents)))

    def __truediv__(self, other: Dimension) -> Dimension:
        return Dimension(*(a - b for a, b in zip(self.exponents, other.exponents)))

    def __pow__(self, power: int | Rational) -> Dimension:
        exact = Fraction(int(power.numerator), int(power.denominator))
        return Dimension(*(a * exact for a in self.exponents))

    def __str__(self) -> str:
        powers = [_power_text(name, n) for name, n in zip(_BASE, self.exponents) if n]
        return " ".join(powers) or "1"


_UNITS: Mapping[str, Dimension] = {
    "1": Dimension(),
    "rad": Dimension(),
    "kg": Dimension(kg=Fraction(1)),
    "m": Dimension(m=Fraction(1)),
    "s": Dimension(s=Fraction(1)),
    "A": Dimension(A=Fraction(1)),
    "Hz": Dimension(s=Fraction(-1)),
    "N": Dimension(Fraction(1), Fraction(1), Fraction(-2)),
    "Pa": Dimension(Fraction(1), Fraction(-1), Fraction(-2)),
    "J": Dimension(Fraction(1), Fraction(2), Fraction(-2)),
    "W": Dimension(Fraction(1), Fraction(2), Fraction(-3)),
    "C": Dimension(s=Fraction(1), A=Fraction(1)),
    "V": Dimension(Fraction(1), Fraction(2), Fraction(-3), Fraction(-1)),
    "F": Dimension(Fraction(-1), Fraction(-2), Fraction(4), Fraction(2)),
    "S": Dimension(Fraction(-1), Fraction(-2), Fraction(3), Fraction(2)),
}


def _unit_factor(factor: str, unit: str) -> Dimension:
    name, caret, power = factor.partition("^")
    if name not in _UNITS:
        raise ValueError(f"unit {unit!r} is not understood: {name!r} is none of {', '.join(_UNITS)}")
    digits = power.removeprefix("-")
    if caret and not (digits.isascii() and digits.isdigit()):
        raise ValueError(f"unit {unit!r} is not understood: the exponent {power!r} is not an integer")
    return _UNITS[name] ** (int(power) if caret else 1)


def _power_text(name: str, power: Fraction) -> str:
    if power == 1:
        return name
    return f"{name}^{power}" if power.denominator == 1 else f"{name}^({power})"
