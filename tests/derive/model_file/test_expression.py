"""Formulas of users: they mean what Python's own arithmetic means, and nothing else can be said in them."""

from __future__ import annotations

import ast
import inspect
import math
import time
from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from delagrange.derive.model_file import expression, expression_tokens
from delagrange.derive.model_file.expression import FUNCTIONS, read_expression
from delagrange.derive.model_file.expression_tokens import LONGEST, ExpressionError

X, MU = sp.symbols("x mu", positive=True)
NAMES = {"x": X, "mu": MU}
AT = {"x": Fraction(3, 7), "mu": Fraction(5, 2)}


def _binary(trees):
    return st.tuples(st.sampled_from("+-*/"), trees, trees)


def _power(trees):
    return st.tuples(st.just("^"), trees, st.integers(-3, 3))


TREES = st.recursive(
    st.one_of(
        st.sampled_from(["x", "mu"]),
        st.integers(0, 99).map(str),
        st.decimals(0, 99, allow_nan=False, allow_infinity=False, places=3).map(lambda d: f"{d:f}"),
    ),
    lambda trees: st.one_of(_binary(trees), _power(trees), st.tuples(st.just("-"), trees)),
    max_leaves=12,
)


_STRENGTH = {"+": 1, "-": 1, "*": 2, "/": 2}


def _text(tree, raised: str, number: str) -> tuple[str, int]:
    """A tree as text with no parenthesis too many, and how strongly it binds."""
    if isinstance(tree, str):
        return (tree if tree in NAMES else number.format(tree)), 5
    if len(tree) == 2:
        return f"-{_wrapped(tree[1], 3, raised, number)}", 3
    operator, left, right = tree
    if operator == "^":
        return f"{_wrapped(left, 5, raised, number)}{raised}{right}", 4
    own = _STRENGTH[operator]
    sides = _wrapped(left, own, raised, number), _wrapped(right, own + 1, raised, number)
    return f" {operator}".join(sides), own


def _wrapped(tree, strength: int, raised: str, number: str) -> str:
    text, own = _text(tree, raised, number)
    return text if own >= strength else f"({text})"


@given(TREES, st.sampled_from(["^", "**"]))
def test_it_means_what_python_means(tree, raised):
    """Exactly what Python's own arithmetic gives for the same text, on fractions."""
    try:
        expected = eval(_text(tree, "**", "F('{}')")[0], {"__builtins__": {}}, {"F": Fraction, **AT})
    except ZeroDivisionError:
        assume(False)
    assume(max(abs(expected.numerator), expected.denominator).bit_length() < 500)
    try:
        read = read_expression(_text(tree, raised, "{}")[0], NAMES)
    except ExpressionError as error:  # what stands within is a division by zero, or beyond a bound
        assume("zero" not in error.reason and "too large" not in error.reason)
        raise
    at = {NAMES[name]: sp.Rational(value.numerator, value.denominator) for name, value in AT.items()}
    found = sp.Rational(read.subs(at))
    assert (int(found.p), int(found.q)) == (expected.numerator, expected.denominator)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-x^2", -(X**2)), ("2^3^2", sp.Integer(512)), ("x^-2", X**-2), ("-2^-1", sp.Rational(-1, 2)),
        ("1 - 2 - 3", sp.Integer(-4)), ("8/4/2", sp.Integer(1)), ("0.1", sp.Rational(1, 10)),
        ("1.5e-3", sp.Rational(3, 2000)), (".5", sp.Rational(1, 2)), ("2.", sp.Integer(2)), ("--x", X),
        ("x**1.3", X ** sp.Rational(13, 10)), ("mu/2*(x^2 - 3)", MU / 2 * (X**2 - 3)), ("2\n *x\t", 2 * X),
        ("x^mu", X**MU), ("sqrt(x)*sqrt(x)", X),
    ],
)  # fmt: skip
def test_exact_readings(text, expected):
    assert read_expression(text, NAMES) == expected


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_functions_are_those_of_mathematics(name):
    read = read_expression(f"{name}(x/2 + 1)", NAMES)
    assert float(read.subs(X, sp.Rational(2, 5))) == pytest.approx(getattr(math, name)(1.2), rel=1e-14)


