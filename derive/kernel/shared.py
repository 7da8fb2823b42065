"""Common subexpressions that are worth a name.

SymPy's `cse` finds every repetition; one that saves a single product in two places, or a product of
constants, costs a reader more than it saves the machine. Only those that save at least two
operations on something that varies keep a name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import sympy as sp

_WORTH = 2  # operations saved, where a person reads the code


def _counts(expression: sp.Expr) -> Counter[sp.Symbol]:
    """How often each symbol stands in an expression."""
    return Counter(part for part in sp.preorder_traversal(expression) if part.is_Symbol)


class _Counted:
    """Expressions with what stands in them, counted anew only where one changes."""

    def __init__(self, expressions: Iterable[sp.Expr]) -> None:
        self.expressions = list(expressions)
        self._counts = [_counts(expression) for expression in self.expressions]

    def append(self, expression: sp.Expr) -> None:
        self.expressions.append(expression)
        self._counts.append(_counts(expression))

    def uses(self, symbol: sp.Symbol) -> int:
        return sum(counts[symbol] for counts in self._counts)

    def write_out(self, symbol: sp.Symbol, value: sp.Expr) -> None:
        """Put the value in the place of the symbol."""
        for place, counts in enumerate(self._counts):
            if symbol in counts:
                self.expressions[place] = self.expressions[place].xreplace({symbol: value})
                self._counts[place] = _counts(self.expressions[place])


def _leaves(found: list[tuple[sp.Symbol, sp.Expr]]) -> dict[sp.Symbol, frozenset[str]]:
    """Names that each common subexpression is made of, every other one written out."""
    leaves: dict[sp.Symbol, frozenset[str]] = {}
    for symbol, value in found:
        leaves[symbol] = frozenset().union(*(leaves.get(f, {f.name}) for f in value.free_symbols))
    return leaves


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
    leaves = _leaves(found)
    first_use = _first_uses(found)
    names_kept: list[sp.Symbol] = []
    kept, rest = _Counted(()), _Counted(rewritten)
    for number, (symbol, value) in reversed(list(enumerate(found))):
        saved = value.count_ops() * (kept.uses(symbol) + rest.uses(symbol) - 1)
        names = leaves[symbol]
        if (
            names - constants
            and not names & later
            and saved >= worth
            and first_use.get(symbol, number) >= number
            and (not sums_only or value.has(sp.Add))
        ):
            names_kept.append(symbol)
            kept.append(value)
            continue
        kept.write_out(symbol, value)
        rest.write_out(symbol, value)
    ordered = list(zip(reversed(names_kept), reversed(kept.expressions), strict=True))
    names = {
        symbol: sp.Symbol(f"shared_{number}") for number, symbol in enumerate(reversed(names_kept), start=1)
    }
    pairs = tuple((names[symbol].name, value.xreplace(names)) for symbol, value in ordered)
    return pairs, tuple(expression.xreplace(names) for expression in rest.expressions)


def _first_uses(found: list[tuple[sp.Symbol, sp.Expr]]) -> dict[sp.Symbol, int]:
    """The first of the common subexpressions that each symbol stands in."""
    first: dict[sp.Symbol, int] = {}
    for number, (_, value) in enumerate(found):
        for symbol in value.free_symbols:
            first.setdefault(symbol, number)
    return first
