"""How large a pasted equation may be: far beyond any print, far below what would keep the algebra busy for minutes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import comb, prod

from delagrange.derive.notation.symbols import Quantity
from delagrange.derive.printed.tokens import LatexError, Source, Span, tokenize
from delagrange.derive.printed.tree import (
    Equation,
    Function,
    Group,
    Node,
    Number,
    Part,
    Power,
    Product,
    Quotient,
    Sum,
    Variable,
    walk,
)

LONGEST = 10_000  # characters of an equation
MOST_PARTS = 1_500  # of its tree: symbols, numbers, sums, products, ...
MOST_TERMS = 3_000  # when all its brackets are multiplied out, over one denominator
HIGHEST_OF_SUM = 10  # exponent of a bracket with several terms
HIGHEST_EXPONENT = 64  # printed ones, and those that brackets make of them
HIGHEST_POWER = 1_000  # of all factors together
_MOST_DIGITS = 30
_NESTED_FUNCTIONS = 2  # exp of exp, or an exponent in an exponent
_LONGEST_SYMBOL = 200
_LONGEST_SHOWN = 60


def check_length(latex: str, number: str) -> None:
    """Refuse text that is too long, and numbers of too many digits, before anything reads it.

    Raises:
        LatexError: it is.
    """
    source = Source(number, latex if len(latex) <= LONGEST else f"{latex[:20]}...")
    if len(latex) > LONGEST:
        raise source.error(Span(0, len(source.latex)), f"no more than {LONGEST} characters")
    for token in tokenize(source):
        if token.kind == "number" and len(token.text) > _MOST_DIGITS:
            raise source.error(token.span, f"a number of no more than {_MOST_DIGITS} digits")


def check_symbol_length(latex: str) -> None:
    """Raises: ValueError: a symbol has more characters than any print has."""
    if len(latex) > _LONGEST_SYMBOL:
        raise ValueError(f"it has {len(latex)} characters; allowed are {_LONGEST_SYMBOL}")


def check_parts(tree: Equation, sizes: Mapping[Quantity, int]) -> None:
    """Refuse an equation of too many parts; `sizes` are those that some symbols are short for.

    Raises:
        LatexError: it has.
    """
    parts = sum(sizes.get(part.quantity, 1) if isinstance(part, Variable) else 1 for _, part in walk(tree))
    if parts > MOST_PARTS:
        raise _refusal(tree, tree, f"no more than {MOST_PARTS} symbols, numbers and operations, not {parts}")


def check_size(tree: Equation) -> None:
    """Refuse what the algebra could not take in reasonable time.

    Raises:
        LatexError: an exponent or a nesting is too high, or too many terms come out of the brackets.
    """
    sides = [_size(side, tree) for side in (tree.lhs, tree.rhs)]
    if (terms := _over_one_denominator(sides).terms) > MOST_TERMS:
        raise _refusal(
            tree, tree, f"no more than {MOST_TERMS} terms with brackets multiplied out, not {terms}"
        )


@dataclass(frozen=True)
class _Size:
    """What a node grows to when its brackets are multiplied out."""

    terms: int = 1
    power: int = 1  # highest power that can come out
    nested: int = 0  # functions, and exponents that are no numbers, within one another
    divisors: Mapping[Node, int] | None = None  # with the terms of each


def _size(node: Node, tree: Equation) -> _Size:
    match node:
        case Number() | Variable():
            return _Size()
        case Group(inner=inner):
            return _size(inner, tree)
        case Sum(terms):
            return _over_one_denominator([_size(term.node, tree) for term in terms])
        case Product(factors):
            return _checked(_multiplied([_size(factor, tree) for factor in factors]), node, tree)
        case Quotient(numerator, denominator):
            return _checked(
                _divided(_size(numerator, tree), _size(denominator, tree), denominator), node, tree
            )
        case Power():
            return _checked(_raised(node, tree), node, tree)
        case Function(argument=argument):
            inner = _size(argument, tree)
            return _checked(_Size(nested=inner.nested + 1), node, tree)
    raise TypeError(f"{type(node).__name__} is not a node of a printed tree")


def _over_one_denominator(sizes: list[_Size]) -> _Size:
    common = {node: terms for size in sizes for node, terms in (size.divisors or {}).items()}
    total = prod(common.values())
    terms = sum(size.terms * total // prod((size.divisors or {}).values()) for size in sizes)
    return _Size(terms, max(s.power for s in sizes), max(s.nested for s in sizes), common)


def _multiplied(sizes: list[_Size]) -> _Size:
    divisors = {node: terms for size in sizes for node, terms in (size.divisors or {}).items()}
    terms, power = prod(size.terms for size in sizes), sum(size.power for size in sizes)
    return _Size(terms, power, max(size.nested for size in sizes), divisors)


def _divided(above: _Size, below: _Size, denominator: Node) -> _Size:
    divisors = dict(above.divisors or {})
    if below.terms > 1:
        divisors[denominator] = below.terms
    return _Size(above.terms, above.power + below.power, max(above.nested, below.nested), divisors)


def _raised(node: Power, tree: Equation) -> _Size:
    base, exponent = _size(node.base, tree), _size(node.exponent, tree)
    if any(isinstance(part, Variable) for _, part in walk(node.exponent)):
        return _Size(1, base.power, max(base.nested, exponent.nested + 1))
    value = _value(node.exponent)
    if value is None or abs(value) > HIGHEST_EXPONENT:
        raise _refusal(tree, node.exponent, f"an exponent of no more than {HIGHEST_EXPONENT}")
    if base.terms > 1 and abs(value) > HIGHEST_OF_SUM:
        raise _refusal(tree, node.exponent, f"an exponent of a sum of no more than {HIGHEST_OF_SUM}")
    times = max(1, int(abs(value)))
    if value < 0 and base.terms > 1:
        return _Size(1, base.power * times, base.nested, {node.base: _multinomial(base.terms, times)})
    return _Size(_multinomial(base.terms, times), base.power * times, base.nested, base.divisors)


def _multinomial(terms: int, power: int) -> int:
    """Terms of (a + b + ...)^power."""
    return comb(min(terms, MOST_TERMS) + power - 1, power) if terms > 1 else 1


def _value(node: Node) -> float | None:
    """The number of an exponent that is made of numbers alone; None where it is none."""
    try:
        match node:
            case Number(value):
                return float(value)
            case Group(inner=inner):
                return _value(inner)
            case Sum(terms):
                return sum(term.sign * _value(term.node) for term in terms)
            case Product(factors):
                return prod(_value(factor) for factor in factors)
            case Quotient(numerator, denominator):
                return _value(numerator) / _value(denominator)
    except (TypeError, ArithmeticError):
        return None
    return None


def _checked(size: _Size, node: Node, tree: Equation) -> _Size:
    if size.terms > MOST_TERMS:
        raise _refusal(tree, node, f"no more than {MOST_TERMS} terms with brackets multiplied out")
    if size.power > HIGHEST_POWER:
        raise _refusal(tree, node, f"powers of no more than {HIGHEST_POWER} in all")
    if size.nested > _NESTED_FUNCTIONS:
        raise _refusal(tree, node, f"no more than {_NESTED_FUNCTIONS} functions or exponents in one another")
    return size


def _refusal(tree: Equation, part: Part, expected: str) -> LatexError:
    span = Span(0, len(tree.latex)) if isinstance(part, Equation) else part.span
    source = Source(tree.number, tree.latex)
    return source.error(span, expected)


def in_brief(error: LatexError) -> str:
    """The error in one line, with no more of the pasted text than shows the place."""
    found = " ".join(error.found.split())
    short = found if len(found) <= _LONGEST_SHOWN else f"{found[:_LONGEST_SHOWN]}..."
    place = f"Eq. ({error.equation[:_LONGEST_SHOWN]}), line {error.line}, column {error.column}"
    return f"{place}: found '{short}', expected {error.expected}"
