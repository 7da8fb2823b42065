"""Generated modules: regeneration, numbers against lambdify, laws, form, and that they stand alone."""

from __future__ import annotations

import ast
import hashlib
import subprocess
import sys
from dataclasses import replace
from importlib import import_module, resources
from pathlib import Path

import numpy as np
import pytest
from conftest import HASH_SEED, PAPER_VALUES, walked_under
from hypothesis import given
from hypothesis import strategies as st
from lambdified import lambdified
from tidy import check_tidy

from delagrange.derive.check.report import as_text
from delagrange.derive.emit import numpy_module as emit_module
from delagrange.derive.emit.folder import stale
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.targets import TARGETS
from delagrange.derive.emit.write_together import write_together
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.papers.sheng_2015.paper import PAPER

NAMES = tuple(each.name for each in PAPER.descriptions if each.name not in PAPER.not_emitted)
FUNCTIONS = (
    "rhs", "jacobian", "input_jacobian", "mass_matrix", "kinetic_energy", "potential_energy", "force_power",
    "dashpot_power", "edge_forces", "principal_stretches",
)  # fmt: skip


def module_of(name):
    return import_module(f"delagrange.generated.{name}")


def parameters_of(module, held_stretch=2.0):
    return (*PAPER_VALUES, held_stretch)[: len(module.PARAMETERS)]


def random_state(module, rng, shape=()):
    values = [
        rng.uniform(-300, 300, shape) if v.unit == "1/s" else rng.uniform(0.6, 2.5, shape)
        for v in module.STATE
    ]
    return np.array(values)


def random_inputs(rng, shape=()):
    return np.array([rng.uniform(-0.5, 1.0, shape), rng.uniform(-6e6, 6e6, shape)])


def _scale(function, theirs, parameters):
    """Size of what is added up: rounding is relative to that, not to what is left of it."""
    L, H, _, _, alpha, beta, viscosity = parameters[:7]
    volume = 8 * L**2 * H
    floors = {
        "potential_energy": volume * (alpha + beta),
        "dashpot_power": volume * beta**2 / viscosity,
        "reaction_forces": 4 * H * L * (alpha + beta),
        "edge_forces": 4 * H * L * (alpha + beta),
    }
    by_column = {"jacobian": None, "rhs": None, "input_jacobian": 0}
    whole = np.max(np.abs(theirs), by_column[function]) if function in by_column else np.abs(theirs)
    return np.maximum(whole, floors.get(function, 0.0))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", range(5))
def test_agrees_with_lambdify_at_random_states(name, seed, equations):
    module, witness, rng = module_of(name), lambdified(equations(name)), np.random.default_rng(seed)
    functions = (*FUNCTIONS, *(("reaction_forces",) if module.REACTIONS else ()))
    for _ in range(100):
        state, inputs = random_state(module, rng), random_inputs(rng)
        parameters = parameters_of(module, rng.uniform(0.8, 4.0))
        for function in functions:
            ours = getattr(module, function)(state, inputs, parameters)
            theirs = np.asarray(getattr(witness, function)(state, inputs, parameters), dtype=float)
            assert np.all(np.abs(ours - theirs) <= 1e-12 * _scale(function, theirs, parameters)), function


@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial", "pure_shear_consistent_free"])
def test_the_dissipated_power_is_never_negative_near_a_relaxed_dashpot(name, rng):
    """Where the dashpots of both axes flow, it is computed as a sum of squares."""
    module = module_of(name)
    parameters, n = parameters_of(module, 1.3), module.COORDINATE_COUNT
    for _ in range(200):
        state = random_state(module, rng)
        along = (*state[:n], 1.3)[: len(module.STATE) - 2 * n]
        state[2 * n :] = np.array(along) * (1 + rng.choice([0.0, 1e-15, 1e-12, 1e-9]) * rng.standard_normal())
        assert module.dashpot_power(state, (0.0, 0.0), parameters) >= 0


def test_the_reference_state_is_of_floating_point():
    for name in NAMES:
        assert module_of(name).reference_state(parameters_of(module_of(name))).dtype == np.float64


@pytest.mark.parametrize("name", NAMES)
def test_jacobian_is_the_complex_step_derivative(name, rng):
    module, step = module_of(name), 1e-200
    for _ in range(20):
        state, inputs, parameters = random_state(module, rng), random_inputs(rng), parameters_of(module)
        columns = [
            module.rhs(state + 1j * step * unit, inputs, parameters).imag / step
            for unit in np.eye(len(state))
        ]
        found = module.jacobian(state, inputs, parameters)
        scale = np.abs(found).max(axis=1, keepdims=True)
        assert np.all(np.abs(found - np.transpose(columns)) <= 1e-12 * scale)


