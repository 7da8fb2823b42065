"""The reader: what it reads, in which notations, and where it refuses."""

from __future__ import annotations

from fractions import Fraction
from math import prod

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from delagrange.derive.notation import symbols as sym
from delagrange.derive.papers.sheng_2015 import symbols as paper
from delagrange.derive.printed.latex import (
    Equation,
    LatexError,
    SymbolTable,
    check_printed,
    evaluate,
    printed_terms,
    read_equation,
    to_latex,
    to_sympy,
)
from delagrange.derive.printed.symbol_table import name_of
from delagrange.derive.printed.tree import Group, Node, Number, Power, Quotient, Sum, Variable

TABLE = SymbolTable.of(
    {
        "E": sym.FIELD,
        "L": sym.HALF_LENGTH,
        "H": sym.HALF_THICKNESS,
        r"\mu^{\alpha}": sym.SHEAR_MODULUS_ALPHA,
        r"\mu^{\beta}": sym.SHEAR_MODULUS_BETA,
        r"\eta": sym.VISCOSITY,
        r"\lambda_{UA1}": paper.STRETCH_UA1,
        r"\xi_{EB}": paper.INELASTIC_STRETCH_EB,
    }
)
L, H = sym.HALF_LENGTH.symbol, sym.HALF_THICKNESS.symbol
mu_alpha, mu_beta = sym.SHEAR_MODULUS_ALPHA.symbol, sym.SHEAR_MODULUS_BETA.symbol
stretch, rate, acceleration = (
    paper.STRETCH_UA1.value.symbol,
    paper.STRETCH_UA1.rate.symbol,
    paper.STRETCH_UA1.acceleration.symbol,
)
inelastic_rate = paper.INELASTIC_STRETCH_EB.rate.symbol


def _read(latex: str) -> Equation:
    return read_equation(latex, TABLE, number="9")


def _side(latex: str) -> Node:
    return _read(f"{latex} = 0").lhs


def _value(latex: str) -> sp.Expr:
    return to_sympy(_side(latex))


# What is read


@pytest.mark.parametrize(
    "latex",
    [
        r"\lambda_{UA1}", r"\lambda_{\mathrm{UA1}}", r"\lambda_{\text{UA}1}", r"\lambda_{\rm UA1}",
        r"\lambda_{\mathrm{UA}1}", r"\lambda_{{\rm UA} 1}", r"{\lambda_{UA1}}", r"\lambda _ { U A 1 }",
        r"\lambda_{\operatorname{UA}1}",
    ],
)  # fmt: skip
def test_subscripts_in_any_type_are_one_symbol(latex: str) -> None:
    assert _value(latex) == stretch


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        (r"\dot{\lambda}_{UA1}", rate), (r"\dot\lambda_{UA1}", rate), (r"\dot{\lambda_{UA1}}", rate),
        (r"\ddot{\lambda}_{\text{UA1}}", acceleration), (r"\dot{\lambda}_{UA1}^2", rate**2),
        (r"\frac{\mathrm{d}\xi_{EB}}{\mathrm{d}t}", inelastic_rate),
        (r"\frac{d\xi_{\rm EB}}{dt}", inelastic_rate), (r"\frac{{\rm d}\xi_{EB}}{{\rm d}t}", inelastic_rate),
        (r"\frac{\mathrm d\xi_{EB}}{\mathrm d t}", inelastic_rate),
        (r"\dfrac{\text{d}\lambda_{UA1}}{\text{d}t}", rate),
        (r"\frac{d^2\lambda_{UA1}}{dt^2}", acceleration),
        (r"\frac{d^{2}\lambda_{UA1}}{dt^{2}}", acceleration),
        (r"\frac{d\dot{\lambda}_{UA1}}{dt}", acceleration),
    ],
)  # fmt: skip
def test_rates_of_change(latex: str, expected: sp.Expr) -> None:
    assert _value(latex) == expected


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        (r"\mu^{\alpha}", mu_alpha), (r"\mu^\alpha", mu_alpha), (r"\mu^{\rm \alpha}", mu_alpha),
        (r"\mu^\beta L^2", mu_beta * L**2), (r"{\mu^\beta}^2", mu_beta**2),
        (r"(\mu^\beta)^{-2}", mu_beta**-2),
    ],
)  # fmt: skip
def test_superscript_label_is_part_of_the_name(latex: str, expected: sp.Expr) -> None:
    assert _value(latex) == expected


