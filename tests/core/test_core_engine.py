"""The compiled core as an engine: the answers of the others, each run to its tolerance, and how runs are lost."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from core_builds import (
    MODELS,
    by_numpy,
    even_samples,
    integrated,
    mixed_lanes,
    problem_of,
    settings_of,
    start_of,
)
from first_order import first_order
from scipy.integrate import solve_ivp

import delagrange as dl
from delagrange.core import kernel, structures
from delagrange.core.kernel import load_core
from delagrange.core.structures import AMPLITUDE, FREQUENCY, LEVEL, PHASE, UNRESOLVED
from delagrange.derive.emit.c_header import emit_header
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.pipeline import description_spec
from delagrange.engines.core_drives import piece_rows
from delagrange.engines.core_engine import integrate_by_core, parameter_rows
from delagrange.engines.lanes import Sampling
from delagrange.problem import status as loss
from delagrange.problem.problem import make_problem


def errors(found, exact, duration):
    """By measure, the error of each lane relative to the size of what is measured in that lane."""
    sizes = np.maximum(np.nanmax(np.abs(exact.samples), axis=0), np.abs(exact.state))
    count = len(exact.maximum)
    scale = {"state": sizes, "samples": sizes, "status_time": duration}
    by_measure = {}
    for name in ("maximum", "minimum", "mean", "mean_square", "state", "samples", "status_time"):
        ours, theirs = getattr(found, name), getattr(exact, name)
        np.testing.assert_array_equal(np.isfinite(ours), np.isfinite(theirs), err_msg=name)
        known = np.where(np.isfinite(theirs), theirs, 0.0)
        error = np.abs(np.where(np.isfinite(ours), ours, 0.0) - known) / scale.get(name, sizes[:count])
        by_measure[name] = float(np.max(error))
    return by_measure


# --- the answers -------------------------------------------------------------------------------------


@pytest.mark.parametrize("window", [None, (1.7e-3, 4.4e-3)])
@pytest.mark.parametrize("model", MODELS)
def test_all_measures_are_those_of_the_numpy_engine(model, window, rng):
    """Easy, hard and lost lanes."""
    problem, count, duration = mixed_lanes(model, 40, rng), 40, 6e-3
    state, sampling = start_of(problem, count), even_samples(count, duration, 13)
    exact = by_numpy(problem, state, settings_of(duration, 1e-13, window, engine="numpy"), sampling)
    assert 0 < np.count_nonzero(exact.status) < count
    most = 100 if model == "pure_shear_as_printed" else 15
    for rtol in (1e-5, 1e-7, 1e-9, 1e-11):
        ours = integrate_by_core(problem, state, settings_of(duration, rtol, window), sampling)
        np.testing.assert_array_equal(ours.status, exact.status)
        for name, error in errors(ours, exact, duration).items():
            assert error < most * rtol, (name, rtol)


@pytest.mark.parametrize(
    "force",
    [
        dl.Constant(0.4),
        dl.Sine(0.3, 180.0, bias=0.2, phase=1.0),
        dl.Step(0.5, 2.1e-3, before=0.1),
        dl.Ramp(0.0, 0.5, duration=3e-3, begin=1.3e-3),
        dl.Tabulated([0.0, 1e-3, 2.5e-3, 6e-3, 0.1], [0.0, 0.4, -0.1, 0.5, 0.2]),
    ],
    ids=str,
)
def test_every_drive_is_followed(force):
    problem = problem_of(
        "equal_biaxial", force, dl.Sine(np.array([0.0, 3e6, 6e7]), np.array([300.0, 410.0, 370.0]))
    )
    state, sampling = start_of(problem, 3), even_samples(3, 6e-3, 13)
    exact = by_numpy(problem, state, settings_of(6e-3, 1e-13, engine="numpy", limits=dl.Limits()), sampling)
    ours = integrate_by_core(problem, state, settings_of(6e-3, 1e-10, limits=dl.Limits()), sampling)
    np.testing.assert_array_equal(ours.status, exact.status)
    for name, error in errors(ours, exact, 6e-3).items():
        assert error < 1e-8, name


def test_tolerances_may_differ_from_state_to_state():
    """A rate that is hardly held to anything, and is so wrong by more; the dashpot likewise."""
    problem = problem_of("equal_biaxial", 0.3, dl.Sine(np.array([2e6]), 300.0))
    state, settings = start_of(problem, 1), settings_of(0.01, 1e-13)
    tight, loose = np.full(3, 1e-15), np.array([1e-15, 1e-2, 1e-15])
    core, steps = load_core(problem.model), []
    for atol in (tight, loose):
        outcome = integrated(
            core, problem, state, replace(settings, control=replace(settings.control, atol=atol))
        )
        steps.append(int(outcome.steps[0]))
    assert steps[1] < steps[0]


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_change_no_bit(threads, rng):
    problem = mixed_lanes("equal_biaxial", 100, rng)
    state = start_of(problem, 100)
    one, many = (
        integrate_by_core(problem, state, settings_of(2e-3, 1e-6, threads=count)) for count in (1, threads)
    )
    for name in ("maximum", "state", "steps", "status_time"):
        np.testing.assert_array_equal(getattr(one, name), getattr(many, name))


# --- extrema -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("rtol", [1e-2, 1e-4, 1e-7])
@pytest.mark.parametrize("model", MODELS)
def test_no_sample_lies_beyond_the_extrema_and_one_is_near(model, rtol, rng):
    """The extrema are those of the interpolant, also where it turns several times in a step."""
    count = 24
    field = dl.Sine(rng.uniform(1e5, 8e6, count), rng.uniform(50.0, 4000.0, count))
    problem, duration = problem_of(model, 0.3, field), 0.02
    state, settings = start_of(problem, count), settings_of(duration, rtol, limits=dl.Limits())
    sampled = integrate_by_core(problem, state, settings, even_samples(count, duration, 20_001))
    plain = integrate_by_core(problem, state, settings)
    kept = np.flatnonzero(sampled.status == loss.COMPLETED)
    assert len(kept) > 5
    values = sampled.samples[:, : len(plain.maximum), kept]
    highest, lowest = values.max(axis=0), values.min(axis=0)
    swing = highest - lowest
    assert np.all(plain.maximum[:, kept] >= highest - 1e-9 * swing)
    assert np.all(plain.minimum[:, kept] <= lowest + 1e-9 * swing)
    assert np.all(plain.maximum[:, kept] <= highest + 1e-3 * swing)
    assert np.all(plain.minimum[:, kept] >= lowest - 1e-3 * swing)


def test_motions_of_the_size_of_rounding_cost_no_more_than_others():
    """A membrane at rest turns by noise in every step; were each looked into, a run would take twice the time."""
    still = problem_of("uniaxial", 0.0, dl.Sine(np.zeros(640), 300.0))
    times = {}
    for name, problem in (
        ("still", still),
        ("moving", problem_of("uniaxial", 0.0, dl.Sine(np.full(640, 3e6), 300.0))),
    ):
        state, settings = start_of(problem, 640), settings_of(0.05, 1e-9)
        core, spent = load_core(problem.model), []
        for _ in range(3):
            outcome, seconds = timed(lambda p=problem, s=state, c=core, t=settings: integrated(c, p, s, t))
            spent.append(seconds / outcome.steps.sum())
        times[name] = min(spent)
    assert times["still"] < 1.35 * times["moving"]
    assert np.all(np.abs(outcome.maximum) < 3)


def timed(function):
    from time import thread_time

    begin = thread_time()
    found = function()
    return found, thread_time() - begin


# --- losses ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def gent(tmp_path_factory):
    """A membrane whose springs lock, with its header, as a user has it."""
    from pathlib import Path

    file = Path(__file__).parents[1] / "models" / "gent_two_branches.toml"
    return written(description_spec(read_model_file(file)), tmp_path_factory.mktemp("gent"))


def written(spec, folder):
    """The NumPy module of a model, with its header beside it, imported."""
    from importlib.util import module_from_spec, spec_from_file_location

    module = emit(spec)
    (folder / f"{spec.name}.py").write_text(module, encoding="utf-8")
    (folder / f"{spec.name}.h").write_text(emit_header(spec, module), encoding="utf-8")
    found = spec_from_file_location(spec.name, folder / f"{spec.name}.py")
    imported = module_from_spec(found)
    found.loader.exec_module(imported)
    return imported


def test_a_spring_that_locks_is_told_from_a_collapse(gent):
    field = dl.Sine(np.array([1e6, 1.5e7, 4e7, 1e8]), 371.0, phase=0.7)
    problem = gent_problem(gent, 0.5, field)
    state, sampling = start_of(problem, 4), even_samples(4, 5e-3, 21)
    for limits in (dl.Limits(), dl.Limits(0.3, 90.0), dl.Limits(1e-3, 2.0)):
        exact = by_numpy(problem, state, settings_of(5e-3, 1e-12, engine="numpy", limits=limits), sampling)
        ours = integrate_by_core(problem, state, settings_of(5e-3, 1e-9, limits=limits), sampling)
        same = (ours.status == exact.status) | (ours.status == loss.LOCKED) & (exact.status == loss.LOCKED)
        assert np.all(same), (limits, ours.status, exact.status)
        assert np.any(ours.status != loss.COMPLETED)
        np.testing.assert_allclose(ours.status_time, exact.status_time, rtol=1e-6)


def gent_problem(model, force, field):
    return make_problem(model, None, {}, None, force, field)


def test_what_no_step_resolves_is_unresolved():
    """Without limits a membrane that is pulled in runs away in a finite time, which no step resolves."""
    problem = problem_of("equal_biaxial", 0.3, dl.Constant(np.array([3e7])))
    core, state = load_core(problem.model), start_of(problem, 1)
    outcome = integrated(core, problem, state, settings_of(0.01, 1e-9, limits=dl.Limits(1e-200, 1e200)))
    assert outcome.status[0] == UNRESOLVED and 0 < outcome.status_time[0] < 0.01
    named = integrate_by_core(problem, state, settings_of(0.01, 1e-9, limits=dl.Limits(1e-200, 1e200)))
    assert named.status[0] == loss.DIVERGED


def test_a_state_that_is_lost_from_the_start_is_lost_there():
    problem = problem_of("equal_biaxial", 0.3, dl.Sine(np.full(3, 1e6), 300.0))
    state = start_of(problem, 3)
    state[0] = [2.5, 1.0, 0.1]
    outcome = integrate_by_core(problem, state, settings_of(1e-3, 1e-8, limits=dl.Limits(0.12, 2.2)))
    np.testing.assert_array_equal(outcome.status, [loss.DIVERGED, loss.COMPLETED, loss.COLLAPSED])
    np.testing.assert_array_equal(outcome.status_time, [0.0, 1e-3, 0.0])
    np.testing.assert_array_equal(outcome.state[0, [0, 2]], [2.5, 0.1])


# --- phases ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def integral(tmp_path_factory):
    """place' = speed, speed' = supply: twice the integral of a drive, known in closed form."""
    import sympy as sp

    rates = {"place": sp.Symbol("speed"), "speed": sp.Symbol("supply")}
    spec = first_order("integral", rates, (0, 0), ("supply",), coordinate_count=1)
    return written(spec, tmp_path_factory.mktemp("integral"))


@pytest.mark.parametrize("start", [0.0, 20.0, 1e6 / 3, 1.3e6])
def test_the_phase_is_exact_after_a_billion_turns_everywhere(integral, start):
    """Lanes, a single trajectory and tangents; in mpmath's precision, to a microturn of the drive."""
    frequency, phase, periods = 801.0 / 0.997, 0.3, 2.7
    stop = start + periods / frequency
    core = load_core(integral)
    drives = np.zeros((1, 5, 1))
    drives[0, AMPLITUDE], drives[0, FREQUENCY], drives[0, PHASE] = 1.0, frequency, phase / (2 * np.pi)
    with mpmath.workdps(50):
        rate = 2 * mpmath.pi * mpmath.mpf(frequency)
        swing = (mpmath.cos(rate * start + phase) - mpmath.cos(rate * stop + phase)) / rate
    unit = 1.0 / (2 * np.pi * frequency)
    microturn = unit * 2 * np.pi * 1e-6
    resolution = max(1e-11 * unit, 5e-16 * start)  # of double precision in the times themselves
    assert frequency * start < 1.1e9 and resolution < microturn
    pieces, atol = np.array([[start, stop, 1.0]]), np.full(2, 1e-16)
    options = {"rtol": 1e-12, "atol": atol, "smallest": 0.5, "largest": 2.0}
    one = core.run(np.zeros(0), np.zeros(2), pieces, drives, np.array([stop]), **options)
    while one.go_on(1000):
        pass
    assert one.job.status == 0 and abs(one.states[-1, 1] - float(swing)) < resolution
    outcome = empty_results(core, 3)
    many = core.runs(
        np.zeros((0, 1)),
        np.zeros((2, 3)),
        pieces,
        drives[..., None],
        averages=False,
        results=outcome,
        **options,
    )
    many.integrate(0, 3, np.zeros(1))
    assert np.all(np.abs(outcome["last_state"][1] - float(swing)) < resolution)
    travel = core.tangent(
        np.zeros(0), np.zeros(2), drives[0], np.array([start, stop]), np.zeros((1, 2)), np.array([[0, 2]]),
        weights=np.full(2, 1e-4), tolerance=1e-13, smallest=0.5, largest=2.0, normalise=False,
    )  # fmt: skip
    while travel.go_on(1000):
        pass
    assert abs(travel.outcome.states[-1, 1] - float(swing)) < resolution
    assert abs(travel.outcome.last_columns[0, 1] - float(swing)) < resolution