HOSTILE = [
    ("__import__('os')", 1, "found '_'"),
    ("import os", 1, "unknown symbol 'import'"),
    ("x.__class__", 2, "found '.'"),
    ("a.b", 2, "found '.'"),
    ("x if", 3, "found 'if', expected an operator or the end"),
    ("lambda: x", 7, "found ':'"),
    ("lambda_1", 1, "unknown symbol 'lambda_1'; allowed are mu, x"),
    ("x; x", 2, "found ';'"),
    ("x[0]", 2, "found '['"),
    ("x = 2", 3, "found '='"),
    ("'x'", 1, 'found "\'"'),
    ("exec(x)", 1, "unknown function 'exec' (did you mean 'exp'?)"),
    ("Symbol(x)", 1, "unknown function 'Symbol'"),
    ("(" * 500 + "x" + ")" * 500, 42, "nested more than 40 deep"),
    ("^".join(["x"] * 300), 82, "nested more than 40 deep"),
    ("exp(" * 300 + "x" + ")" * 300, 165, "nested more than 40 deep"),
    ("9^9^9^9", 5, "a power too large"),
    ("(((9^64)^64)^64)", 10, "a power too large"),
    ("x^1e90", 3, "a power too large"),
    ("x^(1/1e80)", 3, "a power too large"),
    ("*".join(["9^64"] * 700), 1, "too large or too long"),
    ("exp(exp(exp(9)))", 5, "the argument of exp is too large"),
    ("1e400", 1, "powers of ten up to 100"),
    ("1" * 41, 1, "has 41 characters"),
    ("x" * (LONGEST + 1), LONGEST + 1, "allowed are 4000"),
    ("1_000", 2, "found '_'"),
    ("0x10", 2, "found 'x10', expected an operator"),
    ("2x", 2, "found 'x', expected an operator"),
    ("х + 1", 1, "found '\\u0445'"),  # Cyrillic ha
    ("x × 2", 3, "found '\\xd7'"),
    ("x\u202e+1", 2, "found '\\u202e'"),
    ("²x", 1, "found '\\xb2'"),
    ("٣", 1, "found '\\u0663'"),
    ("x\x00", 2, "found '\\x00'"),
    ("nan", 1, "unknown symbol 'nan'"),
    ("x/0", 3, "division by zero"),
    ("0^-1", 3, "division by zero"),
    ("1/(x - x)", 3, "division by zero"),
    ("sqrt(-1)*x", 1, "not a finite real number"),
    ("log(0)", 1, "not a finite real number"),
    ("(-8)^(1/3)", 1, "not a finite real number"),
    ("", 1, "found the end, expected a number"),
    ("x +", 4, "found the end"),
    ("(x", 3, "expected an operator or ')'"),
    ("x)", 2, "expected an operator or the end"),
    ("sin x", 1, "needs an argument in parentheses"),
    ("x(2)", 1, "between factors a * is needed"),
    ("sin()", 5, "expected a number"),
    ("sin(x, x)", 6, "found ','"),
]


@pytest.mark.parametrize(("text", "column", "reason"), HOSTILE, ids=lambda value: str(value)[:20])
def test_what_is_no_formula_is_refused_with_its_place_and_at_once(text, column, reason):
    start = time.perf_counter()
    with pytest.raises(ExpressionError) as caught:
        read_expression(text, NAMES)
    assert time.perf_counter() - start < 1.0
    assert (caught.value.line, caught.value.column) == (1, column)
    assert reason in caught.value.reason
    assert "\n" not in str(caught.value) and str(caught.value).isprintable() and len(str(caught.value)) < 300


def test_the_place_has_a_line():
    with pytest.raises(ExpressionError, match=r"^line 3, column 4: unknown symbol 'nu' \(did you mean 'mu'"):
        read_expression("x +\n x +\n   nu", NAMES)


@given(st.text(max_size=60))
def test_any_text_is_read_or_refused(text):
    """No other error, no other kind of result."""
    try:
        assert isinstance(read_expression(text, NAMES), sp.Expr)
    except ExpressionError as error:
        assert str(error).isascii() and error.line >= 1 and error.column >= 1


@given(st.text(alphabet="x0129.e+-*/^() \nmulogsqrt", max_size=80))
def test_any_text_of_its_letters_is_read_or_refused_at_once(text):
    start = time.perf_counter()
    try:
        found = read_expression(text, NAMES)
        assert found.free_symbols <= {X, MU} and not found.has(sp.I, sp.zoo, sp.nan)
    except ExpressionError:
        pass
    assert time.perf_counter() - start < 2.0


@pytest.mark.parametrize("module", [expression, expression_tokens])
def test_no_evaluator_is_called(module):
    """The modules name no function that turns text into code, and no parser of SymPy's."""
    tree = ast.parse(inspect.getsource(module))
    named = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    named |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    forbidden = {
        "eval",
        "exec",
        "compile",
        "sympify",
        "S",
        "parse_expr",
        "lambdify",
        "nsimplify",
        "__import__",
    }
    assert not named & forbidden
