"""The compiled flow against SciPy's: states, tangents, extrema, losses, phases, and what it refuses."""

from __future__ import annotations

import importlib.util
import signal
import sys
import time
from dataclasses import replace
from types import ModuleType

import mpmath
import numba
import numpy as np
import pytest
import sympy as sp
from first_order import first_order, lorenz, written
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import delagrange as dl
from delagrange.engines import flow_compiled as module_of_flow
from delagrange.engines.flow import (
    AMPLITUDE,
    BIAS,
    FREQUENCY,
    PHASE,
    FlowPath,
    Source,
    drive_numbers,
    drive_slope,
)
from delagrange.engines.flow_compiled import flow_compiled
from delagrange.engines.flow_scipy import flow_by_scipy, orthonormalised
from delagrange.engines.flows import resolve_flow
from delagrange.model import kernels
from delagrange.problem import status as loss
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import frozen, given_state
from delagrange.problem.problem import Problem, make_problem

NAMES = dl.model_names()
FIELD = dl.Sine(2e6, 380.0, bias=5e5, phase=0.4)
SOURCES = (Source(0, BIAS), Source(1, BIAS), Source(1, AMPLITUDE), Source(1, FREQUENCY), Source(1, PHASE))


def problem_of(name, flowing=False, force=0.3, field=FIELD, held_stretch=2.0):
    held = held_stretch if "shear" in name else None
    problem = make_problem(dl.load_model(name), dl.SHENG_2015, {"relaxation_time": 2e-3}, held, force, field)
    return problem if flowing else frozen(problem)


def path_of(name, flowing=False, tolerance=1e-12, **drives):
    problem = problem_of(name, flowing, **drives)
    return FlowPath(problem, typical_sizes(problem), tolerance)


def start_of(path, **values):
    return given_state(path.problem, values)


def unit_columns(path, more=0):
    """Columns of length 1 in units of the weights along every state variable, then some that are zero."""
    return np.hstack([np.diag(path.weights), np.zeros((len(path.weights), more))])


def lengths(path, matrix):
    return np.linalg.norm(matrix / path.weights[:, None], axis=0)


# --- against SciPy -----------------------------------------------------------------------------------


