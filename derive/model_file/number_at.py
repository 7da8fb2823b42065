"""The value of a user's formula in double precision, as emitted code will have it.

SymPy's own numbers have no largest one: of exp(exp(exp(exp(3)))) it would compute hundreds of millions of digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

import sympy as sp

_FUNCTIONS: Mapping[type, Callable[[float], float]] = MappingProxyType(
    {
        sp.exp: math.exp, sp.log: math.log, sp.sin: math.sin, sp.cos: math.cos, sp.tan: math.tan,
        sp.sinh: math.sinh, sp.cosh: math.cosh, sp.tanh: math.tanh, sp.Abs: math.fabs,
    }
)  # fmt: skip


def number_at(expression: sp.Expr, values: Mapping[sp.Symbol, float]) -> float:
    """The value of a formula where its symbols have `values`; NaN where it, or a part of it, is no finite real number.

    Raises:
        KeyError: a symbol has no value.
    """
    try:
        found = _value(expression, values)
    except (OverflowError, ZeroDivisionError, ValueError, TypeError):
        return math.nan
    return found if math.isfinite(found) else math.nan


def _value(expression: sp.Expr, values: Mapping[sp.Symbol, float]) -> float:
    if expression.is_Symbol:
        return float(values[expression])
    if not expression.args:
        return float(expression)
    parts = [_value(part, values) for part in expression.args]
    if not all(map(math.isfinite, parts)):
        raise OverflowError("a part is larger than any number of double precision")
    if expression.is_Add:
        return math.fsum(parts)
    if expression.is_Mul:
        return math.prod(parts)
    if expression.is_Pow:
        return math.pow(*parts)
    return _FUNCTIONS[expression.func](*parts) if expression.func in _FUNCTIONS else math.nan
