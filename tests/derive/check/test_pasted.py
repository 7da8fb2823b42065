"""Equations that a user pastes: against the paper's models and a described one, with symbols, and hostile ones."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange.derive.check.pasted.check import PastedEquation, check_equations, read_pasted
from delagrange.derive.check.pasted.file import read_equations, read_symbols
from delagrange.derive.check.pasted.listing import listed_equations, listed_symbols
from delagrange.derive.check.pasted.symbols import symbols_of_model
from delagrange.derive.check.record import recorded
from delagrange.derive.check.report import detail
from delagrange.derive.check.verdict import Outcome
from delagrange.derive.check.verify import verdict_on, witness
from delagrange.derive.equations.derived_equations import derived_equations
from delagrange.derive.equations.described import description_equations
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.model_file.toml_table import ModelError
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.edits import single_edits
from delagrange.derive.printed.latex import SymbolTable
from delagrange.derive.printed.values import evaluate_roughly

GENT = Path(__file__).parents[2] / "models" / "gent_two_branches.toml"
PAPER_MODELS = ("biaxial", "equal_biaxial", "uniaxial", "pure_shear_as_printed", "pure_shear_consistent")
RECORD = [
    entry for entry in recorded(SHENG_2015) if entry["model"] in PAPER_MODELS and entry["number"] != "22"
]

# The equation of motion of the two-branch Gent membrane by hand: per 16 H L^2, in symbols of its own
BY_HAND = r"""
\frac{\rho}{3} \left(L^2 + 2 H^2 x^{-6}\right) \ddot{x} - 2 \rho H^2 x^{-7} \dot{x}^2
+ \frac{G_0 J_0 (x - x^{-5})}{J_0 + 3 - 2 x^2 - x^{-4}} + G_1 (x \xi_1^{-2} - x^{-5} \xi_1^4)
+ \frac{G_2 J_2 (x \xi_2^{-2} - x^{-5} \xi_2^4)}{J_2 + 3 - 2 x^2 \xi_2^{-2} - x^{-4} \xi_2^4}
- \frac{P}{4HL} - \epsilon E^2 x^3 = 0
"""
SYMBOLS = {
    "x": "stretch", "G_0": "shear_modulus_alpha", "G_1": "shear_modulus_beta_1", "G_2": "shear_modulus_beta_2",
    "J_0": "locking_alpha", "J_2": "locking_beta_2",
}  # fmt: skip


# Each twice the one above: written out, the last would have half a million symbols
DOUBLING = {"a_0": {"latex": "L L"}} | {f"a_{n}": {"latex": f"a_{n - 1} a_{n - 1}"} for n in range(1, 10)}
DOUBLING |= {f"b_{n}": {"latex": f"b_{n - 1} b_{n - 1}" if n else "a_9 a_9"} for n in range(10)}


@functools.cache
def gent():
    return description_equations(read_model_file(GENT))


def verdict(model, latex, symbols=(), **options):
    (found,) = check_equations(model, [PastedEquation(latex, **options)], symbols)
    return found


# --- the paper's own equations by the new road -----------------------------------------------------


@pytest.mark.parametrize("entry", RECORD, ids=lambda entry: f"{entry['number']}-{entry['model']}")
def test_the_paper_pasted_gives_the_recorded_verdicts(entry, equations):
    found = verdict(equations(entry["model"]), SHENG_2015[entry["number"]].reading, number=entry["number"])
    assert (found.quantity, str(found.outcome)) == (entry["quantity"], entry["outcome"])
    for name in ("printed_unmatched", "derived_unmatched", "corrections"):
        assert list(getattr(found, name)) == entry.get(name, [])


def test_the_papers_symbols_may_be_renamed(equations):
    latex = SHENG_2015["9"].reading.replace(r"\lambda_{EB}", "x").replace(r"\mu^{\alpha}", r"\mu_{0}")
    for old, new in ((r"\ddot{\lambda}_{EB}", r"\ddot{x}"), (r"\dot{\lambda}_{EB}", r"\dot{x}")):
        latex = latex.replace(old, new)
    symbols = {"x": "stretch", r"\mu_{0}": "shear_modulus_alpha"}
    assert verdict(equations("equal_biaxial"), latex, symbols).outcome is Outcome.SCALED
    with pytest.raises(
        ValueError, match=r"column .*expected a symbol of the table .nearest.*; a table of symbols"
    ):
        verdict(equations("equal_biaxial"), latex)


def test_short_names_for_what_is_the_only_one(equations):
    rate = r"\dot{\xi} = \frac{\mu^\beta}{6\eta}(\lambda^2 \xi^{-1} - \lambda^{-4} \xi^5)"
    assert verdict(equations("equal_biaxial"), rate).outcome is Outcome.EQUAL
    energy = r"T = \frac{4}{3}\rho L^2 H (L^2 \dot\lambda_1^2 + L^2 \dot\lambda_2^2 + H^2 d^2)"
    law = r"\lambda_1^{-2}\lambda_2^{-1}\dot\lambda_1 + \lambda_1^{-1}\lambda_2^{-2}\dot\lambda_2"
    assert verdict(equations("uniaxial"), energy, {"d": {"latex": law}}).outcome is Outcome.EQUAL


# --- which equation is it? ---------------------------------------------------------------------------


def test_the_equation_of_motion_is_found_among_several(equations):
    mutated = SHENG_2015["14"].reading.replace(r"8HL^{2}\left[\mu^{\alpha}", r"8HL^{2}\left[2\mu^{\alpha}")
    found = verdict(equations("uniaxial"), mutated)
    assert (found.quantity, found.outcome) == ("equation_of_motion_2", Outcome.DIFFERS)
    assert "the nearest of equation of motion 1, equation of motion 2" in found.note
    assert all("α" in term for term in found.derived_unmatched)
    swapped = verdict(equations("uniaxial"), SHENG_2015["14"].reading, quantity="equation of motion 1")
    assert (swapped.quantity, swapped.outcome) == ("equation_of_motion_1", Outcome.DIFFERS)


def test_equations_of_motion_solved_for_one_acceleration(equations):
    """Both equations of motion, solved by hand at det = (a + b_1)(a + b_2) - c^2."""
    symbols = {
        "a": {"latex": r"\frac{L^2}{H^2}"},
        "c": {"latex": r"\lambda_1^{-3} \lambda_2^{-3}"},
        "b_1": {"latex": r"\lambda_1^{-4} \lambda_2^{-2}"},
        "b_2": {"latex": r"\lambda_1^{-2} \lambda_2^{-4}"},
        "s_1": {"latex": r"\mu^\alpha (\lambda_1 - \lambda_1^{-3} \lambda_2^{-2}) + \mu^\beta (\lambda_1 \xi_1^{-2}"
                r"- \lambda_1^{-3} \lambda_2^{-2} \xi_1^2 \xi_2^2)"
                r"- \frac{P}{4HL} - \varepsilon E^2 \lambda_1 \lambda_2^2"},
        "s_2": {"latex": r"\mu^\alpha (\lambda_2 - \lambda_1^{-2} \lambda_2^{-3}) + \mu^\beta (\lambda_2 \xi_2^{-2}"
                r"- \lambda_1^{-2} \lambda_2^{-3} \xi_1^2 \xi_2^2) - \varepsilon E^2 \lambda_1^2 \lambda_2"},
        "v": {"latex": r"\lambda_1^{-2} \dot\lambda_1^2 + \lambda_1^{-1} \lambda_2^{-1} \dot\lambda_1 \dot\lambda_2"
              r"+ \lambda_2^{-2} \dot\lambda_2^2"},
        "f_1": {"latex": r"2 \lambda_1^{-3} \lambda_2^{-2} v - \frac{3}{\rho H^2} s_1"},
        "f_2": {"latex": r"2 \lambda_1^{-2} \lambda_2^{-3} v - \frac{3}{\rho H^2} s_2"},
    }  # fmt: skip
    solved = r"\ddot\lambda_1 = \frac{(a + b_2) f_1 - c f_2}{(a + b_1) (a + b_2) - c^2}"
    found = verdict(equations("uniaxial"), solved, symbols)
    assert (found.quantity, found.outcome) == ("acceleration_1", Outcome.EQUAL)


def test_a_balance_at_rest_is_found_by_its_force(equations):
    balance = (
        r"\frac{P}{4HL} = \mu^\alpha(\lambda - \lambda^{-5}) + \mu^\beta(\lambda \xi^{-2} - \lambda^{-5} \xi^4)"
        r" - \varepsilon E^2 \lambda^3"
    )
    found = verdict(equations("equal_biaxial"), balance)
    assert (found.quantity, found.outcome) == ("static_balance_1", Outcome.SCALED)
    wrong = verdict(equations("equal_biaxial"), balance.replace("4HL", "2HL"))
    assert wrong.corrections[0] == r"coefficient: \frac{P}{2 H L} -> \frac{P}{4 H L}"


@pytest.mark.parametrize("latex", ["1 = 1", r"\lambda = \xi", "E = 2"])
def test_what_states_nothing_is_refused_with_what_there_is(latex, equations):
    with pytest.raises(
        ValueError, match=r"equal_biaxial has an equation for; .*T \(kinetic_energy\)"
    ) as refused:
        verdict(equations("equal_biaxial"), latex)
    assert "\n" not in str(refused.value)


def test_an_unknown_quantity_is_refused_with_the_nearest(equations):
    with pytest.raises(ValueError, match="did you mean 'kinetic_energy'"):
        verdict(equations("equal_biaxial"), "T = 1", quantity="kinetic_enrgy")


# --- a described model -----------------------------------------------------------------------------------


def test_a_described_model_is_checked_by_an_equation_written_by_hand():
    found = verdict(gent(), BY_HAND, SYMBOLS)
    assert (found.outcome, found.factor_text) == (Outcome.SCALED, "1 / (16 H L²)")
    assert "printed = derived x 1 / (16 H L²)" in detail(found)


@pytest.mark.parametrize(
    ("old", "new", "derived", "printed"),
    [
        (r"- \frac{P}{4HL}", r"- \frac{P}{2HL}", "-P / (4 H L)", r"- \frac{P}{2HL}"),
        (r"- \epsilon E^2 x^3", r"+ \epsilon E^2 x^3", "-E² ε λ³", r"+ \epsilon E^2 x^3"),
        (r"- x^{-5} \xi_1^4", r"- x^{-5} \xi_1^3", "-μ^β_1 ξ_1⁴ / λ⁵", r"- x^{-5} \xi_1^3"),
        (r"- 2 \rho H^2", r"- 4 \rho H^2", "-2 H² λ̇² ρ / λ⁷", r"- 4 \rho H^2 x^{-7} \dot{x}^2"),
    ],
)
def test_a_slip_is_reported_with_its_term_and_its_correction(old, new, derived, printed):
    assert BY_HAND.count(old) == 1
    found = verdict(gent(), BY_HAND.replace(old, new), SYMBOLS)
    assert (found.outcome, found.derived_unmatched, found.printed_unmatched) == (
        Outcome.DIFFERS, (derived,), (printed,),
    )  # fmt: skip
    assert found.corrections


def test_a_wrong_locking_term_is_the_only_one_without_partner():
    found = verdict(gent(), BY_HAND.replace("{J_0 + 3", "{J_0 + 2"), SYMBOLS)
    (printed,) = found.printed_unmatched
    assert printed.startswith(r"+ \frac{G_0 J_0") and all("J^α" in term for term in found.derived_unmatched)


@functools.cache
def _listed():
    return {equation.quantity: equation.latex for equation in listed_equations(gent())}


def test_derived_equations_printed_read_back_as_equal():
    assert set(_listed()) == set(derived_equations(gent()))
    for quantity, latex in _listed().items():
        found = verdict(gent(), latex)
        assert (found.quantity, found.outcome) == (quantity, Outcome.EQUAL)


@pytest.mark.parametrize(
    "quantity", ["kinetic_energy", "dashpot_rate_1", "dashpot_rate_2", "static_balance_1"]
)
def test_every_mutation_of_one_place_differs(quantity):
    """Sign, coefficient and exponent; those that leave the mathematics as it was are told by numbers."""
    equation = derived_equations(gent())[quantity]
    subject = witness(equation)
    tree = read_pasted(PastedEquation(_listed()[quantity]), symbols_of_model(gent()), "1")
    edits = [edit for edit in single_edits(tree) if edit.kind in ("sign", "coefficient", "exponent")]
    assert len(edits) > 20
    for edit in edits:
        found = verdict_on(edit.equation, subject, explained=False)
        harmless = _same_law(tree, edit.equation, equation.unknown.symbol, subject.points[1])
        assert found.agrees is harmless, edit


def _same_law(one, other, unknown, point) -> bool:
    """Whether two equations are multiples of each other at a point, whatever they state: in double precision."""

    def residuals(tree):
        at = {symbol: float(value) for symbol, value in point.items()}
        values = ({**at, unknown: x} for x in (0.0, 1.0, 3.0))
        return np.array([evaluate_roughly(tree.lhs, v) - evaluate_roughly(tree.rhs, v) for v in values])

    first, second = residuals(one), residuals(other)
    return np.allclose(first * second[1], second * first[1], rtol=1e-9, atol=0.0)


@pytest.mark.parametrize(
    "factor", [r"\rho", "L^{2}", r"\frac{3}{\lambda}", "7 H", r"\frac{\eta_1}{\mu_1^\beta}", "-1"]
)
def test_scaling_by_any_monomial_keeps_the_verdict(factor):
    left, right = _listed()["dashpot_rate_1"].split(" = ")
    latex = rf"\left( {factor} \right) \left( {left} \right) = \left( {factor} \right) \left( {right} \right)"
    assert verdict(gent(), latex).outcome is Outcome.SCALED


def test_every_default_symbol_reads_as_its_quantity():
    table = symbols_of_model(gent()).table
    for each in listed_symbols(gent()):
        named = SymbolTable.of({each.latex: each.quantity}) if r"\d" not in each.latex else table
        assert all(table[name] == each.quantity for name in named.entries if str(name) == each.latex)
    assert len({each.latex for each in listed_symbols(gent())}) == len(listed_symbols(gent()))


def test_a_charge_balance_is_found_by_the_rate_of_the_charge(tmp_path):
    leaking = 'permittivity = "61.98 pF/m"\ncontrol = "charge"\nconductivity = "1e-12 S/m"'
    text = GENT.read_text(encoding="utf-8").replace('permittivity = "61.98 pF/m"', leaking)
    path = tmp_path / "leaking.toml"
    path.write_text(text, encoding="utf-8")
    eom = description_equations(read_model_file(path))
    found = verdict(eom, r"\frac{dD}{dt} = j - \frac{\sigma}{\epsilon} D")
    assert (found.quantity, found.outcome) == ("charge_rate", Outcome.EQUAL)
    assert verdict(eom, r"\dot{D} = j + \frac{\sigma}{\epsilon} D").outcome is Outcome.DIFFERS


# --- symbols and abbreviations ---------------------------------------------------------------------------


def test_abbreviations_are_written_out_where_they_stand():
    symbols = SYMBOLS | {
        "h": {"latex": r"\frac{H}{L}"},
        "m": {"latex": r"\frac{\rho L^2}{3} (1 + 2 h^2 x^{-6})"},
    }
    latex = BY_HAND.replace(r"\frac{\rho}{3} \left(L^2 + 2 H^2 x^{-6}\right)", "m")
    assert verdict(gent(), latex, symbols).outcome is Outcome.SCALED
    wrong = verdict(gent(), latex, symbols | {"h": {"latex": r"\frac{L}{H}"}})
    assert wrong.outcome is Outcome.DIFFERS and wrong.printed_unmatched == (r"m \ddot{x}",)


@pytest.mark.parametrize(
    ("symbols", "reason"),
    [
        ({"x": "strech"}, r"symbol x stands for 'strech', no quantity of gent_two_branches \(did you mean 'stretch'"),
        ({"x + y": "stretch"}, "is not one symbol"),
        ({"": "stretch"}, "is not one symbol"),
        ({"x" * 5000: "stretch"}, "is not one symbol: it has 5000 characters"),
        ({"x": 3}, "must stand for the name of a quantity or"),
        ({"x": {"tex": "1"}}, "must stand for the name of a quantity or"),
        ({r"\dot{x}": "stretch"}, "give the symbol without dots"),
        ({r"x_{0}": "stretch", "x_0": "density"}, "stands twice"),
        ({"c": {"latex": "c"}}, "abbreviation c: .*expected a symbol of the table"),
        ({"c": {"latex": "1 = 1"}}, "abbreviation c: .*found '='"),
        (DOUBLING, "symbols, numbers and operations"),
    ],
)  # fmt: skip
def test_a_table_of_symbols_that_is_not_understood_is_refused_in_one_line(symbols, reason):
    with pytest.raises(ValueError, match=reason) as refused:
        verdict(gent(), "T = 1", symbols)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 1000


# --- hostile text ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("latex", "reason"),
    [
        ("T = " + "(" * 5000, "levels of brackets"),
        ("T = " + "{" * 5000, "levels of brackets"),
        (r"T = \frac{1}{" * 2000, "no more than 10000 characters"),
        ("T = " + "1" * 5000, "30 digits"),
        ("T = 9^{9^{9^9}}", "an exponent of no more than 64"),
        ("T = L^{1000000}", "an exponent of no more than 64"),
        ("T = (L + H)^{60}", "an exponent of a sum"),
        ("T = ((((L^{60})^{60})^{60})^{60})", "powers of no more than"),
        ("T = " + "(L + H + E)" * 20, "terms with brackets multiplied out"),
        (r"T = \exp(\exp(\exp(\exp(L))))", "functions or exponents in one another"),
        (r"T = L^{L^{L^{L}}}", "functions or exponents in one another"),
        ("T = " + "+ L H" * 1000, "symbols, numbers and operations"),
        ("__import__('os').system('true') = 1", "found '_'"),
        (r"\input{/etc/passwd} = T", "found"),
    ],
)
def test_what_no_print_has_is_refused_at_once(latex, reason):
    with pytest.raises(ValueError, match=reason) as refused:
        verdict(gent(), latex)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 1000


PIECES = [
    "T", "=", "+", "-", "(", ")", "{", "}", "^", "_", r"\lambda", r"\dot", r"\frac", "2", "L", r"\ln", r"\left(",
    r"\right)", "$", "d", "t", r"\mathrm", ",", r"\xi_1", "/", r"\tag", "0", " ",
]  # fmt: skip


@given(st.one_of(st.text(max_size=40), st.lists(st.sampled_from(PIECES), max_size=20).map(" ".join)))
def test_any_text_is_read_or_refused(latex):
    try:
        found = verdict(gent(), latex)
    except ValueError as refused:
        assert "\n" not in str(refused)
    else:
        assert found.outcome in Outcome


# --- files ------------------------------------------------------------------------------------------------


def test_a_file_of_equations_and_symbols(tmp_path):
    path = tmp_path / "equations.toml"
    lines = "\n".join(f"'{latex}' = '{meaning}'" for latex, meaning in SYMBOLS.items())
    path.write_text(f"""citation = "by hand"
