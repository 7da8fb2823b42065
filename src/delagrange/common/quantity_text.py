"""A value as a person writes it, "42 kPa", as a number in the SI unit that is wanted."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from operator import mul
from types import MappingProxyType

from delagrange.common.dimension import Dimension
from delagrange.common.units import shown, unit_name

PREFIXES: Mapping[str, Fraction] = MappingProxyType(
    {
        "T": Fraction(10**12), "G": Fraction(10**9), "M": Fraction(10**6), "k": Fraction(10**3),
        "d": Fraction(1, 10), "c": Fraction(1, 10**2), "m": Fraction(1, 10**3), "u": Fraction(1, 10**6),
        "µ": Fraction(1, 10**6), "μ": Fraction(1, 10**6), "n": Fraction(1, 10**9), "p": Fraction(1, 10**12),
        "f": Fraction(1, 10**15),
    }
)  # fmt: skip
# units that take a prefix
PREFIXED = ("m", "s", "A", "Hz", "N", "Pa", "J", "W", "C", "V", "F", "S", "g", "rad")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_LONGEST = 80  # characters of a value with its unit


@dataclass(frozen=True)
class Unit:
    """A unit as a multiple of the coherent SI unit of its dimension."""

    scale: Fraction  # 1000 for kPa
    dimension: Dimension

    @classmethod
    def of_text(cls, text: str) -> Unit:
        """The unit that a text such as "kPa", "MV/m", "g/cm^3" or "kPa s" writes.

        Factors are separated by spaces, * or ·; one "/" may precede the last factor. Each name may have
        a prefix of `PREFIXES`.

        Raises:
            ValueError: it is not written so, or a name is not known.
        """
        above, slash, below = text.partition("/")
        factors, divisors = _split(above), _split(below)
        if not factors or len(divisors) != len(slash):
            raise ValueError(
                f"unit {shown(text)} is not understood: one '/' is allowed, before the last factor"
            )
        numerator = reduce(mul, (_factor(factor, text) for factor in factors))
        return numerator / _factor(divisors[0], text) if divisors else numerator

    def __mul__(self, other: Unit) -> Unit:
        return Unit(self.scale * other.scale, self.dimension * other.dimension)

    def __truediv__(self, other: Unit) -> Unit:
        return Unit(self.scale / other.scale, self.dimension / other.dimension)


def _split(text: str) -> list[str]:
    return [factor for factor in re.split(r"[\s*·]+", text) if factor]


def _factor(factor: str, unit: str) -> Unit:
    """A name with its power: "cm^3"."""
    name, caret, power = factor.partition("^")
    if caret and not re.fullmatch("-?[1-6]", power):
        raise ValueError(
            f"unit {shown(unit)} is not understood: the exponent {shown(power)} is not an integer from -6 to 6"
        )
    found = _named(name, unit)
    return Unit(found.scale ** int(power or 1), found.dimension ** int(power or 1))


def _named(name: str, unit: str) -> Unit:
    """A unit's name; as it stands before it is taken for a prefix with a unit ("m" is the metre)."""
    if name in ("1", "kg", *PREFIXED) and name != "g":
        return Unit(Fraction(1), Dimension.of_unit(name))
    prefix, base = ("", name) if name == "g" else (name[:1], name[1:])
    if base not in PREFIXED or (prefix and prefix not in PREFIXES):
        known = f"1, kg, {', '.join(PREFIXED)}, with prefixes {' '.join(sorted(set(PREFIXES) - {'μ', 'µ'}))}"
        raise ValueError(f"unit {shown(unit)} is not understood: {shown(name)} is none of {known}")
    scale = PREFIXES.get(prefix, Fraction(1))
    if base == "g":
        return Unit(scale / 1000, Dimension.of_unit("kg"))
    return Unit(scale, Dimension.of_unit(base))


def read_quantity(name: str, value: object, unit: str) -> float:
    """A value in the SI unit `unit`: a bare number is in that unit already, a text carries its own.

    "42 kPa" for a unit of Pa is 4.2e4; the conversion is exact, then rounded once.

    Raises:
        ValueError: no number, not finite, a text without a unit where one is needed, a unit that is not
            understood or has another dimension.
    """
    if isinstance(value, str):
        return _from_text(name, value, unit)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(
            f"{name} must be a number in {unit_name(unit)} or a text with a unit, got {shown(value)}"
        )
    return _finite(name, value, value, unit)


