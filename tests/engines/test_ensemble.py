"""Lanes side by side: the same answers as one by one, each lane for itself, extrema to the tolerance."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import DOP853, RK45
from scipy.optimize import minimize_scalar

import delagrange as dl
from delagrange.engines.interpolation import evaluate, first_crossing, largest_value
from delagrange.engines.lanes import RunSettings, Sampling
from delagrange.engines.numpy_engine import integrate_lanes
from delagrange.engines.step_control import Ode45Control, ScipyControl, step_control
from delagrange.engines.tableau import tableau
from delagrange.problem import status as loss
from delagrange.problem.problem import make_problem

HELD = {"equal_biaxial": None, "uniaxial": None, "pure_shear_consistent": 1.5, "pure_shear_as_printed": 1.5}


def _run(model, force, field, duration=0.01, rtol=1e-10, atol=1e-13, **options):
    """The outcome of lanes of a model with the paper's membrane."""
    module = dl.load_model(model)
    problem = make_problem(module, dl.SHENG_2015, {}, HELD[model], force, field)
    lanes = np.broadcast_shapes(np.shape(force), *(np.shape(value) for value in vars(field).values()))
    start = np.asarray(module.reference_state(problem.parameters), dtype=float)
    state = np.repeat(start[:, None], lanes[0], axis=1)
    name = options.pop("name", "DOP853")
    control = step_control(options.pop("control", "scipy"), rtol, atol, duration)
    defaults = {"window": (0.0, duration), "limits": dl.Limits(), "extrema": "dense"}
    interval = options.pop("sample_interval", None)
    sampling = None
    if interval is not None:
        sampling = Sampling(np.zeros(lanes), np.full(lanes, interval), int(duration / interval))
    chosen = RunSettings(tableau(name), control, duration, **(defaults | options))
    return integrate_lanes(problem, state, chosen, sampling)


lanes = st.lists(
    st.tuples(st.floats(0.0, 0.8), st.floats(0.0, 8e6), st.floats(50.0, 900.0)), min_size=1, max_size=4
)


@pytest.mark.parametrize("model", HELD)
@settings(max_examples=3, deadline=None)
@given(lanes=lanes)
def test_lanes_equal_single_trajectories(model, lanes):
    force, amplitude, frequency = np.array(lanes).T
    outcome = _run(model, force, dl.Sine(amplitude, frequency))
    for lane, (P, E, f) in enumerate(lanes):
        run = dl.simulate(
            model,
            force=P,
            field=dl.Sine(E, f),
            held_stretch=HELD[model],
            duration=0.01,
            rtol=1e-11,
            atol=1e-14,
        )
        assert loss.STATUS[outcome.status[lane]] == run.attrs["status"]
        assert outcome.status_time[lane] == pytest.approx(run.attrs["status_time"], rel=1e-6)
        if run.attrs["status"] == "completed":
            for place, entry in enumerate(dl.load_model(model).STATE):
                scale = np.abs(run[entry.name]).max().item() + 1e-3
                assert outcome.state[place, lane] == pytest.approx(
                    run[entry.name].values[-1], abs=1e-6 * scale
                )
            coordinate = run[dl.load_model(model).STATE[0].name]
            assert outcome.maximum[0, lane] >= coordinate.max().item() - 1e-8
            assert outcome.minimum[0, lane] <= coordinate.min().item() + 1e-8


@settings(max_examples=4, deadline=None)
@given(lanes=lanes, model=st.sampled_from(["equal_biaxial", "uniaxial", "pure_shear_consistent"]))
def test_a_lane_does_not_see_its_neighbours(lanes, model):
    """Bit for bit: alone, among others, and beside a lane that collapses at once."""
    force, amplitude, frequency = np.array([*lanes, (0.5, 9e7, 400.0)]).T
    measured = {"rtol": 1e-7, "averages": True, "sample_interval": 3e-4}
    together = _run(model, force, dl.Sine(amplitude, frequency), **measured)
    assert together.status[-1] != loss.COMPLETED
    for lane in range(len(lanes)):
        alone = _run(model, force[[lane]], dl.Sine(amplitude[[lane]], frequency[[lane]]), **measured)
        for entry in fields(alone):
            both = getattr(together, entry.name), getattr(alone, entry.name)
            np.testing.assert_array_equal(both[0][..., lane], both[1][..., 0], err_msg=entry.name)


