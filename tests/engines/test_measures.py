"""Averages, final states, sections and trajectories of a sweep: closed forms, single runs, a second engine."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import delagrange as dl
from delagrange.common import memory
from delagrange.engines import engines
from delagrange.engines.engines import resolve_engine
from delagrange.engines.lanes import Interrupted, Sampling
from delagrange.run.measures import Measures
from delagrange.run.sampling import make_sampling

WITNESSES = ("numpy", "scipy")
ALL = {"averages": True, "final_state": True}
EQUAL_BIAXIAL = ("stretch", "stretch_rate", "inelastic_stretch")


def known_motion() -> ModuleType:
    """A model whose stretch is driven by the field alone: x'' = 1e-3 E(t), solved in closed form below."""
    model = ModuleType("known_motion")
    model.MODEL, model.FORMULATION, model.COORDINATE_COUNT = "known_motion", "consistent", 1
    quantity = lambda name, unit: SimpleNamespace(name=name, symbol="x", unit=unit, meaning=name)  # noqa: E731
    model.STATE = (quantity("stretch", "1"), quantity("stretch_rate", "1/s"))
    model.INPUTS = (quantity("nominal_electric_field", "V/m"),)
    model.PARAMETERS = ()
    model.rhs = lambda state, inputs, _: np.stack(np.broadcast_arrays(state[1], 1e-3 * inputs[0]))
    model.principal_stretches = lambda state, *_: np.stack([state[0], state[0], state[0] ** -2])
    model.reference_state = lambda _: np.array([1.0, 0.0])
    return model


def closed_form(time, amplitude, frequency, phase, start, rate):
    """Stretch [1] of the known motion."""
    turn, push = 2 * np.pi * frequency, 1e-3 * amplitude
    drift = rate + push / turn * np.cos(phase)
    return start + drift * time - push / turn**2 * (np.sin(turn * time + phase) - np.sin(phase))


@pytest.mark.parametrize("engine", WITNESSES)
@pytest.mark.parametrize("method", ["DOP853", "RK45"])
@settings(max_examples=3, deadline=None)
@given(
    phase=st.floats(-7.0, 7.0), start=st.floats(0.8, 1.5), rate=st.floats(-5.0, 5.0), begin=st.floats(0, 0.03)
)
def test_every_measure_of_a_known_motion(engine, method, phase, start, rate, begin):
    motion = {"amplitude": 3e6, "frequency": 73.0}
    response = dl.frequency_response(
        known_motion(), frequency=[motion["frequency"]], field_amplitude=motion["amplitude"],
        field_phase=phase, initial_state={"stretch": start, "stretch_rate": rate}, duration=0.04,
        window=(begin, 0.04), sample_interval=1e-3, method=method, engine=engine, rtol=1e-10, **ALL,
    )  # fmt: skip

    def stretch(time):
        return closed_form(time, **motion, phase=phase, start=start, rate=rate)

    mean = quad(stretch, begin, 0.04, epsabs=1e-13)[0] / (0.04 - begin)
    square = quad(lambda time: stretch(time) ** 2, begin, 0.04, epsabs=1e-13)[0] / (0.04 - begin)
    assert response["mean"].item() == pytest.approx(mean, rel=1e-8)
    assert response["root_mean_square"].item() == pytest.approx(np.sqrt(square), rel=1e-8)
    assert response["final_stretch"].item() == pytest.approx(stretch(0.04), rel=1e-8)
    np.testing.assert_allclose(response["time"], np.arange(41) * 1e-3, atol=1e-15)
    np.testing.assert_allclose(response["stretch"][0], stretch(response["time"].values), rtol=1e-7)


@pytest.mark.parametrize("engine", WITNESSES)
def test_a_sinusoidal_stretch_has_the_known_averages(engine):
    """x = 1 + a sin(ωt) over whole periods: mean 1, mean square 1 + a²/2; and its sections are all alike."""
    frequency, amplitude, turn = 50.0, 4e7, 100 * np.pi
    swing = -1e-3 * amplitude / turn**2
    response = dl.frequency_response(
        known_motion(), frequency=frequency, field_amplitude=amplitude, duration=0.1, window=(0.02, 0.08),
        initial_state={"stretch_rate": swing * turn}, section_points=3, section_phase=np.pi / 2,
        engine=engine, rtol=1e-11, averages=True,
    )  # fmt: skip
    assert abs(swing) > 0.4
    assert response["mean"].item() == pytest.approx(1.0, abs=1e-9)
    assert response["root_mean_square"].item() == pytest.approx(np.sqrt(1 + swing**2 / 2), rel=1e-9)
    np.testing.assert_allclose(response["section_stretch"], 1 + swing, rtol=1e-8)
    np.testing.assert_allclose(response["section_time"], [[0.045, 0.065, 0.085]], rtol=1e-14)


@settings(max_examples=4, deadline=None)
@given(
    force=st.floats(0.0, 0.6),
    amplitude=st.floats(1e6, 5e6),
    frequency=st.floats(150.0, 600.0),
    phase=st.floats(-4.0, 4.0),
    stretch=st.floats(0.9, 1.2),
    rate=st.floats(-50.0, 50.0),
)
def test_samples_and_final_states_are_those_of_single_runs(force, amplitude, frequency, phase, stretch, rate):
    response = dl.frequency_response(
        "equal_biaxial", force=force, field_amplitude=amplitude, field_phase=phase, frequency=[frequency],
        initial_state={"stretch_rate": rate, "stretch": stretch}, duration=0.01, sample_interval=3e-4,
        **ALL,
    )  # fmt: skip
    run = dl.simulate(
        "equal_biaxial", force=force, field=dl.Sine(amplitude, frequency, phase=phase), rtol=1e-11, atol=1e-14,
        initial_state=[stretch, rate, 1.0], duration=0.01, time=[*np.arange(34) * 3e-4, 0.01],
    )  # fmt: skip
    assert response.sizes["time"] == 34
    for name, scale in zip(EQUAL_BIAXIAL, (1.0, 1e3, 1.0), strict=True):
        np.testing.assert_allclose(response[name][0], run[name][:34], rtol=0, atol=1e-6 * scale)
        assert response[f"final_{name}"].item() == pytest.approx(run[name].values[-1], abs=1e-6 * scale)
        assert response[name].attrs == run[name].attrs


@settings(max_examples=4, deadline=None)
@given(
    frequency=st.floats(200.0, 600.0),
    field_phase=st.floats(-7.0, 7.0),
    section_phase=st.floats(-7.0, 7.0),
    count=st.integers(1, 3),
)
def test_sections_are_those_of_single_runs(frequency, field_phase, section_phase, count):
    response = dl.frequency_response(
        "uniaxial", force=0.3, field_amplitude=3e6, field_phase=field_phase, frequency=frequency,
        duration=0.02, section_points=count, section_phase=section_phase,
    )  # fmt: skip
    times = response["section_time"].values[0]
    assert np.all(np.diff(times) > 0) and times[0] >= 0 and 0.02 - 1 / frequency < times[-1] <= 0.02
    section = dl.stroboscopic_section(
        "uniaxial", force=0.3, field=dl.Sine(3e6, frequency, phase=field_phase), phase=section_phase,
        count=count, transient=int(times[0] * frequency), rtol=1e-11, atol=1e-14,
    )  # fmt: skip
    np.testing.assert_allclose(times, section["time"], rtol=1e-12)
    for entry in dl.load_model("uniaxial").STATE:
        scale = 1e3 if "rate" in entry.name else 1.0
        found = response[f"section_{entry.name}"]
        np.testing.assert_allclose(found[0], section[entry.name], rtol=0, atol=1e-6 * scale)
        assert found.dims == ("frequency", "period") and found.attrs["units"] == entry.unit


@pytest.mark.parametrize(
    "model", ["equal_biaxial", "uniaxial", "pure_shear_consistent", "pure_shear_consistent_free"]
)
@settings(max_examples=2, deadline=None)
@given(
    amplitude=st.floats(1e6, 4e6),
    frequency=st.floats(150.0, 600.0),
    phase=st.floats(-4.0, 4.0),
    window=st.sampled_from([(0.0, 0.008), (0.0, 3e-4), (5e-4, 8e-3), (6e-3, 7e-3)]),
    section_phase=st.floats(0.0, 6.0),
)
def test_engines_agree_on_every_measure_through_losses(
    model, amplitude, frequency, phase, window, section_phase
):
    """Outcomes, not Datasets: those still have the averages up to the loss."""
    held = {"held_stretch": 1.5} if model.startswith("pure_shear") else {}
    outcomes = [
        outcome_of(
            model, engine=engine, force=0.2, field_amplitude=[amplitude, 5e7, 3e8], frequency=[frequency],
            field_phase=phase, duration=8e-3, window=window, section_points=1, section_phase=section_phase,
            averages=True, **held,
        )
        for engine in WITNESSES
    ]  # fmt: skip
    fast, slow = outcomes
    assert fast.status[0] == 0 and np.all(fast.status[1:] > 0)
    np.testing.assert_array_equal(fast.status, slow.status)
    for name in ("mean", "mean_square", "maximum", "minimum"):
        np.testing.assert_allclose(getattr(fast, name), getattr(slow, name), rtol=1e-6, err_msg=name)
    never = fast.status_time <= window[0]
    np.testing.assert_array_equal(np.isnan(fast.mean), np.broadcast_to(never, fast.mean.shape))
    scale = np.abs(slow.state).max(axis=1, keepdims=True)
    np.testing.assert_allclose(fast.samples / scale, slow.samples / scale, rtol=0, atol=1e-6)


def outcome_of(model, engine, **options):
    """The outcome behind the Dataset of a sweep."""
    seen = []
    kept = engines.ENGINES[engine].integrate
    spy = replace(engines.ENGINES[engine], integrate=lambda *given: seen.append(kept(*given)) or seen[-1])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(engines, "ENGINES", {**engines.ENGINES, engine: spy})
        dl.frequency_response(model, engine=engine, **options)
    return seen[0]


@pytest.mark.parametrize("engine", WITNESSES)
def test_a_loss_ends_the_averages_and_the_samples(engine):
    response = dl.frequency_response(
        "equal_biaxial", frequency=[371.0], field_amplitude=[2e6, 5e7], duration=3e-3, engine=engine,
        sample_interval=1e-4, **ALL,
    )  # fmt: skip
    kept, lost = response.isel(field_amplitude=0, frequency=0), response.isel(field_amplitude=1, frequency=0)
    assert (kept["status"].item(), lost["status"].item()) == ("completed", "collapsed")
    for name in ("mean", "root_mean_square"):
        assert np.isfinite(kept[name]) and np.isnan(lost[name])
    run = dl.simulate("equal_biaxial", field=dl.Sine(5e7, 371.0), duration=3e-3, time=response["time"].values)
    assert lost["final_stretch"].item() == pytest.approx(1e-3**-0.5, rel=1e-9)  # where lambda_3 = 1e-3
    assert np.isnan(lost["stretch"].values[-1]) and lost["stretch"].values[0] == 1.0
    np.testing.assert_allclose(lost["stretch"], run["stretch"], rtol=1e-6)
    np.testing.assert_array_equal(lost["time"].values > lost["status_time"].item(), np.isnan(lost["stretch"]))
    assert np.all(np.isfinite(kept["stretch"]))


def test_a_run_lost_at_its_start_has_its_state_there():
    response = dl.frequency_response(
        "equal_biaxial", frequency=[371.0], field_amplitude=1e6, duration=1e-3, sample_interval=5e-4,
        initial_state={"stretch": [1.0, 200.0]}, **ALL,
    )  # fmt: skip
    lost = response.sel(initial_stretch=200.0)
    assert lost["status"].item() == "diverged" and lost["status_time"].item() == 0.0
    np.testing.assert_array_equal(lost["stretch"].values, [[200.0, np.nan, np.nan]])
    assert lost["final_stretch"].item() == 200.0 and np.isnan(lost["mean"].item())


@pytest.mark.parametrize(
    "samples", [{}, {"sample_interval": 2e-4}, {"section_points": 1, "section_phase": 0.5}]
)
def test_chunks_and_neighbours_do_not_show(monkeypatch, samples):
    sweep = {
        "force": [0.2, 0.5], "field_amplitude": [3e6, 5e7], "field_phase": [0.0, 1.0], "averages": True,
        "initial_state": {"stretch_1": [1.0, 1.1]}, "frequency": [300.0, 310.0, 350.0], "duration": 5e-3,
        "final_state": True, "engine": "numpy", "rtol": 1e-6,
    } | samples  # fmt: skip
    whole = dl.frequency_response("uniaxial", **sweep)
    small = replace(engines.ENGINES["numpy"], chunk=5)
    monkeypatch.setattr(engines, "ENGINES", {**engines.ENGINES, "numpy": small})
    xr.testing.assert_identical(dl.frequency_response("uniaxial", **sweep), whole)


def test_what_is_not_asked_for_changes_nothing():
    point = {"frequency": [300.0, 371.0], "field_amplitude": [3e6, 5e7], "force": 0.3, "duration": 5e-3}
    plain = dl.frequency_response("uniaxial", engine="numpy", **point)
    same = dl.frequency_response(
        "uniaxial", engine="numpy", field_phase=0.0, sample_interval=1e-3, **ALL, **point
    )
    assert set(plain.data_vars) == {
        "amplitude", "maximum", "minimum", "stretch_2_amplitude", "stretch_2_maximum", "stretch_2_minimum",
        "status", "status_time",
    }  # fmt: skip
    xr.testing.assert_identical(same[list(plain.data_vars)], plain)
    outcome = outcome_of("uniaxial", engine="numpy", **point)
    assert np.all(np.isnan(outcome.mean)) and np.all(np.isnan(outcome.mean_square))
    assert outcome.samples.shape == (0, 6, 4)


def test_variables_say_what_they_are(tmp_path):
    response = dl.frequency_response(
        "uniaxial", frequency=[300.0, 400.0], field_amplitude=1e6, field_phase=[0.0, 1.0], duration=0.01,
        window=(0.0, 5e-3), section_points=2, section_phase=0.5, initial_state={"stretch_rate_2": [0.0, 1.0]},
        **ALL,
    )  # fmt: skip
    for name, data in response.variables.items():
        if name != "status":
            assert data.attrs["units"] and data.attrs["long_name"], name
    assert response["stretch_2_root_mean_square"].attrs["definition"].startswith("square root of the time av")
    assert response["mean"].attrs["definition"].startswith("time average over the window")
    assert response["mean"].attrs["window_stop"] == 5e-3
    assert response["final_stretch_rate_2"].attrs["units"] == "1/s"
    assert response["field_phase"].attrs["units"] == "rad"
    assert response["initial_stretch_rate_2"].attrs["units"] == "1/s"
    assert response["section_time"].dims == ("field_phase", "frequency", "period")
    assert "0.5 rad" in response["section_time"].attrs["definition"]
    assert list(response["mean"].dims) == ["field_phase", "initial_stretch_rate_2", "frequency"]
    assert response.attrs["nominal_electric_field_drive"].endswith("sin(2 pi frequency t + field_phase)")
    assert (response.attrs["engine"], response.attrs["step_control"]) != ("auto", None)
    response.to_netcdf(tmp_path / "response.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "response.nc"), response)


def test_interrupted_runs_have_no_measures(monkeypatch):
    default = engines.ENGINES["numpy"]

    def stopped(problem, state, settings, sampling, report):
        def stop_late(done):
            if done > 1.5:
                raise KeyboardInterrupt

        return default.integrate(problem, state, settings, sampling, stop_late)

    monkeypatch.setattr(engines, "ENGINES", {"numpy": replace(default, integrate=stopped)})
    with pytest.warns(UserWarning, match="interrupted: 1 of 2 runs"):
        response = dl.frequency_response(
            "equal_biaxial", frequency=[300.0], field_amplitude=[1e6, 5e7], duration=5e-3, engine="numpy",
            sample_interval=1e-4, **ALL,
        )  # fmt: skip
    left, lost = response.isel(field_amplitude=0), response.isel(field_amplitude=1)
    assert (left["status"].item(), lost["status"].item()) == ("interrupted", "collapsed")
    for name in ("stretch", "final_stretch", "mean", "root_mean_square", "amplitude"):
        assert np.all(np.isnan(left[name])), name
    assert lost["stretch"].values[0, 0] == 1.0


def test_an_interrupted_engine_has_carried_the_samples_of_lost_lanes():
    """Each engine raises with its outcome, of the same shape as the whole one."""
    seen = []
    default = engines.ENGINES["scipy"]

    def stop(done):
        raise KeyboardInterrupt

    def stopped(problem, state, settings, sampling, report):
        with pytest.raises(Interrupted) as interruption:
            default.integrate(problem, state, settings, sampling, stop)
        seen.append(interruption.value.outcome)
        raise interruption.value

    with pytest.MonkeyPatch.context() as patch, pytest.warns(UserWarning, match="interrupted: 1 of 2"):
        patch.setattr(engines, "ENGINES", {"scipy": replace(default, integrate=stopped)})
        dl.frequency_response(
            "equal_biaxial", frequency=[300.0, 310.0], field_amplitude=1e6, duration=2e-3, engine="scipy",
            sample_interval=1e-4,
        )  # fmt: skip
    assert seen[0].samples.shape == (21, 3, 2)
    assert np.all(np.isfinite(seen[0].samples[..., 0])) and np.all(np.isnan(seen[0].samples[..., 1]))


@given(
    first=st.floats(0.0, 2.0),
    spacing=st.floats(1e-3, 1.0),
    count=st.integers(1, 50),
    number=st.integers(-2, 60),
    offset=st.sampled_from([-1e-9, 0.0, 1e-9]),
)
def test_samples_are_counted_exactly(first, spacing, count, number, offset):
    """Also at times that are a sample's to the last bit."""
    sampling = Sampling(np.array([first]), np.array([spacing]), count)
    time = np.array([first + number * spacing + offset])
    assert sampling.taken(time)[0] == np.count_nonzero(sampling.times()[:, 0] <= time[0])
    own = sampling.times()[:, 0]
    every = Sampling(np.full(count, first), np.full(count, spacing), count)
    np.testing.assert_array_equal(every.taken(own), np.arange(count) + 1)


