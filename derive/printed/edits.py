"""Every change of an equation in a single place: mutations that a check must notice, and corrections.

An edit changes the tree, never the text, as a slip of the pen or of a typesetter would: one
coefficient, sign, exponent, index or bracket. Whether it changes the mathematics is for the user
of the edit to find out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from types import MappingProxyType
from typing import Literal, TypeVar

from delagrange.derive.printed.symbol_table import Name, SymbolTable
from delagrange.derive.printed.tokens import Span
from delagrange.derive.printed.tree import (
    Equation,
    Function,
    Group,
    Node,
    NodePath,
    Number,
    Part,
    Power,
    Product,
    Quotient,
    Sum,
    Term,
    Variable,
    children,
    factors_of,
    part_at,
    product_of,
    replace_at,
    sum_of,
    terms_of,
)
from delagrange.derive.printed.write import to_latex

EditKind = Literal["coefficient", "sign", "exponent", "index", "bracket"]
_Item = TypeVar("_Item")

_SWAPPED_AXIS = MappingProxyType({"1": "2", "2": "1"})
_SWAPPED_LABEL = MappingProxyType({r"\alpha": r"\beta", r"\beta": r"\alpha"})
_SWAPPED_LETTER = MappingProxyType({r"\lambda": r"\xi", r"\xi": r"\lambda"})
_INSERTED = (Fraction(2), Fraction(1, 2))
_INSERTED_WIDE = (*_INSERTED, *(Fraction(n) for n in (3, 4, 6, 8)), *(Fraction(1, n) for n in (3, 4, 6, 8)))
_RATIOS_WIDE = tuple(Fraction(n) for n in (3, 4, 6, 8, 16))
_INTEGERS_WIDE = tuple(Fraction(n) for n in range(1, 17))
_EXPONENTS_WIDE = tuple(Fraction(n) for n in range(-8, 9))


@dataclass(frozen=True)
class Edit:
    """One change in one place."""

    kind: EditKind
    span: Span  # of what is changed, in `equation.latex`
    before: str  # LaTeX of the surroundings, for a person
    after: str
    equation: Equation  # the edited tree; its `latex` and spans are still those of the unedited one

    def __str__(self) -> str:
        return f"{self.kind}: {self.before} -> {self.after}"


def single_edits(equation: Equation, *, wide: bool = False) -> Iterator[Edit]:
    """All edits of an equation, in an order that depends on nothing but the equation.

    Args:
        equation: as printed.
        wide: many more values for each coefficient, exponent and index, to look for a correction.
    """
    return chain(
        _coefficient_edits(equation, wide),
        _sign_edits(equation),
        _exponent_edits(equation, wide),
        _index_edits(equation, wide),
        _bracket_edits(equation),
    )


def _edit(equation: Equation, kind: EditKind, path: NodePath, new: Part, context: NodePath | None = None) -> Edit:
    """Replace what stands at `path`, and show the change in the part at `context`."""
    edited = replace_at(equation, path, new)
    shown = path if context is None else context
    before, after = to_latex(part_at(equation, shown)), to_latex(part_at(edited, shown))
    return Edit(kind, part_at(equation, path).span, before, after, edited)


# Where edits can be made


def _outside_exponents(part: Part, path: NodePath = ()) -> Iterator[tuple[NodePath, Part]]:
    """Every part with its path, but for what stands in an exponent."""
    yield path, part
    inner = children(part)[:1] if isinstance(part, Power) else children(part)
    for index, child in enumerate(inner):
        yield from _outside_exponents(child, (*path, index))


def _slots(equation: Equation) -> Iterator[tuple[NodePath, Node]]:
    """Every place that can hold a sum: sides, insides of brackets and roots, parts of fractions."""
    for path, part in _outside_exponents(equation):
        is_root = isinstance(part, Function) and part.name == "sqrt"
        if isinstance(part, Equation | Group | Quotient) or is_root:
            yield from (((*path, index), child) for index, child in enumerate(children(part)))


def _additive(equation: Equation) -> Iterator[tuple[NodePath, Node, tuple[Term, ...]]]:
    """The slots that are sums, and the sides even where they are one term; a printed 0 is no term."""
    for path, node in _slots(equation):
        if isinstance(node, Sum) or (len(path) == 1 and not _is_zero(node)):
            yield path, node, terms_of(node)


def _is_zero(node: Node) -> bool:
    return isinstance(node, Number) and node.value == 0


def _distinct(values: Iterable[_Item], *, but: Iterable[_Item]) -> tuple[_Item, ...]:
    """The values in their order, each once, without some."""
    excluded = tuple(but)
    return tuple(value for value in dict.fromkeys(values) if value not in excluded)


# Coefficients


def _coefficient_edits(equation: Equation, wide: bool) -> Iterator[Edit]:
    for path, part in _outside_exponents(equation):
        if isinstance(part, Number) and part.value:
            for value in _other_coefficients(part.value, wide):
                new = replace(part, value=value)
                yield _edit(equation, "coefficient", path, new, _surroundings(equation, path))
    for path, node, terms in _additive(equation):
        for index, term in enumerate(terms):
            if not _prints_coefficient(term.node):
                yield from _inserted_coefficients(equation, path, node, index, wide)


def _other_coefficients(value: Fraction, wide: bool) -> tuple[Fraction, ...]:
    near = (value + 1, value - 1, value * 2, value / 2)
    far = (*(value * n for n in _RATIOS_WIDE), *(value / n for n in _RATIOS_WIDE), *_INTEGERS_WIDE)
    return _distinct((*near, *far) if wide else near, but=(value, Fraction(0)))


def _surroundings(equation: Equation, path: NodePath) -> NodePath:
    """The path of the nearest fraction or term around a place, else of the side."""
    for end in range(len(path), 1, -1):
        if isinstance(part_at(equation, path[:end]), Quotient | Term):
            return path[:end]
    return path[:1]


def _prints_coefficient(node: Node) -> bool:
    if isinstance(node, Product | Quotient):
        return any(_prints_coefficient(child) for child in children(node))
    return isinstance(node, Number)


def _inserted_coefficients(
    equation: Equation, path: NodePath, node: Node, index: int, wide: bool
) -> Iterator[Edit]:
    place = (*path, index, 0) if isinstance(node, Sum) else path  # 0: from the term to its node
    bare = part_at(equation, place)
    for value in _INSERTED_WIDE if wide else _INSERTED:
        new = product_of((Number(value, bare.span), bare))
        yield _edit(equation, "coefficient", place, new, place[:-1] if isinstance(node, Sum) else place)


# Signs


def _sign_edits(equation: Equation) -> Iterator[Edit]:
    for path, _, terms in _additive(equation):
        for index, term in enumerate(terms):
            flipped = replace(term, sign=-term.sign)
            new = sum_of((*terms[:index], flipped, *terms[index + 1 :]))
            edited = replace_at(equation, path, new)
            yield Edit("sign", term.span, to_latex(term), to_latex(flipped), edited)


# Exponents


def _exponent_edits(equation: Equation, wide: bool) -> Iterator[Edit]:
    raised = frozenset(
        (*path, 0) for path, part in _outside_exponents(equation) if isinstance(part, Power | Function)
    )
    for path, part in _outside_exponents(equation):
        if isinstance(part, Power) and isinstance(part.exponent, Number):
            for value in _other_exponents(part.exponent.value, wide):
                yield _edit(equation, "exponent", path, _with_exponent(part.base, value, part.span))
        elif path not in raised and _can_be_raised(part):
            for value in _other_exponents(Fraction(1), wide):
                yield _edit(equation, "exponent", path, _with_exponent(part, value, part.span))


def _can_be_raised(part: Part) -> bool:
    return isinstance(part, Group) or (isinstance(part, Variable) and not part.differential)


def _other_exponents(value: Fraction, wide: bool) -> tuple[Fraction, ...]:
    """A factor without a printed exponent (1) becomes a square; printed exponents move by one or flip."""
    near = (Fraction(2),) if value == 1 else (value + 1, value - 1, -value)
    return _distinct((*near, -value, *_EXPONENTS_WIDE) if wide else near, but=(value,))


def _with_exponent(base: Node, value: Fraction, span: Span) -> Power:
    return Power(base, Number(value, span), span)


# Indices


def _index_edits(equation: Equation, wide: bool) -> Iterator[Edit]:
    present = _names_in(equation) if wide else ()
    for path, part in _outside_exponents(equation):
        if isinstance(part, Variable):
            alike = (name for name in present if equation.table[name].unit == part.quantity.unit)
            names = (*partners(part.name, equation.table), *alike)
            around = path[:-1] if isinstance(part_at(equation, path[:-1]), Power) else path
            for name in _distinct(names, but=(part.name,)):
                new = replace(part, quantity=equation.table[name], name=name)
                yield _edit(equation, "index", path, new, around)


def _names_in(equation: Equation) -> tuple[Name, ...]:
    variables = (part for _, part in _outside_exponents(equation) if isinstance(part, Variable))
    return tuple(dict.fromkeys(variable.name for variable in variables))


def partners(name: Name, table: SymbolTable) -> tuple[Name, ...]:
    """The symbols of a table that a slip could put in place of one.

    They have the index of the other axis, the label of the other spring, or the other stretch with
    the same index; or the table names them as partners.
    """
    axis = _SWAPPED_AXIS.get(name.subscript[-1:], "")
    candidates = (
        *((replace(name, subscript=name.subscript[:-1] + axis),) if axis else ()),
        replace(name, label=_SWAPPED_LABEL.get(name.label, name.label)),
        replace(name, letter=_SWAPPED_LETTER.get(name.letter, name.letter)),
        *(second for first, second in table.partners if first == name),
        *(first for first, second in table.partners if second == name),
    )
    return tuple(other for other in _distinct(candidates, but=(name,)) if other in table)


# Brackets


def _bracket_edits(equation: Equation) -> Iterator[Edit]:
    """Every closing bracket moved to the end of an earlier or a later term."""
    for path, node in _slots(equation):
        terms = terms_of(node)
        for index, place, group in _groups_in(terms):
            for end, moved in chain(_closed_earlier(terms, index, place), _closed_later(terms, index, place)):
                new = sum_of((*terms[:index], *moved, *terms[end:]))
                before, after = to_latex(sum_of(terms[index:end])), to_latex(sum_of(moved))
                yield Edit("bracket", group.span, before, after, replace_at(equation, path, new))


def _groups_in(terms: tuple[Term, ...]) -> Iterator[tuple[int, int, Group]]:
    """Which factor of which term is a pair of brackets, with or without an exponent."""
    for index, term in enumerate(terms):
        for place, factor in enumerate(factors_of(term.node)):
            inner = _without_exponent(factor)
            if isinstance(inner, Group):
                yield index, place, inner


def _without_exponent(factor: Node) -> Node:
    return factor.base if isinstance(factor, Power) else factor


def _refilled(factor: Node, inner: tuple[Term, ...]) -> Node:
    """The same brackets, with their exponent, around other terms."""
    if isinstance(factor, Power):
        return replace(factor, base=_refilled(factor.base, inner))
    return replace(factor, inner=sum_of(inner))


def _times(term: Term, factors: tuple[Node, ...]) -> Term:
    return replace(term, node=product_of((term.node, *factors)))


def _opened(terms: tuple[Term, ...], index: int, place: int) -> tuple[tuple[Term, ...], tuple[Node, ...]]:
    """What stands inside of the brackets, and the factors that stand behind them."""
    factors = factors_of(terms[index].node)
    return terms_of(_without_exponent(factors[place]).inner), factors[place + 1 :]


def _reclosed(terms: tuple[Term, ...], index: int, place: int, inner: tuple[Term, ...]) -> Term:
    """The term up to the closing bracket, with other terms inside."""
    factors = factors_of(terms[index].node)
    return replace(terms[index], node=product_of((*factors[:place], _refilled(factors[place], inner))))


def _closed_earlier(
    terms: tuple[Term, ...], index: int, place: int
) -> Iterator[tuple[int, tuple[Term, ...]]]:
    """`a [x + y] b` becomes `a [x] + y b`: what stood behind the bracket stays behind the last term.

    Yields:
        The index after the terms that are replaced, and what replaces them from `index` on.
    """
    inner, behind = _opened(terms, index, place)
    for kept in range(1, len(inner)):
        closed = _reclosed(terms, index, place, inner[:kept])
        yield index + 1, (closed, *inner[kept:-1], _times(inner[-1], behind))


def _closed_later(terms: tuple[Term, ...], index: int, place: int) -> Iterator[tuple[int, tuple[Term, ...]]]:
    """`a [x + y] b + u` becomes `a [x + y b + u]`; yields as `_closed_earlier`."""
    inner, behind = _opened(terms, index, place)
    tail = (*inner[:-1], _times(inner[-1], behind))
    for end in range(index + 2, len(terms) + 1):
        yield end, (_reclosed(terms, index, place, (*tail, *terms[index + 1 : end])),)