@pytest.mark.parametrize("flowing", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_both_flows_agree(name, flowing):
    path = path_of(name, flowing)
    state, times = start_of(path), np.linspace(0.001, 0.001 + 1.5 / 380.0, 4)
    columns = unit_columns(path, len(SOURCES))
    sources = (*[None] * len(state), *SOURCES)
    ours, theirs = (flow(path, state, times, columns, sources) for flow in (flow_compiled, flow_by_scipy))
    assert ours.status == theirs.status == loss.COMPLETED
    assert ours.status_time == theirs.status_time == times[-1]
    np.testing.assert_array_equal(ours.state[0], state)
    assert np.max(np.abs(ours.state - theirs.state) / path.weights) < 1e-11
    assert np.all(lengths(path, ours.tangent - theirs.tangent) < 1e-10 * lengths(path, theirs.tangent))
    np.testing.assert_allclose(ours.divergence, theirs.divergence, rtol=0, atol=1e-11)
    np.testing.assert_allclose(ours.maximum, theirs.maximum, rtol=1e-11)
    np.testing.assert_allclose(ours.minimum, theirs.minimum, rtol=1e-11)
    assert np.all(ours.growth == 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_a_frozen_dashpot_does_not_move_and_its_neighbours_do_not(name):
    path = path_of(name)
    state, start = start_of(path), 2 * path.problem.model.COORDINATE_COUNT
    travel = flow_compiled(path, state, np.array([0.0, 0.004]), unit_columns(path))
    np.testing.assert_array_equal(travel.state[-1][start:], state[start:])
    np.testing.assert_array_equal(travel.tangent[start:], np.diag(path.weights)[start:])
    assert np.all(np.isfinite(travel.tangent))


@pytest.mark.parametrize("flowing", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_volumes_grow_by_the_divergence(name, flowing):
    """Liouville: det of the tangent is the exponential of the integrated trace."""
    path = path_of(name, flowing, tolerance=1e-13)
    travel = flow_compiled(path, start_of(path), np.linspace(0.0, 0.004, 9), unit_columns(path))
    determinant = np.linalg.det(travel.tangent / path.weights[:, None])
    assert determinant == pytest.approx(np.exp(travel.divergence[-1]), rel=1e-10)


@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial", "pure_shear_consistent_free"])
def test_the_tangent_is_the_derivative_of_the_flow(name):
    """By central differences of flows of high accuracy, at two steps, for the state and for each number of a drive."""
    path = path_of(name, flowing=True, tolerance=1e-13)
    state, times = start_of(path), np.array([0.0, 0.003])
    sources = (*[None] * len(state), *SOURCES)
    tangent = flow_compiled(path, state, times, unit_columns(path, len(SOURCES)), sources).tangent
    numbers = drive_numbers(path.problem)

    def moved(column, step):
        if sources[column] is None:
            return path, state + step * unit_columns(path)[:, column], step
        place, number = sources[column]
        changed = numbers.copy()
        size = max(abs(changed[place, number]), 1e-2)
        changed[place, number] += step * size
        drives = [dl.Sine(a, max(f, 1.0), bias=b, phase=p) for b, a, f, p in changed]
        return replace(path, problem=replace(path.problem, drives=tuple(drives))), state, step * size

    for column in range(len(sources)):
        errors = []
        for step in (2e-4, 1e-4):
            ends = []
            for sign in (1, -1):
                neighbour, start, size = moved(column, sign * step)
                ends.append((flow_compiled(neighbour, start, times).state[-1], size))
            difference = (ends[0][0] - ends[1][0]) / (ends[0][1] - ends[1][1])
            errors.append(np.linalg.norm((difference - tangent[:, column]) / path.weights))
        size = np.linalg.norm(tangent[:, column] / path.weights)
        assert errors[1] < 1e-5 * size
        rounding = 1e-12 / abs(ends[0][1])
        assert errors[1] < 0.3 * errors[0] + rounding  # of second order in the step


@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial"])
def test_the_error_follows_the_tolerance(name):
    path = path_of(name)
    state, times = start_of(path), np.array([0.0, 0.02])
    best = flow_compiled(replace(path, tolerance=1e-14), state, times, unit_columns(path))
    errors, steps = [], []
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        found = flow_compiled(replace(path, tolerance=tolerance), state, times, unit_columns(path))
        errors.append(np.max(np.abs(found.state[-1] - best.state[-1]) / path.weights))
        off = lengths(path, found.tangent - best.tangent) / lengths(path, best.tangent)
        assert np.max(off) < 3e3 * tolerance
        steps.append(found.steps)
    assert np.all(np.array(errors) < 1e3 * np.array([1e-6, 1e-8, 1e-10, 1e-12]))
    assert errors[0] > 100 * errors[2] and np.all(np.diff(steps) > 0)


@given(
    stretch=st.floats(0.8, 1.8), rate=st.floats(-200, 200), force=st.floats(0.0, 0.6), field=st.floats(0, 2e6)
)
@settings(max_examples=15)
def test_extrema_are_those_of_the_fine_motion(stretch, rate, force, field):
    path = path_of("equal_biaxial", force=force, field=dl.Sine(field, 380.0), tolerance=1e-12)
    state = start_of(path, stretch=stretch, stretch_rate=rate)
    travel = flow_compiled(path, state, np.array([0.0, 0.004]))
    fine = solve_ivp(path.problem.rhs, (0.0, 0.004), state, "DOP853", np.linspace(0, 0.004, 4001),
                     rtol=1e-12, atol=1e-14)  # fmt: skip
    coarse = 0.5 * np.max(np.abs(np.gradient(fine.y[1], fine.t))) * (0.5 * 1e-6) ** 2  # between two samples
    assert travel.status == loss.COMPLETED
    assert -1e-10 <= travel.maximum[0] - fine.y[0].max() <= 1.1 * coarse + 1e-10
    assert -1e-10 <= fine.y[0].min() - travel.minimum[0] <= 1.1 * coarse + 1e-10


def test_extrema_do_not_depend_on_the_times_in_between():
    path = path_of("uniaxial", tolerance=1e-13)
    state = start_of(path)
    few, many = (flow_compiled(path, state, np.linspace(0.0, 0.02, count)) for count in (2, 400))
    np.testing.assert_allclose(few.maximum, many.maximum, rtol=1e-11)
    np.testing.assert_allclose(few.minimum, many.minimum, rtol=1e-11)
    np.testing.assert_allclose(few.state[-1] / path.weights, many.state[-1] / path.weights, atol=1e-10)


# --- growth ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("flow", [flow_compiled, flow_by_scipy])
def test_columns_made_orthonormal_grow_by_the_divergence_together(flow):
    path = path_of("uniaxial", flowing=True, tolerance=1e-12)
    travel = flow(path, start_of(path), np.linspace(0.0, 0.004, 5), unit_columns(path), (), True)
    unitary = travel.tangent / path.weights[:, None]
    np.testing.assert_allclose(unitary.T @ unitary, np.eye(6), atol=1e-14)
    np.testing.assert_allclose(travel.growth.sum(axis=1), np.diff(travel.divergence), atol=1e-10)


def test_growth_is_that_of_scipy_for_a_few_columns(rng):
    path = path_of("uniaxial", flowing=True)
    columns = path.weights[:, None] * rng.standard_normal((6, 3))
    ours, theirs = (
        flow(path, start_of(path), np.linspace(0.0, 0.003, 4), columns, (), True)
        for flow in (flow_compiled, flow_by_scipy)
    )
    np.testing.assert_allclose(ours.growth, theirs.growth, atol=1e-9)
    np.testing.assert_allclose(
        ours.tangent / path.weights[:, None], theirs.tangent / path.weights[:, None], atol=1e-9
    )


def test_nearly_parallel_columns_are_orthonormal_all_the_same(rng):
    path = path_of("uniaxial")
    first = rng.standard_normal(6)
    columns = path.weights[:, None] * (first[:, None] + 1e-9 * rng.standard_normal((6, 3)))
    times = np.array([0.0, 1e-9])
    travel = flow_compiled(path, start_of(path), times, columns, (), True)
    unitary = travel.tangent / path.weights[:, None]
    np.testing.assert_allclose(unitary.T @ unitary, np.eye(3), atol=1e-14)
    assert np.all(travel.growth[0, 1:] < -15)
    again, growth = orthonormalised(travel.tangent, path.weights)
    np.testing.assert_allclose(again, travel.tangent, atol=1e-13)
    np.testing.assert_allclose(growth, 0.0, atol=1e-14)


# --- losses ------------------------------------------------------------------------------------------


LOST = {
    "collapsed": ({"field": 3e7}, dl.Limits(smallest_stretch=1e-2), loss.COLLAPSED),
    "too far": ({"field": 3e7}, dl.Limits(largest_stretch=5.0), loss.DIVERGED),
    "no longer resolved": ({"field": 3e7}, dl.Limits(1e-200, 1e200), loss.DIVERGED),
}


@pytest.mark.parametrize("case", LOST)
@pytest.mark.parametrize("name", ["equal_biaxial", "uniaxial"])
def test_a_loss_is_a_status_with_its_time(name, case):
    drives, limits, status = LOST[case]
    path = replace(path_of(name, **drives), limits=limits, tolerance=1e-11)
    times = np.linspace(0.0, 0.01, 41)
    ours, theirs = (
        flow(path, start_of(path), times, unit_columns(path)) for flow in (flow_compiled, flow_by_scipy)
    )
    assert ours.status == theirs.status == status
    assert ours.status_time == pytest.approx(theirs.status_time, rel=1e-7)
    kept = times <= ours.status_time
    assert 1 < kept.sum() < len(times)
    for travel in (ours, theirs):
        assert np.all(np.isfinite(travel.state[kept])) and np.all(np.isnan(travel.state[~kept]))
        assert np.all(np.isfinite(travel.divergence[kept])) and np.all(np.isnan(travel.divergence[~kept]))
    if status == loss.COLLAPSED or case == "too far":
        bound = 1e-2**-0.5 if case == "collapsed" and name == "equal_biaxial" else 5.0
        np.testing.assert_allclose(ours.maximum, theirs.maximum, rtol=1e-7)
        assert ours.maximum[0] == pytest.approx(bound, rel=1e-7) or name == "uniaxial"
        principal = path.problem.principal_stretches(
            0.0, np.array([*ours.maximum, *start_of(path)[len(ours.maximum) :]])
        )
        assert loss.margin(principal, limits) == pytest.approx(0.0, abs=1e-6)


def test_a_state_that_is_lost_from_the_start_is_lost_there():
    path = replace(path_of("equal_biaxial"), limits=dl.Limits(largest_stretch=1.5))
    for flow in (flow_compiled, flow_by_scipy):
        travel = flow(path, start_of(path, stretch=2.0), np.array([1.0, 2.0]))
        assert travel.status == loss.DIVERGED and travel.status_time == pytest.approx(1.0, abs=1e-12)
        np.testing.assert_allclose(travel.maximum, 2.0, rtol=1e-9)


# --- drives ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def integral(tmp_path_factory):
    """place' = supply: the integral of a drive, known in closed form."""
    folder = tmp_path_factory.mktemp("integral")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        yield written(first_order("integral", {"place": sp.Symbol("supply")}, (0,), ("supply",)), folder)
        forget("integral")


def forget(name):
    """Let another module of that name be emitted and imported."""
    for module in (name, f"{name}_variational"):
        sys.modules.pop(module, None)
    kernels.load_kernel.cache_clear()


def exact_swing(drive, start, end):
    """The integral of the sine from start to end, and its slopes by phase and by frequency, in mpmath's precision."""
    first, last, phase = (mpmath.mpf(value) for value in (start, end, drive.phase))
    rate = 2 * mpmath.pi * mpmath.mpf(drive.frequency)
    swing = (mpmath.cos(rate * first + phase) - mpmath.cos(rate * last + phase)) / rate
    turned = (mpmath.sin(rate * last + phase) - mpmath.sin(rate * first + phase)) / rate
    by_frequency = mpmath.quad(
        lambda time: 2 * mpmath.pi * time * mpmath.cos(rate * time + phase), mpmath.linspace(first, last, 9)
    )
    return swing, turned, by_frequency


@pytest.mark.parametrize("start", [0.0, 20.0, 1e6 / 3])
def test_the_phase_is_kept_after_many_periods(integral, start):
    """Half a million seconds are 2.7e8 periods: their product with the frequency, rounded, is off by 2e-7 rad."""
    drive = dl.Sine(1.0, 801.0 / 0.997, phase=0.3)
    path = FlowPath(Problem(integral, (drive,), ()), np.array([1e-4]), 1e-13)
    times = start + np.array([0.0, 0.25, 0.7, 2.0]) / drive.frequency
    sources = (Source(0, AMPLITUDE), Source(0, PHASE), Source(0, FREQUENCY))
    travel = flow_compiled(path, np.zeros(1), times, np.zeros((1, 3)), sources)
    with mpmath.workdps(40):
        swing, turned, by_frequency = (float(value) for value in exact_swing(drive, times[0], times[-1]))
    resolution = 1e-4 * 1e-12 + 4e-16 * start  # of the times themselves
    assert travel.state[-1, 0] == pytest.approx(swing, abs=resolution)
    assert travel.tangent[0, 0] == pytest.approx(swing, abs=resolution)
    assert travel.tangent[0, 1] == pytest.approx(turned, abs=resolution)
    assert travel.tangent[0, 2] == pytest.approx(by_frequency, abs=(1 + 10 * start) * resolution)


@given(
    bias=st.floats(-2, 2), amplitude=st.floats(-2, 2), frequency=st.floats(0.5, 5), phase=st.floats(-3, 3),
    time=st.floats(0, 2),
)  # fmt: skip
def test_slopes_of_a_drive_are_its_derivatives(bias, amplitude, frequency, phase, time):
    numbers = np.array([bias, amplitude, frequency, phase])

    def value(numbers):
        bias, amplitude, frequency, phase = numbers
        return bias + amplitude * np.sin(2 * np.pi * frequency * time + phase)

    for number in (BIAS, AMPLITUDE, FREQUENCY, PHASE):
        step = 1e-200 * (np.arange(4) == number)
        expected = value(numbers + 1j * step).imag / 1e-200
        assert drive_slope(numbers, number, time) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_a_drive_of_another_kind_is_refused():
    path = path_of("equal_biaxial")
    problem = replace(path.problem, drives=(dl.Ramp(0.0, 1.0, 1.0), path.problem.drives[1]))
    for flow in (flow_compiled, flow_by_scipy):
        with pytest.raises(ValueError, match=r"force must be constant or a delagrange.Sine here, got Ramp"):
            flow(replace(path, problem=problem), start_of(path), np.array([0.0, 1.0]))


# --- another system ----------------------------------------------------------------------------------


def test_the_lorenz_system_goes_through_the_same_code(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    module = written(lorenz(), tmp_path)
    path = FlowPath(Problem(module, (), (10.0, 28.0, 8 / 3)), np.full(3, 10.0), 1e-12)
    assert resolve_flow(path.problem) is flow_compiled
    start, times = np.ones(3), np.linspace(0.0, 3.0, 31)
    ours, theirs = (
        flow(path, start, times, 10 * np.eye(3), (), True) for flow in (flow_compiled, flow_by_scipy)
    )
    np.testing.assert_allclose(ours.state, theirs.state, atol=1e-9)
    np.testing.assert_allclose(ours.growth, theirs.growth, atol=1e-8)
    assert ours.divergence[-1] == pytest.approx(-3.0 * (10 + 1 + 8 / 3), rel=1e-13)
    assert ours.maximum.shape == ours.minimum.shape == (0,)
    forget("lorenz")


# --- calls -------------------------------------------------------------------------------------------


def test_the_result_does_not_depend_on_when_the_keyboard_is_heard(monkeypatch):
    path = path_of("uniaxial", flowing=True)
    arguments = path, start_of(path), np.linspace(0.0, 0.004, 5), unit_columns(path), (), True
    whole = flow_compiled(*arguments)
    monkeypatch.setattr(module_of_flow, "_BUDGET", 1)
    pieces = flow_compiled(*arguments)
    assert pieces.steps == whole.steps
    np.testing.assert_allclose(pieces.state / path.weights, whole.state / path.weights, atol=1e-13)
    np.testing.assert_allclose(pieces.growth, whole.growth, atol=1e-12)
    np.testing.assert_allclose(pieces.maximum, whole.maximum, rtol=1e-13)


def test_the_keyboard_is_heard():
    path = path_of("uniaxial")
    start, times = start_of(path), np.array([0.0, 1e4])
    flow_compiled(path, start, np.array([0.0, 1e-4]))

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        begun = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            flow_compiled(path, start, times, unit_columns(path))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert time.perf_counter() - begun < 2.0


def test_the_interpreter_finds_the_same(monkeypatch):
    """With the compiler switched off, where a place outside of an array would be an error."""
    path = path_of("equal_biaxial", flowing=True, tolerance=1e-9)
    arguments = (
        path,
        start_of(path),
        np.array([0.0, 2e-4, 5e-4]),
        unit_columns(path, 1)[:, 1:],
        (None, None, SOURCES[3]),
        True,
    )
    compiled = flow_compiled(*arguments)
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    source = importlib.util.find_spec("delagrange.generated.equal_biaxial_variational")
    plain = importlib.util.module_from_spec(source)
    source.loader.exec_module(plain)
    monkeypatch.setattr(module_of_flow, "load_kernel", lambda name: plain)
    found = flow_compiled(*arguments)
    assert found.steps == compiled.steps
    np.testing.assert_allclose(found.state / path.weights, compiled.state / path.weights, atol=1e-12)
    np.testing.assert_allclose(found.growth, compiled.growth, atol=1e-10)
    np.testing.assert_allclose(found.maximum, compiled.maximum, rtol=1e-12)
    lost = replace(path, limits=dl.Limits(largest_stretch=1.0 + 1e-3))
    assert flow_compiled(lost, *arguments[1:3]).status == loss.DIVERGED


def test_a_single_time_is_the_start():
    path = path_of("equal_biaxial")
    for flow in (flow_compiled, flow_by_scipy):
        travel = flow(path, start_of(path), np.array([0.3]), unit_columns(path))
        assert travel.status == loss.COMPLETED and travel.status_time == 0.3 and travel.steps == 0
        np.testing.assert_array_equal(travel.state, [start_of(path)])
        np.testing.assert_array_equal(travel.tangent, unit_columns(path))


@pytest.mark.parametrize("flow", [flow_compiled, flow_by_scipy])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"state": np.ones(2)}, r"state must have the shape \(3,\), got \(2,\)"),
        ({"tangent": np.ones(3)}, r"tangent must have the shape \(3, 0\), got \(3,\)"),
        ({"tangent": np.ones((2, 1))}, r"tangent must have the shape \(3, 1\), got \(2, 1\)"),
        ({"times": [0.0, 0.0]}, "times must be strictly increasing"),
        ({"times": [0.0, np.inf]}, "times must be finite"),
        ({"sources": (None, None)}, "sources must be one a column of the tangent, 1, got 2"),
        ({"sources": (Source(2, BIAS),)}, "place of a source must be an integer from 0 to 1, got 2"),
        ({"sources": (Source(0, 4),)}, "number of a source must be an integer from 0 to 3, got 4"),
        ({"weights": np.ones(2)}, r"weights of the path must have the shape \(3,\), got \(2,\)"),
        ({"weights": np.zeros(3)}, "weights of the path must be positive"),
        ({"tolerance": 0.0}, "tolerance of the path must be positive"),
    ],
)
def test_what_does_not_fit_is_refused_before_compiled_code_runs(flow, change, message):
    path = path_of("equal_biaxial")
    of_path = {name: change[name] for name in ("weights", "tolerance") if name in change}
    rest = {"state": start_of(path), "times": [0.0, 1e-3], "tangent": np.ones((3, 1)), "sources": ()} | {
        name: value for name, value in change.items() if name not in of_path
    }
    with pytest.raises(ValueError, match=message):
        flow(replace(path, **of_path), **rest)


