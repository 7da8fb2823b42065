"""Compiled kernels as text: arranged expressions, the equations they hold, the method, their form."""

from __future__ import annotations

import ast
import importlib.util
import math
import os
import subprocess
import sys
from dataclasses import replace
from functools import cache
from importlib import import_module, resources
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from conftest import PAPER_VALUES
from hypothesis import given
from hypothesis import strategies as st
from tidy import check_tidy

from delagrange.derive.emit.lanes_module import emit_lanes, sine_coefficients
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.runge_kutta import dop853, quadrature
from delagrange.derive.kernel.arranged import operations, operations_of
from delagrange.derive.kernel.compiled_spec import lane_spec
from delagrange.derive.kernel.constants import Constants
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.kernel.powers import share_powers
from delagrange.derive.kernel.reciprocals import denominators, inverse_name, share_division, without_division
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.papers.sheng_2015.paper import PAPER
from delagrange.derive.pipeline import description_spec
from delagrange.model.kernels import integrate_nothing
from delagrange.problem import status as loss

NAMES = tuple(each.name for each in PAPER.descriptions if each.name not in PAPER.not_emitted)
a, b, c, x, y, z = sp.symbols("a b c x y z", positive=True)


def kernel_of(name):
    return import_module(f"delagrange.generated.{name}_lanes")


def written_out(pairs, expression):
    """The expression with every name replaced by what it stands for, the last first."""
    for name, value in reversed(pairs):
        expression = expression.subs(sp.Symbol(name), value)
    return expression


def plain(expression):
    """The expression in symbols without assumptions, which the arranging functions make up by name."""
    return expression.subs({symbol: sp.Symbol(symbol.name) for symbol in expression.free_symbols})


# --- expressions -------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", range(7))
def test_one_division_gives_every_inverse(count):
    bases = tuple(sp.Symbol(f"base_{number}") for number in range(count))
    pairs = share_division(bases)
    for base in bases:
        assert sp.cancel(written_out(pairs, inverse_name(base)) * base) == 1
    divided = [value for _, value in pairs if value.atoms(sp.Pow)]
    assert len(divided) == min(count, 1)
    assert operations(value for _, value in pairs) <= max(3 * count - 2, 0) + count
    names = [name for name, _ in pairs]
    assert len(set(names)) == len(names)


def test_no_name_is_used_before_it_is_computed():
    known = {"p", "q", "r", "s"}
    for name, value in share_division(sp.symbols("p q r s")):
        assert {symbol.name for symbol in value.free_symbols} <= known
        known.add(name)


def test_denominators_are_the_bases_of_negative_integer_powers():
    expression = a / x**2 + sp.sqrt(y) / (x + y) + b / 3 + z**2 + 1 / sp.sqrt(a)
    assert denominators([expression]) == (x, x + y)
    assert denominators([x + 1]) == ()


@given(exponents=st.lists(st.integers(-6, 6), min_size=1, max_size=4))
def test_without_division_nothing_is_divided(exponents):
    expression = sum((a * sp.Symbol("x") ** n for n in exponents), y)
    found = without_division(expression)
    assert not any(power.exp.is_negative for power in found.atoms(sp.Pow))
    assert sp.simplify(found.subs(inverse_name(sp.Symbol("x")), 1 / sp.Symbol("x")) - expression) == 0


@given(exponents=st.lists(st.integers(-12, 12), min_size=1, max_size=5))
def test_powers_are_products_of_what_is_there(exponents):
    base = sp.Symbol("x")
    expressions = tuple(sp.Symbol("a") * base**n + n for n in exponents)
    pairs, rewritten = share_powers(expressions, frozenset("x"))
    known = {"x"}
    for name, value in pairs:
        assert {symbol.name for symbol in value.free_symbols} <= known
        assert value == 1 / base or (value.is_Mul and len(value.args) == 2) or value.exp == 2
        known.add(name)
    for expression, new in zip(expressions, rewritten, strict=True):
        assert not new.atoms(sp.Pow)
        assert sp.simplify(written_out(pairs, new) - expression) == 0


