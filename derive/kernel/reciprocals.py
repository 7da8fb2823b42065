"""All divisions of a function as one.

A division takes as long as ten products. The reciprocals of a, b and c come from a single one of
their product: 1/c = (a b) / (a b c), 1/b = a c / (a b c), and so on (Montgomery 1987, Math. Comp. 48,
243, Sec. 10.3.1, for inverses in another ring).
"""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp


def denominators(expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    """Bases of negative integer powers, in canonical order; the simple ones first."""
    found = {
        power.base
        for expression in expressions
        for power in expression.atoms(sp.Pow)
        if power.exp.is_Integer and power.exp.is_negative and not power.base.is_number
    }
    return tuple(sorted(found, key=lambda base: (not base.is_Symbol, sp.default_sort_key(base))))


def inverse_name(base: sp.Symbol) -> sp.Symbol:
    """`stretch` -> `inverse_stretch`."""
    return sp.Symbol(f"inverse_{base.name}")


def share_division(bases: tuple[sp.Symbol, ...]) -> tuple[tuple[str, sp.Expr], ...]:
    """Pairs (name, expression) that end with the inverse of every base, by one division."""
    if not bases:
        return ()
    if len(bases) == 1:
        return ((inverse_name(bases[0]).name, 1 / bases[0]),)
    products = [bases[0], *(sp.Symbol(f"product_{number}") for number in range(2, len(bases)))]
    pairs = [
        (product.name, before * base)
        for product, before, base in zip(products[1:], products, bases[1:], strict=False)
    ]
    rest = sp.Symbol("reciprocal")
    pairs.append((rest.name, 1 / (products[-1] * bases[-1])))
    for number in range(len(bases) - 1, 0, -1):
        pairs.append((inverse_name(bases[number]).name, rest * products[number - 1]))
        left = inverse_name(bases[0]) if number == 1 else sp.Symbol(f"reciprocal_{number}")
        pairs.append((left.name, rest * bases[number]))
        rest = left
    return tuple(pairs)


def without_division(expression: sp.Expr) -> sp.Expr:
    """The expression with negative integer powers of symbols as powers of their inverses."""
    return expression.replace(
        lambda part: part.is_Pow and part.base.is_Symbol and part.exp.is_Integer and part.exp.is_negative,
        lambda power: inverse_name(power.base) ** -power.exp,
    )