def empty_results(core, runs):
    rows = (core.coordinates, runs)
    return {
        "maximum": np.full(rows, -np.inf), "minimum": np.full(rows, np.inf), "mean": np.zeros(rows),
        "mean_square": np.zeros(rows), "last_state": np.zeros((core.states, runs)),
        "status": np.full(runs, structures.INTERRUPTED), "status_time": np.zeros(runs),
        "steps": np.zeros(runs, dtype=np.int64), "rejections": np.zeros(runs, dtype=np.int64),
    }  # fmt: skip


# --- one trajectory ----------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_a_trajectory_is_that_of_scipy(model):
    """With a jump and a ramp on the way, at times of any spacing."""
    force = dl.Tabulated([0.0, 1e-3, 2.5e-3, 6e-3], [0.0, 0.4, 0.1, 0.3])
    problem = problem_of(model, force, dl.Sine(2e6, 380.0, bias=5e5, phase=0.4))
    state = start_of(problem, 1)[:, 0].copy()
    times = np.sort(np.random.default_rng(1).uniform(0, 6e-3, 40))
    times[0], times[-1] = 0.0, 6e-3
    call = one_run(problem, state, times, 6e-3, 1e-11)
    exact, end = [state], state
    for span in ((0.0, 1e-3), (1e-3, 2.5e-3), (2.5e-3, 6e-3)):
        inside = times[(times > span[0]) & (times <= span[1])]
        found = solve_ivp(problem.piece(*span).rhs, span, end, "DOP853", rtol=1e-13,
                          atol=1e-15, dense_output=True)  # fmt: skip
        exact += list(found.sol(inside).T)
        end = found.y[:, -1]
    size = np.max(np.abs(exact), axis=0)
    assert call.job.status == loss.COMPLETED and call.job.status_time == 6e-3
    np.testing.assert_allclose(call.states / size, np.array(exact) / size, rtol=0, atol=3e-9)


