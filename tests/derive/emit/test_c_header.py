"""Headers for the C core: the equations of their modules in exact numbers, and nothing a user writes becomes code."""

from __future__ import annotations

import ast
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest
import sympy as sp
from first_order import duffing, lorenz
from hypothesis import given
from hypothesis import strategies as st

import delagrange as dl
from delagrange.common.header_digest import belongs, header_digest, stated_digest
from delagrange.derive.emit.c_header import emit_header
from delagrange.derive.emit.c_names import c_name, comment_text
from delagrange.derive.emit.c_printer import CPrinter, VectorPrinter
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.kernel.header_spec import header_spec
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.pipeline import description_spec

TEXTS = Path(__file__).parents[2] / "models"
NAMES = tuple(dl.model_names())


@cache
def spec_of(name):
    from conftest import derived

    if name.endswith(".toml"):
        return description_spec(read_model_file(TEXTS / name))
    return kernel(derived(name), ())


@cache
def header_text(name):
    spec = spec_of(name)
    return emit_header(spec, emit(spec))


# --- C read in exact numbers -------------------------------------------------------------------------

ASSIGNMENT = re.compile(r"(?:const double |vec |VALUE\()?([a-z]\w*|\*?[a-z]+(?:\[\w+\])*)\)? = (.*)")
EXACT = {
    "madd": lambda a, b, c: a * b + c,
    "maddc": lambda a, b, c: a * b + c,
    "all": lambda x: x,
    "smaller": min,
    "smaller_known": min,
    "larger": max,
}


class Exactly(ast.NodeTransformer):
    """Numbers as fractions."""

    def visit_Constant(self, node):
        if not isinstance(node.value, float):
            return node
        return ast.Call(ast.Name("Fraction", ast.Load()), [ast.Constant(repr(node.value))], [])


def run(body, **given):
    """What a function of the header does with exact numbers: the arrays given, and those that it fills."""
    names = EXACT | {"Fraction": Fraction} | given
    for statement in re.sub(r"/\*.*?\*/", "", body, flags=re.S).split(";"):
        text = " ".join(statement.replace("EACH", "").replace("[v]", "").split())
        if not text or text.startswith("(void)"):
            continue
        target, code = ASSIGNMENT.fullmatch(text).groups()
        tree = Exactly().visit(ast.parse(code, mode="eval"))
        value = eval(compile(ast.fix_missing_locations(tree), "C", "eval"), names)
        if "[" in target:
            array, *places = re.split(r"[\[\]]+", target.rstrip("]"))
            names[array][int(places[-1])] = value
        else:
            names[target.lstrip("*")] = value
    return names


def body_of(text, function):
    start = text.index("{\n", text.index(f" {function}(")) + 2
    return text[start : text.index("\n}\n", start)]


def module_of(spec):
    names: dict = {}
    exec(compile(emit(spec), spec.name, "exec"), names)
    return names


def exact_arguments(spec, seed):
    """Small fractions, all different, for state, inputs and parameters."""
    numbers = iter(Fraction(7 + (seed + 5 * n) % 11, 9 + n % 4) for n in range(100))
    return tuple([next(numbers) for _ in group] for group in (spec.state, spec.inputs, spec.parameters))


def exactly(function, arguments):
    """A function of the NumPy module on fractions: what it stacks, flat."""
    import numpy as np

    arrays = tuple([np.array(value, dtype=object)[()] for value in group] for group in arguments)
    return list(np.ravel(np.array(function(*arrays), dtype=object)))


EXACT_NAMES = (*NAMES, "gent_two_branches.toml")