def typed_quantity(name: str, text: str, unit: str) -> float:
    """A value as typed on a command line: a bare number is in `unit` already, any other carries its own.

    Raises:
        ValueError: no number, or a unit that is not understood or has another dimension.
    """
    try:
        return float(text)
    except ValueError:
        if not _NUMBER.match(text.strip()) or not _is_understood(unit):
            raise ValueError(f"{name} must be a number in {unit_name(unit)}, got {shown(text)}") from None
    return read_quantity(name, text, unit)


def _is_understood(unit: str) -> bool:
    """Whether a unit is one of ours: a module that somebody wrote may have any."""
    try:
        Dimension.of_unit(unit)
    except ValueError:
        return False
    return True


def _from_text(name: str, text: str, unit: str) -> float:
    number = _NUMBER.match(text.strip()) if len(text) <= _LONGEST else None
    if number is None:
        example = _example(unit)
        raise ValueError(
            f"{name} must be a number in {unit_name(unit)}, such as {example}, got {shown(text)}"
        )
    written = text.strip()[number.end() :].strip()
    scale = _scale(name, text, written, unit)
    return _finite(name, Fraction(number.group()) * scale, text, unit)


def _scale(name: str, text: str, written: str, unit: str) -> Fraction:
    """What turns the written unit into the one that is wanted."""
    wanted = Dimension.of_unit(unit)
    if not written and not wanted.is_number:
        raise ValueError(f"{name} must carry a unit as a text, such as {_example(unit)}, got {shown(text)}")
    try:
        found = Unit.of_text(written or "1")
    except ValueError as error:
        raise ValueError(f"{name} must be in {unit_name(unit)}, got {shown(text)}: {error}") from None
    if found.dimension != wanted:
        base = "" if str(wanted) == unit else f" ({wanted})"
        needed = "a pure number" if wanted.is_number else f"{unit}{base}"
        raise ValueError(
            f"{name} = {shown(text)} has a unit of dimension {found.dimension}; needed is {needed}"
        )
    return found.scale


def _example(unit: str) -> str:
    return repr("1.5" if unit == "1" else f"1.5 {unit}")


def _finite(name: str, number: float | Fraction, given: object, unit: str) -> float:
    try:
        converted = float(number)
    except OverflowError:
        converted = math.inf
    if not math.isfinite(converted):
        raise ValueError(f"{name} must be finite in {unit_name(unit)}, got {shown(given)}")
    return converted


def read_with_unit(name: str, value: object) -> tuple[float, str]:
    """A value whose unit is the user's choice, and the SI unit it is then in: "42 kPa" gives 4.2e4 and "Pa".

    A bare number, or a text without a unit, is a pure number.

    Raises:
        ValueError: as `read_quantity`.
    """
    written = _unit_written(value) if isinstance(value, str) else ""
    if not written:
        return read_quantity(name, value, "1"), "1"
    try:
        unit = coherent(written)
    except ValueError as error:
        raise ValueError(f"{name} has no unit that is known, got {shown(value)}: {error}") from None
    return read_quantity(name, value, unit), unit


def coherent(text: str) -> str:
    """A unit without its prefixes: "g/cm^3" gives "kg/m^3".

    Raises:
        ValueError: as `Unit.of_text`.
    """
    Unit.of_text(text)
    above, _, below = text.partition("/")
    numerator = " ".join(_coherent_factor(factor) for factor in _split(above))
    return "/".join([numerator, *(_coherent_factor(factor) for factor in _split(below))])


def _coherent_factor(factor: str) -> str:
    name, caret, power = factor.partition("^")
    bare = name if name in ("1", "kg", *PREFIXED) else name[1:]
    return f"{'kg' if bare == 'g' else bare}{caret}{power}"


def _unit_written(text: str) -> str:
    number = _NUMBER.match(text.strip())
    return text.strip()[number.end() :].strip() if number else ""