def one_run(problem, state, times, duration, rtol, limits=(1e-3, 100.0), budget=17):
    spans = list(pairwise([0.0, *problem.breakpoints(0.0, duration), duration]))
    call = load_core(problem.model).run(
        parameter_rows(problem)[:, 0].copy(),
        state,
        np.array([(*span, 1.0) for span in spans]),
        np.ascontiguousarray(piece_rows(problem, spans)[..., 0]),
        times,
        rtol=rtol,
        atol=np.full(len(state), 1e-3 * rtol),
        smallest=limits[0],
        largest=limits[1],
    )
    while call.go_on(budget):
        pass
    return call


@pytest.mark.parametrize("model", MODELS)
def test_energies_along_a_trajectory_are_those_of_the_module(model):
    """With a drive that jumps: at the jump, those before it."""
    problem = problem_of(model, dl.Step(0.5, 2e-3, before=0.1), dl.Sine(2e6, 380.0, bias=5e5))
    times = np.array([0.0, 1e-3, 1.9e-3, 2.4e-3, 4e-3])
    call = one_run(problem, start_of(problem, 1)[:, 0].copy(), times, 4e-3, 1e-9)
    names = ("kinetic_energy", "potential_energy", "force_power", "dashpot_power")
    for place, name in enumerate(names):
        exact = getattr(problem.model, name)(call.states.T, problem.inputs(times), problem.parameters)
        exact = np.broadcast_to(exact, times.shape)
        np.testing.assert_allclose(
            call.energies[:, place], exact, rtol=1e-9, atol=1e-12 * np.abs(exact).max()
        )