@pytest.mark.parametrize(
    "latex", [r"\mu_1^{\alpha}", r"\mu^{\alpha}_1", r"\mu^\alpha_{1}", r"\mu_{\rm 1}^\alpha"]
)
def test_label_and_index_in_either_order(latex: str) -> None:
    table = SymbolTable.of({r"\mu^{\alpha}_1": sym.SHEAR_MODULUS_ALPHA})
    assert to_sympy(read_equation(f"{latex} = 0", table, number="1").lhs) == mu_alpha


def test_superscript_that_is_no_label_is_an_exponent() -> None:
    assert _value("L^{H}") == L**H
    assert _value("L^H") == L**H
    assert _value(r"\lambda^{2}_{UA1}") == stretch**2


@pytest.mark.parametrize(
    ("latex", "expected"),
    [
        ("8HL^{2}", 8 * H * L**2), ("8HL^2", 8 * H * L**2), ("L^{-2}", L**-2), ("L^{+2}", L**2),
        (r"L^{\frac{1}{2}}", sp.sqrt(L)), ("0.5 L", L / 2), ("1.25", sp.Rational(5, 4)), ("- L + H", H - L),
        (r"2 \times 3 L", 6 * L), (r"L \cdot 2 H", 2 * L * H), (r"\tfrac{8}{3}L", sp.Rational(8, 3) * L),
        (r"\left( L + H \right)^2", (L + H) ** 2), (r"\{L - [H - (L)]\}", 2 * L - H),
        (r"\left\{ L \right\}", L), (r"\big[ L \big]", L), (r"L \,\; \quad ~ & H", L * H),
        (r"\sqrt{L + H}", sp.sqrt(L + H)), (r"\sqrt{2}^3", sp.sqrt(8)), (r"\ln(L)", sp.log(L)),
        (r"2\ln(\lambda_{UA1}^2)", 2 * sp.log(stretch**2)), (r"\exp\left(-L\right) H", sp.exp(-L) * H),
        (r"\sin L + \cos(H)\tanh(L)", sp.sin(L) + sp.cos(H) * sp.tanh(L)), ("2^{3}L", 8 * L),
        ("L − H", L - H), (r"\left(\ln(L)\right)^{2}", sp.log(L) ** 2), (r"\ln L - H", sp.log(L) - H),
        (r"2 \times {3} L", 6 * L), (r"{2}L", 2 * L),
        (r"\frac{L}{H}\frac{H}{L}", sp.Integer(1)),
    ],
)  # fmt: skip
def test_expressions(latex: str, expected: sp.Expr) -> None:
    assert sp.expand(_value(latex) - expected) == 0


def test_numbers_are_exact() -> None:
    assert _side("0.1 L").factors[0] == Number(Fraction(1, 10), None)


@pytest.mark.parametrize(
    "ending", ["", ".", ",", " .", r", \tag{9}", r"\tag{9}.", r".\tag{9}", r" \quad \tag{9}", r"\\"]
)
def test_ending(ending: str) -> None:
    assert to_sympy(_read(rf"L = 2H{ending}").rhs) == 2 * H


@pytest.mark.parametrize(
    "latex", ["$$L = 2H$$", "$L = 2H$", "$$L$$\n\n$$= 2$$\n$$H.$$", "$$\nL \\\\\n= 2H,\n$$"]
)
def test_blocks_are_joined(latex: str) -> None:
    assert to_sympy(_read(latex).rhs) == 2 * H


