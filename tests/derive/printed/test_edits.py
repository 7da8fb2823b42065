"""Edits: each changes one thing in one place, all of them change the mathematics, in a fixed order."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter

import mpmath
import pytest

from delagrange.derive.notation import symbols as sym
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.edits import Edit, partners, single_edits
from delagrange.derive.printed.latex import Equation, SymbolTable, evaluate, read_equation, to_latex
from delagrange.derive.printed.symbol_table import name_of
from delagrange.derive.printed.tree import Power, Variable, walk

NUMBERS = tuple(printed.number for printed in SHENG_2015.readable)
KINDS = ("coefficient", "sign", "exponent", "index", "bracket")
TABLE = SymbolTable.of(
    {
        r"\lambda_1": sym.STRETCH_1,
        r"\lambda_2": sym.STRETCH_2,
        r"\xi_1": sym.INELASTIC_STRETCH_1,
        r"\xi_2": sym.INELASTIC_STRETCH_2,
        r"\mu^{\alpha}": sym.SHEAR_MODULUS_ALPHA,
        r"\mu^{\beta}": sym.SHEAR_MODULUS_BETA,
        "L": sym.HALF_LENGTH,
        "H": sym.HALF_THICKNESS,
    }
)


def _edits(latex: str, kind: str, *, wide: bool = False) -> list[str]:
    """What the edits of one kind make of an equation, spaces dropped."""
    equation = read_equation(latex, TABLE, number="1")
    found = [edit for edit in single_edits(equation, wide=wide) if edit.kind == kind]
    return [_plain(edit.equation) for edit in found]


def _plain(equation: Equation) -> str:
    text = to_latex(equation)
    for spelled in (" ", "{", "}", r"\left", r"\right"):
        text = text.replace(spelled, "")
    return text


def _values() -> dict:
    """A point at which no two symbols and no two monomials are alike."""
    with mpmath.workdps(40):
        return {
            quantity.symbol: 1 + mpmath.frac(mpmath.sqrt(7 * index + 3)) / 3
            for index, quantity in enumerate(SHENG_2015.table.entries.values())
        }


def _residual(equation: Equation, values: dict) -> mpmath.mpf:
    return evaluate(equation.lhs, values) - evaluate(equation.rhs, values)


# What each kind does


def test_coefficients() -> None:
    assert _edits("L = 3 H", "coefficient") == [
        "L=4H", "L=2H", "L=6H", r"L=\frac32H", "2L=3H", r"\frac12L=3H",
    ]  # fmt: skip


def test_coefficient_is_inserted_where_a_term_prints_none() -> None:
    found = _edits(r"\frac{L}{2H}(\lambda_1 + 3) = 0", "coefficient")
    assert r"\fracL2H(2\lambda_1+3)=0" in found
    assert r"2\fracL2H(\lambda_1+3)=0" not in found


def test_a_printed_zero_has_no_coefficient_and_no_sign() -> None:
    assert all(found.endswith("=0") for kind in ("coefficient", "sign") for found in _edits("L = 0", kind))


def test_signs() -> None:
    assert _edits("L = - H + (L - H)", "sign") == [
        "-L=-H+(L-H)", "L=H+(L-H)", "L=-H-(L-H)", "L=-H+(-L-H)", "L=-H+(L+H)",
    ]  # fmt: skip


def test_exponents() -> None:
    assert _edits("L^2 = H", "exponent") == ["L^3=H", "L^1=H", "L^-2=H", "L^2=H^2"]
    assert _edits("L^{-1} = 0", "exponent") == ["L^0=0", "L^-2=0", "L^1=0"]
    wide = _edits("L = 2", "exponent", wide=True)
    assert len(wide) == len(set(wide)) == 16
    assert {"L^-8=2", "L^0=2", "L^8=2"} <= set(wide)


def test_exponent_of_brackets() -> None:
    assert _edits("2(1 - 3) = 0", "exponent") == ["2(1-3)^2=0"]


def test_indices() -> None:
    assert _edits(r"\lambda_1 = \mu^{\alpha}", "index") == [
        r"\lambda_2=\mu^\alpha", r"\xi_1=\mu^\alpha", r"\lambda_1=\mu^\beta",
    ]  # fmt: skip
    assert _edits(r"\dot{\xi}_2 = 1", "index") == [r"\dot\xi_1=1", r"\dot\lambda_2=1"]
    assert _edits(r"\frac{d\xi_2}{dt} = 1", "index") == [
        r"\frac\mathrmd\xi_1\mathrmdt=1", r"\frac\mathrmd\lambda_2\mathrmdt=1",
    ]  # fmt: skip


def test_wide_indices_are_the_other_symbols_of_the_unit_in_the_equation() -> None:
    assert _edits(r"L = H\lambda_1", "index") == [r"L=H\lambda_2", r"L=H\xi_1"]
    assert _edits(r"L = H\lambda_1", "index", wide=True) == [
        r"H=H\lambda_1", r"L=L\lambda_1", r"L=H\lambda_2", r"L=H\xi_1",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("key", "expected"),
    [
        (r"\lambda_{UA1}", [r"\lambda_{UA2}", r"\xi_{UA1}"]), (r"\dot{\lambda}_{EB}", [r"\dot{\xi}_{EB}"]),
        (r"\mu^{\alpha}", [r"\mu^{\beta}"]), ("P_1", ["P_{2}"]), ("P_{2p}", ["P"]), ("P", ["P_{2p}"]),
        (r"\lambda_{2p}", [r"\lambda_{PS}"]), (r"\rho", []), ("H", ["L"]),
    ],
)  # fmt: skip
def test_partners_in_the_table_of_the_paper(key: str, expected: list[str]) -> None:
    assert [str(name) for name in partners(name_of(key), SHENG_2015.table)] == expected


def test_bracket_closes_earlier() -> None:
    assert _edits("2(L - H + 1)H = 0", "bracket") == ["2(L)-H+1H=0", "2(L-H)+1H=0"]


def test_bracket_closes_later() -> None:
    assert _edits("2[L]^2 H - H + 1 = 0", "bracket") == ["2[LH-H]^2+1=0", "2[LH-H+1]^2=0"]


def test_bracket_inside_of_a_fraction() -> None:
    assert _edits(r"\frac{2}{L(1 + H)} = 0", "bracket") == [r"\frac2L(1)+H=0"]


def test_bracket_of_a_function_stays() -> None:
    assert _edits(r"\ln(L + H) + 1 = 0", "bracket") == []


def test_square_bracket_of_equation_21_is_moved_to_the_end() -> None:
    """Read so, the equation has one unit: the correction that is looked for is among the edits."""
    last = r"+ \varepsilon E^{2} \lambda_{2p}^{2} \lambda_{PS}^{5} \right]"
    found = [edit for edit in single_edits(SHENG_2015.read("21")) if edit.after.endswith(last)]
    (edit,) = found
    assert edit.kind == "bracket"
    assert edit.before.startswith(r"\frac{3}{\rho H^{2}")
    assert to_latex(edit.equation) == to_latex(SHENG_2015.read("21")).replace(edit.before, edit.after)


def test_prefactor_of_equation_16_is_halved_by_an_edit() -> None:
    shown = [str(edit) for edit in single_edits(SHENG_2015.read("16")) if edit.kind == "coefficient"]
    assert r"coefficient: \frac{\mu^{\beta}}{3 \eta} -> \frac{\mu^{\beta}}{6 \eta}" in shown


# Laws of all edits of the paper's equations


def test_count_of_edits() -> None:
    counts = Counter(edit.kind for number in NUMBERS for edit in single_edits(SHENG_2015.read(number)))
    assert tuple(counts) == KINDS
    assert counts.total() == 2279


@pytest.mark.parametrize("number", NUMBERS)
def test_each_edit_changes_the_mathematics_and_is_what_it_prints(number: str) -> None:
    """Lost edits would make mutation tests pass for nothing: each moves the residual at a point."""
    equation, values = SHENG_2015.read(number), _values()
    with mpmath.workdps(40):
        unedited = _residual(equation, values)
        for edit in single_edits(equation):
            changed = _residual(edit.equation, values)
            assert abs(changed - unedited) > 1e-9 * abs(unedited), str(edit)
            again = read_equation(to_latex(edit.equation), SHENG_2015.table, number=number)
            assert mpmath.almosteq(_residual(again, values), changed, rel_eps=1e-30, abs_eps=1e-30), str(edit)


@pytest.mark.parametrize("number", NUMBERS)
def test_no_edit_comes_twice_and_each_has_its_place(number: str) -> None:
    equation = SHENG_2015.read(number)
    edits = tuple(single_edits(equation))
    assert len({to_latex(edit.equation) for edit in edits}) == len(edits)
    for edit in edits:
        assert edit.before != edit.after
        assert equation.literal(edit.span)
        assert edit.equation.latex == equation.latex


def test_wide_edits_contain_the_narrow_ones() -> None:
    equation = SHENG_2015.read("9")
    narrow = {to_latex(edit.equation) for edit in single_edits(equation)}
    wide = [to_latex(edit.equation) for edit in single_edits(equation, wide=True)]
    assert narrow < set(wide)
    assert len(set(wide)) == len(wide)


def test_span_is_that_of_what_changes() -> None:
    equation = SHENG_2015.read("10")
    for edit in single_edits(equation):
        if edit.kind == "index":
            assert equation.literal(edit.span) in _literal_variables(equation)


def _literal_variables(equation: Equation) -> list[str]:
    return [equation.literal(part.span) for _, part in walk(equation) if isinstance(part, Variable)]


def test_edit_leaves_the_rest_alone() -> None:
    equation = SHENG_2015.read("7")
    (edit,) = [edit for edit in single_edits(equation) if _raises_length_to_the_fifth(edit)]
    assert edit.equation.lhs == equation.lhs
    assert edit.equation.rhs.terms[1:] == equation.rhs.terms[1:]


def _raises_length_to_the_fifth(edit: Edit) -> bool:
    powers = (part for _, part in walk(edit.equation) if isinstance(part, Power))
    return any(to_latex(power) == "L^{5}" for power in powers)


def test_order_does_not_depend_on_the_hash_seed() -> None:
    program = (
        "from delagrange.derive.printed.edits import single_edits\n"
        "from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015\n"
        "for edit in single_edits(SHENG_2015.read('15'), wide=True): print(edit)\n"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", program], env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True, check=True,
        ).stdout
        for seed in ("1", "2")
    ]  # fmt: skip
    assert outputs[0] == outputs[1] != b""
