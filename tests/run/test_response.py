"""Frequency response: dimensions, statuses, the SciPy engine as witness, interruption, peaks."""

from __future__ import annotations

import _thread
import signal
import threading
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.engines import engines
from delagrange.engines.engines import Numerics
from delagrange.engines.lanes import Interrupted, empty_outcome
from delagrange.engines.numpy_engine import integrate_lanes
from delagrange.problem.problem import make_problem
from delagrange.problem.status import INTERRUPTED, STATUS
from delagrange.run.sweep import make_settings

NUMERICS = Numerics("DOP853", "numpy", "scipy", "dense")
SHORT = {"duration": 0.01, "rtol": 1e-9, "atol": 1e-12}


@pytest.mark.parametrize(
    ("model", "options"),
    [
        ("equal_biaxial", {}),
        ("uniaxial", {}),
        ("pure_shear", {"held_stretch": [1.5, 2.0]}),
        ("pure_shear", {"held_stretch": 1.5, "formulation": "as_printed"}),
        ("pure_shear", {"held_stretch": 1.5, "lateral_dashpot": "free"}),
    ],
)
def test_scipys_engine_agrees_through_failures_too(model, options):
    sweep = {
        "force": 0.3,
        "field_amplitude": [1e6, 5e6, 4e7],
        "frequency": [200.0, 371.0],
        **options,
        **SHORT,
    }
    fast = dl.frequency_response(model, **sweep)
    slow = dl.frequency_response(model, engine="scipy", **sweep)
    assert fast["status"].equals(slow["status"])
    if model != "pure_shear":
        assert {"completed", "collapsed"} <= set(fast["status"].values.ravel())
    np.testing.assert_allclose(fast["status_time"], slow["status_time"], rtol=1e-7)
    for name in fast.data_vars:
        if name not in ("status", "status_time"):
            np.testing.assert_allclose(fast[name], slow[name], rtol=1e-6)


@settings(max_examples=4, deadline=None)
@given(
    force=st.floats(0.05, 0.8),
    amplitude=st.floats(5e5, 5e6),
    frequency=st.floats(100.0, 800.0),
    window=st.sampled_from([None, (0.0, 5e-3), (4e-3, 1e-2)]),
    density=st.floats(500.0, 3000.0),
)
def test_random_points_agree_with_scipys_engine(force, amplitude, frequency, window, density):
    point = {
        "force": force,
        "field_amplitude": amplitude,
        "frequency": frequency,
        "density": density,
        "window": window,
    }
    fast = dl.frequency_response("uniaxial", **point, **SHORT)
    slow = dl.frequency_response("uniaxial", engine="scipy", **point, **SHORT)
    np.testing.assert_allclose(fast["amplitude"], slow["amplitude"], rtol=1e-6)
    np.testing.assert_allclose(fast["stretch_2_minimum"], slow["stretch_2_minimum"], rtol=1e-8)


def test_whatever_is_an_array_becomes_a_dimension():
    response = dl.frequency_response(
        "pure_shear",
        frequency=[300.0, 310.0],
        force=[0.1, 0.2],
        field_amplitude=[1e6],
        held_stretch=[1.5, 2.0, 3.0],
        relaxation_time=[1.0, 400.0],
        shear_modulus_beta=[3e4, 4.2e4],
        duration=2e-3,
    )
    assert dict(response["amplitude"].sizes) == {
        "force": 2, "field_amplitude": 1, "held_stretch": 3, "relaxation_time": 2, "shear_modulus_beta": 2,
        "frequency": 2,
    }  # fmt: skip
    assert "viscosity" not in response.attrs
    assert response.attrs["density"] == 1200.0 and response.attrs["density_units"] == "kg/m^3"
    one = dl.frequency_response(
        "pure_shear", frequency=310.0, force=0.2, field_amplitude=1e6, held_stretch=2.0, relaxation_time=1.0,
        shear_modulus_beta=3e4, duration=2e-3,
    )  # fmt: skip
    same = response.sel(
        force=0.2,
        field_amplitude=1e6,
        held_stretch=2.0,
        relaxation_time=1.0,
        shear_modulus_beta=3e4,
        frequency=310.0,
    )
    assert one["amplitude"].dims == ("frequency",)
    assert one["field_amplitude"].ndim == 0 and one["field_amplitude"].item() == 1e6
    assert same["amplitude"].item() == one["amplitude"].item()