def test_tree_keeps_what_is_printed() -> None:
    """Brackets, order, unreduced fractions: all as on the page, with their places."""
    latex = r"\frac{2}{4}(H - L)^{2} + 0"
    tree = _side(latex)
    assert isinstance(tree, Sum)
    half, power = tree.terms[0].node.factors
    assert isinstance(half, Quotient) and half.denominator == Number(Fraction(4), None)
    assert isinstance(power, Power) and isinstance(power.base, Group)
    assert latex[slice(*half.span)] == r"\frac{2}{4}"
    assert latex[slice(*power.span)] == "(H - L)^{2}"
    assert latex[slice(*power.base.span)] == "(H - L)"
    assert latex[slice(*tree.terms[1].span)] == "+ 0"


def test_places_count_from_the_stored_text() -> None:
    equation = _read("$$L$$\n$$- \\eta$$ $$= 0$$")
    lone, term = printed_terms(equation, "lhs")
    assert (lone.latex, lone.span.start) == ("L", 2)
    assert (term.latex, term.sign) == (r"- \eta", -1)


# Where it refuses, with the place


@pytest.mark.parametrize(
    ("latex", "position", "found", "expected"),
    [
        ("", 0, "the end", "a number, a symbol"),
        ("   ", 3, "the end", "a number, a symbol"),
        ("$$$$", 4, "the end", "a number, a symbol"),
        ("L", 1, "the end", "="),
        ("L = ", 4, "the end", "a number, a symbol"),
        ("L = H = 0", 6, "=", "the end"),
        ("L = n", 4, "n", r"a symbol of the table (nearest: E, L, H, \mu^{\alpha}"),
        (r"L = \lambda_{UA2}", 4, r"\lambda_{UA2}", r"nearest: \lambda_{UA1}"),
        (r"L = \lambda", 4, r"\lambda", r"nearest: \lambda_{UA1}"),
        (r"L = \mu^{\gamma}", 4, r"\mu^{\gamma}", r"nearest: \mu^{\alpha}, \mu^{\beta}"),
        (r"L = \mu", 4, r"\mu", r"\mu^{\alpha}"),
        (r"L = \mu^2", 4, r"\mu^2", r"\mu^{\alpha}"),
        (r"L = \dot{L}", 4, r"\dot{L}", "a symbol of the table"),
        (r"L = \frac{dL}{dt}", 11, "L", "a quantity that depends on time"),
        (r"L = \frac{dn}{dt}", 11, "n", "a symbol of the table"),
        (r"L = \frac{d\lambda_{UA1}^2}{dt}", 25, "2", "one symbol without exponent"),
        (r"L = \frac{d L H}{dt}", 14, "H", "one symbol without exponent"),
        (r"L = \frac{d^2\lambda_{UA1}}{dt}", 30, "}", "^"),
        (r"L = \frac{d\lambda_{UA1}}{dt^2}", 28, "^", "}"),
        (r"L = \frac{L}", 12, "the end", "{"),
        (r"L = \frac12", 9, "12", "{"),
        (r"L = \frac{L}{H", 14, "the end", "}"),
        (r"L = \frac{}{H}", 10, "}", "a number, a symbol"),
        (r"L = (H", 6, "the end", ")"),
        (r"L = H)", 5, ")", "the end"),
        (r"L = (H]", 6, "]", ")"),
        (r"L = \left(H)", 11, ")", r"\right)"),
        (r"L = (H\right)", 6, r"\right", ")"),
        (r"L = \left[H\right)", 11, r"\right", r"\right]"),
        (r"L = \left.H\right.", 9, ".", r"one of ( [ \{"),
        ("L = (1, 2)", 6, ",", ")"),
        ("L = H}", 5, "}", "the end"),
        ("L = {H", 6, "the end", "}"),
        ("L = {H + L}", 7, "+", "braces around more do not show"),
        ("L = {H^2}^3", 8, "}", "braces around more do not show"),
        ("L = H^{2", 6, "{", "braces that close"),
        ("L = H^{}", 7, "}", "a number, a symbol"),
        ("L = H^23", 6, "23", "one letter or digit, or braces"),
        ("L = H^-1", 6, "-", "one letter or digit, or braces"),
        ("L = H^2^3", 7, "^", "no second superscript"),
        ("L = H_1_2", 7, "_", "no second subscript"),
        ("L = H_{1+1}", 6, "{", "a subscript of letters and digits"),
        ("L = H_", 6, "the end", "a subscript"),
        (r"L = \frac{L}{H}^2", 15, "^", "brackets around what is raised"),
        (r"L = \ln H \lambda_{UA1}", 10, r"\lambda", "brackets around the argument"),
        (r"L = \sin^2 H", 8, "^", "a number, a symbol"),
        (r"L = \ln^{2}(H)", 7, "^", "a number, a symbol"),
        (r"L = \ln(H)^{2}", 7, "(H)^{2}", "brackets that show what is raised"),
        (r"L = \exp\left(H\right)^2", 8, r"\left(H\right)^2", "brackets that show what is raised"),
        (r"L = \sin H^2", 9, "H^2", "brackets that show what is raised"),
        (r"L = \ln {H}^2", 9, "H}^2", "brackets that show what is raised"),
        (r"L = \ln 2^3", 8, "2^3", "brackets that show what is raised"),
        (r"L = \sqrt[3]{H}", 9, "[", "{"),
        ("L = H 2", 6, "2", "an operator before a number"),
        ("L = 2 3", 6, "3", "an operator before a number"),
        ("L = H{2}", 5, "{", "an operator before a number"),
        ("L = {3}{4}", 7, "{", "an operator before a number"),
        (r"L = \lambda_{UA1}{1}", 17, "{", "an operator before a number"),
        ("L = H{{2}}", 5, "{", "an operator before a number"),
        ("L = H{2}^3", 5, "{", "an operator before a number"),
        ("L = H / 2", 6, "/", "an operator, a factor or the end"),
        ("L = H + - H", 8, "-", "a number, a symbol"),
        ("L = H +", 7, "the end", "a number, a symbol"),
        (r"L = \times H", 4, r"\times", "a number, a symbol"),
        (r"L = H \times", 12, "the end", "a number, a symbol"),
        (r"L = H'", 5, "'", "the end"),
        (r"L = |H|", 4, "|", "a number, a symbol"),
        (r"L = \partial H", 4, r"\partial", "a number, a symbol"),
        (r"L = \int H", 4, r"\int", "a number, a symbol"),
        (r"L = H \unknown", 6, r"\unknown", "a number, a symbol"),
        (r"L = \mathrm{H}", 4, r"\mathrm", "a number, a symbol"),
        (r"L = H \tag{8}", 10, "{8}", "{9}"),
        (r"L = H. L", 7, "L", "the end"),
        ("$$L = H", 0, "$$", "a closing $$"),
        ("$L = H$ and", 8, "and", "nothing outside"),
        ("so $L = H$", 0, "so", "nothing outside"),
        ("L \n = \n n", 8, "n", "a symbol of the table"),
    ],
)  # fmt: skip
def test_refusal_names_equation_place_and_expectation(
    latex: str, position: int, found: str, expected: str
) -> None:
    with pytest.raises(LatexError) as caught:
        _read(latex)
    error = caught.value
    assert (error.equation, error.position, error.found) == ("9", position, found)
    assert expected in error.expected
    assert latex[: error.position].count("\n") == error.line - 1
    assert str(error).startswith(
        f"Eq. (9), line {error.line}, column {error.column}: found '{found}', expected "
    )
    assert "\n" not in str(error)