@pytest.mark.parametrize("name", NAMES)
def test_input_jacobian_is_the_complex_step_derivative(name, rng):
    module = module_of(name)
    for _ in range(20):
        state, inputs, parameters = random_state(module, rng), random_inputs(rng), parameters_of(module)
        found = module.input_jacobian(state, inputs, parameters)
        for column, size in enumerate((1.0, 1e6)):
            step = 1e-200 * size
            moved = [value + 1j * step * (place == column) for place, value in enumerate(inputs)]
            expected = module.rhs(state, moved, parameters).imag / step
            assert np.max(np.abs(expected)) > 0
            assert np.all(np.abs(found[:, column] - expected) <= 1e-12 * np.max(np.abs(expected)))


@pytest.mark.parametrize("name", [name for name in NAMES if name != "pure_shear_as_printed"])
def test_an_applied_force_equal_to_that_on_the_edge_is_balance(name, rng):
    """Axis 1 has its force; in the uniaxial membrane axis 2 is left with what would have to hold it."""
    module = module_of(name)
    for _ in range(20):
        state, parameters = random_state(module, rng), parameters_of(module, rng.uniform(0.8, 4.0))
        n, lever = module.COORDINATE_COUNT, 2 * parameters[0]
        state[n : 2 * n] = 0.0
        field = rng.uniform(-6e6, 6e6)
        along, across = module.edge_forces(state, (0.0, field), parameters)
        inputs = (along, field)
        balance = (
            module.mass_matrix(state, inputs, parameters) @ module.rhs(state, inputs, parameters)[n : 2 * n]
        )
        np.testing.assert_allclose(balance, (0.0, -lever * across)[:n], rtol=0, atol=1e-11 * lever)


@pytest.mark.parametrize("name", ["pure_shear_consistent", "pure_shear_consistent_free"])
def test_at_rest_the_reaction_is_the_edge_force(name, rng):
    module = module_of(name)
    for _ in range(20):
        state, parameters = random_state(module, rng), parameters_of(module, rng.uniform(0.8, 4.0))
        state[1], field = 0.0, rng.uniform(-6e6, 6e6)
        along, across = module.edge_forces(state, (0.0, field), parameters)
        (reaction,) = module.reaction_forces(state, (along, field), parameters)
        assert reaction == pytest.approx(across, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_broadcasts_over_any_trailing_shape(name, rng):
    module, shape = module_of(name), (3, 4)
    state, inputs = random_state(module, rng, shape), random_inputs(rng, shape)
    parameters = parameters_of(module)
    for function in FUNCTIONS:
        whole = getattr(module, function)(state, inputs, parameters)
        one = getattr(module, function)(state[:, 1, 2], inputs[:, 1, 2], parameters)
        assert whole.shape == np.shape(one) + shape
        np.testing.assert_array_equal(whole[..., 1, 2], one)


def test_inputs_and_parameters_broadcast_against_the_state():
    module = module_of("equal_biaxial")
    state = module.reference_state(PAPER_VALUES)
    forces = np.linspace(0.0, 1.0, 5)[:, None]
    densities = np.array([1e3, 1.2e3])
    parameters = (*PAPER_VALUES[:2], densities, *PAPER_VALUES[3:])
    assert module.rhs(state, (forces, 0.0), parameters).shape == (3, 5, 2)


@pytest.mark.parametrize("name", [name for name in NAMES if name != "pure_shear_as_printed"])
def test_the_reference_state_is_at_rest_without_load(name):
    module = module_of(name)
    held = 1.0  # any other held stretch loads the membrane
    parameters = parameters_of(module, held)
    state = module.reference_state(parameters)
    assert np.max(np.abs(module.rhs(state, (0.0, 0.0), parameters))) < 1e-9


def test_the_printed_pure_shear_is_not_at_rest_even_unloaded():
    """Tripled terms: the undeformed, unloaded membrane accelerates."""
    module = module_of("pure_shear_as_printed")
    parameters = parameters_of(module, 1.0)
    assert module.rhs(module.reference_state(parameters), (0.0, 0.0), parameters)[1] > 1e6


stretches = st.floats(0.6, 2.5)


@given(
    a=stretches,
    b=stretches,
    xa=stretches,
    xb=stretches,
    va=st.floats(-300, 300),
    vb=st.floats(-300, 300),
    field=st.floats(0, 6e6),
)
def test_uniaxial_without_force_is_symmetric_in_its_axes(a, b, xa, xb, va, vb, field):
    module = module_of("uniaxial")
    swap = [1, 0, 3, 2, 5, 4]
    state = np.array([a, b, va, vb, xa, xb])
    left = module.rhs(state, (0.0, field), PAPER_VALUES)[swap]
    right = module.rhs(state[swap], (0.0, field), PAPER_VALUES)
    np.testing.assert_allclose(left, right, rtol=1e-10, atol=1e-10 * np.max(np.abs(right)))


@given(stretch=stretches, xi=stretches, rate=st.floats(-300, 300), field=st.floats(0, 6e6))
def test_unforced_uniaxial_on_the_diagonal_is_equal_biaxial(stretch, xi, rate, field):
    uniaxial, equal = module_of("uniaxial"), module_of("equal_biaxial")
    found = uniaxial.rhs((stretch, stretch, rate, rate, xi, xi), (0.0, field), PAPER_VALUES)[::2]
    expected = equal.rhs((stretch, rate, xi), (0.0, field), PAPER_VALUES)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.max(np.abs(expected)))