def test_chunks_do_not_show(monkeypatch):
    sweep = {
        "force": [0.2, 0.5],
        "field_amplitude": 3e6,
        "frequency": np.arange(300.0, 310.0),
        "duration": 5e-3,
    }
    whole = dl.frequency_response("uniaxial", **sweep)
    small = replace(engines.ENGINES[whole.attrs["engine"]], chunk=3)
    monkeypatch.setattr(engines, "ENGINES", {**engines.ENGINES, whole.attrs["engine"]: small})
    xr.testing.assert_identical(dl.frequency_response("uniaxial", **sweep), whole)


def test_amplitude_is_half_of_peak_to_peak_and_says_so():
    response = dl.frequency_response(
        "equal_biaxial", frequency=371.0, force=0.5, field_amplitude=5e6, duration=0.02, window=(0.005, 0.015)
    )
    run = dl.simulate(
        "equal_biaxial",
        force=0.5,
        field=dl.Sine(5e6, 371.0),
        duration=0.02,
        time=np.linspace(0.005, 0.015, 50_001),
    )
    half = (run["stretch"].max() - run["stretch"].min()).item() / 2
    assert response["amplitude"].item() == pytest.approx(half, rel=1e-6)
    attributes = response["amplitude"].attrs
    assert attributes["definition"].startswith("half of peak to peak")
    assert (attributes["window_start"], attributes["window_stop"], attributes["units"]) == (0.005, 0.015, "1")


def test_a_bias_and_a_driven_force():
    bias = dl.frequency_response(
        "equal_biaxial", frequency=[371.0], field_amplitude=1e6, field_bias=2e6, **SHORT
    )
    field = dl.Sine(1e6, 371.0, bias=2e6)
    run = dl.simulate("equal_biaxial", field=field, samples=20_001, **SHORT)
    assert bias["maximum"].item() == pytest.approx(run["stretch"].max().item(), rel=1e-7)
    ramp = dl.Ramp(0.0, 0.5, duration=5e-3)
    driven = dl.frequency_response(
        "equal_biaxial", frequency=[371.0], field_amplitude=1e6, force=ramp, **SHORT
    )
    run = dl.simulate("equal_biaxial", field=dl.Sine(1e6, 371.0), force=ramp, samples=20_001, **SHORT)
    assert driven["maximum"].item() == pytest.approx(run["stretch"].max().item(), rel=1e-7)
    assert driven.attrs["force_drive"].startswith("Ramp(")


def test_lost_points_keep_their_extrema_and_leave_the_rest_right():
    frequency = np.array([300.0, 371.0])
    both = dl.frequency_response("equal_biaxial", frequency=frequency, field_amplitude=[2e6, 5e7], **SHORT)
    lost, kept = both.isel(field_amplitude=1), both.isel(field_amplitude=0)
    assert set(lost["status"].values) == {"collapsed"}
    assert np.all(np.isnan(lost["amplitude"])) and np.all(lost["status_time"] < 0.01)
    np.testing.assert_allclose(lost["maximum"], 1e-3**-0.5, rtol=1e-9)  # where lambda_3 = 1e-3
    alone = dl.frequency_response("equal_biaxial", frequency=frequency, field_amplitude=2e6, **SHORT)
    np.testing.assert_array_equal(kept["amplitude"], alone["amplitude"])


def test_peaks():
    amplitude = xr.DataArray(
        [[0.1, 0.3, 0.2], [0.5, np.nan, 0.4], [np.nan] * 3],
        dims=("force", "frequency"),
        coords={"frequency": [1.0, 2.0, 3.0], "force": [0.1, 0.2, 0.3]},
    )
    found = dl.peaks(xr.Dataset({"amplitude": amplitude}))
    np.testing.assert_array_equal(found["resonance_frequency"], [2.0, 1.0, np.nan])
    np.testing.assert_array_equal(found["peak_amplitude"], [0.3, 0.5, np.nan])
    assert found["resonance_frequency"].attrs["units"] == "Hz"