def test_line_and_column_start_at_one() -> None:
    with pytest.raises(LatexError) as caught:
        _read("L =\n  n")
    assert (caught.value.line, caught.value.column) == (2, 3)


@pytest.mark.parametrize("piece", ["(", r"\left[", "{", r"\ln", r"\sqrt{", r"\frac{", "L^{", "- {"])
def test_endless_nesting_is_refused(piece: str) -> None:
    with pytest.raises(LatexError):
        _read(piece * 3000 + "L")


PIECES = (
    "L", "H", "n", "d", "t", "2", "0.5", "+", "-", "=", "(", ")", "[", "]", "{", "}", "^", "_", ".", ",", " ",
    "$", "&", "/", "\n", "\\", r"\lambda", r"\mu", r"\alpha", r"\dot", r"\frac", r"\left", r"\right",
    r"\times", r"\tag",
    r"\mathrm", r"\rm", r"\sqrt", r"\ln", r"\{", r"\}", r"\xi_{EB}", r"\frac{d", r"^{2}", "é", "²",
)  # fmt: skip


@settings(max_examples=400, deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join))
def test_anything_is_read_or_refused_with_a_place(latex: str) -> None:
    try:
        equation = _read(latex)
    except LatexError as error:
        assert 0 <= error.position <= len(latex)
    else:
        assert _read(to_latex(equation)) is not None


