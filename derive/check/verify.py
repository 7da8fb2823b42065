"""Derived against printed: the only place where the two witnesses meet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from delagrange.derive.check.compare import Comparison, Witness, compare, witness
from delagrange.derive.check.explain import corrections, fewest_unmatched
from delagrange.derive.check.verdict import Outcome, Verdict
from delagrange.derive.equations.derived_equations import DerivedEquation, derived_equations
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.notation.printer import text_printer
from delagrange.derive.papers.paper import Paper, PrintedEquation
from delagrange.derive.printed.dimensions import check_printed
from delagrange.derive.printed.tree import Equation, walk

_LONGEST_CORRECTED = 600  # parts of a printed tree; the edits to try, and the time of each, grow with them
_TOO_LONG = "too long to try what single edit would mend it"


def printed_for(eom: EquationsOfMotion, paper: Paper) -> tuple[PrintedEquation, ...]:
    """The printed equations that this model can be checked against."""
    return tuple(equation for equation in paper.equations if equation.load == eom.load_case.family)


def verify(eom: EquationsOfMotion, paper: Paper) -> tuple[Verdict, ...]:
    """The verdict on each printed equation that speaks of this model.

    Raises:
        LatexError: a printed equation cannot be read.
        ValueError: one is said to state what the model does not give.
    """
    derived = derived_equations(eom)
    return tuple(_verdict(printed, derived, paper) for printed in printed_for(eom, paper))


def _verdict(printed: PrintedEquation, derived: Mapping[str, DerivedEquation], paper: Paper) -> Verdict:
    if printed.quantity not in derived:
        raise ValueError(
            f"Eq. ({printed.number}) of {paper.citation} states {printed.quantity!r}, which its models do not give; "
            f"there are {', '.join(derived)}"
        )
    equation = derived[printed.quantity]
    if printed.latex is None:
        return _missing(printed, equation)
    verdict = verdict_on(printed.read(paper.table), witness(equation, paper.table.entries.values()))
    repairs = (f"read {r.new} for {r.old}" for r in printed.repairs)
    note = "; ".join(filter(None, (verdict.note, printed.note, *repairs)))
    return replace(verdict, number=printed.number, note=note)


def _missing(printed: PrintedEquation, equation: DerivedEquation) -> Verdict:
    """No verdict where nothing is printed; the derived equation stands in its place."""
    unknown = equation.unknown
    solved = f"{unknown.text} = {text_printer(equation.quantities)(unknown.symbol - equation.residual)}"
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
        factor_text=text_printer(subject.derived.quantities)(comparison.factor),
        unit_faults=tuple(str(fault) for fault in check_printed(tree) if not fault.ok),
        note=f"{comparison.reason}: compared as differing" if comparison.reason else "",
    )
    if comparison.equal or not explained:
        return verdict
    short = sum(1 for _ in walk(tree)) <= _LONGEST_CORRECTED
    from_derivation, from_print = fewest_unmatched(tree, subject.derived)
    return replace(
        verdict,
        derived_unmatched=from_derivation,
        printed_unmatched=from_print,
        corrections=corrections(tree, subject) if short else (),
        note=verdict.note if short else "; ".join(filter(None, (verdict.note, _TOO_LONG))),
    )


def _outcome(comparison: Comparison) -> Outcome:
    if not comparison.equal:
        return Outcome.DIFFERS
    return Outcome.EQUAL if comparison.factor == 1 else Outcome.SCALED
