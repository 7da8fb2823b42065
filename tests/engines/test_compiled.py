"""The compiled engine: the answers of the others, each lane to its tolerance and the same bits in any company."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import Phase, assume, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st
from scipy.integrate import quad

import delagrange as dl
from delagrange.engines import compiled, engines, threads
from delagrange.engines.compiled import integrate_compiled
from delagrange.engines.engines import Numerics
from delagrange.engines.lanes import Sampling
from delagrange.engines.numpy_engine import integrate_lanes
from delagrange.engines.scipy_engine import integrate_one_by_one
from delagrange.problem import status as loss
from delagrange.problem.problem import make_problem
from delagrange.run.sweep import make_settings

HELD = {
    "equal_biaxial": None,
    "uniaxial": None,
    "pure_shear_as_printed": 1.5,
    "pure_shear_consistent": 1.5,
    "pure_shear_consistent_free": 1.5,
}
INTEGRATE = {"compiled": integrate_compiled, "numpy": integrate_lanes, "scipy": integrate_one_by_one}
CONTROL = {"compiled": "pi", "numpy": "scipy", "scipy": "scipy"}


def few(examples):
    """So many examples, and none of the time that shrinking a failing one takes."""
    return hypothesis_settings(max_examples=examples, deadline=None, phases=[Phase.explicit, Phase.generate])


NARROW = dl.Limits(0.2, 2.2)  # so that lanes of every model leave them at some field


def run(engine, model, force, field, *, rtol=1e-10, duration=8e-3, samples=None, materials=None, **options):
    """The outcome of lanes: `samples` of each, evenly from 0 to the duration, and all that can be measured.

    options: `held`, `start` (n_state, n_lanes), `window`, `limits`, `threads`, `averages`
    """
    module = dl.load_model(model)
    held = options.get("held", HELD[model])
    problem = make_problem(module, None, materials or {}, held, force, field)
    lanes = max(map(np.size, (*problem.parameters, *problem.inputs(0.0))))
    reference = np.asarray(module.reference_state(problem.parameters), dtype=float)
    state = options.get(
        "start", np.broadcast_to(reference.reshape(len(reference), -1), (len(reference), lanes))
    )
    chosen = make_settings(
        duration, options.get("window"), rtol, max(1e-3 * rtol, 1e-16),
        Numerics("DOP853", engine, CONTROL[engine], "dense"), options.get("limits", dl.Limits()),
        options.get("averages", True), options.get("threads"),
    )  # fmt: skip
    sampling = None
    if samples is not None:
        sampling = Sampling(np.zeros(lanes), np.full(lanes, duration / (samples - 1)), samples)
    with np.errstate(all="ignore"):
        return INTEGRATE[engine](problem, np.array(state), chosen, sampling)


def errors(found, exact, duration):
    """By measure, the error of each lane relative to the size of what is measured in that lane."""
    sizes = np.maximum(np.nanmax(np.abs(exact.samples), axis=0), np.abs(exact.state))
    count = len(exact.maximum)
    scale = {"state": sizes, "samples": sizes, "status_time": duration}
    found_by = {}
    for name in ("maximum", "minimum", "mean", "mean_square", "state", "samples", "status_time"):
        ours, theirs = getattr(found, name), getattr(exact, name)
        np.testing.assert_array_equal(np.isfinite(ours), np.isfinite(theirs), err_msg=name)
        known = np.where(np.isfinite(theirs), theirs, 0.0)
        error = np.abs(np.where(np.isfinite(ours), ours, 0.0) - known) / scale.get(name, sizes[:count])
        found_by[name] = error.reshape(-1, error.shape[-1]).max(axis=0)
    return found_by


def assert_same_bits(first, second, lanes=slice(None)):
    for entry in fields(first):
        np.testing.assert_array_equal(
            getattr(first, entry.name)[..., lanes], getattr(second, entry.name), err_msg=entry.name
        )


# --- the answers -------------------------------------------------------------------------------------

factors = st.floats(0.6, 1.6)


@pytest.mark.parametrize("model", HELD)
@few(4)
@given(
    force=st.floats(-0.2, 0.8),
    amplitude=st.floats(1e5, 5e6),
    bias=st.floats(-2e6, 2e6),
    phase=st.floats(-7.0, 7.0),
    frequency=st.floats(100.0, 900.0),
    materials=st.tuples(*[factors] * 7),
    held=st.floats(0.8, 2.0),
    stretch=st.floats(0.85, 1.3),
    rate=st.floats(-60.0, 60.0),
    inelastic=st.floats(0.85, 1.3),
    window=st.sampled_from([None, (1e-3, 2.5e-3), (0.0, 1e-4), (2.4e-3, 3e-3)]),
)
def test_all_measures_are_those_of_scipy_for_random_parameters(
    model, force, amplitude, bias, phase, frequency, materials, held, stretch, rate, inelastic, window
):
    """Beside a lane of many times the field that is lost at once; up to the loss it is compared as well."""
    names = (
        "half_length", "half_thickness", "density", "permittivity", "shear_modulus_alpha", "shear_modulus_beta",
        "relaxation_time",
    )  # fmt: skip
    paper = vars(dl.SHENG_2015) | {"relaxation_time": 400.0}
    changed = {name: paper[name] * factor for name, factor in zip(names, materials, strict=True)}
    kinds = [entry.name for entry in dl.load_model(model).STATE]
    values = [inelastic if "inelastic" in kind else rate if "rate" in kind else stretch for kind in kinds]
    field = dl.Sine(np.array([amplitude, 3e8]), np.array([frequency, 1.5 * frequency]), bias, phase)
    given_to_all = {
        "materials": changed, "start": np.repeat(np.array(values)[:, None], 2, axis=1), "limits": NARROW,
        "window": window, "duration": 3e-3, "samples": 7, "held": held if HELD[model] else None,
    }  # fmt: skip
    ours, theirs = (
        run(engine, model, force, field, rtol=rtol, **given_to_all)
        for engine, rtol in (("compiled", 1e-11), ("scipy", 1e-12))
    )
    np.testing.assert_array_equal(ours.status, theirs.status)
    assert ours.status[1] != loss.COMPLETED or model == "pure_shear_as_printed"
    for name, error in errors(ours, theirs, 3e-3).items():
        assert np.all(error < 1e-8), name


@pytest.mark.parametrize("model", HELD)
def test_collapse_and_divergence_are_told_apart(model):
    """A field pulls in; with a narrow upper limit the same motion has diverged."""
    for limits in (dl.Limits(0.05, 90.0), dl.Limits(1e-3, 2.5)):
        field = dl.Sine(np.array([1e6, 3e7, 1e8, 4e8]), 371.0, phase=0.7)
        ours, theirs = (
            run(engine, model, 0.3, field, limits=limits, duration=3e-3, samples=31)
            for engine in ("compiled", "scipy")
        )
        np.testing.assert_array_equal(ours.status, theirs.status)
        assert np.any(ours.status != loss.COMPLETED) or limits.largest_stretch > 3
        for name, error in errors(ours, theirs, 3e-3).items():
            assert np.all(error < 1e-6), name
        lost = ours.status != loss.COMPLETED
        times = np.linspace(0, 3e-3, 31)[:, None]
        np.testing.assert_array_equal(np.isnan(ours.samples[:, 0]), lost & (times > ours.status_time))


# --- the tolerance -----------------------------------------------------------------------------------

DECADES = 10.0 ** -np.arange(4, 11)
LARGEST_ERROR = 15  # in units of rtol, of any measure of any lane over these durations
LARGEST_ERROR_AS_PRINTED = 100  # whose tripled terms make the motion several times as fast


def mixed_lanes(model, count, rng):
    """Easy, hard and lost lanes in random order."""
    amplitude = rng.permutation(np.geomspace(1e4, 2e8, count))
    field = dl.Sine(amplitude, rng.uniform(50.0, 1500.0, count), rng.uniform(-1e6, 1e6, count), 0.4)
    return {"model": model, "force": rng.uniform(0.0, 0.6, count), "field": field, "limits": NARROW}


@pytest.mark.parametrize("model", HELD)
def test_the_error_follows_the_tolerance_lane_by_lane(model, rng):
    """Over six decades; no lane of the batch, easy, hard or lost, has more than its tolerance's share."""
    lanes = mixed_lanes(model, 40, rng) | {"samples": 17}
    exact = run("numpy", rtol=1e-13, **lanes)
    assert 0 < np.count_nonzero(exact.status) < 40
    most = LARGEST_ERROR_AS_PRINTED if model == "pure_shear_as_printed" else LARGEST_ERROR
    found = {rtol: run("compiled", rtol=rtol, **lanes) for rtol in DECADES}
    by_measure = {}
    for rtol, outcome in found.items():
        np.testing.assert_array_equal(outcome.status, exact.status)
        for name, error in errors(outcome, exact, 8e-3).items():
            assert np.max(error) < most * rtol, (name, rtol, np.argmax(error))
            by_measure.setdefault(name, []).append(np.median(error))
    for name in ("state", "samples", "maximum", "mean"):
        slope = np.polyfit(np.log10(DECADES), np.log10(by_measure[name]), 1)[0]
        assert 0.85 < slope < 1.15, name


