"""A printed tree as a SymPy expression, and as a number, by two roads that share nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import mpmath
import sympy as sp

from delagrange.derive.printed.tree import (
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


_MATH_FUNCTIONS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {
        "sqrt": math.sqrt, "ln": math.log, "exp": math.exp, "sin": math.sin, "cos": math.cos, "tan": math.tan,
        "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    }
)  # fmt: skip


@dataclass(frozen=True)
class _Arithmetic:
    """What numbers are made of."""

    number: Callable[[int], mpmath.mpf | float]
    functions: Mapping[str, Callable]


_HIGH_PRECISION = _Arithmetic(mpmath.mpf, _MPMATH_FUNCTIONS)
_DOUBLE_PRECISION = _Arithmetic(float, _MATH_FUNCTIONS)


def evaluate(node: Node, values: Mapping[sp.Symbol, mpmath.mpf]) -> mpmath.mpf:
    """The number that a printed tree comes to, at mpmath's current precision, without SymPy's algebra.

    Raises:
        ValueError: a symbol has no value.
    """
    return _value(node, values, _HIGH_PRECISION)


def evaluate_roughly(node: Node, values: Mapping[sp.Symbol, float]) -> float:
    """The same in double precision, for sorting out many trees quickly; raises as `evaluate`."""
    return _value(node, values, _DOUBLE_PRECISION)


def _value(node: Node, values: Mapping, arithmetic: _Arithmetic) -> mpmath.mpf | float:
    match node:
        case Number(value):
            return arithmetic.number(value.numerator) / value.denominator
        case Variable(quantity):
            if quantity.symbol not in values:
                raise ValueError(
                    f"symbol {quantity.symbol} [{quantity.unit}] has no value; a number is needed"
                )
            return values[quantity.symbol]
        case Sum(terms):
            return sum(term.sign * _value(term.node, values, arithmetic) for term in terms)
        case Product(factors):
            return math.prod(_value(factor, values, arithmetic) for factor in factors)
        case Quotient(numerator, denominator):
            return _value(numerator, values, arithmetic) / _value(denominator, values, arithmetic)
        case Power(base, exponent):
            return _value(base, values, arithmetic) ** _value(exponent, values, arithmetic)
        case Group(inner=inner):
            return _value(inner, values, arithmetic)
        case Function(name, argument):
            return arithmetic.functions[name](_value(argument, values, arithmetic))
    raise TypeError(f"{type(node).__name__} is not a node of a printed tree")
