"""The flow through the compiled core against SciPy's: states, tangents, growth, divergence, extrema, losses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from core_builds import MODELS
from scipy.integrate import solve_ivp
from test_core_engine import written

import delagrange as dl
from delagrange.engines.core_flow import flow_by_core
from delagrange.engines.flow import AMPLITUDE, BIAS, FREQUENCY, PHASE, FlowPath, Source
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.problem import status as loss
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import frozen, given_state
from delagrange.problem.problem import Problem, make_problem

FIELD = dl.Sine(2e6, 380.0, bias=5e5, phase=0.4)
SOURCES = (Source(0, BIAS), Source(1, BIAS), Source(1, AMPLITUDE), Source(1, FREQUENCY), Source(1, PHASE))


def path_of(name, flowing=False, tolerance=1e-12, force=0.3, field=FIELD):
    held = 2.0 if "shear" in name else None
    problem = make_problem(dl.load_model(name), dl.SHENG_2015, {"relaxation_time": 2e-3}, held, force, field)
    problem = problem if flowing else frozen(problem)
    return FlowPath(problem, typical_sizes(problem), tolerance)


def unit_columns(path, more=0):
    return np.hstack([np.diag(path.weights), np.zeros((len(path.weights), more))])


def lengths(path, matrix):
    return np.linalg.norm(matrix / path.weights[:, None], axis=0)


@pytest.mark.parametrize("flowing", [True, False])
@pytest.mark.parametrize("name", MODELS)
def test_both_flows_agree(name, flowing):
    """From a time that is not zero, with columns by the state and by every number of a drive."""
    path = path_of(name, flowing)
    state, times = given_state(path.problem, {}), np.linspace(0.001, 0.001 + 1.5 / 380.0, 4)
    columns, sources = unit_columns(path, len(SOURCES)), (*[None] * len(path.weights), *SOURCES)
    ours, theirs = (flow(path, state, times, columns, sources) for flow in (flow_by_core, flow_by_scipy))
    assert ours.status == theirs.status == loss.COMPLETED
    assert ours.status_time == theirs.status_time == times[-1]
    np.testing.assert_array_equal(ours.state[0], state)
    assert np.max(np.abs(ours.state - theirs.state) / path.weights) < 1e-11
    assert np.all(lengths(path, ours.tangent - theirs.tangent) < 1e-10 * lengths(path, theirs.tangent))
    np.testing.assert_allclose(ours.divergence, theirs.divergence, rtol=0, atol=1e-11)
    np.testing.assert_allclose(ours.maximum, theirs.maximum, rtol=1e-11)
    np.testing.assert_allclose(ours.minimum, theirs.minimum, rtol=1e-11)
    assert np.all(ours.growth == 0.0)


@pytest.mark.parametrize("count", [0, 1, 7, 8, 15, 16, 23])
def test_any_number_of_columns(count, rng):
    """One more and one less than vectors hold; each goes its way whatever columns are beside it."""
    path = path_of("uniaxial", flowing=True, tolerance=1e-11)
    state, times = given_state(path.problem, {}), np.array([0.0, 0.002])
    columns = path.weights[:, None] * rng.standard_normal((6, count))
    base = flow_by_scipy(path, state, times, unit_columns(path)).tangent / path.weights
    found = flow_by_core(path, state, times, columns)
    expected = base @ columns
    assert found.tangent.shape == (6, count)
    assert np.all(lengths(path, found.tangent - expected) < 1e-9 * lengths(path, expected) + 1e-300)


@pytest.mark.parametrize("name", MODELS)
def test_volumes_grow_by_the_divergence(name):
    path = path_of(name, flowing=True, tolerance=1e-13)
    travel = flow_by_core(path, given_state(path.problem, {}), np.linspace(0.0, 0.004, 9), unit_columns(path))
    determinant = np.linalg.det(travel.tangent / path.weights[:, None])
    assert determinant == pytest.approx(np.exp(travel.divergence[-1]), rel=1e-10)


def test_columns_made_orthonormal_grow_as_those_of_scipy(rng):
    path = path_of("uniaxial", flowing=True)
    columns = path.weights[:, None] * rng.standard_normal((6, 4))
    start = given_state(path.problem, {})
    ours, theirs = (
        flow(path, start, np.linspace(0.0, 0.003, 4), columns, (), True)
        for flow in (flow_by_core, flow_by_scipy)
    )
    np.testing.assert_allclose(ours.growth, theirs.growth, atol=1e-9)
    ours, theirs = (travel.tangent / path.weights[:, None] for travel in (ours, theirs))
    np.testing.assert_allclose(ours, theirs, atol=1e-9)
    np.testing.assert_allclose(ours.T @ ours, np.eye(4), atol=1e-14)


@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial"])
def test_the_error_follows_the_tolerance(name):
    path = path_of(name)
    state, times = given_state(path.problem, {}), np.array([0.0, 0.02])
    best = flow_by_core(replace(path, tolerance=1e-14), state, times, unit_columns(path))
    errors, steps = [], []
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        found = flow_by_core(replace(path, tolerance=tolerance), state, times, unit_columns(path))
        errors.append(np.max(np.abs(found.state[-1] - best.state[-1]) / path.weights))
        off = lengths(path, found.tangent - best.tangent) / lengths(path, best.tangent)
        assert np.max(off) < 3e3 * tolerance
        steps.append(found.steps)
    assert np.all(np.array(errors) < 1e3 * np.array([1e-6, 1e-8, 1e-10, 1e-12]))
    assert errors[0] > 100 * errors[2] and np.all(np.diff(steps) > 0)


def test_extrema_are_those_of_the_fine_motion():
    path = path_of("equal_biaxial", force=0.45, field=dl.Sine(1.5e6, 380.0))
    state = given_state(path.problem, {"stretch": 1.4, "stretch_rate": -150.0})
    travel = flow_by_core(path, state, np.array([0.0, 0.004]))
    fine = solve_ivp(
        path.problem.rhs, (0.0, 0.004), state, "DOP853", np.linspace(0, 0.004, 4001), rtol=1e-12, atol=1e-14
    )
    coarse = 0.5 * np.max(np.abs(np.gradient(fine.y[1], fine.t))) * (0.5 * 1e-6) ** 2  # between two samples
    assert -1e-10 <= travel.maximum[0] - fine.y[0].max() <= 1.1 * coarse + 1e-10
    assert -1e-10 <= fine.y[0].min() - travel.minimum[0] <= 1.1 * coarse + 1e-10


@pytest.mark.parametrize(
    ("limits", "status"),
    [
        (dl.Limits(smallest_stretch=1e-2), loss.COLLAPSED),
        (dl.Limits(largest_stretch=5.0), loss.DIVERGED),
        (dl.Limits(1e-200, 1e200), loss.DIVERGED),  # in a finite time, which no step resolves
    ],
)
@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial"])
def test_a_loss_is_a_status_with_its_time(name, limits, status):
    path = replace(path_of(name, field=3e7, tolerance=1e-11), limits=limits)
    times, start = np.linspace(0.0, 0.01, 41), given_state(path.problem, {})
    ours, theirs = (flow(path, start, times, unit_columns(path)) for flow in (flow_by_core, flow_by_scipy))
    assert ours.status == status
    assert ours.status_time == pytest.approx(theirs.status_time, rel=1e-7)
    kept = times <= ours.status_time
    assert 1 < kept.sum() < len(times)
    assert np.all(np.isfinite(ours.state[kept])) and np.all(np.isnan(ours.state[~kept]))
    assert np.all(np.isfinite(ours.divergence[kept])) and np.all(np.isnan(ours.divergence[~kept]))
    if limits.largest_stretch < 1e200:
        np.testing.assert_allclose(ours.maximum, theirs.maximum, rtol=1e-7)


def test_a_state_that_is_lost_from_the_start_is_lost_there():
    path = replace(path_of("equal_biaxial"), limits=dl.Limits(largest_stretch=1.5))
    travel = flow_by_core(path, given_state(path.problem, {"stretch": 2.0}), np.array([1.0, 2.0]))
    assert travel.status == loss.DIVERGED and travel.status_time == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(travel.maximum, 2.0, rtol=1e-9)


def test_a_single_time_is_the_start():
    path = path_of("equal_biaxial")
    start = given_state(path.problem, {})
    travel = flow_by_core(path, start, np.array([0.3]), unit_columns(path))
    assert travel.status == loss.COMPLETED and travel.status_time == 0.3 and travel.steps == 0
    np.testing.assert_array_equal(travel.state, [start])
    np.testing.assert_array_equal(travel.tangent, unit_columns(path))


def test_a_spring_that_locks_stops_the_flow(tmp_path):
    from pathlib import Path

    from delagrange.derive.model_file.file import read_model_file
    from delagrange.derive.pipeline import description_spec

    file = Path(__file__).parents[1] / "models" / "gent_two_branches.toml"
    gent = written(description_spec(read_model_file(file)), tmp_path)
    problem = make_problem(gent, None, {}, None, 0.5, 4e7)
    path = FlowPath(problem, typical_sizes(problem), 1e-10, dl.Limits(1e-9, 1e9))
    start = given_state(problem, {})
    ours, theirs = (flow(path, start, np.linspace(0, 0.01, 21)) for flow in (flow_by_core, flow_by_scipy))
    assert ours.status == theirs.status == loss.LOCKED
    assert ours.status_time == pytest.approx(theirs.status_time, rel=1e-6)


# --- functions beyond arithmetic, and systems that are no membranes ----------------------------------


@pytest.mark.parametrize("materials", [("Ogden", "neo-Hookean"), ("Gent", "Arruda-Boyce")])
def test_energies_of_any_form_go_through_the_core(materials, tmp_path, rng):
    """Powers of any exponent and exponentials; rates, Jacobians and energies against the module's."""
    from described import described, parameters_of, state_of

    from delagrange.derive.pipeline import description_spec

    module = written(description_spec(described("uniaxial", *materials)), tmp_path)
    parameters = parameters_of(module)
    state = state_of(module, rng, parameters)
    drives = (dl.Constant(0.4), dl.Constant(1e6))
    problem = Problem(module, drives[: len(module.INPUTS)], tuple(parameters))
    path = FlowPath(problem, np.maximum(np.abs(state), 1.0), 1e-11)
    ours, theirs = (
        flow(path, state, np.array([0.0, 5e-4]), unit_columns(path)) for flow in (flow_by_core, flow_by_scipy)
    )
    assert ours.status == theirs.status == loss.COMPLETED
    assert np.max(np.abs(ours.state - theirs.state) / path.weights) < 1e-9
    assert np.all(lengths(path, ours.tangent - theirs.tangent) < 1e-8 * lengths(path, theirs.tangent))


def test_the_lorenz_system_goes_through_the_same_code(tmp_path):
    """Its exponents sum to the trace of its Jacobian, -(sigma + 1 + beta), and the largest is some 0.906."""
    from first_order import lorenz

    module = written(lorenz(), tmp_path)
    path = FlowPath(Problem(module, (), (10.0, 28.0, 8.0 / 3.0)), np.ones(3), 1e-10)
    times = np.linspace(0.0, 200.0, 401)
    travel = flow_by_core(path, np.array([1.0, 1.0, 20.0]), times, np.eye(3), (), True)
    exponents = travel.growth[40:].sum(axis=0) / (times[-1] - times[40])
    assert exponents.sum() == pytest.approx(-(10.0 + 1.0 + 8.0 / 3.0), rel=1e-9)
    assert exponents[0] == pytest.approx(0.906, abs=0.05) and abs(exponents[1]) < 0.02