def test_a_budget_does_not_show():
    problem = problem_of("uniaxial", 0.3, dl.Sine(2e6, 380.0))
    state, times = start_of(problem, 1)[:, 0].copy(), np.linspace(0, 5e-3, 77)
    once, often = (one_run(problem, state, times, 5e-3, 1e-8, budget=budget) for budget in (10**6, 1))
    np.testing.assert_array_equal(once.states, often.states)
    assert once.job.steps == often.job.steps > 20


def test_a_trajectory_ends_where_it_is_lost():
    problem = problem_of("equal_biaxial", 0.3, 3e7)
    state, times = start_of(problem, 1)[:, 0].copy(), np.linspace(0, 0.01, 41)
    call = one_run(problem, state, times, 0.01, 1e-10, limits=(1e-2, 100.0))
    assert call.job.status == loss.COLLAPSED
    kept = times <= call.job.status_time
    assert 1 < kept.sum() < 41
    assert np.all(np.isfinite(call.states[kept])) and np.all(np.isnan(call.states[~kept]))
    assert call.last_state[0] == pytest.approx(1e-2**-0.5, rel=1e-9)


# --- what is refused ---------------------------------------------------------------------------------


def arguments(**changed):
    given = {
        "parameters": np.ones(7), "state": np.array([1.0, 0.0, 1.0]), "pieces": np.array([[0.0, 1.0, 1.0]]),
        "drives": np.zeros((1, 5, 2)), "times": np.array([0.0, 0.5]), "atol": np.full(3, 1e-9),
    }  # fmt: skip
    given |= changed
    return given | {"rtol": 1e-6, "smallest": 0.1, "largest": 10.0}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"parameters": np.ones(6)}, r"parameters must be an array of float64 .*\(7,\), got float64 \(6,\)"),
        ({"state": np.ones(3, dtype=np.float32)}, "state must be an array of float64"),
        ({"state": [1.0, 0.0, 1.0]}, "state must be an array of float64 .* got list"),
        ({"atol": 1e-9}, "atol must be an array"),
        ({"drives": np.zeros((1, 2, 5)).transpose(0, 2, 1)}, "drives must lie row after row in memory"),
        ({"drives": np.zeros((2, 5, 2))}, "drives must be an array"),
        ({"pieces": np.zeros((0, 3))}, "pieces of time must follow each other"),
        ({"pieces": np.array([[1.0, 0.0, 1.0]])}, "pieces of time must follow each other"),
        ({"pieces": np.array([[0.0, 0.5, 1.0], [0.6, 1.0, 1.0]])}, "pieces of time must follow each other"),
        ({"times": np.array([0.5, 0.5])}, "times must increase"),
        (
            {"times": np.array([0.5, 1.5])},
            "times must increase, from the start of the run to its end at most",
        ),
    ],
)
def test_arrays_that_do_not_fit_never_reach_compiled_code(changed, message):
    core = load_core(dl.load_model("equal_biaxial"))
    with pytest.raises(ValueError, match=message):
        core.run(**arguments(**changed))