def test_survives_the_disk(tmp_path):
    response = dl.frequency_response(
        "uniaxial", frequency=[300.0, 400.0], force=[0.2, 0.5], field_amplitude=1e6, duration=2e-3
    )
    response.to_netcdf(tmp_path / "response.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "response.nc"), response)
    for name, data in response.variables.items():
        if name != "status":
            assert data.attrs["units"] and data.attrs["long_name"]


@pytest.fixture
def keyboard():
    """Ctrl-C interrupts, also where these tests were started in the background, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_interrupted_from_the_keyboard_what_is_done_stays(keyboard):
    frequency = np.linspace(100.0, 800.0, 20_000)
    timer = threading.Timer(0.7, _thread.interrupt_main)
    timer.start()
    with pytest.warns(UserWarning, match="interrupted: .* of 20000 runs not computed"):
        response = dl.frequency_response(
            "equal_biaxial", frequency=frequency, field_amplitude=1e6, duration=1e-3, engine="scipy"
        )
    timer.cancel()
    status = response["status"].values
    done = np.flatnonzero(status == "completed")
    assert 0 < len(done) < len(status)
    assert set(status) == {"completed", "interrupted"}
    assert np.all(np.isfinite(response["amplitude"].values[done]))
    assert np.all(np.isnan(response["amplitude"].values[status == "interrupted"]))


def test_progress_goes_to_standard_error(capsys):
    dl.frequency_response("equal_biaxial", frequency=300.0, field_amplitude=1e6, duration=1e-3, progress=True)
    captured = capsys.readouterr()
    assert captured.out == "" and "response" in captured.err


@pytest.mark.parametrize(
    ("force", "amplitude", "printed_frequency", "printed_amplitude"),
    [(0.2, 1e6, 431, 0.05206), (0.5, 1e6, 385, 0.1248), (0.8, 1e6, 340, 0.2373)],
)
def test_the_papers_own_numerics_give_its_printed_peaks(
    force, amplitude, printed_frequency, printed_amplitude
):
    """Sheng et al. (2015), Sec. III A: RK5(4) as `ode45` has it, default tolerances, pi taken as 3.14."""
    frequency = np.arange(printed_frequency - 15.0, printed_frequency + 16.0)
    response = dl.frequency_response(
        "equal_biaxial", force=force, field_amplitude=amplitude, frequency=frequency * 3.14 / np.pi,
        duration=0.1, rtol=1e-3, atol=1e-6, method="RK45", step_control="ode45", extrema="samples",
    )  # fmt: skip
    peak = dl.peaks(response.assign_coords(frequency=frequency))
    assert peak["resonance_frequency"].item() == printed_frequency
    assert peak["peak_amplitude"].item() == pytest.approx(printed_amplitude, rel=3e-3)


def test_interrupted_between_chunks_the_default_engine_keeps_the_first(monkeypatch):
    """An interruption while the second chunk runs leaves the first as if nothing had happened."""
    whole = dl.frequency_response(
        "equal_biaxial", frequency=[300.0, 310.0, 320.0, 330.0], field_amplitude=1e6, duration=2e-3
    )
    name = whole.attrs["engine"]
    default = engines.ENGINES[name]
    calls = []

    def interrupted_later(problem, state, *others):
        calls.append(1)
        if len(calls) == 2:
            raise Interrupted(empty_outcome(state, 1, INTERRUPTED))
        return default.integrate(problem, state, *others)

    interrupted = replace(default, integrate=interrupted_later, chunk=2)
    monkeypatch.setattr(engines, "ENGINES", {**engines.ENGINES, name: interrupted})
    with pytest.warns(UserWarning, match="interrupted: 2 of 4 runs not computed"):
        part = dl.frequency_response(
            "equal_biaxial", frequency=[300.0, 310.0, 320.0, 330.0], field_amplitude=1e6, duration=2e-3
        )
    assert list(part["status"].values) == ["completed"] * 2 + ["interrupted"] * 2
    np.testing.assert_array_equal(part["amplitude"][:2], whole["amplitude"][:2])


def test_an_interruption_inside_a_chunk_carries_the_lanes_that_had_ended(monkeypatch):
    """Pulled-in lanes end early; what they found is not lost with the rest of their chunk."""
    seen = []

    def stop_late(done):
        seen.append(done)
        if done > 1.9:
            raise KeyboardInterrupt

    model = dl.load_model("equal_biaxial")
    problem = make_problem(model, None, {}, None, 0.0, dl.Constant(np.array([3e7, 1e6])))
    state = np.repeat(model.reference_state(problem.parameters)[:, None], 2, axis=1)
    settings = make_settings(5e-3, None, 1e-8, 1e-11, NUMERICS, dl.Limits())
    with pytest.raises(Interrupted) as interruption:
        integrate_lanes(problem, state, settings, report=stop_late)
    status = [STATUS[code] for code in interruption.value.outcome.status]
    assert status == ["collapsed", "interrupted"]
    assert seen == sorted(seen) and 0 < seen[0] < seen[-1] <= 2


def test_progress_moves_while_a_chunk_runs():
    seen = []
    model = dl.load_model("equal_biaxial")
    problem = make_problem(model, None, {}, None, 0.2, dl.Constant(np.array([1e6, 2e6])))
    state = np.repeat(model.reference_state(problem.parameters)[:, None], 2, axis=1)
    settings = make_settings(2e-3, None, 1e-8, 1e-11, NUMERICS, dl.Limits())
    integrate_lanes(problem, state, settings, report=seen.append)
    assert len(seen) > 5 and seen == sorted(seen) and seen[-1] == 2


def test_a_force_drive_of_several_lanes_is_refused():
    with pytest.raises(ValueError, match="is a drive with arrays"):
        dl.frequency_response(
            "equal_biaxial",
            force=dl.Step(np.array([0.1, 0.2])),
            frequency=[300.0, 301.0],
            field_amplitude=1e6,
            duration=1e-3,
        )


def test_a_grid_beyond_memory_is_refused():
    with pytest.raises(ValueError, match="has 810000000000 runs; at most"):
        dl.frequency_response(
            "equal_biaxial",
            frequency=np.arange(1.0, 900001.0),
            force=np.arange(900000.0),
            field_amplitude=1e6,
            duration=1e-3,
        )


def test_peaks_of_something_else_are_refused():
    run = dl.simulate("equal_biaxial", duration=1e-4, samples=3)
    with pytest.raises(ValueError, match="peaks needs the Dataset of frequency_response"):
        dl.peaks(run)


@pytest.mark.parametrize(
    ("values", "status"),
    [
        ({"half_length": [1e300, 5e-3], "field_amplitude": 1e6}, ["diverged", "completed"]),
        ({"density": [1e308, 1.2e3], "field_amplitude": 1e6}, ["diverged", "completed"]),
    ],
)
def test_a_lane_beyond_double_precision_ends_alone(values, status):
    """It must neither crawl for ever nor touch its neighbour."""
    response = dl.frequency_response("equal_biaxial", frequency=[300.0], duration=1e-3, **values)
    assert list(response["status"].values.ravel()) == status
    alone = dl.frequency_response("equal_biaxial", frequency=[300.0], duration=1e-3, field_amplitude=1e6)
    assert response["amplitude"].values.ravel()[1] == alone["amplitude"].values.ravel()[0]


def test_a_field_beyond_any_sense_is_refused():
    with pytest.raises(
        ValueError, match=r"field_amplitude must lie from -1e\+15 to 1e\+15 V/m, got 1e\+200 V/m"
    ):
        dl.frequency_response("equal_biaxial", frequency=[300.0], duration=1e-3, field_amplitude=[1e200, 1e6])


def test_a_ramp_too_short_to_be_one_is_refused():
    with pytest.raises(ValueError, match="Ramp duration must be at least 1e-12 s"):
        dl.Ramp(0.0, 1e6, 1e-320)
