"""Products that stand in several places, computed once.

Every product is a bag of factors. The pair of factors that stands together most often gets a name and
takes the place of the two, again and again, until no pair is left that stands in two places (greedy, as
Breuer 1969, Commun. ACM 12, 333). Powers come out of it by themselves.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import combinations

import sympy as sp

Bag = Counter[sp.Symbol]  # how often each factor stands in a product
Pair = tuple[sp.Symbol, sp.Symbol]


def share_products(
    expressions: tuple[sp.Expr, ...],
) -> tuple[tuple[tuple[str, sp.Expr], ...], tuple[sp.Expr, ...]]:
    """Named products of two, and the expressions rewritten in them.

    Returns:
        Pairs (name, product) in the order in which they must be computed, and the expressions in the
        order given.
    """
    bags = [_bag(product) for expression in expressions for product in _products(expression)]
    found: Counter[Pair] = Counter()
    for bag in bags:
        found.update(_pairs(bag))
    named: dict[sp.Symbol, Pair] = {}
    while (pair := _most_frequent(found)) is not None:
        name = _name(pair, named)
        named[name] = pair
        for bag in (bag for bag in bags if pair[0] in bag and pair[1] in bag):
            found.subtract(_pairs(bag))
            _replace(bag, pair, name)
            found.update(_pairs(bag))
    rest = iter(bags)
    rewritten = tuple(_rewritten(expression, rest) for expression in expressions)
    return tuple((name.name, sp.Mul(*pair, evaluate=False)) for name, pair in named.items()), rewritten


def _pairs(bag: Bag) -> dict[Pair, int]:
    """How often each pair of factors stands together in a product."""
    factors = sorted(bag, key=_by_name)
    pairs = {(one, other): min(bag[one], bag[other]) for one, other in combinations(factors, 2)}
    return pairs | {(one, one): bag[one] // 2 for one in factors}


def _by_name(symbol: sp.Symbol) -> str:
    return symbol.name


def _most_frequent(found: Counter[Pair]) -> Pair | None:
    """The pair that stands together most often, at least twice; squares first, then by name."""
    often = max(found.values(), default=0)
    candidates = (pair for pair, count in found.items() if count == often)
    return min(candidates, key=lambda pair: (pair[0] != pair[1], *map(str, pair))) if often > 1 else None


def _name(pair: Pair, named: dict[sp.Symbol, Pair]) -> sp.Symbol:
    """`x_pow3` for x and `x_pow2`, else the next `factor_n`."""
    (base, low), (other, high) = (_power(factor, named) for factor in pair)
    if base == other:
        return sp.Symbol(f"{base.name}_pow{low + high}")
    return sp.Symbol(f"factor_{1 + sum(_power(name, named)[1] == 1 for name in named)}")


def _power(factor: sp.Symbol, named: dict[sp.Symbol, Pair]) -> tuple[sp.Symbol, int]:
    """What a named product is a power of, and which; any other symbol is the first power of itself."""
    if factor not in named:
        return factor, 1
    (base, low), (other, high) = (_power(part, named) for part in named[factor])
    return (base, low + high) if base == other else (factor, 1)


def _replace(bag: Bag, pair: Pair, name: sp.Symbol) -> None:
    """Let the name take the place of the pair as often as it stands in the bag."""
    one, other = pair
    count = bag[one] // 2 if one == other else min(bag[one], bag[other])
    bag.subtract({one: 2 * count} if one == other else {one: count, other: count})
    bag[name] += count
    for factor in [factor for factor, left in bag.items() if left == 0]:
        del bag[factor]


def _is_product(expression: sp.Expr) -> bool:
    return expression.is_Mul or _is_power(expression)


def _is_power(expression: sp.Expr) -> bool:
    """A positive integer power of a symbol, from the first on."""
    base, exponent = expression.as_base_exp()
    return bool(base.is_Symbol and exponent.is_Integer and exponent > 0)


def _bag(product: sp.Expr) -> Bag:
    """The symbols of a product with how often they stand in it; sums and numbers are left aside."""
    powers = (factor.as_base_exp() for factor in sp.Mul.make_args(product) if _is_power(factor))
    return Counter({base: int(exponent) for base, exponent in powers})


def _inner(product: sp.Expr) -> tuple[sp.Expr, ...]:
    """The factors of a product that are not in its bag."""
    return tuple(factor for factor in sp.Mul.make_args(product) if not _is_power(factor))


def _products(expression: sp.Expr) -> Iterator[sp.Expr]:
    """The products in an expression, each before those inside of it."""
    if _is_product(expression):
        yield expression
    for part in _inner(expression) if _is_product(expression) else expression.args:
        yield from _products(part)


def _rewritten(expression: sp.Expr, bags: Iterator[Bag]) -> sp.Expr:
    """The expression with its products made of what is left in their bags, taken in the order of `_products`."""
    if _is_product(expression):
        bag = next(bags)
        powers = [factor**count for factor, count in sorted(bag.items(), key=lambda item: str(item[0]))]
        return sp.Mul(*powers, *(_rewritten(factor, bags) for factor in _inner(expression)))
    return (
        expression.func(*(_rewritten(part, bags) for part in expression.args))
        if expression.args
        else expression
    )
