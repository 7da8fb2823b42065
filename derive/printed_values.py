"""A printed tree as a SymPy expression, and as a number, by two roads that share nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import mpmath
import sympy as sp

from delagrange.derive.printed_tree import (
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

_SYMPY_FUNCTIONS: Mapping[str, Callable[[sp.Expr], sp.Expr]] = MappingProxyType(
    {
        "sqrt": sp.sqrt, "ln": sp.log, "exp": sp.exp, "sin": sp.sin, "cos": sp.cos, "tan": sp.tan,
        "sinh": sp.sinh, "cosh": sp.cosh, "tanh": sp.tanh,
    }
)  # fmt: skip
_MPMATH_FUNCTIONS: Mapping[str, Callable[[mpmath.mpf], mpmath.mpf]] = MappingProxyType(
    {
        "sqrt": mpmath.sqrt, "ln": mpmath.log, "exp": mpmath.exp, "sin": mpmath.sin, "cos": mpmath.cos,
        "tan": mpmath.tan, "sinh": mpmath.sinh, "cosh": mpmath.cosh, "tanh": mpmath.tanh,
    }
)  # fmt: skip


def to_sympy(node: Node) -> sp.Expr:
    """The exact SymPy expression of a printed tree."""
    match node:
        case Number(value):
            return sp.Rational(value.numerator, value.denominator)
        case Variable(quantity):
            return quantity.symbol
        case Sum(terms):
            return sp.Add(*(term.sign * to_sympy(term.node) for term in terms))
        case Product(factors):
            return sp.Mul(*(to_sympy(factor) for factor in factors))
        case Quotient(numerator, denominator):
            return to_sympy(numerator) / to_sympy(denominator)
        case Power(base, exponent):
            return to_sympy(base) ** to_sympy(exponent)
        case Group(inner=inner):
            return to_sympy(inner)
        case Function(name, argument):
            return _SYMPY_FUNCTIONS[name](to_sympy(argument))
    raise TypeError(f"{type(node).__name__} is not a node of a printed tree")


def evaluate(node: Node, values: Mapping[sp.Symbol, mpmath.mpf]) -> mpmath.mpf:
    """The number that a printed tree comes to, at mpmath's current precision, without SymPy's algebra.

    Raises:
        ValueError: a symbol has no value.
    """
    match node:
        case Number(value):
            return mpmath.mpf(value.numerator) / value.denominator
        case Variable(quantity):
            if quantity.symbol not in values:
                raise ValueError(f"symbol {quantity.symbol} [{quantity.unit}] has no value; give a number")
            return mpmath.mpf(values[quantity.symbol])
        case Sum(terms):
            return mpmath.fsum(term.sign * evaluate(term.node, values) for term in terms)
        case Product(factors):
            return mpmath.fprod(evaluate(factor, values) for factor in factors)
        case Quotient(numerator, denominator):
            return evaluate(numerator, values) / evaluate(denominator, values)
        case Power(base, exponent):
            return mpmath.power(evaluate(base, values), evaluate(exponent, values))
        case Group(inner=inner):
            return evaluate(inner, values)
        case Function(name, argument):
            return _MPMATH_FUNCTIONS[name](evaluate(argument, values))
    raise TypeError(f"{type(node).__name__} is not a node of a printed tree")