def test_sections_and_amplitudes_follow_the_tolerance():
    sweep = {
        "frequency": [240.0, 371.0], "field_amplitude": [1e6, 3e6], "force": 0.4, "duration": 0.02,
        "section_points": 3, "section_phase": 1.0,
    }  # fmt: skip
    exact = dl.frequency_response("uniaxial", engine="numpy", rtol=1e-13, atol=1e-16, **sweep)
    worst = {name: [] for name in ("amplitude", "section_stretch_1", "section_stretch_2")}
    for rtol in DECADES:
        found = dl.frequency_response("uniaxial", engine="compiled", rtol=rtol, atol=1e-3 * rtol, **sweep)
        for name, values in worst.items():
            values.append(float(np.max(np.abs(found[name] / exact[name] - 1))))
            assert values[-1] < LARGEST_ERROR * rtol, (name, rtol)
    for name, values in worst.items():
        assert 0.85 < np.polyfit(np.log10(DECADES), np.log10(values), 1)[0] < 1.15, name


# --- the same bits -----------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["equal_biaxial", "uniaxial"])
def test_threads_order_and_company_change_no_bit(model, rng):
    count = 300
    lanes = mixed_lanes(model, count, rng)
    options = {"rtol": 1e-6, "duration": 2e-3, "samples": 5, "limits": NARROW}
    force, field = lanes["force"], lanes["field"]
    whole = run("compiled", model, force, field, threads=1, **options)
    assert 0 < np.count_nonzero(whole.status) < count
    for workers in (2, 3, 7, 400):
        assert_same_bits(whole, run("compiled", model, force, field, threads=workers, **options))
    order = rng.permutation(count)
    assert_same_bits(whole, run("compiled", model, force[order], field.take(order), **options), order)
    for lane in (0, 31, 150, 299):
        alone = run("compiled", model, force[[lane]], field.take([lane]), **options)
        assert_same_bits(whole, alone, [lane])


