"""Variational kernels as text: the equations they hold, the phase of their drives, other systems, their form."""

from __future__ import annotations

import ast
import importlib.util
import sys
from dataclasses import replace
from importlib import import_module, resources

import numba
import numpy as np
import pytest
import sympy as sp
from conftest import PAPER_VALUES
from first_order import duffing, lorenz, written

from delagrange.derive.kernel.arranged import operations
from delagrange.derive.kernel.compiled_spec import joined, variational_spec
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.kernel.spec import Assignment, KernelFunction
from delagrange.derive.papers.sheng_2015.paper import PAPER
from delagrange.model.kernels import compile_tangents

NAMES = tuple(each.name for each in PAPER.descriptions if each.name not in PAPER.not_emitted)
MATRICES = ("rhs", "jacobian", "input_jacobian")


def interpreted(path, monkeypatch):
    """The kernel in the file with the compiler switched off: its functions are plain Python."""
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    spec = importlib.util.spec_from_file_location(f"plain_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def path_of(name):
    return resources.files("delagrange.generated").joinpath(f"{name}_variational.py")


@pytest.fixture
def plain(monkeypatch):
    return lambda name: interpreted(path_of(name), monkeypatch)


def parameters_of(module, viscosity=PAPER_VALUES[-1], held_stretch=1.7):
    return (*PAPER_VALUES[:-1], viscosity, held_stretch)[: len(module.PARAMETERS)]


def random_state(module, rng):
    return np.array(
        [rng.uniform(-300, 300) if v.unit == "1/s" else rng.uniform(0.6, 2.5) for v in module.STATE]
    )


def motion(kernel, state, inputs, tangent, sources=None, pushes=None, parameters=()):
    """Rates of state, tangent and the integral of the divergence, as the kernel computes them."""
    size, columns = tangent.shape
    frame = np.zeros(kernel.COLUMN + 2 * columns)
    frame[kernel.CONSTANT : kernel.CONSTANT + kernel.CONSTANT_COUNT] = kernel.constants(parameters)
    frame[kernel.INPUT : kernel.INPUT + kernel.INPUT_COUNT] = inputs
    frame[kernel.COLUMN : kernel.COLUMN + columns] = 0.0 if pushes is None else pushes
    places = np.full((columns, 2), -1) if sources is None else sources
    vector = np.concatenate([state, tangent.T.ravel(), [0.0]])
    rates = np.full(2 * len(vector), np.nan)
    kernel._motion(frame, places, columns, vector, rates, len(vector))
    assert np.all(np.isnan(rates[: len(vector)]))
    rates = rates[len(vector) :]
    return rates[:size], rates[size:-1].reshape(columns, size).T, rates[-1]


# --- the equations -----------------------------------------------------------------------------------


def plain_symbols(expression):
    return expression.subs({symbol: sp.Symbol(symbol.name) for symbol in expression.free_symbols})


def exact_values(pairs, outputs, values):
    """The outputs in rational numbers, with the names given values one after the other."""
    known = dict(values)
    for name, value in pairs:
        known[sp.Symbol(name)] = plain_symbols(value).subs(known)
    return [plain_symbols(output).subs(known) for output in outputs]


@pytest.mark.parametrize("name", NAMES)
def test_the_kernel_holds_the_modules_equations(name, equations):
    """In rational numbers: what the kernel assigns is the right-hand side and both Jacobians of the model."""
    spec = kernel(equations(name), ())
    ours = variational_spec(spec)
    functions = {function.name: function for function in spec.functions}
    symbols = [sp.Symbol(entry.name) for entry in (*spec.state, *spec.inputs, *spec.parameters)]
    values = {symbol: sp.Rational(7 + 3 * place, 5 + 2 * place) for place, symbol in enumerate(symbols)}
    arranged = (ours.volume, *ours.constants, *ours.motion.assignments)
    found = exact_values([(a.name, a.expression) for a in arranged], ours.motion.outputs, values)
    rhs = functions["rhs"]
    by_name = dict(zip((entry.name for entry in spec.state), rhs.outputs, strict=True))
    accelerations = [(a.name, a.expression) for a in rhs.assignments]
    assert len(by_name) == len(rhs.outputs)
    expected = []
    for function in (functions[matrix] for matrix in MATRICES):
        assignments = [*accelerations, *((a.name, a.expression) for a in function.assignments)]
        expected += exact_values(assignments, function.outputs, values)
    assert found == expected
    assert ours.operations < sum(
        operations((*(a.expression for a in f.assignments), *f.outputs))
        for f in (functions[matrix] for matrix in MATRICES)
    )


@pytest.mark.parametrize("name", NAMES)
def test_an_evaluation_divides_once(name, equations):
    ours = variational_spec(kernel(equations(name), ()))
    expressions = (*(a.expression for a in ours.motion.assignments), *ours.motion.outputs)
    assert sum(any(p.exp.is_negative for p in e.atoms(sp.Pow)) for e in expressions) == 1


@pytest.mark.parametrize("name", NAMES)
def test_rates_of_a_tangent_are_the_modules_jacobians_times_it(name, plain, rng):
    compiled, module = plain(name), import_module(f"delagrange.generated.{name}")
    size = len(module.STATE)
    for _ in range(10):
        state, parameters = random_state(module, rng), parameters_of(module)
        inputs = np.array([rng.uniform(-0.5, 1.0), rng.uniform(-6e6, 6e6)])
        tangent, pushes = rng.standard_normal((size, 5)), rng.standard_normal(5)
        sources = np.array([(-1, -1), (0, 0), (1, 1), (1, 2), (-1, -1)])
        rates, moving, trace = motion(compiled, state, inputs, tangent, sources, pushes, parameters)
        slopes = module.jacobian(state, inputs, parameters)
        pushed = module.input_jacobian(state, inputs, parameters)
        expected = slopes @ tangent
        for column, (place, _) in enumerate(sources):
            if place >= 0:
                expected[:, column] += pushed[:, place] * pushes[column]
        rhs = module.rhs(state, inputs, parameters)
        np.testing.assert_allclose(rates, rhs, rtol=1e-11, atol=1e-12 * np.max(np.abs(rhs)))
        scale = np.abs(slopes) @ np.abs(tangent) + np.abs(pushed).max(axis=1)[:, None] * np.abs(pushes)
        assert np.all(np.abs(moving - expected) <= 1e-11 * (scale + np.abs(slopes).max(axis=1)[:, None]))
        assert trace == pytest.approx(np.trace(slopes), rel=1e-11, abs=1e-11 * np.abs(slopes).max())


@pytest.mark.parametrize("name", NAMES)
def test_a_frozen_dashpot_is_exactly_still(name, plain, rng):
    """Of infinite viscosity: rates and rows of the Jacobian are zero, and nothing is no number."""
    compiled, module = plain(name), import_module(f"delagrange.generated.{name}")
    size, start = len(module.STATE), 2 * module.COORDINATE_COUNT
    state, parameters = random_state(module, rng), parameters_of(module, viscosity=np.inf)
    rates, moving, trace = motion(compiled, state, (0.3, 4e6), np.eye(size), parameters=parameters)
    assert np.all(np.isfinite(moving)) and np.all(np.isfinite(rates)) and np.isfinite(trace)
    assert np.all(rates[start:] == 0.0) and np.all(moving[start:] == 0.0)
    assert np.all(moving[module.COORDINATE_COUNT : start].any(axis=0))


def test_a_name_with_two_meanings_is_refused():
    x = sp.Symbol("x")
    first, second = (
        KernelFunction(name, "", "", (), (Assignment("half", value),), (x,))
        for name, value in (("rhs", x / 2), ("jacobian", x / 3))
    )
    with pytest.raises(ValueError, match="half of jacobian is not what it is before"):
        joined("motion", [first, second])
    assert len(joined("motion", [first, replace(second, assignments=first.assignments)]).assignments) == 1


# --- other systems -----------------------------------------------------------------------------------


@pytest.mark.parametrize("system", [lorenz, duffing])
def test_a_system_that_is_no_membrane_is_emitted(system, tmp_path, monkeypatch, rng):
    monkeypatch.syspath_prepend(str(tmp_path))
    spec = system()
    module = written(spec, tmp_path)
    monkeypatch.delitem(sys.modules, spec.name)
    compiled = interpreted(tmp_path / f"{spec.name}_variational.py", monkeypatch)
    size = len(module.STATE)
    parameters, inputs = rng.uniform(1, 10, len(module.PARAMETERS)), rng.uniform(-1, 1, len(module.INPUTS))
    state, tangent = rng.standard_normal(size), rng.standard_normal((size, 2))
    rates, moving, trace = motion(compiled, state, inputs, tangent, parameters=parameters)
    slopes = module.jacobian(state, inputs, parameters)
    np.testing.assert_allclose(rates, module.rhs(state, inputs, parameters), rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(moving, slopes @ tangent, rtol=1e-13, atol=1e-12)
    assert trace == pytest.approx(np.trace(slopes), rel=1e-13)
    assert spec.coordinate_count == compiled.COORDINATE_COUNT


# --- text --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_imports_numpy_and_numba_only(name):
    imported = {
        name
        for node in ast.walk(ast.parse(path_of(name).read_text(encoding="utf-8")))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in ([a.name for a in node.names] if isinstance(node, ast.Import) else [node.module])
    }
    assert imported == {"numba", "numpy"}


@pytest.mark.parametrize("name", NAMES)
def test_the_docstring_says_what_the_kernel_is(name):
    kernel, module = (import_module(f"delagrange.generated.{name}{kind}") for kind in ("_variational", ""))
    text = kernel.__doc__
    assert text.splitlines()[0] == module.__doc__.splitlines()[0]
    assert "do not edit" in text and "DOP853" in text and "Numba" in text
    assert f"digest of the governing equations {kernel.DIGEST}" in text and kernel.DIGEST in module.__doc__


@pytest.mark.parametrize("name", NAMES)
def test_every_number_of_the_frame_has_its_own_place(name):
    kernel = import_module(f"delagrange.generated.{name}_variational")
    counts = {
        "CONSTANT": kernel.CONSTANT_COUNT,
        "DRIVE": 4 * kernel.INPUT_COUNT,
        "WEIGHT": kernel.STATE_COUNT,
    }
    counts |= {"TURNS": kernel.INPUT_COUNT, "INPUT": kernel.INPUT_COUNT}
    single = (
        "TOLERANCE", "SMALLEST", "LARGEST", "TIME", "ROW", "SINCE", "WISH", "OLD_ERROR", "STATUS",
        "STATUS_TIME", "STEPS", "REJECTIONS",
    )  # fmt: skip
    counts |= dict.fromkeys(single, 1)
    taken = [getattr(kernel, place) + k for place, count in counts.items() for k in range(count)]
    assert sorted(taken) == list(range(kernel.COLUMN))


def test_to_go_nowhere_is_no_error():
    for name in NAMES:
        compile_tangents(import_module(f"delagrange.generated.{name}_variational"))
