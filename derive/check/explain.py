"""Where a printed equation and a derived one part: terms without a partner, and the smallest correction."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from delagrange.common.roles import Role
from delagrange.derive.check.compare import Witness, alike, compare, may_agree, printed_residual, scaling
from delagrange.derive.equations.derived_equations import DerivedEquation
from delagrange.derive.notation.printer import text_printer
from delagrange.derive.printed.edits import Edit, single_edits
from delagrange.derive.printed.tokens import Span
from delagrange.derive.printed.tree import (
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
from delagrange.derive.printed.values import to_sympy

Monomials = dict[sp.Expr, sp.Expr]  # what varies -> its number

_TELL_THE_SCALE = (Role.FORCE, Role.REACTION, Role.MODULUS, Role.CONSTANT)


def _monomials(expression: sp.Expr) -> Monomials:
    """Terms of an expanded expression, numbers apart."""
    found: Monomials = {}
    for term in sp.Add.make_args(sp.expand(sp.expand_log(alike(expression)))):
        number, rest = _one_form(term).as_coeff_Mul()
        found[rest] = found.get(rest, sp.S.Zero) + number
    return {rest: number for rest, number in found.items() if number != 0}


def _one_form(term: sp.Expr) -> sp.Expr:
    """A term over a sum as one fraction: `x / (1 - x / a)` and `a x / (a - x)` then look equal."""
    over_a_sum = any(power.exp.is_negative and power.base.is_Add for power in term.atoms(sp.Pow))
    return sp.factor(sp.together(term)) if over_a_sum else term


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


Unmatched = tuple[tuple[str, ...], tuple[str, ...]]  # from the derivation, from the print


def fewest_unmatched(tree: Equation, derived: DerivedEquation) -> Unmatched:
    """`unmatched_terms`, scaled by the coefficients of the unknown or, where fewer are left so, of another symbol.

    The scale of a balance of forces is free, and the slip may be in the term of the unknown itself: then the
    force or a modulus tells the scale. What is solved for its unknown has no other scale.
    """
    found = unmatched_terms(tree, derived, scaling(tree, derived))
    if not derived.quantity.startswith(("equation_of_motion", "static_balance")):
        return found
    count = len(_monomials(derived.residual))
    for factor in _other_scalings(tree, derived):
        if 2 * len(found[0]) <= count:
            break
        found = min(found, unmatched_terms(tree, derived, factor), key=lambda terms: sum(map(len, terms)))
    return found


def _other_scalings(tree: Equation, derived: DerivedEquation) -> Iterator[sp.Expr]:
    """Ratios of the coefficients of forces, moduli and constants of own energies, where they are single terms."""
    printed = printed_residual(tree)
    for each in derived.quantities:
        slope = derived.residual.diff(each.symbol)
        if each.role not in _TELL_THE_SCALE or slope == 0:
            continue
        ratio = sp.factor(sp.cancel(sp.together(printed.diff(each.symbol) / slope)))
        if ratio != 0 and not ratio.has(sp.Add, sp.zoo, sp.nan):
            yield ratio


def unmatched_terms(tree: Equation, derived: DerivedEquation, factor: sp.Expr) -> Unmatched:
    """Derived terms (scaled as the printed equation is) and printed terms that have no partner.

    Derived ones as text in the notation of the model, printed ones as the LaTeX that stands there.
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
    text = text_printer(derived.quantities)
    from_derivation = tuple(
        text(sp.factor(scale * number * rest)) for rest, number in own.items() if rest in apart
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
