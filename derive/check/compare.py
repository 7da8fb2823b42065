"""Is a printed equation the derived one, perhaps scaled? Numbers first, then proof.

Both are linear in the quantity that the equation gives, so the only factor that can make them equal
is the ratio of its two coefficients. A difference that is not zero at a random point in high
precision settles the matter; one that is zero there has to be proved zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from random import Random

import mpmath
import sympy as sp

from delagrange.derive.equations.derived_equations import DerivedEquation
from delagrange.derive.notation.printer import text_printer
from delagrange.derive.notation.symbols import Quantity
from delagrange.derive.printed.tree import Equation
from delagrange.derive.printed.values import evaluate, evaluate_roughly, to_sympy

_DIGITS = 50
_ZERO = mpmath.mpf(10) ** -35  # relative to the size of the terms
_ROUGHLY_ZERO = 1e-6
_POINTS = 3
_ATTEMPTS = 20
_SEED = 20150225


@dataclass(frozen=True)
class Comparison:
    """`printed = factor * derived`, or not, and then for what reason if it is not plainly another equation."""

    equal: bool
    factor: sp.Expr  # ratio of the coefficients of the unknown; 0 where nothing makes the two equal
    reason: str = ""


Point = Mapping[sp.Symbol, mpmath.mpf]


@dataclass(frozen=True)
class Witness:
    """A derived equation with its values at random points, ready for comparison with printed ones.

    At each point the residual is `constants + slopes * unknown`.
    """

    derived: DerivedEquation
    points: tuple[Point, ...]
    constants: tuple[mpmath.mpf, ...]
    slopes: tuple[mpmath.mpf, ...]


def _random_point(symbols: tuple[sp.Symbol, ...], random: Random, spread: mpmath.mpf) -> Point:
    """Values of order one, all different, negative ones too where a symbol allows them.

    `spread` below 1 brings the positive ones nearer to 1.
    """
    point = {}
    for symbol in symbols:
        value = mpmath.mpf(random.randint(10**14, 3 * 10**15)) / 10**15
        near = 1 + (value - 1) * spread
        point[symbol] = near if symbol.is_positive else value * random.choice((-1, 1))
    return point


def _valid_point(symbols: tuple[sp.Symbol, ...], random: Random, validity: tuple[sp.Expr, ...]) -> Point:
    """A random point where the strain energies hold, so that no logarithm there is complex.

    In the reference state, where all stretches are 1, they do; hence points nearer and nearer to it.
    """
    bounds = [sp.lambdify(symbols, bound, "mpmath") for bound in validity]
    for attempt in range(_ATTEMPTS):
        point = _random_point(symbols, random, mpmath.mpf("0.7") ** attempt)
        if all(bound(*(point[symbol] for symbol in symbols)) > 0 for bound in bounds):
            break
    return point


def witness(derived: DerivedEquation, others: Iterable[Quantity] = ()) -> Witness:
    """Evaluate a derived equation; `others` are what a printed one may use beyond the quantities of the model."""
    random, unknown = Random(_SEED), derived.unknown.symbol
    symbols = tuple(sorted({each.symbol for each in (*derived.quantities, *others)}, key=str))
    residual = sp.lambdify(symbols, derived.residual, "mpmath")
    slope = sp.lambdify(symbols, derived.residual.diff(unknown), "mpmath")
    with mpmath.workdps(_DIGITS):
        points = tuple(_valid_point(symbols, random, derived.validity) for _ in range(_POINTS))
        constants = tuple(
            residual(*({**point, unknown: mpmath.mpf(0)}[s] for s in symbols)) for point in points
        )
        slopes = tuple(slope(*(point[s] for s in symbols)) for point in points)
    return Witness(derived, points, constants, slopes)


def _printed_at(tree: Equation, point: Point) -> mpmath.mpf:
    return evaluate(tree.lhs, point) - evaluate(tree.rhs, point)


def _agrees_at(
    tree: Equation, unknown: sp.Symbol, point: Point, constant: mpmath.mpf, slope: mpmath.mpf
) -> bool:
    """Whether the printed residual is, at one point, the same multiple of constant and slope, and straight."""
    try:
        printed = _printed_at(tree, {**point, unknown: mpmath.mpf(0)})
        printed_slope = _printed_at(tree, {**point, unknown: mpmath.mpf(1)}) - printed
        left, right = printed * slope, constant * printed_slope
        size = abs(left) + abs(right) + abs(printed_slope * slope)
        if abs(printed_slope) < _ZERO or abs(left - right) > _ZERO * size:
            return False
        bend = _printed_at(tree, point) - printed - printed_slope * point[unknown]
    except ZeroDivisionError:
        return False
    return abs(bend) <= _ZERO * (abs(printed) + abs(printed_slope))


def agrees_numerically(tree: Equation, subject: Witness) -> bool:
    """Whether the printed equation is a multiple of the derived one at random points, to 35 digits.

    The printed side is evaluated from its tree, without SymPy.
    """
    unknown = subject.derived.unknown.symbol
    with mpmath.workdps(_DIGITS):
        return all(
            _agrees_at(tree, unknown, point, constant, slope)
            for point, constant, slope in zip(subject.points, subject.constants, subject.slopes, strict=True)
        )


def may_agree(tree: Equation, subject: Witness) -> bool:
    """Whether double precision at one point leaves room for agreement: a quick sieve, never a verdict."""
    unknown, point = (
        subject.derived.unknown.symbol,
        {symbol: float(v) for symbol, v in subject.points[0].items()},
    )

    def printed(value: float) -> float:
        at = {**point, unknown: value}
        return evaluate_roughly(tree.lhs, at) - evaluate_roughly(tree.rhs, at)

    try:
        constant = printed(0.0)
        left = constant * float(subject.slopes[0])
        right = float(subject.constants[0]) * (printed(1.0) - constant)
    except (ArithmeticError, ValueError):
        return True
    return bool(abs(left - right) <= _ROUGHLY_ZERO * (abs(left) + abs(right)))


def printed_residual(tree: Equation) -> sp.Expr:
    return to_sympy(tree.lhs) - to_sympy(tree.rhs)


def scaling(tree: Equation, derived: DerivedEquation) -> sp.Expr:
    """What the derived equation has to be multiplied by to become the printed one; 0 where nothing does."""
    unknown = derived.unknown.symbol
    slope = printed_residual(tree).diff(unknown)
    ratio = sp.factor(sp.cancel(sp.together(slope / derived.residual.diff(unknown))))
    return sp.S.Zero if ratio.has(unknown, sp.zoo, sp.nan) else ratio


def _is_zero(expression: sp.Expr) -> bool:
    return sp.expand(sp.numer(sp.together(alike(expression)))) == 0


def alike(expression: sp.Expr) -> sp.Expr:
    """The same with the argument of each logarithm as one fraction, so that equal ones look equal."""
    return expression.replace(sp.log, lambda argument: sp.log(sp.cancel(sp.together(argument))))


def _why_not(tree: Equation, subject: Witness) -> str:
    """A reason for the difference that its terms do not show."""
    unknown = subject.derived.unknown
    residual = printed_residual(tree)
    if not residual.has(unknown.symbol):
        return f"{unknown.text} does not stand in it"
    if residual.diff(unknown.symbol, 2) != 0:
        return f"it is not linear in {unknown.text}, as the derived one is"
    return ""


def compare(tree: Equation, subject: Witness) -> Comparison:
    """Compare a printed equation with a derived one: equal, equal after scaling, or not."""
    if not agrees_numerically(tree, subject):
        return Comparison(False, sp.S.Zero, _why_not(tree, subject))
    factor = scaling(tree, subject.derived)
    if factor == 0 or not _is_zero(printed_residual(tree) - factor * subject.derived.residual):
        return Comparison(False, factor, "it agrees in numbers to 35 digits, but no proof of it was found")
    if not factor.is_nonzero:
        return Comparison(
            False,
            factor,
            f"it is the derived one times {text_printer(subject.derived.quantities)(factor)}, which can vanish",
        )
    return Comparison(True, factor)