@given(
    periods=st.integers(1, 400), frequency=st.floats(1.0, 1e4), phase=st.sampled_from([0.0, 2 * np.pi, -2.0])
)
def test_rounding_costs_no_section_and_no_sample(periods, frequency, phase):
    """A duration of whole periods holds its last point, and no point lies behind it."""
    fraction = np.mod(phase / (2 * np.pi), 1.0)
    duration = (periods + fraction) / frequency
    sections = Measures(section_points=periods + 1, section_phase=phase)
    times = make_sampling(sections, duration, np.array([frequency]), 0.0).times()[:, 0]
    np.testing.assert_allclose(times * frequency, np.arange(periods + 1) + fraction, rtol=1e-10, atol=1e-10)
    assert times[0] >= 0 and times[-1] <= duration
    regular = Measures(sample_interval=1 / frequency)
    times = make_sampling(regular, periods / frequency, np.array([1.0]), 0.0).times()[:, 0]
    assert len(times) == periods + 1 and times[-1] <= periods / frequency
    np.testing.assert_allclose(times, np.arange(periods + 1) / frequency, rtol=1e-12)


def test_the_memory_of_the_result_is_bounded_before_anything_runs(monkeypatch):
    def fail(*_):
        raise AssertionError("integrated")

    unable = {name: replace(engine, integrate=fail) for name, engine in engines.ENGINES.items()}
    monkeypatch.setattr(engines, "ENGINES", unable)
    with pytest.raises(
        ValueError, match=r"result of 1000 runs would take 2235.17 GiB .*for 100000001 samples of 3 state"
    ):
        dl.frequency_response(
            "equal_biaxial", frequency=np.arange(1.0, 1001.0), field_amplitude=1e6, duration=10.0,
            sample_interval=1e-7,
        )  # fmt: skip


