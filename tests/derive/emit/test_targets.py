"""Targets: what is emitted for a model, another one beside them, and the names that their code keeps for itself."""

from __future__ import annotations

import ast
import builtins
import math
import re
from dataclasses import replace
from importlib import resources
from pathlib import Path

import jinja2
import numpy as np
import pytest
import sympy as sp
from described import plain
from first_order import first_order

from delagrange.derive.emit.target import Target
from delagrange.derive.emit.targets import TARGETS, emitted
from delagrange.derive.kernel.spec import KernelSpec
from delagrange.derive.membrane.description import EQUAL_BIAXIAL, UNIAXIAL
from delagrange.derive.notation.printer import FUNCTIONS, ExpressionPrinter
from delagrange.derive.pipeline import description_spec

# --- a target of its own: printer, template, and what to place in it ---------------------------------

CARETS = ExpressionPrinter(FUNCTIONS, power="{}^{}".format, raised="^")
RATES = jinja2.Template(
    "Rates of {{ title }}\n{% for name, value in lines %}{{ name }} = {{ value }}\n{% endfor %}"
)


def rates_as_text(spec: KernelSpec) -> str:
    rhs = next(function for function in spec.functions if function.name == "rhs")
    named = [(each.name, CARETS(each.expression)) for each in rhs.assignments]
    rates = [(f"d({entry.name})/dt", CARETS(rate)) for entry, rate in zip(spec.state, rhs.outputs, strict=True)]
    return RATES.render(title=spec.title, lines=[*named, *rates])


TEXT = Target("_rates.txt", CARETS, rates_as_text, reserved=frozenset({"Rates"}))


@pytest.mark.parametrize("kind", [EQUAL_BIAXIAL, UNIAXIAL])
def test_a_target_is_added_by_naming_it(kind, tmp_path, rng):
    """Its file comes beside the others, which are what they were; its rates are those of the module."""
    spec = description_spec(plain(kind))
    files = emitted(spec, (*TARGETS, TEXT))
    assert files[:-1] == emitted(spec)
    name, text = files[-1]
    assert name == f"{spec.name}_rates.txt"
    module: dict = {}
    exec(files[0][1], module)
    parameters = [1.0 + 0.1 * place for place in range(len(spec.parameters))]
    state, inputs = rng.uniform(0.8, 1.6, len(spec.state)), rng.uniform(0.1, 0.5, len(spec.inputs))
    values = dict(zip((q.name for q in (*spec.state, *spec.inputs, *spec.parameters)), (*state, *inputs, *parameters)))
    assert text.splitlines()[0] == f"Rates of {spec.title}"
    for line in text.splitlines()[1:]:
        left, right = line.split(" = ")
        values[left] = eval(right.replace("^", "**"), vars(math).copy(), values)
    found = [values[f"d({entry.name})/dt"] for entry in spec.state]
    np.testing.assert_allclose(found, module["rhs"](state, inputs, parameters), rtol=1e-12)


def test_a_function_that_a_target_has_no_name_for_is_refused():
    """Before anything is rendered; the targets that know it take it."""
    few = {function: name for function, name in FUNCTIONS.items() if name != "tanh"}
    poor = replace(TEXT, printer=ExpressionPrinter(few))
    spec = first_order("system", {"x": -sp.tanh(sp.Symbol("x"))}, (1,))
    assert len(emitted(spec, (TEXT,))) == 1
    with pytest.raises(ValueError, match=r"system_rates.txt has no name for tanh\(x\); allowed are cos, cosh, exp"):
        emitted(spec, (TARGETS[0], poor))


# --- names -------------------------------------------------------------------------------------------


def named(name):
    return first_order("system", {name: -sp.Symbol(name)}, (1,))


@pytest.mark.parametrize(
    "name",
    ["vector", "max", "lambda", "work", "range", "constant", "constant_12", "slope_1_2", "tangent_3", "rhs", "Rates"],
)
def test_a_name_that_a_target_needs_is_refused(name):
    with pytest.raises(ValueError, match=rf"system: quantity '{name}' \({name}\) has the name of something else"):
        emitted(named(name), (*TARGETS, TEXT))


@pytest.mark.parametrize("name", ["a b", "", "2x", "λ"])
def test_what_is_no_name_is_refused(name):
    with pytest.raises(ValueError, match="must be called by ASCII letters, digits and _"):
        emitted(named(name))


@pytest.mark.parametrize("name", ["Rates", "x", "vectors", "constant_alpha", "slope_1_alpha"])
def test_any_other_name_is_free(name):
    assert emitted(named(name))[0][0] == "system.py"


PLACED = {"_lanes": ("_rates", "_stretches", "constants"), "_variational": ("_motion", "_stretches", "constants")}


PYTHON = tuple(target for target in TARGETS if target.suffix.endswith(".py"))  # a header renames: test_c_header.py


@pytest.mark.parametrize("target", PYTHON, ids=lambda target: target.suffix)
def test_a_target_reserves_all_that_its_code_is_written_with(target):
    """Every name in the functions that equations are placed in is the model's, made of a name of it, or reserved."""
    for path in sorted(Path(str(resources.files("delagrange.generated"))).glob(f"*{target.suffix}")):
        if target.suffix == ".py" and path.stem.endswith((*PLACED, "__init__")):
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        kind = next((kind for kind in PLACED if path.stem.endswith(kind)), "")
        model = ast.parse(path.with_name(f"{path.stem.removesuffix(kind)}.py").read_text(encoding="utf-8"))
        ours = _variables(model) | _assigned(model) | {each.name for each in _functions(model)}
        for function in _functions(tree):
            if function.name in PLACED.get(kind, (function.name,)) and function.name != "_stack":
                for name in _names(function) - ours:
                    stem = re.fullmatch("(inverse_)?(.+?)(_numerator)?(_pow[0-9]+)?", name)[2]
                    known = stem in ours or target.reserves(stem) or name.startswith("_")
                    assert known, (path.name, function.name, name)


def _functions(tree):
    return [node for node in tree.body if isinstance(node, ast.FunctionDef)]


def _names(function):
    """What a function calls by name, but for what stands in its decorators or is given to it as an argument only."""
    inner = [node for statement in function.body for node in ast.walk(statement)]
    return {node.id for node in inner if isinstance(node, ast.Name)} | {each.arg for each in function.args.args}


def _assigned(tree):
    return {
        node.id for each in _functions(tree) for node in ast.walk(each)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }  # fmt: skip


def _variables(tree):
    """Names of the quantities of a module."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == "Variable"]
    return {ast.literal_eval(call.args[0]) for call in calls}


def test_no_builtin_is_hidden():
    """What the code of a compiled module calls of Python itself is reserved there."""
    assert {"min", "max", "range"} <= set(vars(builtins)) and all(target.reserves("range") for target in PYTHON)


# --- languages ---------------------------------------------------------------------------------------


def test_no_language_is_written_outside_of_its_target():
    """No text anywhere else in the derivation is code of NumPy."""
    root = Path(str(resources.files("delagrange.derive")))
    for path in sorted(root.rglob("*.py")):
        if "emit" not in path.relative_to(root).parts:
            texts = [node.value for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
                     if isinstance(node, ast.Constant) and isinstance(node.value, str)]  # fmt: skip
            assert not [text for text in texts if re.search(r"\bnp\.", text)], path