def test_a_lane_is_the_same_among_thousands():
    count = 3000
    frequency = np.linspace(100.0, 800.0, count)
    options = {"rtol": 1e-5, "duration": 1e-3, "samples": 3}
    force, amplitude = np.full(count, 0.3), np.full(count, 3e6)
    whole = run("compiled", "equal_biaxial", force, dl.Sine(amplitude, frequency), **options)
    for lane in (0, 1234, 2999):
        field = dl.Sine(amplitude[[lane]], frequency[[lane]])
        assert_same_bits(whole, run("compiled", "equal_biaxial", force[[lane]], field, **options), [lane])


@pytest.mark.parametrize("samples", [{}, {"sample_interval": 2e-4}, {"section_points": 1}])
def test_chunks_and_parts_do_not_show(monkeypatch, samples):
    sweep = {
        "force": [0.2, 0.5], "field_amplitude": [3e6, 5e7], "field_phase": [0.0, 1.0], "averages": True,
        "initial_state": {"stretch_1": [1.0, 1.1]}, "frequency": [300.0, 310.0, 350.0], "duration": 5e-3,
        "final_state": True, "engine": "compiled", "rtol": 1e-6,
    } | samples  # fmt: skip
    whole = dl.frequency_response("uniaxial", **sweep)
    small = replace(engines.ENGINES["compiled"], chunk=7)
    monkeypatch.setattr(engines, "ENGINES", {**engines.ENGINES, "compiled": small})
    xr.testing.assert_identical(dl.frequency_response("uniaxial", **sweep), whole)
    monkeypatch.setattr(compiled, "_DRIVE_NUMBERS", 50)
    monkeypatch.setattr(threads, "parts", lambda lanes, workers, width: threads.slices(lanes, 2))
    xr.testing.assert_identical(dl.frequency_response("uniaxial", **sweep), whole)


