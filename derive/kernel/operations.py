"""How many floating-point operations an expression takes as it is printed."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp


def operations(expressions: Iterable[sp.Expr]) -> int:
    """Additions, products, divisions and calls; an integer power counts as its products."""
    return sum(_of(expression) for expression in expressions)


def _of(expression: sp.Expr) -> int:
    inner = sum(_of(argument) for argument in expression.args)
    match expression:
        case sp.Add():
            return inner + len(expression.args) - 1
        case sp.Mul():
            return inner + len(expression.args) - 1 - (expression.args[0] == -1)
        case sp.Pow(args=(_, sp.Integer(p=exponent))):
            return inner + max(abs(exponent) - 1, 0) + (exponent < 0)
        case sp.Atom():
            return 0
    return inner + 1