# --- which flow --------------------------------------------------------------------------------------


def without_kernel():
    source = dl.load_model("equal_biaxial")
    own = ModuleType("my_own")
    vars(own).update({name: value for name, value in vars(source).items() if not name.startswith("__")})
    return own


def test_auto_is_compiled_where_there_is_a_kernel():
    problem = problem_of("equal_biaxial")
    assert resolve_flow(problem) is resolve_flow(problem, "compiled") is flow_compiled
    assert resolve_flow(problem, "scipy") is flow_by_scipy
    with pytest.raises(ValueError, match="engine must be one of auto, compiled, core, scipy"):
        resolve_flow(problem, "fast")


def test_a_module_without_a_kernel_goes_by_scipy(recwarn):
    problem = replace(problem_of("equal_biaxial"), model=without_kernel())
    assert resolve_flow(problem) is flow_by_scipy and not recwarn.list
    with pytest.raises(
        ValueError, match="no variational kernel stands beside the module of the model equal_bi"
    ):
        resolve_flow(problem, "compiled")
    path = FlowPath(problem, np.ones(3))
    with pytest.raises(RuntimeError, match="the model equal_biaxial has no variational kernel"):
        flow_compiled(path, start_of(path), np.array([0.0, 1e-3]))


@pytest.fixture
def forgetful():
    """What is known about this machine's compiler is found out anew, before and after."""
    for known in (kernels.why_not_compiled, kernels.load_kernel):
        known.cache_clear()
    yield
    for known in (kernels.why_not_compiled, kernels.load_kernel):
        known.cache_clear()


