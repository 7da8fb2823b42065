"""Integer powers of moving quantities, computed once by products.

`pow` costs as much as a dozen products, and the equations of a membrane are full of integer powers
of the same few stretches; a person would name them, and so does this module.
"""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp


def _integer_powers(expressions: Iterable[sp.Expr], moving: frozenset[str]) -> dict[sp.Symbol, set[int]]:
    found: dict[sp.Symbol, set[int]] = {}
    for expression in expressions:
        for power in expression.atoms(sp.Pow):
            base, exponent = power.args
            if base.is_Symbol and exponent.is_Integer and base.name in moving:
                found.setdefault(base, set()).add(int(exponent))
    return found


def _power_name(stem: str, exponent: int) -> str:
    return stem if exponent == 1 else f"{stem}_pow{exponent}"


def _chain(stem: str, wanted: set[int]) -> list[tuple[str, sp.Expr]]:
    """Products that reach the wanted powers of `stem`, each from two smaller ones already there."""
    needed = sorted(wanted)
    steps: dict[int, tuple[int, int]] = {}

    def reach(exponent: int) -> None:
        if exponent <= 1 or exponent in steps:
            return
        have = [1, *sorted(set(steps) | {n for n in needed if n < exponent})]
        big = max(n for n in have if n < exponent)
        split = (big, exponent - big) if exponent - big in have else (exponent - exponent // 2, exponent // 2)
        for part in sorted(split):
            reach(part)
        steps[exponent] = split

    for exponent in needed:
        reach(exponent)
    return [
        (_power_name(stem, n), sp.Mul(*(sp.Symbol(_power_name(stem, k)) for k in steps[n]), evaluate=False))
        for n in sorted(steps)
    ]


def share_powers(
    expressions: tuple[sp.Expr, ...], moving: frozenset[str]
) -> tuple[tuple[tuple[str, sp.Expr], ...], tuple[sp.Expr, ...]]:
    """Named powers of the `moving` names, and the expressions rewritten in them.

    Returns:
        Pairs (name, product or reciprocal) in the order in which they must be computed, and the
        expressions in the order given.
    """
    found = _integer_powers(expressions, moving)
    named: list[tuple[str, sp.Expr]] = []
    replacement: dict[sp.Expr, sp.Expr] = {}
    for base in sorted(found, key=str):
        above = {n for n in found[base] if n > 1}
        below = {-n for n in found[base] if n < 0}
        named += _chain(base.name, above)
        inverse = f"inverse_{base.name}"
        if below:
            named.append((inverse, 1 / base))
            named += _chain(inverse, below)
        replacement |= {base**n: sp.Symbol(_power_name(base.name, n)) for n in above}
        replacement |= {base**-n: sp.Symbol(_power_name(inverse, n)) for n in below}
    rewritten = tuple(expression.xreplace(replacement) for expression in expressions)
    return tuple(named), rewritten