@pytest.mark.parametrize("seed", [0, 3])
@pytest.mark.parametrize("name", EXACT_NAMES)
def test_the_header_holds_the_equations_of_the_module_in_exact_numbers(name, seed):
    spec, text = spec_of(name), header_text(name)
    arguments, described = exact_arguments(spec, seed), header_spec(spec)
    state, inputs, parameters = arguments
    module, count = module_of(spec), len(described.constants)
    if any(map(uses_functions, described.motion.outputs)):
        pytest.skip("not rational")
    constant = run(body_of(text, "constants"), parameter=parameters, constant=[None] * count)["constant"]
    shared = {"state": state, "input": inputs, "constant": constant}
    size, drives = len(state), len(inputs)
    rate = run(body_of(text, "rates"), rate=[None] * size, **shared)["rate"]
    expected = exactly(module["rhs"], arguments)
    assert rate == expected
    lines = body_of(text, "motion").split("    for (int group")[0]
    motion = run(lines, rate=[None] * size, **shared)
    assert motion["rate"] == expected
    jacobian = exactly(module["jacobian"], arguments)
    assert motion["trace"] == sum(jacobian[:: size + 1])
    slopes = exactly(module["input_jacobian"], arguments)
    along, push = [Fraction(n + 2, 3) for n in range(size)], [Fraction(n - 2, 5) for n in range(drives)]
    columns = re.sub(r"\[group\]", "", text.split("group++) {\n")[1].split("\n    }\n")[0])
    named = {key: value for key, value in motion.items() if key not in EXACT}
    moved = run(columns, tangent=along, push=push, moved=[None] * size, **named)["moved"]
    for row in range(size):
        wanted = sum(jacobian[row * size + column] * along[column] for column in range(size))
        wanted += sum(slopes[row * drives + column] * push[column] for column in range(drives))
        assert moved[row] == wanted
    stretches = run(body_of(text, "stretches"), **shared)
    principal = exactly(module["principal_stretches"], arguments)
    assert (stretches["least"], stretches["most"]) == (min(principal), max(principal[:2]))
    start = run(body_of(text, "reference"), parameter=parameters, state=[None] * size)["state"]
    assert start == [
        Fraction(value) for value in exactly(lambda _, __, p: module["reference_state"](p), arguments)
    ]
    if "validity" in module:
        assert run(body_of(text, "validity"), **shared)["room"] == exactly(module["validity"], arguments)[0]


def uses_functions(expression):
    return expression.has(sp.log, sp.exp) or any(not p.exp.is_Integer for p in expression.atoms(sp.Pow))


@pytest.mark.parametrize("name", NAMES)
def test_energies_and_powers_are_those_of_the_module(name):
    spec, text = spec_of(name), header_text(name)
    arguments, described = exact_arguments(spec, 1), header_spec(spec)
    state, inputs, parameters = arguments
    constants = [None] * len(described.constants)
    constant = run(body_of(text, "constants"), parameter=parameters, constant=constants)["constant"]
    count = len(described.energy_names)
    found = run(
        body_of(text, "energies"), energy=[None] * count, state=state, input=inputs, constant=constant
    )["energy"]
    module = module_of(spec)
    assert count >= 4 and found == [exactly(module[each], arguments)[0] for each in described.energy_names]


def test_systems_that_are_no_membranes_have_headers_too():
    for spec in (lorenz(), duffing()):
        text = emit_header(spec, emit(spec))
        assert "#define ENERGIES 0" in text and "energies(" not in text


def test_the_same_text_each_time():
    spec = spec_of("uniaxial")
    assert emit_header(spec, emit(spec)) == header_text("uniaxial")
    assert max(map(len, header_text("uniaxial").splitlines())) <= 125


# --- expressions -------------------------------------------------------------------------------------

x, y, z = sp.symbols("x y z")
CODE = {
    x * y + z: "madd(x, y, z)",
    z - x * y: "madd(-x, y, z)",
    2 * x + y: "maddc(2.0, x, y)",
    x + y: "x + y",
    x - y: "x - y",
    -x - y: "-x - y",
    x * y: "x * y",
    x**2: "x * x",
    x**4: "(x * x) * (x * x)",
    x**7: "vec_pow(x, all(7.0))",
    x**y: "vec_pow(x, y)",
    sp.sqrt(x): "vec_sqrt(x)",
    1 / x: "1.0 / x",
    x / (y * z): "x / (y * z)",
    sp.Rational(3, 4) * x: "3.0 / 4.0 * x",
    -x: "-x",
    x * (y + z): "x * (y + z)",
    sp.exp(x): "vec_exp(x)",
    sp.log(x + 1): "vec_log(x + 1.0)",
    x * y + 1: "madd(x, y, all(1.0))",
    x**2 + y: "madd(x, x, y)",
    sp.Min(x, y): "smaller_known(x, y)",
}


@pytest.mark.parametrize("expression", CODE, ids=str)
def test_an_expression_as_code_for_vectors(expression):
    code = VectorPrinter(lambda symbol: symbol.name)(expression)
    assert code.replace("1.0 + x", "x + 1.0") == CODE[expression]