@pytest.mark.parametrize(("name", "solver"), [("DOP853", DOP853), ("RK45", RK45)])
def test_steps_are_those_of_scipy(name, solver):
    """The same controller: as many accepted steps, and the same end to rounding."""
    force, amplitude, frequency = 0.5, 5e6, 371.0
    outcome = _run(
        "equal_biaxial", np.array([force]), dl.Sine(amplitude, frequency), rtol=1e-6, atol=1e-9, name=name
    )
    problem = make_problem(
        dl.load_model("equal_biaxial"), dl.SHENG_2015, {}, None, force, dl.Sine(amplitude, frequency)
    )
    single, steps = solver(problem.rhs, 0.0, [1.0, 0.0, 1.0], 0.01, rtol=1e-6, atol=1e-9), 0
    while single.status == "running":
        single.step()
        steps += 1
    assert outcome.steps[0] == steps
    np.testing.assert_allclose(outcome.state[:, 0], single.y, rtol=1e-9)


@pytest.mark.parametrize("name", ["DOP853", "RK45"])
def test_interpolants_are_those_of_scipy(name):
    solver = {"DOP853": DOP853, "RK45": RK45}[name](
        lambda t, y: np.array([y[1], -np.sin(y[0]) + np.cos(t)]), 0.0, [1.0, 0.0], 10.0, rtol=1e-5, atol=1e-8
    )
    for _ in range(3):
        solver.step()
    dense = solver.dense_output()
    rates = solver.K_extended if name == "DOP853" else solver.K
    pair = tableau(name)
    assert pair.total_stages == len(rates)
    fractions = np.linspace(0, 1, 11)
    powers = [sum(c * rates[stage] for stage, c in row) for row in pair.interpolant]
    polynomial = np.stack([solver.y_old, *(solver.h_previous * power for power in powers)])
    values = evaluate(polynomial[:, :, None], fractions)
    np.testing.assert_allclose(
        values, dense(solver.t_old + fractions * solver.h_previous), rtol=0, atol=1e-13
    )


def test_matlabs_interpolant_ends_where_the_step_ends():
    weights, interpolant = dict(tableau("RK45").weights), tableau("RK45_MATLAB").interpolant
    for stage in range(7):
        total = sum(dict(row).get(stage, 0.0) for row in interpolant)
        assert total == pytest.approx(weights.get(stage, 0.0), abs=1e-14)


@given(coefficients=st.lists(st.floats(-3, 3), min_size=3, max_size=8), stop=st.floats(0.2, 1.0))
def test_largest_value_of_a_polynomial(coefficients, stop):
    """Not below any of many samples; for few extrema in the step, not above either."""
    polynomial = np.array(coefficients)[:, None]
    found = largest_value(polynomial, np.array([stop]))[0]
    samples = evaluate(polynomial, np.linspace(0, stop, 2001))
    best = np.linspace(0, stop, 2001)[np.argmax(samples)]
    low, high = max(best - stop / 2000, 0.0), min(best + stop / 2000, stop)
    exact = -minimize_scalar(
        lambda x: -evaluate(polynomial, x)[0], bounds=(low, high), method="bounded", options={"xatol": 1e-12}
    ).fun
    assert found <= max(exact, samples.max()) + 1e-9
    assert found >= samples.max() - 0.05 * (1 + np.ptp(samples))


@given(place=st.floats(0.05, 0.95), other=st.floats(-5.0, -0.5))
def test_a_single_top_is_found_to_rounding(place, other):
    """y = -(x - place)^2 (1 + (x - other)^2): one top in the step, of value 0."""
    square, hump = np.poly1d([-1, 2 * place, -(place**2)]), np.poly1d([1, -2 * other, other**2 + 1])
    polynomial = (square * hump).coeffs[::-1][:, None]
    assert abs(largest_value(polynomial)[0]) < 1e-12 * np.abs(polynomial).max()


@given(place=st.floats(0.0, 1.0, exclude_min=True, exclude_max=True))
def test_first_crossing(place):
    assert first_crossing(lambda x: place - x, (3,)) == pytest.approx(np.full(3, place), abs=1e-15)


def test_amplitude_is_right_to_1e_6_at_rtol_1e_10_and_follows_the_tolerance():
    force, amplitude = np.repeat([0.2, 0.8], 2), np.tile([1e6, 5e6], 2)
    field = dl.Sine(amplitude, 371.0)

    def heights(rtol):
        outcome = _run("equal_biaxial", force, field, duration=0.02, rtol=rtol, atol=1e-3 * rtol)
        return outcome.maximum[0] - outcome.minimum[0]

    reference = heights(1e-13)
    errors = np.array([np.max(np.abs(heights(10.0**-k) / reference - 1)) for k in (4, 6, 8, 10)])
    assert errors[-1] < 1e-7
    slope = np.polyfit([-4, -6, -8, -10], np.log10(errors), 1)[0]
    assert 0.8 < slope < 1.4
    assert np.all(np.diff(errors) < 0)