# The symbol table


def test_key_twice_is_refused() -> None:
    with pytest.raises(ValueError, match=r"symbol \\lambda_\{1\} stands twice"):
        SymbolTable.of({r"\lambda_1": sym.STRETCH_1, r"\lambda_{\rm 1}": sym.STRETCH_2})


@pytest.mark.parametrize("key", ["", "2", "LH", r"\lambda_{", r"L^{+}", r"\frac"])
def test_key_that_is_no_symbol_is_refused(key: str) -> None:
    with pytest.raises(LatexError):
        SymbolTable.of({key: sym.HALF_LENGTH})


def test_unknown_partner_is_refused() -> None:
    with pytest.raises(ValueError, match="has a partner and is not in the symbol table"):
        SymbolTable.of({"L": sym.HALF_LENGTH}, partners=(("L", "H"),))


@pytest.mark.parametrize("key", [str(name) for name in TABLE.entries])
def test_name_prints_as_a_key_of_itself(key: str) -> None:
    assert str(name_of(key)) == key


def test_greek_command_in_a_subscript_keeps_its_end() -> None:
    assert str(name_of(r"L_{\alpha x}")) == r"L_{\alpha x}"


# Random trees, printed by a printer of the test's own, with their exact value

VALUES = {quantity.symbol: Fraction(3 + index, 7) for index, quantity in enumerate(TABLE.entries.values())}
KEYS = {str(name): VALUES[quantity.symbol] for name, quantity in TABLE.entries.items()}
Printed = tuple[str, Fraction]


def _atoms() -> st.SearchStrategy[Printed]:
    symbols = st.sampled_from(sorted(KEYS.items()))
    numbers = st.integers(1, 99).map(lambda n: (str(n), Fraction(n)))
    return symbols | numbers


def _sum(parts: list[tuple[bool, Printed]]) -> Printed:
    text = " ".join(f"{'-' if minus else '+'} {latex}" for minus, (latex, _) in parts)
    return text.removeprefix("+ "), sum(-value if minus else value for minus, (_, value) in parts)


def _grouped(inner: Printed, brackets: tuple[str, str]) -> Printed:
    return f"{brackets[0]}{inner[0]}{brackets[1]}", inner[1]


def _product(parts: list[Printed]) -> Printed:
    return r" \times ".join(latex for latex, _ in parts), prod(value for _, value in parts)


def _implicit(number: int, parts: list[Printed]) -> Printed:
    text = "".join(rf"\left[{latex}\right]" for latex, _ in parts)
    return f"{number}{text}", number * prod(value for _, value in parts)


def _raised(inner: Printed, power: int) -> Printed:
    return rf"\left({inner[0]}\right)^{{{power}}}", inner[1] ** power


def _over(above: Printed, below: Printed) -> Printed:
    return rf"\frac{{{above[0]}}}{{({below[0]})^2 + 1}}", above[1] / (below[1] ** 2 + 1)


