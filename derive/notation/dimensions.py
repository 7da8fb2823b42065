"""The dimensions of symbols and expressions, and which term of an expression breaks its unit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from operator import mul
from typing import TypeVar

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.derive.notation.symbols import Quantity

_Item = TypeVar("_Item", bound=Hashable)


class DimensionError(ValueError):
    """Terms that do not have one dimension, or a function or exponent that is not a pure number.

    Attributes:
        terms: what breaks the unit.
    """

    def __init__(self, message: str, terms: tuple[object, ...]) -> None:
        super().__init__(message)
        self.terms = terms


@dataclass(frozen=True)
class TermDimension:
    """A term of a sum, its dimension, and whether that is the one most terms of the sum have."""

    term: sp.Expr
    dimension: Dimension
    ok: bool


def symbol_dimensions(quantities: tuple[Quantity, ...]) -> dict[sp.Symbol, Dimension]:
    """The dimension of the symbol of each quantity."""
    return {quantity.symbol: Dimension.of_unit(quantity.unit) for quantity in quantities}


def most_common(items: Sequence[_Item]) -> _Item:
    """What occurs most often; of those that occur equally often, what comes first."""
    return Counter(items).most_common(1)[0][0]


def check_terms(expression: sp.Expr, dimensions: Mapping[sp.Symbol, Dimension]) -> tuple[TermDimension, ...]:
    """The top-level terms of an expression, each with its dimension.

    Raises:
        DimensionError: inside a term, a sum, an exponent or the argument of a function is at fault.
        ValueError: a symbol has no entry in `dimensions`, or a construct has no rule.
    """
    terms = sp.Add.make_args(sp.sympify(expression))
    found = [dimension_of(term, dimensions) for term in terms]
    expected = most_common(found)
    return tuple(TermDimension(term, each, each == expected) for term, each in zip(terms, found))


def dimension_of(expression: sp.Expr, dimensions: Mapping[sp.Symbol, Dimension]) -> Dimension:
    """The dimension of an expression.

    Raises:
        DimensionError: terms of a sum differ, or an exponent or the argument of a function such as
            log is not a pure number.
        ValueError: a symbol has no entry in `dimensions`, or a construct has no rule.
    """
    if isinstance(expression, sp.Symbol):
        return _of_symbol(expression, dimensions)
    if expression.is_number:
        return Dimension()
    if isinstance(expression, sp.Add):
        return _of_sum(expression, dimensions)
    if isinstance(expression, sp.Mul):
        return reduce(mul, (dimension_of(factor, dimensions) for factor in expression.args))
    if isinstance(expression, sp.Pow):
        return _of_power(expression, dimensions)
    if isinstance(expression, sp.Function):
        return _of_function(expression, dimensions)
    raise ValueError(f"{expression} has no dimension: {type(expression).__name__} has no rule")


def _of_symbol(symbol: sp.Symbol, dimensions: Mapping[sp.Symbol, Dimension]) -> Dimension:
    if symbol not in dimensions:
        raise ValueError(f"symbol {symbol} has no dimension: it is not in the symbol table")
    return dimensions[symbol]


def _of_sum(expression: sp.Add, dimensions: Mapping[sp.Symbol, Dimension]) -> Dimension:
    checked = check_terms(expression, dimensions)
    odd = [each for each in checked if not each.ok]
    expected = next(each.dimension for each in checked if each.ok)
    if odd:
        named = "; ".join(f"{each.term} has dimension {each.dimension}" for each in odd)
        raise DimensionError(f"{named}; the other terms have {expected}", tuple(each.term for each in odd))
    return expected


def _of_power(expression: sp.Pow, dimensions: Mapping[sp.Symbol, Dimension]) -> Dimension:
    base, exponent = expression.args
    _require_number(exponent, expression, dimensions)
    of_base = dimension_of(base, dimensions)
    if of_base.is_number:
        return of_base
    if not exponent.is_Rational:
        message = f"{base} has dimension {of_base} and the exponent {exponent}; allowed is a rational number"
        raise DimensionError(message, (expression,))
    return of_base ** Fraction(int(exponent.p), int(exponent.q))


def _of_function(expression: sp.Function, dimensions: Mapping[sp.Symbol, Dimension]) -> Dimension:
    for argument in expression.args:
        _require_number(argument, expression, dimensions)
    return Dimension()


def _require_number(part: sp.Expr, whole: sp.Expr, dimensions: Mapping[sp.Symbol, Dimension]) -> None:
    found = dimension_of(part, dimensions)
    if not found.is_number:
        raise DimensionError(f"{part} in {whole} has dimension {found}; allowed is a pure number", (part,))