@pytest.mark.parametrize(
    ("expression", "count"),
    [
        (a * b * x + a * y, 2),
        (a * b * x - a * b * y, 1),  # a constant and its negative share a name
        (a**2 / b, 1),
        (x * y, 0),
        (3 * x + 2, 0),
        (a + x, 1),
        (c * (a * x + b * y), 2),  # a factor vanishes in terms that have a constant already
        (c * (x + y), 1),
        ((a + b) * x / (c * x + y), 2),
        (sp.exp(a * x) * c, 2),
    ],
)
def test_what_does_not_move_is_one_name(expression, count):
    constants = Constants(frozenset({a, b, c}))
    folded = constants.fold(expression)
    named = {name: value for value, name in constants.values.items()}
    assert len(named) == count
    assert not folded.free_symbols & {a, b, c}
    assert all(value.free_symbols <= {a, b, c} for value in named.values())
    assert sp.simplify(folded.subs(named) - expression) == 0


def test_a_constant_met_again_keeps_its_name():
    constants = Constants(frozenset({a, b}))
    first, second = constants.fold(a * b * x), constants.fold(a * b * y + z)
    assert len(constants.values) == 1
    assert first / x == (second - z) / y


@pytest.mark.parametrize(
    ("expression", "count"),
    [
        (x, 0),
        (-x, 0),
        (x + y + z, 2),
        (x - y, 1),
        (2 * x * y, 2),
        (x**3, 2),
        (x**-2, 2),
        (1 / x, 1),
        (sp.sin(x + y), 2),
        (x**4 * (y + z) * a, 6),
    ],
)
def test_operations_are_those_of_the_printed_expression(expression, count):
    assert operations([expression]) == count


@pytest.mark.parametrize("name", NAMES)
def test_arranged_equations_are_the_modules_equations(name, equations):
    """Symbolically: what the kernel assigns, written out, is the right-hand side of the model."""
    spec = kernel(equations(name), ())
    arranged = lane_spec(spec)
    rhs = next(function for function in spec.functions if function.name == "rhs")
    before = [(entry.name, plain(entry.expression)) for entry in rhs.assignments]
    after = [
        (entry.name, plain(entry.expression))
        for entry in (arranged.volume, *arranged.constants, *arranged.motion.assignments)
    ]
    symbols = [sp.Symbol(entry.name) for entry in (*spec.state, *spec.inputs, *spec.parameters)]
    values = {symbol: sp.Rational(7 + 3 * place, 5 + 2 * place) for place, symbol in enumerate(symbols)}
    for ours, theirs in zip(arranged.rates, rhs.outputs, strict=True):
        found, expected = (
            exact_value(pairs, output, values) for pairs, output in ((after, ours), (before, theirs))
        )
        assert found == expected
    divisions = [e for e in arranged.motion.assignments if 1 in {-p.exp for p in e.expression.atoms(sp.Pow)}]
    assert len(divisions) == 1
    assert arranged.operations < operations((*(e.expression for e in rhs.assignments), *rhs.outputs))


def exact_value(pairs, output, values):
    """The output in rational numbers, with the names given values one after the other."""
    known = dict(values)
    for name, value in pairs:
        known[sp.Symbol(name)] = value.subs(known)
    return plain(output).subs(known)


# --- numbers -----------------------------------------------------------------------------------------


def parameters_of(module, held_stretch):
    return (*PAPER_VALUES, held_stretch)[: len(module.PARAMETERS)]