def test_the_dataset_says_what_integrated_it():
    response = dl.frequency_response("uniaxial", frequency=300.0, field_amplitude=1e6, duration=1e-3)
    assert response.attrs["engine"] == "compiled" and response.attrs["step_control"] == "pi"


def test_progress_grows_to_the_number_of_lanes():
    seen, model = [], dl.load_model("equal_biaxial")
    problem = make_problem(model, None, {}, None, 0.2, dl.Sine(np.full(3, 1e6), 300.0))
    state = np.repeat(np.array([[1.0], [0.0], [1.0]]), 3, axis=1)
    numerics = Numerics("DOP853", "compiled", "pi", "dense")
    integrate_compiled(
        problem, state, make_settings(9.0, None, 1e-9, 1e-12, numerics, dl.Limits()), None, seen.append
    )
    assert len(seen) > 1 and seen == sorted(seen) and 0 <= seen[0] < seen[-1] == 3


# --- drives, windows, samples ------------------------------------------------------------------------

FORCES = {
    "constant": dl.Constant(0.4),
    "sine": dl.Sine(0.3, 180.0, bias=0.2, phase=1.0),
    "step": dl.Step(0.5, 2.1e-3, before=0.1),
    "step before the run": dl.Step(0.5, -1.0),
    "ramp": dl.Ramp(0.0, 0.5, duration=3e-3, begin=1.3e-3),
    "ramp beyond the run": dl.Ramp(0.1, 0.9, duration=0.1, begin=-0.01),
    "table": dl.Tabulated([0.0, 1e-3, 2.5e-3, 6e-3, 0.1], [0.0, 0.4, -0.1, 0.5, 0.2]),
}


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("window", [None, (1.7e-3, 4.4e-3)])
def test_every_drive_of_the_force_in_any_window(force, window):
    sweep = {
        "frequency": [300.0, 410.0], "field_amplitude": [0.0, 3e6, 6e7], "field_bias": 5e5, "force": FORCES[force],
        "duration": 6e-3, "window": window, "averages": True, "final_state": True, "section_points": 1,
        "section_phase": 2.0, "rtol": 1e-10,
    }  # fmt: skip
    ours, theirs = (
        dl.frequency_response("equal_biaxial", engine=engine, **sweep) for engine in ("compiled", "scipy")
    )
    assert set(ours["status"].values.ravel()) == {"completed", "collapsed"}
    assert ours["status"].equals(theirs["status"])
    for name in set(ours.data_vars) - {"status"}:
        scale = np.nanmax(np.abs(theirs[name])) + 1e-300
        np.testing.assert_allclose(ours[name] / scale, theirs[name] / scale, rtol=0, atol=1e-7, err_msg=name)


