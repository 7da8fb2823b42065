"""The rate of change of an expression of what moves."""

from __future__ import annotations

import sympy as sp

from delagrange.derive.notation.symbols import TimeDependent


def time_derivative(expression: sp.Expr, moving: tuple[TimeDependent, ...]) -> sp.Expr:
    """Total time derivative by the chain rule, for expressions of values and rates."""
    return sum(
        (
            expression.diff(each.value.symbol) * each.rate.symbol
            + expression.diff(each.rate.symbol) * each.acceleration.symbol
            for each in moving
        ),
        sp.Integer(0),
    )