@given(
    numbers=st.lists(st.fractions(-3, 3, max_denominator=7), min_size=6, max_size=6),
    powers=st.lists(st.integers(-3, 4), min_size=6, max_size=6),
)
def test_what_is_printed_has_the_value_of_the_expression(numbers, powers):
    a, b, c, d, e, f = (sp.Rational(n.numerator, n.denominator) for n in numbers)
    expression = (
        a * x ** powers[0] * y ** powers[1]
        + b * (x + c * y ** powers[2]) * z ** powers[3]
        + d
        - e * x
        + f * z
    )
    at = {"x": Fraction(3, 2), "y": Fraction(-5, 7), "z": Fraction(11, 3)}
    exact = expression.subs(
        {sp.Symbol(name): sp.Rational(v.numerator, v.denominator) for name, v in at.items()}
    )
    names = EXACT | {"Fraction": Fraction, "vec_pow": lambda p, q: p**q, "pow": lambda p, q: p**q} | at
    for printer in (VectorPrinter(lambda s: s.name), CPrinter(lambda s: s.name)):
        tree = Exactly().visit(ast.parse(printer(expression), mode="eval"))
        found = eval(compile(ast.fix_missing_locations(tree), "C", "eval"), names)
        assert sp.Rational(found.numerator, found.denominator) == exact


def test_what_has_no_name_in_c_is_refused():
    with pytest.raises(TypeError, match="no way to write besselj in C"):
        VectorPrinter(lambda symbol: symbol.name)(sp.besselj(0, x))


# --- names and texts ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    [
        "double",
        "vec",
        "madd",
        "rates",
        "linux",
        "I",
        "WIDTH",
        "C_10",
        "_x",
        "__asm",
        "vec_pow",
        "state",
        "inline",
    ],
)
def test_a_name_that_means_something_else_gets_an_ending(name):
    assert c_name(name).endswith("_of_model") and re.fullmatch("[A-Za-z][A-Za-z0-9_]*", c_name(name))


def test_every_macro_and_function_of_the_core_is_a_name_that_a_quantity_does_not_get():
    from core_builds import CORE

    for source in CORE.glob("*.h"):
        text = source.read_text(encoding="utf-8")
        macros = re.findall(r"^ *#define (\w+)", text, re.M)
        macros += (
            re.findall(r"^INLINE [a-z_]+ \*?(\w+)\(", text, re.M) if source.name in FOR_EQUATIONS else []
        )
        macros += re.findall(r"^BY_LANES\((\w+)", text, re.M)
        assert [name for name in macros if c_name(name) == name] == [], source.name


FOR_EQUATIONS = ("vectors.h", "abreast.h")  # what a header is written with

HOSTILE = [
    "*/ int main(void) { abort(); } /*",
    "ends here */",
    "opens /* again",
    "a line\n#define double float",
    "a line\r#include </etc/passwd>",
    "continued \\",
    "continued ??/",
    'a "quotation"',
    "\u202e reversed",
    "a tab\there",
    "a form\ffeed",
]


@pytest.mark.parametrize("text", HOSTILE)
def test_a_text_cannot_end_its_comment(text):
    with pytest.raises(ValueError, match="cannot stand in a comment of C"):
        comment_text(text)


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("place", ["title", "meaning", "unit", "text", "formulation"])
def test_a_strangers_model_puts_no_c_into_its_header(text, place):
    """Each text of a model that stands in a header."""
    spec = duffing()
    if place in ("title", "formulation"):
        spec = replace(spec, **{place: text})
    else:
        spec = replace(spec, parameters=(replace(spec.parameters[0], **{place: text}),))
    with pytest.raises(ValueError, match="cannot stand in a comment of C"):
        emit_header(spec, "")


@pytest.mark.parametrize("name", ["a; abort()", "a b", "1a", "é", "", "a\n", "a-b", "a)"])
def test_a_strangers_name_is_refused(name):
    with pytest.raises(ValueError, match="cannot be a name in C"):
        c_name(name)
    spec = duffing()
    with pytest.raises(ValueError, match="cannot be a name in C"):
        emit_header(replace(spec, inputs=(replace(spec.inputs[0], name=name),)), "")


@pytest.mark.parametrize("name", ["a*/b", 'a"', "a\nb", "../a"])
def test_a_strangers_model_name_is_refused(name):
    with pytest.raises(ValueError, match="cannot be a name in C"):
        emit_header(replace(duffing(), name=name), "")


# --- whose header ------------------------------------------------------------------------------------


def test_a_header_belongs_to_the_text_of_its_module():
    spec = spec_of("equal_biaxial")
    module, header = emit(spec).encode(), header_text("equal_biaxial").encode()
    assert belongs(module, header) and stated_digest(header) == header_digest(module, header)
    assert not belongs(module + b" ", header) and not belongs(module, header + b" ")
    assert not belongs(module, header.replace(stated_digest(header).encode(), b"0" * 32))
    assert stated_digest(b"nothing") is None