@pytest.mark.parametrize("model", HELD)
def test_breakpoints_of_each_lane_are_met(model):
    """Steps and ramps at other times in each lane, two of them so near that only one step lies between."""
    times = np.array([1e-3, 2.2e-3, 2.2e-3 + 1e-9, 6e-3])
    for force in (dl.Step(np.full(4, 0.4), times), dl.Ramp(0.0, np.full(4, 0.4), times, 5e-4)):
        ours, theirs = (
            run(engine, model, force, dl.Sine(np.full(4, 1e6), 250.0), samples=9, window=(1.5e-3, 7e-3))
            for engine in ("compiled", "scipy")
        )
        for name, error in errors(ours, theirs, 8e-3).items():
            assert np.all(error < 1e-7), name


def test_a_window_that_a_lane_never_comes_into():
    field = dl.Sine(np.array([1e6, 6e7]), 371.0)
    ours, theirs = (
        run(engine, "equal_biaxial", 0.2, field, window=(6e-3, 8e-3)) for engine in ("compiled", "numpy")
    )
    assert ours.status[1] == loss.COLLAPSED and ours.status_time[1] < 6e-3
    for name in ("maximum", "minimum", "mean", "mean_square"):
        np.testing.assert_allclose(getattr(ours, name), getattr(theirs, name), rtol=1e-8, err_msg=name)
    assert np.isnan(ours.mean[0, 1]) and not np.isfinite(ours.maximum[0, 1])


@few(6)
@given(duration=st.floats(1e-3, 9e-3), count=st.integers(2, 40), rtol=st.sampled_from([1e-3, 1e-6, 1e-9]))
def test_the_first_and_the_last_sample_are_the_ends_of_the_run(duration, count, rtol):
    field = dl.Sine(np.array([1e6, 4e6]), 333.0)
    outcome = run("compiled", "equal_biaxial", 0.3, field, duration=duration, samples=count, rtol=rtol)
    np.testing.assert_array_equal(outcome.samples[0], [[1.0, 1.0], [0.0, 0.0], [1.0, 1.0]])
    np.testing.assert_allclose(outcome.samples[-1], outcome.state, rtol=1e-12)
    assert np.all(np.isfinite(outcome.samples))


def test_samples_begin_late_and_lie_closer_than_steps():
    """Hundreds in a step, and none where the first lies beyond the duration."""
    module = dl.load_model("equal_biaxial")
    problem = make_problem(module, None, {}, None, 0.3, dl.Sine(np.full(3, 3e6), 300.0))
    state, numerics = (
        np.repeat([[1.0], [0.0], [1.0]], 3, axis=1),
        Numerics("DOP853", "compiled", "pi", "dense"),
    )
    sampling = Sampling(np.array([0.0, 3e-3, 1.0]), np.array([1e-6, 1e-6, 1.0]), 2000)
    settings = make_settings(4e-3, None, 1e-9, 1e-12, numerics, dl.Limits())
    outcome = integrate_compiled(problem, state, settings, sampling)
    taken = np.count_nonzero(np.isfinite(outcome.samples[:, 0]), axis=0)
    np.testing.assert_array_equal(taken, [2000, 1001, 0])
    exact = dl.simulate(
        "equal_biaxial", force=0.3, field=dl.Sine(3e6, 300.0), duration=4e-3, rtol=1e-12, atol=1e-15,
        time=3e-3 + 1e-6 * np.arange(1000),
    )  # fmt: skip
    np.testing.assert_allclose(outcome.samples[:1000, 0, 1], exact["stretch"], rtol=1e-8)


