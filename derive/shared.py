"""Common subexpressions that are worth a name.

SymPy's `cse` finds every repetition; one that saves a single product in two places, or a product of
constants, costs a reader more than it saves the machine. Only those that save at least two
operations on something that varies keep a name.
"""

from __future__ import annotations

import sympy as sp

_WORTH = 2  # operations saved, where a person reads the code


def _uses(symbol: sp.Symbol, expressions: list[sp.Expr]) -> int:
    """How often a symbol stands in the expressions."""
    return sum(int(expression.count(symbol)) for expression in expressions)


def _unfolded(value: sp.Expr, found: list[tuple[sp.Symbol, sp.Expr]]) -> sp.Expr:
    """The value with every other common subexpression written out."""
    for symbol, expression in reversed(found):
        value = value.subs(symbol, expression)
    return value


def share_subexpressions(
    expressions: tuple[sp.Expr, ...],
    constants: frozenset[str],
    later: frozenset[str],
    worth: int = _WORTH,
    sums_only: bool = False,
) -> tuple[tuple[tuple[str, sp.Expr], ...], tuple[sp.Expr, ...]]:
    """Named common subexpressions, and the expressions rewritten in them.

    What is made of `constants` only is not worth a name; what needs a name computed `later` cannot
    stand before it.

    Returns:
        Pairs (`shared_1`, expression), ... in the order in which they must be computed, and the
        expressions in the order given.
    """
    found, rewritten = sp.cse(expressions, symbols=sp.numbered_symbols("_cse"), order="canonical")
    kept: list[tuple[sp.Symbol, sp.Expr]] = []
    rest = list(rewritten)
    for number, (symbol, value) in reversed(list(enumerate(found))):
        earlier = [expression for _, expression in found[:number]]
        users = [expression for _, expression in kept] + rest
        saved = value.count_ops() * (_uses(symbol, users) - 1)
        names = {free.name for free in _unfolded(value, found).free_symbols}
        if (
            names - constants
            and not names & later
            and saved >= worth
            and _uses(symbol, earlier) == 0
            and (not sums_only or value.has(sp.Add))
        ):
            kept.append((symbol, value))
            continue
        kept = [(name, expression.subs(symbol, value)) for name, expression in kept]
        rest = [expression.subs(symbol, value) for expression in rest]
    kept.reverse()
    names = {symbol: sp.Symbol(f"shared_{number}") for number, (symbol, _) in enumerate(kept, start=1)}
    pairs = tuple((names[symbol].name, value.xreplace(names)) for symbol, value in kept)
    return pairs, tuple(expression.xreplace(names) for expression in rest)