def filled(kernel, model, rng):
    """Rows of `work` with random lanes in them, with their state, inputs and parameters."""
    lanes = kernel.LANES
    scale = np.array([300.0 if entry.unit == "1/s" else 0.0 for entry in model.STATE])[:, None]
    state = np.where(scale > 0, rng.uniform(-1, 1, (len(scale), lanes)) * scale, 0.0)
    state += np.where(scale == 0, rng.uniform(0.6, 2.5, state.shape), 0.0)
    inputs = np.stack([rng.uniform(-0.5, 1.0, lanes), rng.uniform(-6e6, 6e6, lanes)])
    materials = [value * rng.uniform(0.5, 2.0, lanes) for value in PAPER_VALUES]
    parameters = (*materials, rng.uniform(0.8, 4.0, lanes))[: len(model.PARAMETERS)]
    work = np.full(kernel.SIZE, np.nan)
    constants = [np.broadcast_to(value, lanes) for value in kernel.constants(parameters)]
    for start, rows in ((kernel.POINT, state), (kernel.INPUT, inputs), (kernel.CONSTANT, constants)):
        work[start : start + len(rows) * lanes] = np.ravel(rows)
    return work, state, inputs, parameters


@pytest.mark.parametrize("name", NAMES)
def test_the_kernels_equations_are_the_modules(name, rng):
    """The text of the kernel as Python runs it, without the compiler, to rounding."""
    model, kernel = import_module(f"delagrange.generated.{name}"), kernel_of(name)
    for _ in range(20):
        work, state, inputs, parameters = filled(kernel, model, rng)
        kernel._rates.py_func(work, kernel.RATE_1)
        rates = work[kernel.RATE_1 :][: kernel.STATE_COUNT * kernel.LANES]
        expected = model.rhs(state, inputs, parameters)
        scale = np.maximum(np.abs(expected), np.abs(expected).max(axis=0) * 1e-3)
        error = np.abs(rates.reshape(expected.shape) - expected) / scale
        assert np.max(error) < 2e-12
        principal = np.broadcast_arrays(*model.principal_stretches(state, inputs, parameters))
        for k in range(kernel.LANES):
            least, most = kernel._stretches.py_func(work, k)
            assert least == pytest.approx(min(value[k] for value in principal), rel=1e-14)
            assert most == pytest.approx(max(value[k] for value in principal[:2]), rel=1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_names_and_counts_are_the_modules(name):
    model, kernel = import_module(f"delagrange.generated.{name}"), kernel_of(name)
    assert (
        kernel.MODEL == model.MODEL and f"digest of the governing equations {kernel.DIGEST}" in model.__doc__
    )
    assert len(model.STATE) == kernel.STATE_COUNT and len(model.INPUTS) == kernel.INPUT_COUNT
    assert kernel.COORDINATE_COUNT == model.COORDINATE_COUNT
    assert len(kernel.constants(parameters_of(model, 2.0))) == kernel.CONSTANT_COUNT
    assert [loss.COMPLETED, loss.COLLAPSED, loss.DIVERGED, loss.INTERRUPTED] == [
        kernel.COMPLETED, kernel.COLLAPSED, kernel.DIVERGED, kernel.INTERRUPTED,
    ]  # fmt: skip


WITHOUT_COMPILER = """
import sys
import types
import numpy as np
from delagrange.engines import compiled
from test_emit_lanes import kernel_of, short_run
compiled.load_kernel = lambda _: kernel_of(sys.argv[1])  # which the engine would refuse
assert isinstance(kernel_of(sys.argv[1]).integrate, types.FunctionType)
outcome = short_run(sys.argv[1])
np.savez(sys.argv[2], **vars(outcome))
"""


def short_run(name):
    """Lanes of every kind for a moment: kept, lost, sampled, averaged, in a window that begins later."""
    import delagrange as dl
    from delagrange.engines.compiled import integrate_compiled
    from delagrange.engines.engines import Numerics
    from delagrange.engines.lanes import Sampling
    from delagrange.problem.problem import make_problem
    from delagrange.run.sweep import make_settings

    model, amplitude = dl.load_model(name), np.array([2e6, 5e6, 2e8])
    held = 1.5 if name.startswith("pure_shear") else None
    field = dl.Sine(amplitude, np.array([300.0, 900.0, 5e3]), phase=np.array([0.0, 1.0, 2.0]))
    problem = make_problem(model, dl.SHENG_2015, {}, held, dl.Ramp(0.1, 0.5, 4e-4, 2e-4), field)
    state = np.asarray(model.reference_state(problem.parameters), dtype=float).reshape(-1, 1)
    numerics, limits = Numerics("DOP853", "compiled", "pi", "dense"), dl.Limits(0.25, 2.2)
    settings = make_settings(1.2e-3, (1e-4, 1.1e-3), 1e-4, 1e-7, numerics, limits, averages=True, threads=1)
    sampling = Sampling(np.zeros(3), np.array([1e-4, 2e-4, 1e-4]), 6)
    return integrate_compiled(problem, np.repeat(state, 3, axis=1), settings, sampling)


@pytest.mark.parametrize("name", NAMES)
def test_a_whole_run_without_the_compiler_is_the_compiled_one(name, tmp_path):
    """In the interpreter every access to an array is checked.

    The compiler fuses products with sums, which steps feel in their last digits: far below the tolerance.
    """
    folders = [str(Path(__file__).parent), str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
    subprocess.run(
        [sys.executable, "-c", WITHOUT_COMPILER, name, str(tmp_path / "outcome.npz")],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(folders)},
        check=True,
    )
    slow, fast = np.load(tmp_path / "outcome.npz"), vars(short_run(name))
    assert {0} < set(fast["status"])
    np.testing.assert_array_equal(fast["status"], slow["status"])
    for entry in set(fast) - {"status"}:
        counts = entry in ("steps", "rejections")
        size = (
            1.0
            if counts
            else 1e-8
            * np.maximum(1.0, np.max(np.abs(slow[entry]), initial=0, where=np.isfinite(slow[entry])))
        )
        np.testing.assert_allclose(fast[entry], slow[entry], rtol=0, atol=size, err_msg=entry)


# --- sine and method ---------------------------------------------------------------------------------


def test_the_sine_is_right_to_five_parts_in_1e_16(rng):
    import numba

    scalar = kernel_of("equal_biaxial")._sine
    compiled = numba.njit(lambda turns: scalar(turns))
    turns = np.concatenate([rng.uniform(-0.5, 0.5, 2000), np.arange(-8, 9) / 16, [1e-300, 1e-9, -0.0]])
    with mpmath.workdps(40):
        exact = [mpmath.sin(2 * mpmath.pi * mpmath.mpf(float(turn))) for turn in turns]
        for sine in (compiled, scalar.py_func):
            errors = [abs(mpmath.mpf(float(sine(turn))) - value) for turn, value in zip(turns, exact)]
            assert max(errors) < 5e-16


def test_the_sine_repeats_every_turn():
    sine = kernel_of("equal_biaxial")._sine.py_func
    for turn in np.arange(64) / 64:
        for whole in (1, -3, 1e6):
            assert sine(turn + whole) == pytest.approx(sine(turn), abs=1e-15)
    assert np.isnan(sine(np.nan))


def test_the_polynomial_of_the_sine_has_coefficients_near_taylors():
    for place, found in enumerate(sine_coefficients(8)[:5]):
        power = 2 * place + 1
        taylor = (-1) ** place * (2 * math.pi) ** power / math.factorial(power)
        assert found == pytest.approx(taylor, rel=1e-5)


def test_the_pair_satisfies_its_order_conditions():
    """Quadrature to order 8, every row consistent, and the conditions of order 3 with two stages."""
    pair = dop853()
    nodes = {0: 0.0} | {stage.number: stage.node for stage in (*pair.stages, *pair.extra_stages)}
    weights = dict(pair.weights)
    for power in range(8):
        total = math.fsum(weight * nodes[stage] ** power for stage, weight in weights.items())
        assert total == pytest.approx(1 / (power + 1), abs=1e-15)
    assert abs(math.fsum(weight * nodes[stage] ** 8 for stage, weight in weights.items()) - 1 / 9) > 1e-6
    rows = {stage.number: dict(stage.row) for stage in (*pair.stages, *pair.extra_stages)}
    for number, row in rows.items():
        assert math.fsum(row.values()) == pytest.approx(nodes[number], abs=1e-14)
        assert max(row) < number
    inner = {
        number: math.fsum(value * nodes[stage] for stage, value in row.items())
        for number, row in rows.items()
    }
    total = math.fsum(weight * inner.get(stage, 0.0) for stage, weight in weights.items())
    assert total == pytest.approx(1 / 6, abs=1e-15)
    assert rows[pair.last] == weights and nodes[pair.last] == 1.0


def test_the_errors_vanish_for_what_the_pair_integrates_exactly():
    pair = dop853()
    nodes = {0: 0.0} | {stage.number: stage.node for stage in pair.stages}
    for row, order in zip(pair.errors, (5, 3), strict=True):
        for power in range(order):
            assert abs(math.fsum(value * nodes[stage] ** power for stage, value in row)) < 1e-14
        assert abs(math.fsum(value * nodes[stage] ** order for stage, value in row)) > 1e-6


@pytest.mark.parametrize("power", range(7))
def test_the_interpolant_is_exact_to_degree_7(power):
    """y' = t^k over one step: the interpolant, as the kernel evaluates it, is t^(k+1) / (k+1)."""
    pair = dop853()
    rates = {stage.number: stage.node**power for stage in (*pair.stages, *pair.extra_stages)}
    rates[0] = 0.0**power
    rise = math.fsum(weight * rates[stage] for stage, weight in pair.weights)
    terms = [rise, rates[0] - rise, 2 * rise - rates[0] - rates[pair.last]]
    terms += [math.fsum(value * rates[stage] for stage, value in row) for row in pair.interpolant]
    for place in np.linspace(0, 1, 11):
        total = 0.0
        for number in range(6, -1, -1):
            total = (terms[number] + total) * (place if number % 2 == 0 else 1 - place)
        assert total == pytest.approx(place ** (power + 1) / (power + 1), abs=1e-13)


@pytest.mark.parametrize("count", [1, 3, 8])
def test_the_quadrature_is_exact_to_its_degree(count):
    for power in range(2 * count):
        total = math.fsum(weight * node**power for node, weight in quadrature(count))
        assert total == pytest.approx(1 / (power + 1), rel=1e-15)


# --- text --------------------------------------------------------------------------------------------


def source_of(name):
    return resources.files("delagrange.generated").joinpath(f"{name}_lanes.py").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NAMES)