@pytest.mark.parametrize("obstacle", ["switched off", "broken kernel"])
def test_without_a_compiler_auto_is_scipy_and_says_so(obstacle, monkeypatch, forgetful):
    def broken(kernel):
        raise NotImplementedError("no such instruction")

    if obstacle == "switched off":
        monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
        reason = "NUMBA_DISABLE_JIT is set"
    else:
        monkeypatch.setattr(kernels, "compile_tangents", broken)
        reason = "equal_biaxial_variational cannot be compiled here: no such instruction"
    problem = problem_of("equal_biaxial")
    with pytest.warns(UserWarning, match=f"compiled code cannot run here .*{reason}.*engine 'scipy'"):
        assert resolve_flow(problem) is flow_by_scipy
    with pytest.raises(
        ValueError, match=f"engine 'compiled' cannot run this: .*{reason}.*use 'scipy', or 'auto'"
    ):
        resolve_flow(problem, "compiled")


# --- where a motion starts ---------------------------------------------------------------------------


def test_a_given_state_is_the_reference_state_with_what_is_given():
    path = path_of("uniaxial")
    state = start_of(path, stretch_2=1.3, inelastic_stretch_1=0.9)
    np.testing.assert_array_equal(state, [1.0, 1.3, 0.0, 0.0, 0.9, 1.0])
    with pytest.raises(ValueError, match="stretch_2 must be a single number"):
        start_of(path, stretch_2=[1.0, 1.1])
    with pytest.raises(ValueError, match="unknown state variable 'stretch'"):
        start_of(path, stretch=1.0)


def test_sizes_are_ones_and_the_fastest_angular_frequency():
    """Equal-biaxial, undeformed, closed form: 2 pi times 918.9 Hz."""
    problem = problem_of("equal_biaxial", force=0.0, field=0.0)
    L, H, density, _, alpha, beta, _ = problem.parameters
    fastest = np.sqrt(18 * (alpha + beta) / (density * H**2 * (2 + L**2 / H**2)))
    np.testing.assert_allclose(typical_sizes(problem), [1.0, fastest, 1.0], rtol=1e-12)