# --- extrema -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", HELD)
@few(5)
@given(
    amplitude=st.floats(1e5, 5e6),
    frequency=st.floats(50.0, 4000.0),
    rtol=st.sampled_from([1e-2, 1e-3, 1e-5, 1e-8]),
    begin=st.floats(0.0, 0.015),
)
def test_no_sample_lies_beyond_the_extrema_and_one_is_near(model, amplitude, frequency, rtol, begin):
    """The extrema are those of the interpolant, also where it turns several times in a step."""
    field = dl.Sine(np.array([amplitude, 2 * amplitude]), np.array([frequency, 0.7 * frequency]))
    options = {"duration": 0.02, "rtol": rtol, "held": 1.0 if HELD[model] else None}
    window = (begin, 0.02)
    sampled = run("compiled", model, 0.3, field, samples=20_001, **options)
    plain = run("compiled", model, 0.3, field, window=window, **options)
    kept = np.flatnonzero(sampled.status == loss.COMPLETED)
    inside = sampled.samples[np.linspace(0, 0.02, 20_001) >= begin]
    if begin > 0:  # the window ends a step at its start
        inside = run("compiled", model, 0.3, field, window=window, samples=20_001, **options).samples
        inside = inside[np.linspace(0, 0.02, 20_001) >= begin]
    values = inside[:, : len(plain.maximum), kept]
    highest, lowest = values.max(axis=0), values.min(axis=0)
    swing = highest - lowest
    assert np.all(plain.maximum[:, kept] >= highest - 1e-9 * swing)
    assert np.all(plain.minimum[:, kept] <= lowest + 1e-9 * swing)
    assert np.all(plain.maximum[:, kept] <= highest + 1e-3 * swing)
    assert np.all(plain.minimum[:, kept] >= lowest - 1e-3 * swing)


def test_an_extremum_at_the_start_or_the_end_of_the_window():
    """On its first way up a membrane is lowest where the window begins and highest where it ends."""
    field = dl.Constant(np.array([2e6, 3e6]))
    outcome = run("compiled", "equal_biaxial", 0.1, field, duration=4e-4, window=(1e-4, 3e-4), samples=5)
    np.testing.assert_allclose(outcome.minimum[0], outcome.samples[1, 0], rtol=1e-12)
    np.testing.assert_allclose(outcome.maximum[0], outcome.samples[3, 0], rtol=1e-12)
    assert np.all(outcome.maximum > outcome.minimum)
    whole = run("compiled", "equal_biaxial", 0.1, field, duration=4e-4)
    np.testing.assert_array_equal(whole.minimum[0], [1.0, 1.0])
    np.testing.assert_array_equal(whole.maximum[0], whole.state[0])


@pytest.mark.parametrize("model", ["equal_biaxial", "uniaxial", "pure_shear_consistent"])
def test_what_does_not_move_has_no_amplitude(model):
    response = dl.frequency_response(
        model, frequency=[100.0, 300.0], field_amplitude=0.0, duration=0.05, averages=True, engine="compiled",
        held_stretch=1.0 if HELD[model] else None,
    )  # fmt: skip
    for name in ("maximum", "minimum", "mean", "root_mean_square"):
        np.testing.assert_allclose(response[name], 1.0, rtol=1e-12)
    np.testing.assert_allclose(response["amplitude"], 0.0, atol=1e-12)


def test_a_coordinate_that_moves_as_the_other_has_its_extrema():
    """Uniaxial without a force: both axes alike, to rounding."""
    response = dl.frequency_response(
        "uniaxial", frequency=[250.0, 371.0], field_amplitude=3e6, duration=0.02, engine="compiled"
    )
    np.testing.assert_allclose(response["stretch_2_amplitude"], response["amplitude"], rtol=1e-9)
    assert np.all(response["amplitude"] > 1e-3)


@pytest.mark.parametrize("relaxation_time", [1e-3, 5e-3, 0.05])
def test_a_slow_drift_under_the_vibration(relaxation_time):
    """Every period is a little higher than the one before: its top is a new record."""
    sweep = {
        "frequency": [200.0, 371.0], "field_amplitude": 2e6, "force": 0.4, "duration": 0.04, "averages": True,
        "relaxation_time": relaxation_time, "rtol": 1e-9, "window": (0.01, 0.04),
    }  # fmt: skip
    ours, theirs = (
        dl.frequency_response("equal_biaxial", engine=engine, **sweep) for engine in ("compiled", "scipy")
    )
    for name in ("maximum", "minimum", "amplitude", "mean", "root_mean_square"):
        np.testing.assert_allclose(ours[name], theirs[name], rtol=2e-7, err_msg=name)