def test_imports_numpy_and_numba_only(name):
    imported = set()
    for node in ast.walk(ast.parse(source_of(name))):
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            imported.add(node.module)
    assert imported == {"numba", "numpy"}


@pytest.mark.parametrize("name", NAMES)
def test_the_docstring_says_what_the_kernel_is(name):
    text = kernel_of(name).__doc__
    module = import_module(f"delagrange.generated.{name}")
    assert text.splitlines()[0] == module.__doc__.splitlines()[0]
    assert "do not edit" in text and "Provenance: digest" in text and "Numba" in text


def test_every_row_has_its_own_place():
    """Rows neither overlap nor leave the arrays."""
    for name in NAMES:
        kernel = kernel_of(name)
        starts = {
            target.id: getattr(kernel, target.id)
            for node in ast.parse(source_of(name)).body
            if isinstance(node, ast.Assign) and "* LANES" in ast.unparse(node.value)
            for target in node.targets
        }
        size = starts.pop("SIZE")
        assert size == kernel.SIZE and len(set(starts.values())) == len(starts)
        assert all(start % kernel.LANES == 0 and 0 <= start < size for start in starts.values())
        assert kernel.FIRST_STATE - kernel.FIRST_CONSTANT == kernel.CONSTANT_COUNT


def test_nothing_to_integrate_is_no_error():
    for name in NAMES:
        integrate_nothing(kernel_of(name))