def test_the_memory_counted_is_that_of_the_arrays():
    """No array that a run keeps is forgotten; the scalar coordinates and axes are not counted."""
    options = {"field_amplitude": [1e6, 2e6], "frequency": np.arange(300.0, 310.0), "duration": 1e-3}
    outcome = outcome_of("uniaxial", engine="numpy", sample_interval=1e-5, averages=True, **options)
    response = dl.frequency_response("uniaxial", sample_interval=1e-5, averages=True, **options)
    model, kept = dl.load_model("uniaxial"), sum(values.nbytes for values in vars(outcome).values())
    copied = [
        name for name in response.data_vars if name.endswith(("tude", "mum", "mean", "square", "status"))
    ]
    kept += sum(response[name].nbytes for name in copied)
    assert len(copied) == 11 and kept == 20 * sum(memory.run_memory(model, 101).values())
    memory.check_memory(model, 10**7, 4)
    with pytest.raises(
        ValueError, match=r"extrema, averages, final state and status of every run\); at most 8"
    ):
        memory.check_memory(model, 10**8, 0)


def test_large_samples_are_integrated_in_smaller_chunks():
    model = dl.load_model("equal_biaxial")
    assert memory.lanes_at_a_time(model, 4096, 0) == 4096
    assert memory.lanes_at_a_time(model, 4096, 1000) == 4096
    assert (
        memory.lanes_at_a_time(model, 4096, 10**6) * 10**6 * memory.sample_memory(model) <= memory.MOST_CHUNK
    )
    assert memory.lanes_at_a_time(model, 4096, 10**9) == 1


def test_auto_is_an_engine_of_the_registry():
    model = dl.load_model("equal_biaxial")
    for method, control, extrema in [("DOP853", None, "dense"), ("RK45", "ode45", "steps")]:
        assert resolve_engine("auto", method, control, extrema, model, []) in engines.ENGINES
    for name in engines.ENGINES:
        assert resolve_engine(name, "DOP853", None, "dense", model, []) == name


def test_threads_reach_the_settings(monkeypatch):
    seen = []
    default = engines.ENGINES["numpy"]

    def counted(problem, state, settings, *others):
        seen.append(settings.threads)
        return default.integrate(problem, state, settings, *others)

    monkeypatch.setattr(engines, "ENGINES", {"numpy": replace(default, integrate=counted)})
    for threads in (None, 3):
        dl.frequency_response(
            "equal_biaxial",
            frequency=300.0,
            field_amplitude=1e6,
            duration=1e-3,
            engine="numpy",
            threads=threads,
        )
    assert seen == [None, 3]
