"""Derived against printed: the only place where the two witnesses meet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from delagrange.derive.compare import Comparison, Witness, compare, scaling, witness
from delagrange.derive.derived_equations import DerivedEquation, derived_equations
from delagrange.derive.euler_lagrange import EquationsOfMotion
from delagrange.derive.explain import corrections, unmatched_terms
from delagrange.derive.printed_dimensions import check_printed
from delagrange.derive.printed_tree import Equation
from delagrange.derive.printer import PAPER_TEXT
from delagrange.derive.published import Paper, PrintedEquation
from delagrange.derive.symbols import QUANTITIES
from delagrange.derive.verdict import Outcome, Verdict

# Printed for the general membrane, i.e. before any load case
_FAMILY = {"biaxial": "membrane"}


def _known_symbols() -> tuple[sp.Symbol, ...]:
    return tuple(quantity.symbol for quantity in QUANTITIES)


def printed_for(eom: EquationsOfMotion, paper: Paper) -> tuple[PrintedEquation, ...]:
    """The printed equations that this model can be checked against."""
    family = _FAMILY.get(eom.load_case.family, eom.load_case.family)
    return tuple(equation for equation in paper.equations if equation.load_case == family)


def verify(eom: EquationsOfMotion, paper: Paper) -> tuple[Verdict, ...]:
    """The verdict on each printed equation that speaks of this model.

    Raises:
        LatexError: a printed equation cannot be read.
    """
    derived = derived_equations(eom)
    return tuple(_verdict(printed, derived, paper) for printed in printed_for(eom, paper))


def _verdict(printed: PrintedEquation, derived: Mapping[str, DerivedEquation], paper: Paper) -> Verdict:
    equation = derived[printed.quantity]
    if printed.latex is None:
        return _missing(printed, equation)
    verdict = verdict_on(printed.read(paper.table), witness(equation, _known_symbols()))
    repairs = (f"read {r.new} for {r.old}" for r in printed.repairs)
    note = "; ".join(filter(None, (verdict.note, printed.note, *repairs)))
    return replace(verdict, number=printed.number, note=note)


def _missing(printed: PrintedEquation, equation: DerivedEquation) -> Verdict:
    """No verdict where nothing is printed; the derived equation stands in its place."""
    unknown = equation.unknown
    solved = f"{unknown.text} = {PAPER_TEXT(unknown.symbol - equation.residual)}"
    return Verdict(
        printed.number, equation.model, printed.quantity, Outcome.MISSING, derived=solved, note=printed.note
    )


def verdict_on(tree: Equation, subject: Witness, *, explained: bool = True) -> Verdict:
    """The verdict on one equation as read; `explained=False` leaves out what differs and how to mend it."""
    comparison = compare(tree, subject)
    verdict = Verdict(
        tree.number,
        subject.derived.model,
        subject.derived.quantity,
        _outcome(comparison),
        comparison.factor,
        unit_faults=tuple(str(fault) for fault in check_printed(tree) if not fault.ok),
        note=f"{comparison.reason}: compared as differing" if comparison.reason else "",
    )
    if comparison.equal or not explained:
        return verdict
    from_derivation, from_print = unmatched_terms(tree, subject.derived, scaling(tree, subject.derived))
    return replace(
        verdict,
        derived_unmatched=from_derivation,
        printed_unmatched=from_print,
        corrections=corrections(tree, subject),
    )


def _outcome(comparison: Comparison) -> Outcome:
    if not comparison.equal:
        return Outcome.DIFFERS
    return Outcome.EQUAL if comparison.factor == 1 else Outcome.SCALED