@given(stretch=stretches, field=st.floats(-6e6, 6e6))
def test_the_field_enters_squared(stretch, field):
    module = module_of("equal_biaxial")
    state = (stretch, 1.0, 1.1)
    np.testing.assert_array_equal(
        module.rhs(state, (0.1, field), PAPER_VALUES), module.rhs(state, (0.1, -field), PAPER_VALUES)
    )


# --- the text ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_imports_numpy_only(name):
    source = resources.files("delagrange.generated").joinpath(f"{name}.py").read_text(encoding="utf-8")
    imported = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            imported.add(node.module)
    assert imported == {"numpy", "typing"}


@pytest.mark.parametrize("name", NAMES)
def test_a_copy_outside_the_package_still_works(name, tmp_path):
    source = resources.files("delagrange.generated").joinpath(f"{name}.py")
    (tmp_path / "copied.py").write_bytes(source.read_bytes())
    values = parameters_of(module_of(name))
    code = f"import copied; s = copied.reference_state({values}); print(copied.rhs(s, (0.1, 1e6), {values}).shape)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == f"({len(module_of(name).STATE)},)"


@pytest.mark.parametrize("name", NAMES)
def test_the_docstring_says_what_the_module_is(name):
    module = module_of(name)
    text = module.__doc__
    assert "do not edit" in text and "Provenance: digest" in text and "SymPy" in text
    assert "T = " in text and "Π = " in text and f"Checked against the equations printed in {PAPER.citation}:" in text
    assert all(
        variable.unit and variable.meaning for variable in (*module.STATE, *module.INPUTS, *module.PARAMETERS)
    )
    for line in text.splitlines():
        assert len(line) <= 112


def test_no_line_is_too_long_and_no_name_is_unused():
    """In modules of every kind."""
    folder = Path(str(resources.files("delagrange.generated")))
    check_tidy(*(folder / f"{name}{kind}.py" for name in NAMES for kind in ("", "_lanes", "_variational")))


def test_the_same_text_under_any_hash_seed(walked):
    """All modules and the table of all verdicts, walked in full."""
    other = walked_under("0" if HASH_SEED != "0" else "1")
    assert other.modules == walked.modules
    assert as_text(other.verdicts) == as_text(walked.verdicts)
    texts = dict(walked.modules)
    assert len(texts) == len(TARGETS) * len(NAMES)
    for name in NAMES:
        assert texts[f"{name}.py"].startswith(f'"""{module_of(name).__doc__[:40]}')
        assert "\nMany trajectories side by side, compiled: " in texts[f"{name}_lanes.py"]
        assert "\nOne trajectory with its variational equations, compiled: " in texts[f"{name}_variational.py"]


def test_the_template_and_its_view_must_fit(equations, monkeypatch):
    spec = kernel(equations("equal_biaxial"), ())
    view = emit_module._view
    monkeypatch.setattr(emit_module, "_view", lambda spec: view(spec) | {"surplus": 1})
    with pytest.raises(KeyError, match="surplus"):
        emit(spec)


def test_a_changed_equation_changes_the_digest(equations):
    eom = equations("equal_biaxial")
    changed = replace(eom, kinetic_energy=2 * eom.kinetic_energy)
    assert kernel(eom, ()).digest != kernel(changed, ()).digest


def test_a_checked_in_module_is_what_the_derivation_emits(walked, tmp_path):
    """The modules of the uniaxial membrane, byte for byte."""
    modules = tuple((name, text) for name, text in walked.modules if name.startswith("uniaxial"))
    assert [name for name, _ in modules] == [f"uniaxial{target.suffix}" for target in TARGETS]
    folder = Path(str(resources.files("delagrange.generated")))
    assert stale(modules, folder) == ()
    write_together(modules, tmp_path)
    assert (
        hashlib.sha256((tmp_path / "uniaxial.py").read_bytes()).digest()
        == hashlib.sha256((folder / "uniaxial.py").read_bytes()).digest()
    )
    (tmp_path / "uniaxial.py").write_text("edited by hand")
    assert stale(modules, tmp_path) == ("uniaxial.py",)


def test_an_output_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match=r"output folder .*file.* cannot be written"):
        write_together((("a.py", ""),), tmp_path / "file")