def test_results_that_do_not_fit_never_reach_compiled_code():
    core = load_core(dl.load_model("equal_biaxial"))
    given = arguments(parameters=np.ones((7, 1)), state=np.ones((3, 4)), drives=np.zeros((1, 5, 2, 1)))
    del given["times"]
    for name, array in (
        ("maximum", np.zeros((1, 3))),
        ("status", np.zeros(4)),
        ("steps", np.zeros(4, dtype=np.int32)),
    ):
        with pytest.raises(ValueError, match=f"{name} must be an array"):
            core.runs(averages=False, results=empty_results(core, 4) | {name: array}, **given)
    call = core.runs(averages=False, results=empty_results(core, 4), **given)
    for first, last in ((-1, 2), (0, 5), (3, 2)):
        with pytest.raises(ValueError, match="of 4"):
            call.integrate(first, last, np.zeros(1))
    assert kernel.load_core(dl.load_model("equal_biaxial")) is core


def test_samples_begin_late_and_lie_closer_than_steps():
    """Hundreds in a step, and none where the first lies beyond the duration."""
    problem = problem_of("equal_biaxial", 0.3, dl.Sine(np.full(3, 3e6), 300.0))
    sampling = Sampling(np.array([0.0, 3e-3, 1.0]), np.array([1e-6, 1e-6, 1.0]), 2000)
    outcome = integrate_by_core(
        problem, start_of(problem, 3), settings_of(4e-3, 1e-9, limits=dl.Limits()), sampling
    )
    taken = np.count_nonzero(np.isfinite(outcome.samples[:, 0]), axis=0)
    np.testing.assert_array_equal(taken, [2000, 1001, 0])
    assert LEVEL == 0
