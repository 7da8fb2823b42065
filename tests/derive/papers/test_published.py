"""The stored equations: verbatim, read, of one unit, and with known exceptions."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from delagrange.derive.notation import symbols as sym
from delagrange.derive.papers.printed_equation import TextRepair
from delagrange.derive.papers.sheng_2015 import symbols as paper
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.latex import (
    LatexError,
    check_printed,
    evaluate,
    printed_terms,
    read_equation,
    to_latex,
    to_sympy,
)
from delagrange.derive.printed.symbol_table import name_of
from delagrange.derive.printed.tree import Equation, Group, Variable, walk

NUMBERS = tuple(printed.number for printed in SHENG_2015.readable)
READ = {number: SHENG_2015.read(number) for number in NUMBERS}
# SHA-256 of the text, taken when it was copied
VERBATIM = "099bc6e6e4dbf36a0cfafadaa8db3c53a22a26eb8cb1232878a3ab159b849fb0"


def _symbols(equation: Equation) -> list[sp.Symbol]:
    variables = (part for _, part in walk(equation) if isinstance(part, Variable))
    return list(dict.fromkeys(variable.quantity.symbol for variable in variables))


def test_equations_4_to_21_are_there_and_22_is_recorded_as_lost() -> None:
    assert list(NUMBERS) == [str(number) for number in range(4, 22)]
    lost = SHENG_2015["22"]
    assert lost.latex is None
    assert (lost.quantity, lost.load) == ("dashpot_rate_1", "pure_shear")
    with pytest.raises(ValueError, match=r"Eq. \(22\) is missing in the text"):
        SHENG_2015.read("22")


def test_text_is_verbatim() -> None:
    """Repairs and corrections belong beside the text: it stays what it was, to the character."""
    text = "\n\n".join(printed.latex for printed in SHENG_2015.readable)
    assert hashlib.sha256(text.encode()).hexdigest() == VERBATIM


def test_each_equation_has_its_source() -> None:
    for printed in SHENG_2015.equations:
        assert printed.source == f"{SHENG_2015.citation}, Eq. ({printed.number})"


def test_unknown_number_is_named() -> None:
    with pytest.raises(ValueError, match="equation '99' is not stored; there are 4, 5"):
        SHENG_2015["99"]


@pytest.mark.parametrize(("number", "denominator"), [("10", "{6n}"), ("16", "{3n}")])
def test_without_its_repair_the_glyph_n_is_refused(number: str, denominator: str) -> None:
    printed = SHENG_2015[number].latex
    with pytest.raises(LatexError) as caught:
        read_equation(printed, SHENG_2015.table, number=number)
    error = caught.value
    assert (error.equation, error.position, error.found) == (number, printed.index(denominator) + 2, "n")
    assert (error.line, error.column) == (1, error.position + 1)


def test_only_glyphs_are_repaired() -> None:
    repaired = {printed.number: printed.repairs for printed in SHENG_2015.equations if printed.repairs}
    assert set(repaired) == {"10", "16"}
    for repairs in repaired.values():
        (repair,) = repairs
        assert repair.old.replace("n", r"\eta") == repair.new


@pytest.mark.parametrize("old", [r"\lambda", "absent"])
def test_repair_must_apply_exactly_once(old: str) -> None:
    printed = replace(SHENG_2015["10"], repairs=(TextRepair(old, "x", "a test"),))
    with pytest.raises(ValueError, match="allowed is once"):
        printed.read(SHENG_2015.table)


# What is read is what is printed: two typed by hand


def test_equation_7_as_typed_by_hand() -> None:
    rho, L, H = (quantity.symbol for quantity in (sym.DENSITY, sym.HALF_LENGTH, sym.HALF_THICKNESS))
    stretch, rate = paper.STRETCH_EB.value.symbol, paper.STRETCH_EB.rate.symbol
    inertia = sp.Rational(8, 3) * rho * L**4 * H + sp.Rational(16, 3) * rho * L**2 * H**3 / stretch**6
    assert to_sympy(READ["7"].lhs) == sym.KINETIC_ENERGY.symbol
    assert sp.expand(to_sympy(READ["7"].rhs) - inertia * rate**2) == 0


def test_equation_10_as_typed_by_hand() -> None:
    mu, eta = sym.SHEAR_MODULUS_BETA.symbol, sym.VISCOSITY.symbol
    stretch, inelastic = paper.STRETCH_EB.value.symbol, paper.INELASTIC_STRETCH_EB.value.symbol
    assert to_sympy(READ["10"].lhs) == paper.INELASTIC_STRETCH_EB.rate.symbol
    expected = mu / (6 * eta) * (stretch**2 / inelastic - inelastic**5 / stretch**4)
    assert sp.expand(to_sympy(READ["10"].rhs) - expected) == 0


def test_printed_terms_of_a_side_are_literal() -> None:
    terms = printed_terms(READ["21"], "lhs")
    assert [term.sign for term in terms] == [1, -1, 1, -1, 1]
    assert terms[0].latex == r"\ddot{\lambda}_{PS}"
    assert terms[3].latex == r"-\frac{P}{4HL}\lambda_{PS}^{4}"
    assert terms[4].latex == r"+ \varepsilon E^{2}\lambda_{2p}^{2}\lambda_{PS}^{5}"


def test_square_bracket_of_equation_21_closes_where_it_is_printed() -> None:
    brackets = [part for _, part in walk(READ["21"]) if isinstance(part, Group) and part.bracket == "["]
    (bracket,) = brackets
    text = READ["21"].literal(bracket.span)
    assert text.startswith(r"\left[\mu^{\alpha}")
    assert text.endswith(r"\xi_{PS}^{2}\right)\right]")


# Laws of every stored equation


@pytest.mark.parametrize("number", NUMBERS)
@settings(max_examples=5, deadline=None)
@given(data=st.data())
def test_sympy_and_mpmath_agree_to_40_digits(number: str, data: st.DataObject) -> None:
    equation = READ[number]
    point = {
        symbol: sp.Rational(data.draw(st.integers(10**6, 10**7)), data.draw(st.integers(10**6, 10**7)))
        for symbol in _symbols(equation)
    }
    with mpmath.workdps(60):
        values = {symbol: mpmath.mpf(int(value.p)) / int(value.q) for symbol, value in point.items()}
        for side in (equation.lhs, equation.rhs):
            exact = to_sympy(side).xreplace(point)  # a rational number
            expected = mpmath.mpf(int(exact.p)) / int(exact.q)
            assert mpmath.almosteq(evaluate(side, values), expected, rel_eps=mpmath.mpf(10) ** -40)


@pytest.mark.parametrize("number", NUMBERS)
def test_written_and_read_again_it_is_the_same_tree(number: str) -> None:
    again = read_equation(to_latex(READ[number]), SHENG_2015.table, number=number)
    assert again == READ[number]


@pytest.mark.parametrize("number", NUMBERS)
def test_every_part_knows_its_place(number: str) -> None:
    """What stands at the span of a symbol reads as that symbol."""
    equation = READ[number]
    for _, part in walk(equation):
        if isinstance(part, Variable) and not part.differential:
            assert name_of(equation.latex[part.span.start : part.span.end]) == part.name


@pytest.mark.parametrize("number", [number for number in NUMBERS if number != "21"])
def test_units_hold(number: str) -> None:
    checked = check_printed(READ[number])
    assert len(checked) >= 3
    assert [str(term) for term in checked if not term.ok] == []


def test_unit_check_names_the_last_two_terms_of_equation_21() -> None:
    broken = [term for term in check_printed(READ["21"]) if not term.ok]
    last = printed_terms(READ["21"], "lhs")[-2:]
    assert [(term.latex, term.span) for term in broken] == [(term.latex, term.span) for term in last]
    assert str(broken[0]) == (
        r"Eq. (21): -\frac{P}{4HL}\lambda_{PS}^{4} has dimension kg m^-1 s^-2, where s^-2 is expected"
    )
