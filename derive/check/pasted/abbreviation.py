"""Abbreviations of a paper, c for mu/rho: read once, and put where they stand as a bracket."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from delagrange.derive.check.pasted.bounds import check_length, check_parts, check_size, in_brief
from delagrange.derive.notation.symbols import Quantity
from delagrange.derive.printed.latex import read_equation
from delagrange.derive.printed.symbol_table import Name, SymbolTable
from delagrange.derive.printed.tokens import LatexError, Span
from delagrange.derive.printed.tree import Equation, Group, Node, Part, Variable, children, walk, with_child


@dataclass(frozen=True)
class Abbreviation:
    """A symbol and what it is short for; `placeholder` stands for it in the table while an equation is read."""

    placeholder: Quantity
    node: Node  # in quantities of the model only


def read_abbreviation(
    name: Name, latex: str, table: SymbolTable, above: tuple[Abbreviation, ...], place: str
) -> Abbreviation:
    """Read what a symbol is short for; it may hold abbreviations that stand `above` it.

    Raises:
        ValueError: it is not understood, or too long with all that it is short for.
    """
    text = str(name)
    try:
        check_length(latex, text)
        filled = substituted(read_equation(f"{latex} = 0", table, number=text), above, table)
        check_size(filled)
    except LatexError as error:
        raise ValueError(f"{place}the abbreviation {text}: {in_brief(error)}") from None
    placeholder = Quantity(sp.Symbol(f"short for {text}"), text, text, text, "1", f"short for {latex}")
    return Abbreviation(placeholder, filled.lhs)


def substituted(tree: Equation, abbreviations: tuple[Abbreviation, ...], table: SymbolTable) -> Equation:
    """The equation with all abbreviations written out, as one in the symbols of `table`.

    Raises:
        LatexError: written out, it is too long.
    """
    nodes = {each.placeholder: each.node for each in abbreviations}
    sizes = {quantity: sum(1 for _ in walk(node)) for quantity, node in nodes.items()}
    check_parts(tree, sizes)
    return replace(_filled(tree, nodes), table=table)


def _filled(part: Part, nodes: dict[Quantity, Node]) -> Part:
    if isinstance(part, Variable) and part.quantity in nodes:
        return Group("(", _moved(nodes[part.quantity], part.span), part.span)
    for index, child in enumerate(children(part)):
        part = with_child(part, index, _filled(child, nodes))
    return part


def _moved(part: Part, span: Span) -> Part:
    """The same at the place of the symbol that is short for it."""
    for index, child in enumerate(children(part)):
        part = with_child(part, index, _moved(child, span))
    return replace(part, span=span)