def _larger(inner: st.SearchStrategy[Printed]) -> st.SearchStrategy[Printed]:
    brackets = st.sampled_from([("(", ")"), (r"\left[", r"\right]"), (r"\{", r"\}")])
    closed = st.builds(_grouped, inner, brackets) | st.builds(_raised, inner, st.integers(0, 3))
    sums = st.lists(st.tuples(st.booleans(), closed), min_size=1, max_size=4).map(_sum)
    products = st.lists(closed, min_size=1, max_size=3).map(_product)
    several = st.lists(inner, min_size=1, max_size=3)
    return (
        st.builds(_grouped, sums | products, brackets)
        | st.builds(_implicit, st.integers(1, 9), several)
        | st.builds(_over, inner, inner)
    )


SOURCES = st.recursive(_atoms(), _larger, max_leaves=12)


@settings(max_examples=150, deadline=None)
@given(SOURCES)
def test_random_tree_has_the_value_that_was_printed(source: Printed) -> None:
    latex, expected = source
    point = {symbol: sp.Rational(value.numerator, value.denominator) for symbol, value in VALUES.items()}
    assert to_sympy(_side(latex)).xreplace(point) == sp.Rational(expected.numerator, expected.denominator)


@settings(max_examples=150, deadline=None)
@given(SOURCES)
def test_random_tree_is_the_same_when_written_and_read_again(source: Printed) -> None:
    equation = _read(f"{source[0]} = 0")
    again = _read(to_latex(equation))
    assert again == equation
    assert to_latex(again) == to_latex(equation)


def test_missing_value_is_named() -> None:
    with pytest.raises(ValueError, match=r"symbol H \[m\] has no value"):
        evaluate(_side("L H"), {L: mpmath.mpf(1)})


def test_every_variable_is_in_the_table() -> None:
    variable = _side(r"\eta")
    assert variable == Variable(sym.VISCOSITY, name_of(r"\eta"), None)


# Dimensions


def _broken(latex: str) -> list[str]:
    return [term.latex for term in check_printed(_read(latex)) if not term.ok]


@pytest.mark.parametrize(
    ("latex", "broken"),
    [
        ("L + H = 0", []),
        ("L + H + H^2 = 0", ["+ H^2"]),
        ("L^2 - H + L = 0", ["L^2"]),
        ("L - 1 = H", ["- 1"]),
        ("L = H^2", ["H^2"]),
        ("L = L^2 + H^2", ["L^2 + H^2"]),
        ("L = 0", []),
        ("0 = L + 0", []),
        (r"\frac{L + 1}{H} = 1", ["+ 1"]),
        (r"L(1 + \frac{L}{H} - \lambda_{UA1}) = H", []),
        (r"\mu^{\alpha}(1 + L) + \mu^{\beta}(\lambda_{UA1} - L) = 0", ["+ L", "- L"]),
        (r"\ln(\frac{L}{H}) + \sqrt{\frac{L^2}{H^2}} = 1", []),
        (r"\ln(L) = 1", ["(L)"]),
        (r"\sqrt{L H} = L", []),
        (r"\lambda_{UA1}^{L} = 1", ["L"]),
        (r"L^{\lambda_{UA1}} = 1", ["L"]),
        (r"L^{\frac{1}{2}} L^{\frac{1}{2}} = H", []),
        (r"\dot{\lambda}_{UA1} = \frac{\mu^{\alpha}}{\eta}", []),
    ],
)
def test_printed_term_that_breaks_the_unit(latex: str, broken: list[str]) -> None:
    assert _broken(latex) == broken


def test_every_printed_term_gets_its_dimension() -> None:
    checked = check_printed(_read(r"L(1 + \lambda_{UA1}) + H = 0"))
    assert [(term.latex, str(term.dimension)) for term in checked] == [
        (r"L(1 + \lambda_{UA1})", "m"),
        ("1", "1"),
        (r"+ \lambda_{UA1}", "1"),
        ("+ H", "m"),
    ]
