"""Stroboscopic sections at exact phases, and phase portraits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl

FIELD = dl.Sine(5e6, 371.0)


@settings(max_examples=4, deadline=None)
@given(phase=st.floats(0.0, 6.28), transient=st.integers(0, 3))
def test_points_lie_at_exact_phases(phase, transient):
    section = dl.stroboscopic_section(
        "equal_biaxial",
        force=0.5,
        field=FIELD,
        count=5,
        transient=transient,
        phase=phase,
        rtol=1e-12,
        atol=1e-14,
    )
    cycles = section["time"].values * FIELD.frequency - phase / (2 * np.pi)
    np.testing.assert_allclose(cycles, np.arange(5) + transient, atol=1e-12)
    np.testing.assert_array_equal(section["period_number"], np.arange(5) + transient)
    np.testing.assert_allclose(section["nominal_electric_field"], FIELD.amplitude * np.sin(phase), atol=1e-5)
    last = section["time"].values[-1]
    end = dl.simulate(
        "equal_biaxial", force=0.5, field=FIELD, duration=last, samples=2, rtol=1e-12, atol=1e-14
    )
    assert section["stretch"].values[-1] == pytest.approx(end["stretch"].values[-1], rel=1e-9)
    assert section["stretch_rate"].values[-1] == pytest.approx(
        end["stretch_rate"].values[-1], rel=1e-7, abs=1e-5
    )


def test_a_period_of_ones_own_and_a_loss():
    section = dl.stroboscopic_section("uniaxial", force=0.2, period=1e-3, count=3)
    np.testing.assert_allclose(section["time"], [0.0, 1e-3, 2e-3])
    lost = dl.stroboscopic_section("equal_biaxial", field=dl.Sine(5e7, 371.0), count=10)
    assert lost["status"].item() == "collapsed"
    assert np.isnan(lost["stretch"].values[-1]) and np.isfinite(lost["stretch"].values[0])


def test_section_survives_the_disk(tmp_path):
    section = dl.stroboscopic_section("equal_biaxial", field=FIELD, count=3)
    section.to_netcdf(tmp_path / "section.nc")
    assert section["period_number"].dims == ("point",)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"field": 1e6, "count": 3}, "period"),
        ({"field": FIELD, "force": dl.Sine(0.1, 100.0), "count": 3}, "period"),
        ({"field": FIELD, "count": 0}, "count"),
        ({"field": FIELD, "count": 3, "transient": -1}, "transient"),
        ({"field": FIELD, "count": 3, "phase": float("nan")}, "phase .* rad"),
        ({"field": FIELD, "count": 3, "period": -1.0}, "period .* -1 s"),
        ({"field": FIELD, "count": 3, "duration": 1.0}, "duration"),
    ],
)
def test_senseless_sections_are_refused(options, named):
    with pytest.raises(ValueError, match=named):
        dl.stroboscopic_section("equal_biaxial", **options)


def test_phase_portrait():
    run = dl.simulate("uniaxial", force=0.5, field=FIELD, duration=0.01)
    portrait = dl.phase_portrait(run, start=0.005)
    assert list(portrait.data_vars) == ["stretch_1", "stretch_rate_1"]
    assert portrait["time"].values[0] == pytest.approx(0.005)
    assert list(dl.phase_portrait(run, "stretch_2").data_vars) == ["stretch_2", "stretch_rate_2"]
    lost = dl.simulate("equal_biaxial", field=5e7, duration=0.01)
    shown = dl.phase_portrait(lost)
    assert 0 < shown.sizes["time"] < lost.sizes["time"]
    assert bool(np.isfinite(shown["stretch_rate"]).all())
    with pytest.raises(ValueError, match="coordinate must be one of stretch_1, stretch_2; got 'stretch_3'"):
        dl.phase_portrait(run, "stretch_3")
    with pytest.raises(ValueError, match="start = 1 s leaves nothing"):
        dl.phase_portrait(run, start=1.0)


def test_phase_portrait_of_a_section():
    section = dl.stroboscopic_section("equal_biaxial", force=0.5, field=FIELD, count=6)
    portrait = dl.phase_portrait(section, start=2.5 / FIELD.frequency)
    np.testing.assert_array_equal(portrait["stretch"], section["stretch"].values[3:])
    np.testing.assert_array_equal(portrait["stretch_rate"], section["stretch_rate"].values[3:])


def _response():
    return dl.frequency_response("equal_biaxial", field_amplitude=1e6, frequency=[300.0], duration=1e-3)


@pytest.mark.parametrize(
    ("make", "given"),
    [
        (lambda: None, "got None"),
        (lambda: np.ones((3, 3)), "got .* of shape"),
        (_response, "got a Dataset of amplitude, maximum, minimum"),
        (lambda: dl.simulate("uniaxial", duration=1e-3).drop_vars("time"), "got a Dataset of stretch_1"),
    ],
)
def test_what_is_no_run_has_no_phase_portrait(make, given):
    with pytest.raises(ValueError, match=f"run must be a Dataset over time as simulate returns it.* {given}"):
        dl.phase_portrait(make())