# --- limits of the strain energies -------------------------------------------------------------------

GENT = Path(__file__).parents[2] / "models" / "gent_two_branches.toml"


@cache
def gent_spec():
    """A membrane with two Gent springs."""
    return description_spec(read_model_file(GENT))


@cache
def without_limits():
    """The same membrane where nobody says how far a spring can be stretched."""
    kept = tuple(function for function in gent_spec().functions if function.name != "validity")
    return replace(gent_spec(), functions=kept)


@pytest.fixture(scope="module")
def gent(tmp_path_factory):
    """Module and kernel of it, imported and not compiled."""
    folder = tmp_path_factory.mktemp("gent")
    texts = {"gent": emit(gent_spec()), "gent_lanes": emit_lanes(gent_spec())}
    return tuple(imported(folder / f"{name}.py", text) for name, text in texts.items())


def imported(path, text):
    path.write_text(text, encoding="utf-8")
    described = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(described)
    described.loader.exec_module(module)
    return module


def functions_in(text):
    """Text of every function by name."""
    return {
        each.name: ast.unparse(each) for each in ast.parse(text).body if isinstance(each, ast.FunctionDef)
    }


def test_a_lane_is_measured_against_the_limits_of_the_module(gent, rng):
    model, lanes = gent
    work, state, inputs, parameters = np.full(lanes.SIZE, np.nan), *gent_states(model, lanes.LANES, rng)
    for start, rows in ((lanes.POINT, state), (lanes.CONSTANT, lanes.constants(parameters))):
        work[start : start + len(rows) * lanes.LANES] = np.ravel(rows)
    expected = model.validity(state, inputs, parameters)
    assert expected.min() < 0 < expected.max()
    for k in range(lanes.LANES):
        assert lanes._validity.py_func(work, k) == pytest.approx(expected[k], rel=1e-13, abs=1e-11)