@settings(max_examples=3, deadline=None)
@given(start=st.floats(0.0, 0.005), length=st.floats(1e-3, 5e-3))
@example(start=1e-300, length=0.004)  # a span shorter than any step that is worth taking
def test_extrema_belong_to_the_window(start, length):
    window = (start, start + length)
    outcome = _run("uniaxial", np.array([0.5]), dl.Sine(4e6, 300.0), duration=0.01, window=window)
    run = dl.simulate(
        "uniaxial",
        force=0.5,
        field=dl.Sine(4e6, 300.0),
        duration=0.01,
        time=np.linspace(*window, 4001),
        rtol=1e-11,
    )
    for place, name in enumerate(("stretch_1", "stretch_2")):
        assert outcome.maximum[place, 0] == pytest.approx(run[name].max().item(), abs=1e-6)
        assert outcome.minimum[place, 0] == pytest.approx(run[name].min().item(), abs=1e-6)


def test_steps_samples_and_dense_see_more_and_more():
    spans = {}
    for extrema in ("steps", "samples", "dense"):
        outcome = _run(
            "equal_biaxial",
            np.array([0.5]),
            dl.Sine(5e6, 371.0),
            duration=0.05,
            extrema=extrema,
            rtol=1e-4,
            name="RK45",
        )
        spans[extrema] = outcome.maximum[0, 0] - outcome.minimum[0, 0]
    assert spans["steps"] < spans["samples"] < spans["dense"]


def test_a_lane_lost_at_the_start_has_its_status_there():
    outcome = _run("equal_biaxial", np.array([0.1, 0.1]), dl.Sine(1e6, 300.0), limits=dl.Limits(0.5, 2.0))
    assert list(outcome.status) == [loss.COMPLETED] * 2
    module = dl.load_model("equal_biaxial")
    problem = make_problem(module, dl.SHENG_2015, {}, None, np.array([0.1, 0.1]), dl.Constant(0.0))
    state = np.array([[3.0, 1.0], [0.0, 0.0], [1.0, 1.0]])
    chosen = RunSettings(
        tableau("DOP853"), ScipyControl(1e-8, 1e-11), 0.01, (0.0, 0.01), dl.Limits(0.01, 2.0), "dense"
    )
    outcome = integrate_lanes(problem, state, chosen)
    assert list(outcome.status) == [loss.DIVERGED, loss.COMPLETED]
    assert outcome.status_time[0] == 0.0


def test_a_breakpoint_of_one_lane_is_met_by_all():
    """Steps of the force at other times in each lane, each as in a single run."""
    times = np.array([2e-3, 5e-3, 7.7e-3])
    problem = make_problem(
        dl.load_model("equal_biaxial"), dl.SHENG_2015, {}, None, dl.Step(np.full(3, 0.5), time=times), 2e6
    )
    chosen = RunSettings(tableau("DOP853"), ScipyControl(1e-11, 1e-14), 0.01, (0.0, 0.01), dl.Limits(), "dense")
    outcome = integrate_lanes(problem, np.repeat([[1.0], [0.0], [1.0]], 3, axis=1), chosen)
    for lane, time in enumerate(times):
        run = dl.simulate(
            "equal_biaxial", force=dl.Step(0.5, time=time), field=2e6, duration=0.01, rtol=1e-11, atol=1e-14
        )
        assert outcome.state[0, lane] == pytest.approx(run["stretch"].values[-1], rel=1e-9)


def test_ode45_controller_follows_its_published_rules():
    """Growth at most five-fold, none after a rejection, at first 0.8 (tol / err)^(1/5), then halving."""
    control, pair = Ode45Control(1e-3, 1e-6, largest_step=0.01), tableau("RK45")
    step, yes, no = np.ones(1), np.array([True]), np.array([False])

    def factor(error, accepted, retried):
        return control.next_step(pair, step, np.array([error]), accepted, retried)[0]

    assert factor(1e-12, yes, no) == 5.0
    assert factor(0.5, yes, no) == pytest.approx(1 / (1.25 * 0.5**0.2))
    assert factor(0.5, yes, yes) == 1.0
    assert factor(32.0, no, no) == pytest.approx(0.4)
    assert factor(1e9, no, no) == pytest.approx(0.1)
    assert factor(32.0, no, yes) == 0.5
    np.testing.assert_allclose(control.bounded(np.array([0.5]), np.zeros(1), 1.0)[1], 0.01)
    np.testing.assert_allclose(control.bounded(np.array([0.0095]), np.array([0.99]), 1.0)[1], 1.0)
