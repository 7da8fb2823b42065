"""Where a printed equation and a derived one part: terms without a partner, and the smallest correction."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from delagrange.derive.compare import Witness, compare, may_agree
from delagrange.derive.derived_equations import DerivedEquation
from delagrange.derive.edits import Edit, single_edits
from delagrange.derive.latex_tokens import Span
from delagrange.derive.printed_tree import (
    Equation,
    Group,
    Node,
    Number,
    Power,
    Product,
    Quotient,
    Sum,
    walk,
)
from delagrange.derive.printed_values import to_sympy
from delagrange.derive.printer import PAPER_TEXT

Monomials = dict[sp.Expr, sp.Expr]  # what varies -> its number


def _monomials(expression: sp.Expr) -> Monomials:
    """Terms of an expanded expression, numbers apart."""
    found: Monomials = {}
    for term in sp.Add.make_args(sp.expand(sp.expand_log(expression))):
        number, rest = term.as_coeff_Mul()
        found[rest] = found.get(rest, sp.S.Zero) + number
    return {rest: number for rest, number in found.items() if number != 0}


def _printed_leaves(node: Node, around: sp.Expr) -> Iterator[tuple[sp.Expr, Span]]:
    """The smallest printed terms, each times what stands around its brackets."""
    match node:
        case Group(inner=inner):
            yield from _printed_leaves(inner, around)
        case Sum(terms):
            for term in terms:
                inside = list(_printed_leaves(term.node, term.sign * around))
                yield from inside if len(inside) > 1 else ((inside[0][0], term.span),)
        case Product(factors) if opened := _opened_factor(factors):
            others = sp.Mul(*(to_sympy(factor) for factor in factors if factor is not opened))
            yield from _printed_leaves(opened, around * others)
        case Quotient(numerator, denominator) if _opens(numerator):
            yield from _printed_leaves(numerator, around / to_sympy(denominator))
        case _:
            yield around * to_sympy(node), node.span


def _opens(node: Node) -> bool:
    return isinstance(node, Sum) or (isinstance(node, Group) and _opens(node.inner))


def _opened_factor(factors: tuple[Node, ...]) -> Node | None:
    """The bracketed sum that a reader would multiply out: the last one."""
    return next(
        (factor for factor in reversed(factors) if _opens(factor) and not isinstance(factor, Power)), None
    )


def unmatched_terms(
    tree: Equation, derived: DerivedEquation, factor: sp.Expr
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Derived terms (scaled as the printed equation is) and printed terms that have no partner.

    Derived ones as text in the notation of the paper, printed ones as the LaTeX that stands there.
    """
    scale = factor if factor != 0 else sp.S.One
    own = _monomials(derived.residual)
    sides = (*_printed_leaves(tree.lhs, sp.S.One), *_printed_leaves(tree.rhs, sp.S.NegativeOne))
    leaves = [(span, _monomials(sp.cancel(sp.together(value / scale)))) for value, span in sides]
    printed: Monomials = {}
    for _, monomials in leaves:
        for rest, number in monomials.items():
            printed[rest] = printed.get(rest, sp.S.Zero) + number
    apart = {rest for rest in {**own, **printed} if own.get(rest, 0) != printed.get(rest, 0)}
    from_derivation = tuple(
        PAPER_TEXT(sp.factor(scale * number * rest)) for rest, number in own.items() if rest in apart
    )
    from_print = tuple(tree.literal(span) for span, monomials in leaves if apart & set(monomials))
    return tuple(sorted(from_derivation)), from_print


def corrections(tree: Equation, subject: Witness) -> tuple[str, ...]:
    """The single edits of the printed equation that make it equal, each as kind, before and after.

    Smallest first: an edit of what is printed (a number, sign, exponent, index or bracket) comes
    before one that inserts a number where none is printed, such as `x -> 2 x`; within each of the
    two, coefficients come first, then signs, exponents, indices and brackets, in order of printing.
    """
    mending = (edit for edit in single_edits(tree, wide=True) if _mends(edit, subject))
    printed = _count_numbers(tree)
    ranked = sorted(mending, key=lambda edit: _count_numbers(edit.equation) > printed)
    return tuple(str(edit) for edit in ranked)


def _mends(edit: Edit, subject: Witness) -> bool:
    """Whether an edit is proved to make the equation equal; what cannot be proved is no correction."""
    return may_agree(edit.equation, subject) and compare(edit.equation, subject).equal


def _count_numbers(tree: Equation) -> int:
    return sum(isinstance(part, Number) for _, part in walk(tree))
