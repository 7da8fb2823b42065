"""An equation as printed: a tree that keeps what stands where.

Nothing is simplified or reordered, so that a place in the tree is a place on the page. Equality of
two trees ignores the places.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Literal, TypeAlias

from delagrange.derive.notation.symbols import Quantity
from delagrange.derive.printed.symbol_table import Name, SymbolTable
from delagrange.derive.printed.tokens import Span


@dataclass(frozen=True)
class Number:
    """An exact number."""

    value: Fraction
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Variable:
    """A symbol of the table, rates of change included."""

    quantity: Quantity
    name: Name
    span: Span = field(compare=False)
    differential: bool = field(default=False, compare=False)  # written d/dt instead of with a dot


@dataclass(frozen=True)
class Power:
    """A base with an exponent."""

    base: Node
    exponent: Node
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Quotient:
    """A numerator over a denominator."""

    numerator: Node
    denominator: Node
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Group:
    """What stands in a pair of brackets; `bracket` is the opening one: ( or [ or \\{."""

    bracket: str
    inner: Node
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Function:
    """A named function, such as ln or sqrt, of one argument."""

    name: str
    argument: Node
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Product:
    """Two or more factors."""

    factors: tuple[Node, ...]
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Term:
    """A term of a sum with its sign, +1 or -1."""

    sign: int
    node: Node
    span: Span = field(compare=False)


@dataclass(frozen=True)
class Sum:
    """Terms; one alone is a sum only when its sign is printed."""

    terms: tuple[Term, ...]
    span: Span = field(compare=False)


Node: TypeAlias = Number | Variable | Power | Quotient | Group | Function | Product | Sum
Side = Literal["lhs", "rhs"]


@dataclass(frozen=True)
class Equation:
    """A printed equation; spans refer to `latex`."""

    number: str
    lhs: Node
    rhs: Node
    latex: str = field(compare=False, repr=False)
    table: SymbolTable = field(compare=False, repr=False)

    def literal(self, span: Span) -> str:
        """The LaTeX that stands at `span`, line breaks as spaces."""
        return " ".join(self.latex[span.start : span.end].split())


Part: TypeAlias = Node | Term | Equation
NodePath: TypeAlias = tuple[int, ...]


@dataclass(frozen=True)
class PrintedTerm:
    """One additive term of a side: its sign, what it is, where it stands and its literal LaTeX."""

    sign: int
    node: Node
    span: Span
    latex: str


def terms_of(node: Node) -> tuple[Term, ...]:
    """The terms of a sum; anything else is one term with a plus sign."""
    return node.terms if isinstance(node, Sum) else (Term(1, node, node.span),)


def factors_of(node: Node) -> tuple[Node, ...]:
    """The factors of a product; anything else is one factor."""
    return node.factors if isinstance(node, Product) else (node,)


def sum_of(terms: tuple[Term, ...]) -> Node:
    """A sum, or the node itself where it is one term with a plus sign."""
    if len(terms) == 1 and terms[0].sign == 1:
        return terms[0].node
    return Sum(terms, terms[0].span.to(terms[-1].span))


def product_of(factors: tuple[Node, ...]) -> Node:
    """A product, or the factor itself where there is one."""
    flat = tuple(part for factor in factors for part in factors_of(factor))
    return flat[0] if len(flat) == 1 else Product(flat, flat[0].span.to(flat[-1].span))


def printed_terms(equation: Equation, side: Side) -> tuple[PrintedTerm, ...]:
    """The additive terms of one side, in the order of printing."""
    return tuple(
        PrintedTerm(term.sign, term.node, term.span, equation.literal(term.span))
        for term in terms_of(getattr(equation, side))
    )


_CHILDREN: dict[type, tuple[str, ...]] = {
    Number: (),
    Variable: (),
    Power: ("base", "exponent"),
    Quotient: ("numerator", "denominator"),
    Group: ("inner",),
    Function: ("argument",),
    Term: ("node",),
    Equation: ("lhs", "rhs"),
}
_SEQUENCES: dict[type, str] = {Product: "factors", Sum: "terms"}


def children(part: Part) -> tuple[Part, ...]:
    """What a part of the tree is made of, in the order of printing."""
    if type(part) in _SEQUENCES:
        return getattr(part, _SEQUENCES[type(part)])
    return tuple(getattr(part, name) for name in _CHILDREN[type(part)])


def with_child(part: Part, index: int, child: Part) -> Part:
    """The same part with one child replaced."""
    if type(part) in _SEQUENCES:
        old = children(part)
        return replace(part, **{_SEQUENCES[type(part)]: (*old[:index], child, *old[index + 1 :])})
    return replace(part, **{_CHILDREN[type(part)][index]: child})


def walk(part: Part, path: NodePath = ()) -> Iterator[tuple[NodePath, Part]]:
    """Every part of a tree with its path from the root, a parent before its children."""
    yield path, part
    for index, child in enumerate(children(part)):
        yield from walk(child, (*path, index))


def part_at(root: Part, path: NodePath) -> Part:
    """The part of the tree at a path."""
    for index in path:
        root = children(root)[index]
    return root


def replace_at(root: Part, path: NodePath, new: Part) -> Part:
    """The tree with the part at a path replaced."""
    if not path:
        return new
    index, *rest = path
    return with_child(root, index, replace_at(children(root)[index], tuple(rest), new))