[[equation]]
number = "7"
latex = '''{BY_HAND}'''
note = "as written"
[[equation]]
latex = 'T = 0 \\tag{{8}}'
quantity = "kinetic_energy"
[symbols]
{lines}
""", encoding="utf-8")  # fmt: skip
    found = read_equations(path)
    motion, energy = check_equations(gent(), found.equations, found.symbols)
    assert (motion.number, motion.outcome, motion.note) == ("7", Outcome.SCALED, "as written")
    assert (energy.number, energy.outcome) == ("8", Outcome.DIFFERS)
    assert read_symbols(path) == found.symbols


def test_a_text_file_holds_one_equation_a_line(tmp_path):
    path = tmp_path / "equations.txt"
    path.write_text(f"# energies\n\n{_listed()['kinetic_energy']}\nT = x\n", encoding="utf-8")
    good, bad = read_equations(path).equations
    assert verdict(gent(), good.latex).outcome is Outcome.EQUAL
    with pytest.raises(ValueError, match=f"^{path}, line 4: Eq. .1., line 1, column 5: found 'x'"):
        check_equations(gent(), [bad])


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "holds 0 equations"),
        ("[[equation]]\nlatx = 'T = 1'\n", "line 2: unknown key 'latx'.*did you mean 'latex'"),
        ("[[equation]]\nnumber = '1'\n", "line 1: .*needs a value of latex"),
        ("[[equation]]\nlatex = 3\n", "line 2: latex must be a text"),
        ("equation = 3\n", "must be tables"),
        ("[symbols]\n'x' = 3\n[[equation]]\nlatex = 'T'\n", "line 2: symbol 'x' must stand for"),
        ("[[equation\n", "not understood as TOML"),
        ("[[equation]]\nlatex = 'T = 1'\n" * 201, "holds 201 equations; allowed are 1 to 200"),
    ],
)
def test_a_file_that_is_not_understood_is_refused_with_its_line(tmp_path, text, reason):
    path = tmp_path / "equations.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=reason):
        read_equations(path)


def test_an_unknown_meaning_is_refused_with_file_and_line(tmp_path):
    path = tmp_path / "symbols.toml"
    path.write_text('[symbols]\n# of the paper\n"\\\\mu_{0}" = "shear_modulus"\n', encoding="utf-8")
    with pytest.raises(
        ValueError, match=rf"^{path}, line 3: symbol .mu_.0. stands for 'shear_modulus'.*did you mean"
    ):
        verdict(gent(), "T = 1", read_symbols(path))
    path.write_text("[[equation]]\nlatex = 'T = 1'\n", encoding="utf-8")
    with pytest.raises(ModelError, match=r"needs a table \[symbols\]"):
        read_symbols(path)
    with pytest.raises(ModelError, match="cannot be read"):
        read_symbols(tmp_path)
