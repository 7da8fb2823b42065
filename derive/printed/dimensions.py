"""Which printed term breaks the unit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.derive.notation.dimensions import most_common
from delagrange.derive.printed.tokens import Span
from delagrange.derive.printed.tree import (
    Equation,
    Function,
    Group,
    Node,
    Number,
    Power,
    Product,
    Quotient,
    Sum,
    Variable,
)
from delagrange.derive.printed.values import to_sympy


@dataclass(frozen=True)
class PrintedTermDimension:
    """A printed term, exponent or argument, its dimension, and the one that its place asks for."""

    equation: str  # number
    latex: str  # literal
    span: Span
    dimension: Dimension
    expected: Dimension
    ok: bool

    def __str__(self) -> str:
        verdict = "as expected" if self.ok else f"where {self.expected} is expected"
        return f"Eq. ({self.equation}): {self.latex} has dimension {self.dimension}, {verdict}"


_Check: TypeAlias = tuple[Span, Dimension, Dimension]  # where, found, expected


@dataclass(frozen=True)
class _Found:
    """Dimension of a node, None for a printed 0 (it fits anything), and what was met inside."""

    dimension: Dimension | None
    checks: tuple[_Check, ...] = ()


_ONE = Dimension()


def check_printed(equation: Equation) -> tuple[PrintedTermDimension, ...]:
    """Every term of every sum of an equation with its dimension, and the two sides against each other.

    Of the terms of a sum those not `ok` deviate from the majority (from the first in a tie). The
    right side must have the dimension of the left one; "= 0" fits anything. Exponents and arguments
    of functions must be pure numbers. A side of one term is listed as a term.
    """
    lhs, rhs = _find(equation.lhs), _find(equation.rhs)
    expected = lhs.dimension or rhs.dimension or _ONE
    sides = ((equation.lhs, lhs), (equation.rhs, rhs))
    checks = [check for side in sides for check in (*_side_check(*side, expected), *side[1].checks)]
    return tuple(
        PrintedTermDimension(equation.number, equation.literal(span), span, found, wanted, found == wanted)
        for span, found, wanted in checks
    )


def _side_check(node: Node, found: _Found, expected: Dimension) -> Iterator[_Check]:
    """A side that is a sum is listed by its terms, unless as a whole it does not fit the other side."""
    if found.dimension is None or (isinstance(node, Sum) and found.dimension == expected):
        return
    yield node.span, found.dimension, expected


def _find(node: Node) -> _Found:
    match node:
        case Number(value):
            return _Found(_ONE if value else None)
        case Variable(quantity):
            return _Found(Dimension.of_unit(quantity.unit))
        case Group(inner=inner):
            return _find(inner)
        case Sum():
            return _of_sum(node)
        case Product(factors):
            return _of_product(factors)
        case Quotient(numerator, denominator):
            return _of_quotient(numerator, denominator)
        case Power():
            return _of_power(node)
        case Function("sqrt", argument):
            inner = _find(argument)
            return _Found(inner.dimension and inner.dimension ** Fraction(1, 2), inner.checks)
        case Function(argument=argument):
            inner = _find(argument)
            return _Found(_ONE, (*_number_check(argument, inner), *inner.checks))
    raise TypeError(f"{type(node).__name__} is not a node of a printed tree")


def _of_sum(node: Sum) -> _Found:
    found = [_find(term.node) for term in node.terms]
    known = [each.dimension for each in found if each.dimension is not None]
    if not known:
        return _Found(None)
    expected = most_common(known)
    checks = []
    for term, each in zip(node.terms, found):
        checks.append((term.span, each.dimension or expected, expected))
        checks.extend(each.checks)
    return _Found(expected, tuple(checks))


def _of_product(factors: tuple[Node, ...]) -> _Found:
    found = [_find(factor) for factor in factors]
    checks = tuple(check for each in found for check in each.checks)
    product: Dimension | None = _ONE
    for each in found:
        product = None if product is None or each.dimension is None else product * each.dimension
    return _Found(product, checks)


def _of_quotient(numerator: Node, denominator: Node) -> _Found:
    above, below = _find(numerator), _find(denominator)
    ratio = None if above.dimension is None else above.dimension / (below.dimension or _ONE)
    return _Found(ratio, above.checks + below.checks)


def _of_power(node: Power) -> _Found:
    base, exponent = _find(node.base), _find(node.exponent)
    checks = (*base.checks, *_number_check(node.exponent, exponent), *exponent.checks)
    if base.dimension is None or base.dimension.is_number:
        return _Found(base.dimension, checks)
    power = to_sympy(node.exponent)
    if not isinstance(power, sp.Rational):  # a unit raised to something that varies: the base is at fault
        return _Found(_ONE, (*checks, (node.base.span, base.dimension, _ONE)))
    return _Found(base.dimension ** Fraction(int(power.p), int(power.q)), checks)


def _number_check(node: Node, found: _Found) -> Iterator[_Check]:
    if found.dimension is not None and not found.dimension.is_number:
        yield node.span, found.dimension, _ONE
