"""The check can fail: every single-place mutation that changes the mathematics is reported as differing.

Each printed equation is mutated in one coefficient, sign, exponent, index or bracket at a time, all of
them in turn. Whether a mutation changes the mathematics is decided without the derivation: the
equation, solved for the quantity that it gives, is evaluated before and after in exact rationals.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random

import pytest

from delagrange.derive.check.compare import witness
from delagrange.derive.check.verdict import Outcome
from delagrange.derive.check.verify import verdict_on
from delagrange.derive.equations.derived_equations import derived_equations
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.edits import Edit, single_edits
from delagrange.derive.printed.latex import read_equation
from delagrange.derive.printed.tree import Group, Number, Power, Product, Quotient, Sum, Variable

MODEL = {"pure_shear": "pure_shear_as_printed"}
# What Eqs. (15), (16) and (21) should read, so that their mutations start from an equation that is right
CORRECTED = {
    "15": (r"- \lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3} + \lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3} \xi_{\mathrm{UA2}}^{2}",
           r"- \lambda_{\mathrm{UA1}}^{-2} \lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3} \xi_{\mathrm{UA2}}^{2}"),
    "16": (r"{3\eta}", r"{6\eta}"),
}  # fmt: skip
KNOWN = tuple(SHENG_2015.table.entries.values())
NUMBERS = [equation.number for equation in SHENG_2015.readable]


def _starting_tree(number: str):
    """The printed equation, or where it is wrong, what it should be."""
    text = SHENG_2015[number].reading
    if number in CORRECTED:
        old, new = CORRECTED[number]
        assert text.count(old) == 1
        text = text.replace(old, new)
    tree = read_equation(text, SHENG_2015.table, number=number)
    if number != "21":
        return tree
    to_the_end = [
        e for e in single_edits(tree) if e.kind == "bracket" and e.after.rstrip().endswith(r"\right]")
    ]
    return max(to_the_end, key=lambda edit: len(edit.after)).equation


def _exact(node, values: dict) -> Fraction:
    """The value of a printed tree in rationals; a third road beside SymPy and mpmath."""
    match node:
        case Number(value):
            return value
        case Variable(quantity):
            return values[quantity.symbol]
        case Sum(terms):
            return sum((term.sign * _exact(term.node, values) for term in terms), Fraction(0))
        case Product(factors):
            product = Fraction(1)
            for factor in factors:
                product *= _exact(factor, values)
            return product
        case Quotient(numerator, denominator):
            return _exact(numerator, values) / _exact(denominator, values)
        case Power(base, exponent):
            return _exact(base, values) ** int(_exact(exponent, values))
        case Group(inner=inner):
            return _exact(inner, values)
    raise TypeError(type(node).__name__)


def _solved(tree, unknown, values: dict) -> tuple[Fraction | None, Fraction]:
    """The unknown from a straight equation, and how much the equation bends."""

    def residual(value: Fraction) -> Fraction:
        at = {**values, unknown: value}
        return _exact(tree.lhs, at) - _exact(tree.rhs, at)

    at_zero, at_one, at_two = (residual(Fraction(n)) for n in range(3))
    slope = at_one - at_zero
    return (-at_zero / slope if slope else None), at_two - 2 * at_one + at_zero


def _points():
    random = Random(7)
    return [
        {each.symbol: Fraction(random.randint(3, 97), random.randint(3, 97)) for each in KNOWN}
        for _ in range(2)
    ]


POINTS = _points()


def _same_mathematics(tree, other, unknown) -> bool:
    try:
        return all(_solved(tree, unknown, values) == _solved(other, unknown, values) for values in POINTS)
    except ZeroDivisionError:
        return False


def _derived(number, equations):
    printed = SHENG_2015[number]
    return derived_equations(equations(MODEL.get(printed.load, printed.load)))[printed.quantity]


@cache
def _mutations_that_matter(number: str, unknown) -> tuple[Edit, ...]:
    """Those of an equation that change the mathematics of the quantity that it gives."""
    tree = _starting_tree(number)
    return tuple(edit for edit in single_edits(tree) if not _same_mathematics(tree, edit.equation, unknown))


@pytest.mark.parametrize("number", NUMBERS)
def test_every_mutation_that_matters_is_reported(number, equations, record_property):
    subject = witness(_derived(number, equations), KNOWN)
    tree = _starting_tree(number)
    assert verdict_on(tree, subject, explained=False).agrees

    mutations = _mutations_that_matter(number, subject.derived.unknown.symbol)
    survivors = [
        str(edit)
        for edit in mutations
        if verdict_on(edit.equation, subject, explained=False).outcome is not Outcome.DIFFERS
    ]
    record_property("mutations", len(mutations))
    print(f"Eq. ({number}): {len(mutations)} mutations, {len(survivors)} survive")
    assert survivors == []
    assert len(mutations) >= 30


def test_the_number_of_mutations_is_the_one_that_the_readme_states(equations):
    unknowns = {number: _derived(number, equations).unknown.symbol for number in NUMBERS}
    count = sum(len(_mutations_that_matter(number, unknown)) for number, unknown in unknowns.items())
    readme = " ".join((Path(__file__).parents[3] / "README.md").read_text(encoding="utf-8").split())
    assert f"all {count} mutations that change the mathematics" in readme


def test_kinds_of_mutation_are_all_there():
    kinds = {edit.kind for number in NUMBERS for edit in single_edits(SHENG_2015.read(number))}
    assert kinds == {"coefficient", "sign", "exponent", "index", "bracket"}