def gent_states(model, lanes, rng):
    """States within the limits and beyond either of them, with inputs and parameters of each lane."""
    reference = np.asarray(model.reference_state(tuple(model.DEFAULTS.values())), dtype=float)
    state = reference[:, None] * rng.uniform(0.4, 9.0, (len(reference), lanes))
    inputs = rng.uniform(0.0, 1.0, (len(model.INPUTS), lanes))
    return state, inputs, [value * rng.uniform(0.5, 2.0, lanes) for value in model.DEFAULTS.values()]


def test_limits_are_looked_at_once_a_step_and_not_in_its_stages():
    """All that evaluates, integrates and interpolates is, to the letter, what it would be without them."""
    bound, free = lane_spec(gent_spec()), lane_spec(without_limits())
    assert bound.operations == free.operations and bound.motion == free.motion
    assert bound.constants[: len(free.constants)] == free.constants
    with_limits, without = functions_in(emit_lanes(gent_spec())), functions_in(emit_lanes(without_limits()))
    changed = {name for name, text in with_limits.items() if text != without.get(name)}
    assert changed == {
        "_validity", "constants", "_marks", "_note_ends", "_kept", "_kind_of_loss", "_look_into", "integrate",
    }  # fmt: skip
    asking = {
        name for name, text in with_limits.items() if "_validity(work, k)" in text and name != "_validity"
    }
    assert asking == {"_marks", "_kept", "_kind_of_loss"}  # at the end of a step; at a start or a loss
    assert with_limits["_marks"].count("_validity(") == 1
    assert "_kept(" not in with_limits["_stages"] + with_limits["_rates"] + with_limits["_control"]


def test_the_kernel_says_what_its_limits_cost():
    spec, text = lane_spec(gent_spec()), emit_lanes(gent_spec())
    assert f"At the end of every step, {operations_of(spec.validity)} more say" in text
    assert operations_of(spec.validity) < spec.operations / 2
    assert "LOCKED" not in emit_lanes(without_limits())


def test_the_kernel_counts_losses_as_the_program_does(gent):
    assert gent[1].LOCKED == loss.LOCKED
    for name in NAMES:
        assert not hasattr(kernel_of(name), "LOCKED")


def test_a_kernel_with_limits_is_tidy(gent):
    _, lanes = gent
    starts = sorted(
        getattr(lanes, target.id)
        for node in ast.parse(Path(lanes.__file__).read_text(encoding="utf-8")).body
        if isinstance(node, ast.Assign) and "* LANES" in ast.unparse(node.value)
        for target in node.targets
    )
    assert len(set(starts)) == len(starts) and starts[-1] == lanes.SIZE
    check_tidy(Path(lanes.__file__))
