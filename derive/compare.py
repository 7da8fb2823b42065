"""Is a printed equation the derived one, perhaps scaled? Numbers first, then proof.

Both are linear in the quantity that the equation gives, so the only factor that can make them equal
is the ratio of its two coefficients. A difference that is not zero at a random point in high
precision settles the matter; one that is zero there has to be proved zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

import mpmath
import sympy as sp

from .derived_equations import DerivedEquation
from .printed_tree import Equation
from .printed_values import evaluate, to_sympy

_DIGITS = 50
_ZERO = mpmath.mpf(10) ** -35  # relative to the size of the terms
_POINTS = 3
_SEED = 20150225


@dataclass(frozen=True)
class Comparison:
    """`printed = factor * derived`, or not."""

    equal: bool
    factor: sp.Expr  # ratio of the coefficients of the unknown; meaningful where it exists


class UnprovedEqualityError(RuntimeError):
    """Zero at random points in high precision, yet not proved: a case for a person."""


@dataclass(frozen=True)
class Witness:
    """A derived equation ready for comparison: its residual as a function of numbers, and random points."""

    derived: DerivedEquation
    symbols: tuple[sp.Symbol, ...]
    residual: Callable[..., mpmath.mpf]
    points: tuple[dict[sp.Symbol, mpmath.mpf], ...]


def _random_point(symbols: tuple[sp.Symbol, ...], random: Random) -> dict[sp.Symbol, mpmath.mpf]:
    """Values of order one, all different, negative ones too where a symbol allows them."""
    point = {}
    for symbol in symbols:
        value = mpmath.mpf(random.randint(10**14, 3 * 10**15)) / 10**15
        point[symbol] = value if symbol.is_positive else value * random.choice((-1, 1))
    return point


def witness(derived: DerivedEquation, known: tuple[sp.Symbol, ...]) -> Witness:
    """Prepare a derived equation; `known` are all symbols that a printed equation may use."""
    symbols = tuple(sorted(derived.residual.free_symbols, key=str))
    random = Random(_SEED)
    with mpmath.workdps(_DIGITS):
        points = tuple(_random_point(tuple(sorted({*known, *symbols}, key=str)), random) for _ in range(_POINTS))
    return Witness(derived, symbols, sp.lambdify(symbols, derived.residual, "mpmath"), points)


def _line(function: Callable, point: dict, unknown: sp.Symbol) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    """Value with the unknown at 0, slope, and by how much the function bends away from that line."""
    at_zero = function({**point, unknown: mpmath.mpf(0)})
    slope = function({**point, unknown: mpmath.mpf(1)}) - at_zero
    return at_zero, slope, function(point) - at_zero - slope * point[unknown]


def _agrees_at(tree: Equation, subject: Witness, point: dict[sp.Symbol, mpmath.mpf]) -> bool:
    unknown = subject.derived.unknown.symbol

    def printed_residual(values: dict) -> mpmath.mpf:
        return evaluate(tree.lhs, values) - evaluate(tree.rhs, values)

    def derived_residual(values: dict) -> mpmath.mpf:
        return subject.residual(*(values[symbol] for symbol in subject.symbols))

    try:
        printed, printed_slope, bend = _line(printed_residual, point, unknown)
    except ZeroDivisionError:
        return False
    derived, derived_slope, _ = _line(derived_residual, point, unknown)
    left, right = printed * derived_slope, derived * printed_slope
    if abs(printed_slope) < _ZERO or abs(bend) > _ZERO * (abs(printed) + abs(printed_slope)):
        return False
    return abs(left - right) <= _ZERO * (abs(left) + abs(right) + abs(printed_slope * derived_slope))


def agrees_numerically(tree: Equation, subject: Witness) -> bool:
    """Whether the printed equation is a multiple of the derived one at random points, to 35 digits.

    The printed side is evaluated from its tree, without SymPy.
    """
    with mpmath.workdps(_DIGITS):
        return all(_agrees_at(tree, subject, point) for point in subject.points)


def printed_residual(tree: Equation) -> sp.Expr:
    return to_sympy(tree.lhs) - to_sympy(tree.rhs)


def scaling(tree: Equation, derived: DerivedEquation) -> sp.Expr:
    """What the derived equation has to be multiplied by to become the printed one; 0 where nothing does."""
    unknown = derived.unknown.symbol
    ratio = sp.factor(sp.cancel(sp.together(printed_residual(tree).diff(unknown) / derived.residual.diff(unknown))))
    return sp.S.Zero if ratio.has(unknown) else ratio


def _is_zero(expression: sp.Expr) -> bool:
    return sp.expand(sp.numer(sp.together(expression))) == 0


def compare(tree: Equation, subject: Witness) -> Comparison:
    """Compare a printed equation with a derived one.

    Raises:
        UnprovedEqualityError: the numbers agree to 35 digits but the proof fails.
    """
    factor = scaling(tree, subject.derived)
    if not agrees_numerically(tree, subject):
        return Comparison(False, factor)
    if factor.is_nonzero and _is_zero(printed_residual(tree) - factor * subject.derived.residual):
        return Comparison(True, factor)
    raise UnprovedEqualityError(f"Eq. ({tree.number}) agrees with {subject.derived.model} in numbers, without proof")