def test_extrema_are_those_of_the_motion_at_the_loosest_tolerance():
    sweep = {
        "frequency": [80.0, 371.0, 1500.0],
        "field_amplitude": [1e6, 4e6],
        "force": 0.3,
        "duration": 0.02,
    }
    loose = dl.frequency_response("uniaxial", engine="compiled", rtol=1e-2, atol=1e-5, **sweep)
    exact = dl.frequency_response("uniaxial", engine="numpy", rtol=1e-11, atol=1e-14, **sweep)
    for name in ("amplitude", "stretch_2_amplitude"):
        np.testing.assert_allclose(loose[name], exact[name], rtol=0.05, err_msg=name)


# --- averages ----------------------------------------------------------------------------------------


@few(6)
@given(
    push=st.floats(0.5, 3.0),
    frequency=st.floats(80.0, 200.0),
    phase=st.floats(-4.0, 4.0),
    begin=st.floats(0, 8e-3),
)
def test_mean_and_root_mean_square_of_a_known_motion(push, frequency, phase, begin):
    """A flat membrane with hardly any springs: x'' is the force over the mass, which a table integral solves."""
    flat = {
        "half_thickness": 1e-8, "density": 1e8, "shear_modulus_alpha": 1e-6, "shear_modulus_beta": 1e-6,
        "permittivity": 1e-20,
    }  # fmt: skip
    module, turn, duration = dl.load_model("equal_biaxial"), 2 * np.pi * frequency, 0.01
    problem = make_problem(module, None, flat, None, 1.0, 0.0)
    acceleration = (
        push * 1e4 / module.rhs(module.reference_state(problem.parameters), (1.0, 0.0), problem.parameters)[1]
    )
    drive = dl.Sine(acceleration, frequency, phase=phase)
    assert module.rhs([2.0, 30.0, 1.0], (acceleration, 0.0), problem.parameters)[1] == pytest.approx(
        push * 1e4, rel=1e-6
    )

    def stretch(time):
        reach = push * 1e4 / turn
        return (
            1.2 + reach * np.cos(phase) * time + reach / turn * (np.sin(phase) - np.sin(turn * time + phase))
        )

    response = dl.frequency_response(
        "equal_biaxial", frequency=[300.0], field_amplitude=0.0, force=drive, duration=duration, engine="compiled",
        initial_state={"stretch": 1.2}, window=(begin, duration), averages=True, final_state=True, rtol=1e-10,
        **flat,
    )  # fmt: skip
    assume(stretch(np.linspace(0.0, duration, 500)).min() > 0.1)
    assert response["status"].item() == "completed"
    mean = quad(stretch, begin, duration, epsabs=1e-13)[0] / (duration - begin)
    square = quad(lambda time: stretch(time) ** 2, begin, duration, epsabs=1e-13)[0] / (duration - begin)
    assert response["final_stretch"].item() == pytest.approx(stretch(duration), rel=1e-6)
    assert response["mean"].item() == pytest.approx(mean, rel=1e-6)
    assert response["root_mean_square"].item() == pytest.approx(np.sqrt(square), rel=1e-6)


def test_averages_not_asked_for_are_not_there_and_change_nothing():
    field = dl.Sine(np.array([1e6, 4e6, 6e7]), 371.0)
    plain = run("compiled", "uniaxial", 0.3, field, averages=False, samples=5)
    measured = run("compiled", "uniaxial", 0.3, field, averages=True, samples=5)
    assert np.all(np.isnan(plain.mean)) and np.all(np.isnan(plain.mean_square))
    for name in ("maximum", "minimum", "state", "status", "status_time", "steps", "rejections", "samples"):
        np.testing.assert_array_equal(getattr(plain, name), getattr(measured, name), err_msg=name)
