"""Branches of periodic motions: closed forms, laws, independent runs, and every way of ending."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.analysis.steady import steady_response as module
from delagrange.analysis.steady.floquet import BRANCH_POINT, FOLD, PERIOD_DOUBLING
from delagrange.engines.flows import resolve_flow

COARSE = {"resolution": 20, "seeds": 2}
DAMPED = {"force": 0.1, "field_amplitude": 4e6, "relaxation_time": 1e-2, "dashpots": "relaxed"}


@cache
def softening():
    """The resonance of the undamped membrane, whose left side folds back."""
    return dl.steady_response(
        "equal_biaxial", force=0.5, field_amplitude=5e6, frequency=(340.0, 420.0), largest_amplitude=0.6,
        resolution=60, seeds=5,
    )  # fmt: skip


@cache
def damped():
    """A resonance with hysteresis."""
    return dl.steady_response(
        "equal_biaxial", frequency=(400.0, 430.0), largest_amplitude=0.25, seeds=4, **DAMPED
    )


def of_branch(data, number):
    return data.isel(point=np.flatnonzero(data["branch_number"].values == number))


def bifurcation_values(data, kind, name="frequency"):
    return np.sort(data[f"bifurcation_{name}"].values[data["bifurcation_kind"].values == kind])


def crossings(data, value):
    """(amplitude, stability) of every branch where it passes a value of what varies, linearly between points."""
    varied, found = data.attrs["varied"], []
    for number in range(data.sizes["branch"]):
        one = of_branch(data, number)
        x, y, names = one[varied].values, one["amplitude"].values, one["stability"].values
        for k in np.flatnonzero((x[:-1] - value) * (x[1:] - value) <= 0):
            share = (value - x[k]) / (x[k + 1] - x[k]) if x[k + 1] != x[k] else 0.0
            found.append((y[k] + share * (y[k + 1] - y[k]), names[k]))
    return found


def linear_amplitude(field_amplitude, frequency):
    """Forced vibration of the undeformed membrane to first order in E^2, and with it the drive at 2 f.

    m q'' + 12 mu V q = 2 eps V E0^2 sin^2(2 pi f t), from the energies at the reference state.
    """
    p = dl.SHENG_2015
    volume = 8 * p.half_length**2 * p.half_thickness
    mass = 2 * p.density * volume / 3 * (p.half_length**2 + 2 * p.half_thickness**2)
    stiffness = 12 * (p.shear_modulus_alpha + p.shear_modulus_beta) * volume
    return volume * p.permittivity * field_amplitude**2 / abs(stiffness - mass * (4 * np.pi * frequency) ** 2)


@pytest.mark.parametrize("frequency", [(200.0, 400.0), (500.0, 700.0)])
def test_a_small_drive_gives_the_linear_response(frequency):
    found = dl.steady_response(
        "equal_biaxial", field_amplitude=1e4, frequency=frequency, tolerance=1e-13, **COARSE
    )
    assert found.sizes["branch"] == 1
    expected = linear_amplitude(1e4, found["frequency"].values)
    assert found["amplitude"].values == pytest.approx(expected, rel=1e-6)


def test_every_point_is_periodic_by_an_independent_run():
    data = softening()
    for k in range(0, data.sizes["point"], data.sizes["point"] // 6):
        one = data.isel(point=k)
        state = [one[name].item() for name in ("stretch", "stretch_rate", "inelastic_stretch")]
        run = dl.simulate(
            "equal_biaxial", force=0.5, field=dl.Sine(5e6, one["frequency"].item()), duration=one["period"].item(),
            initial_state=np.array(state), viscosity=1e30, rtol=1e-12, samples=4001,
        )  # fmt: skip
        stretch = run["stretch"].values
        assert stretch[-1] == pytest.approx(stretch[0], abs=1e-9)
        assert (stretch.max() - stretch.min()) / 2 == pytest.approx(one["amplitude"].item(), abs=2e-6)
    assert float(data["closure_error"].max()) < 1e-10


def test_without_damping_the_left_side_folds_and_the_right_one_does_not():
    data = softening()
    assert len(bifurcation_values(data, FOLD)) == 1
    fold = bifurcation_values(data, FOLD)[0]
    below = crossings(data, fold - 1.0)
    above = crossings(data, fold + 1.0)
    assert sorted(name for _, name in below) == ["neutral", "neutral", "unstable"]
    assert [name for _, name in above] == ["neutral"]
    assert any("limit: an amplitude beyond 0.6" in ending for ending in data["ending"].values.ravel())


def test_the_multipliers_of_a_conservative_motion_come_in_reciprocal_pairs():
    data = softening()
    values = data["multiplier_real"].values + 1j * data["multiplier_imag"].values
    assert np.prod(values, axis=1) == pytest.approx(np.exp(data["divergence"].values), rel=1e-8)
    assert np.prod(values, axis=1) == pytest.approx(1.0, rel=1e-8)


CASES = [
    ("equal_biaxial", {}),
    ("uniaxial", {}),
    ("pure_shear", {"held_stretch": 2.0}),
    ("pure_shear", {"held_stretch": 2.0, "formulation": "as_printed"}),
    ("pure_shear", {"held_stretch": 2.0, "lateral_dashpot": "free"}),
]


@pytest.mark.parametrize("dashpots", ["frozen", "relaxed"])
@pytest.mark.parametrize("name, more", CASES)
def test_the_product_of_the_multipliers_is_that_of_the_divergence(name, more, dashpots):
    data = dl.steady_response(
        name, force=0.1, field_amplitude=1e6, frequency=(300.0, 330.0), dashpots=dashpots, relaxation_time=5e-3,
        largest_amplitude=0.5, **more, **COARSE,
    )  # fmt: skip
    assert data.sizes["point"] > 10
    assert float(data["product_error"].max()) < 1e-8
    assert (dashpots == "frozen") == ("neutral" in data["stability"].values)


def test_a_multiplier_far_below_the_others_is_resolved():
    data = dl.steady_response(
        "equal_biaxial", field_amplitude=1e6, frequency=(300.0, 310.0), dashpots="relaxed", relaxation_time=1e-5,
        largest_amplitude=0.1, **COARSE,
    )  # fmt: skip
    assert float(data["multiplier_logarithm"].max() - data["multiplier_logarithm"].min()) > 100
    assert float(data["product_error"].max()) < 1e-8
    assert set(data["stability"].values) == {"stable"}


def test_sweeps_follow_the_stable_branches_and_jump_at_the_folds():
    data = damped()
    low, high = bifurcation_values(data, FOLD)
    assert 410 < low < high < 425
    frequencies = np.arange(408.0, 424.5, 1.0)
    kept = {name: value for name, value in DAMPED.items()}
    up, down = (
        dl.stepped_sweep("equal_biaxial", frequency=values, settle=300, **kept)
        for values in (frequencies, frequencies[::-1])
    )
    for sweep in (up, down):
        for frequency in frequencies:
            if min(abs(frequency - low), abs(frequency - high)) < 1.0:
                continue  # near a fold a motion settles too slowly
            amplitude = sweep["amplitude"].sel(frequency=frequency).item()
            stable = [value for value, name in crossings(data, frequency) if name == "stable"]
            assert min(abs(value - amplitude) for value in stable) < 2e-4
    between = [value for value in frequencies if low + 0.5 < value < high - 0.5]
    assert len(between) >= 3
    for frequency in between:
        one, other = (sweep["amplitude"].sel(frequency=frequency).item() for sweep in (up, down))
        assert other > 1.5 * one
    one, other = (sweep["amplitude"].sel(frequency=np.ceil(high) + 1).item() for sweep in (up, down))
    assert one == pytest.approx(other, rel=1e-2)


def test_a_stable_branch_attracts_and_an_unstable_one_does_not():
    data = damped()
    frequency = float(np.mean(bifurcation_values(data, FOLD)))
    middle = data.isel(point=np.flatnonzero(np.abs(data["frequency"].values - frequency) < 0.3))
    for name, factor in (("stable", 0.8), ("unstable", 1.2)):
        some = middle.isel(point=np.flatnonzero(middle["stability"].values == name))
        some = some.isel(point=int(np.argmin(some["amplitude"].values)))
        largest = np.abs(some["multiplier_real"].values + 1j * some["multiplier_imag"].values).max()
        periods = int(np.ceil(abs(np.log(factor) / np.log(largest))))
        state = np.array([some[key].item() for key in ("stretch", "stretch_rate", "inelastic_stretch")])
        ends = []
        for nudge in (0.0, 1e-6):
            run = dl.simulate(
                "equal_biaxial", force=0.1, field=dl.Sine(4e6, some["frequency"].item()), relaxation_time=1e-2,
                duration=periods * some["period"].item(), initial_state=state + nudge * np.eye(3)[0], rtol=1e-12,
            )  # fmt: skip
            ends.append(run["stretch"].values[-1])
        assert (abs(ends[1] - ends[0]) < 1e-6) or name == "unstable"
        assert abs(ends[0] - state[0]) < 1e-7


def test_a_reversed_range_gives_the_same():
    there = softening()
    back = dl.steady_response(
        "equal_biaxial", force=0.5, field_amplitude=5e6, frequency=(420.0, 340.0), largest_amplitude=0.6,
        resolution=60, seeds=5,
    )  # fmt: skip
    assert back.sizes["branch"] == there.sizes["branch"]
    for kind in (FOLD, PERIOD_DOUBLING):
        assert bifurcation_values(back, kind) == pytest.approx(bifurcation_values(there, kind), rel=1e-9)
    for frequency in (350.5, 380.5, 400.5):
        one, other = (sorted(crossings(data, frequency)) for data in (there, back))
        assert [name for _, name in one] == [name for _, name in other]
        assert [value for value, _ in one] == pytest.approx([value for value, _ in other], rel=0.02)


@settings(max_examples=4)
@given(st.floats(0.3, 3.0), st.floats(0.5, 2.0), st.floats(0.5, 2.0))
def test_scaling_laws(stiffness, density, size):
    """mu -> c mu: E sqrt(c), P c, f sqrt(c); rho -> d rho: f / sqrt(d); lengths times s: P s^2, f / s."""
    p = dl.SHENG_2015
    faster = np.sqrt(stiffness / density) / size
    one = dl.steady_response("uniaxial", force=0.3, field_amplitude=2e6, frequency=(300.0, 320.0), **COARSE)
    other = dl.steady_response(
        "uniaxial", force=0.3 * stiffness * size**2, field_amplitude=2e6 * np.sqrt(stiffness),
        frequency=(300.0 * faster, 320.0 * faster), density=density * p.density,
        shear_modulus_alpha=stiffness * p.shear_modulus_alpha, shear_modulus_beta=stiffness * p.shear_modulus_beta,
        half_length=size * p.half_length, half_thickness=size * p.half_thickness, **COARSE,
    )  # fmt: skip
    first, last = one.isel(point=[0, -1]), other.isel(point=[0, -1])
    assert last["amplitude"].values == pytest.approx(first["amplitude"].values, rel=1e-7)
    values, scaled = (np.sort(data["multiplier_real"].values, axis=1) for data in (first, last))
    assert scaled == pytest.approx(values, abs=1e-7)


def test_the_branches_along_field_force_and_frequency_meet():
    fixed = {"force": 0.3, "field_amplitude": 3e6, "field_bias": 0.0, "frequency": 320.0}
    expected = None
    for varied in ("frequency", "field_amplitude", "force"):
        ends = (0.8 * fixed[varied], fixed[varied])
        data = dl.steady_response("equal_biaxial", **{**fixed, varied: ends}, largest_amplitude=0.3, **COARSE)
        at_end = data.isel(point=np.flatnonzero(data[varied].values == fixed[varied]))
        lowest = float(at_end["amplitude"].min())
        expected = lowest if expected is None else expected
        assert lowest == pytest.approx(expected, rel=1e-8)
        assert data.attrs["varied"] == varied


def test_a_range_of_fields_may_begin_at_zero():
    data = dl.steady_response("equal_biaxial", field_amplitude=(0.0, 1e6), frequency=300.0, **COARSE)
    assert data["amplitude"].values[0] == pytest.approx(0.0, abs=1e-10)
    assert data["amplitude"].values[-1] == pytest.approx(linear_amplitude(1e6, 300.0), rel=1e-2)


def test_with_a_bias_the_period_is_that_of_the_field():
    data = dl.steady_response(
        "equal_biaxial", field_amplitude=1e6, field_bias=(0.0, 2e6), frequency=300.0, **COARSE
    )
    assert data["period"].values == pytest.approx(1 / 300)
    assert data.attrs["forcing_period"] == "1/f"
    assert data["amplitude"].values[0] == pytest.approx(linear_amplitude(1e6, 300.0), rel=1e-2)


def test_motions_of_doubled_period_branch_off_at_the_period_doublings():
    given = {"force": 0.5, "field_amplitude": 5e6, "frequency": (753.0, 763.0), "largest_amplitude": 0.2}
    single = dl.steady_response("equal_biaxial", resolution=100, seeds=2, **given)
    double = dl.steady_response("equal_biaxial", resolution=100, seeds=2, period_multiple=2, **given)
    places = bifurcation_values(single, PERIOD_DOUBLING)
    assert len(places) == 2
    assert bifurcation_values(double, BRANCH_POINT) == pytest.approx(places, rel=1e-8)
    crossing = [k for k, origin in enumerate(double["origin"].values) if origin.startswith("crossing")]
    assert len(crossing) == 2
    for number in crossing:
        one = of_branch(double, number)
        one = one.isel(point=int(np.argmax(one["amplitude"].values)))
        times = np.array([0.0, 0.5, 1.0]) * one["period"].item()
        run = dl.simulate(
            "equal_biaxial", force=0.5, field=dl.Sine(5e6, one["frequency"].item()), duration=times[-1], time=times,
            initial_state=np.array([one[key].item() for key in ("stretch", "stretch_rate", "inelastic_stretch")]),
            viscosity=1e30, rtol=1e-12,
        )["stretch"].values  # fmt: skip
        assert run[2] == pytest.approx(run[0], abs=1e-8)
        assert abs(run[1] - run[0]) + abs(one["stretch_rate"].item()) > 1e-3


def test_at_a_branch_point_motions_leave_that_are_not_their_own_mirror_in_time():
    """Under E(-t) = -E(t) a motion run backwards is a motion; one that is its own mirror is at rest at phase 0."""
    data = dl.steady_response(
        "uniaxial", force=0.5, field_amplitude=5e6, frequency=(255.0, 300.0), largest_amplitude=0.92, resolution=100,
        seeds=[255.0],
    )  # fmt: skip
    crossing = [
        k for k, origin in enumerate(data["origin"].values) if origin.startswith("crossing at a branch")
    ]
    assert len(crossing) == 1 and BRANCH_POINT in data["bifurcation_kind"].values
    here = of_branch(data, crossing[0])
    for number in range(data.sizes["branch"]):
        rate = np.abs(of_branch(data, number)["stretch_rate_1"].values)
        assert (rate.max() > 1.0) == (number == crossing[0])
    first, last = here.isel(point=0), here.isel(point=-1)
    assert first["stretch_rate_1"].item() == pytest.approx(-last["stretch_rate_1"].item(), rel=0.1)


def test_between_period_doublings_a_disturbance_grows_as_the_multiplier_says():
    data = dl.steady_response(
        "equal_biaxial",
        force=0.5,
        field_amplitude=5e6,
        frequency=(757.0, 759.0),
        largest_amplitude=0.2,
        **COARSE,
    )
    assert set(data["stability"].values) == {"unstable"}
    one = data.isel(point=data.sizes["point"] // 2)
    largest = np.abs(one["multiplier_real"].values).max()
    state = np.array([one[key].item() for key in ("stretch", "stretch_rate", "inelastic_stretch")])
    periods = 700
    times = np.arange(periods - 399, periods + 1, 2) * one["period"].item()
    run = dl.simulate(
        "equal_biaxial", force=0.5, field=dl.Sine(5e6, one["frequency"].item()), viscosity=1e30, rtol=1e-10,
        time=np.append(0.0, times), duration=times[-1], initial_state=state + 1e-6 * np.eye(3)[0],
    )  # fmt: skip
    grown = np.log(np.abs(run["stretch"].values[1:] - state[0]))
    assert np.polyfit(np.arange(len(grown)) * 2, grown, 1)[0] == pytest.approx(np.log(largest), rel=0.02)


def test_a_lost_branch_says_where_and_keeps_its_points():
    data = dl.steady_response(
        "equal_biaxial", force=0.5, field_amplitude=5e6, frequency=(350.0, 420.0), resolution=60, seeds=2,
        limits=dl.Limits(largest_stretch=1.6),
    )  # fmt: skip
    endings = data["ending"].values.ravel()
    lost = [ending for ending in endings if ending.startswith("lost: the motion diverged after")]
    assert lost and all("near parameter 3" in ending for ending in lost)
    assert data.sizes["point"] > 20
    assert float(data["maximum"].max()) <= 1.601  # the flow looks at the limits at the ends of its steps


def test_a_branch_that_ends_at_the_most_points_is_continued_by_another_and_not_found_twice():
    data = dl.steady_response(
        "equal_biaxial", frequency=(412.0, 422.0), largest_amplitude=0.25, seeds=[412.0, 422.0], resolution=100,
        most_points=150, **DAMPED,
    )  # fmt: skip
    endings = list(data["ending"].values.ravel())
    assert "150 points" in endings and "runs onto branch 0" in endings
    for frequency in (416.03, 420.03):
        values = np.sort([value for value, _ in crossings(data, frequency)])
        assert np.all(np.diff(values) > 1e-3)


def test_what_cannot_be_reached_gives_no_branch():
    data = dl.steady_response(
        "equal_biaxial",
        force=0.5,
        field_amplitude=5e6,
        frequency=(300.0, 320.0),
        largest_amplitude=1e-6,
        **COARSE,
    )
    assert data.sizes["point"] == data.sizes["branch"] == data.sizes["bifurcation"] == 0


def test_an_interruption_keeps_what_is_found(monkeypatch):
    calls = iter(range(10**9))

    def resolve(problem, engine):
        flow = resolve_flow(problem, engine)

        def stopped(*arguments, **more):
            if next(calls) > 600:
                raise KeyboardInterrupt
            return flow(*arguments, **more)

        return stopped

    monkeypatch.setattr(module, "resolve_flow", resolve)
    data = dl.steady_response(
        "equal_biaxial", field_amplitude=1e6, frequency=(300.0, 400.0), resolution=20, seeds=9
    )
    assert data.attrs["search"] == "interrupted"
    assert data.sizes["branch"] == 1


def test_the_engines_agree():
    given = {"field_amplitude": (1e6, 1.01e6), "frequency": 300.0, "resolution": 10, "most_points": 2}
    given |= {"seeds": [1e6], "largest_amplitude": 1e-2}
    one, other = (
        dl.steady_response("equal_biaxial", engine=engine, **given) for engine in ("compiled", "scipy")
    )
    assert one["field_amplitude"].values == pytest.approx(other["field_amplitude"].values, rel=1e-9)
    assert one["amplitude"].values == pytest.approx(other["amplitude"].values, rel=1e-8)


def test_everything_has_a_unit_and_a_meaning():
    data = damped()
    words = {"stability", "bifurcation_kind", "ending", "origin", "branch", "end"}
    for name, variable in data.variables.items():
        assert variable.attrs["long_name"]
        assert name in words or variable.attrs["units"]
    assert data.attrs["dashpots"] == "relaxed"
    assert data.attrs["forcing_period"].startswith("1/(2 f)")
    assert "twice" in dl.steady_response.__doc__ and "f_n/2" in data.attrs["explanation"]
    assert data.attrs["tolerance"] == 1e-12


def test_it_is_written_and_read_back(tmp_path):
    import xarray as xr

    damped().to_netcdf(tmp_path / "steady.nc")
    again = xr.load_dataset(tmp_path / "steady.nc")
    assert list(again["stability"].values) == list(damped()["stability"].values)


BAD = [
    ({"seeds": [[410.0, 420.0]]}, "seeds must be a count, or a one-dimensional array"),
    ({"seeds": []}, "seeds must be a count, or a one-dimensional array"),
    ({"frequency": 300.0}, "exactly one of force, field_amplitude, field_bias, frequency must be a pair"),
    ({"force": (0.0, 1.0)}, "exactly one of .* got 2 pairs: force, frequency"),
    ({"frequency": (300.0, 310.0, 320.0)}, r"frequency must be a number or a pair \(start, stop\)"),
    ({"frequency": (300.0, 300.0)}, "frequency must go from start to another stop, got 300 Hz twice"),
    ({"frequency": (0.0, 300.0)}, "frequency must be positive and finite, got 0 Hz"),
    ({"field_amplitude": 0.0}, "field_amplitude must be positive, got 0 V/m"),
    ({"field_amplitude": -1.0}, "field_amplitude must not be negative, got -1 V/m"),
    ({"force": np.nan}, "force must be finite, got nan N"),
    ({"dashpots": "evolving"}, "dashpots must be one of frozen, relaxed"),
    ({"seeds": 1}, "seeds must be an integer of at least 2|seeds must be an integer from 2"),
    ({"seeds": [200.0, 305.0]}, "seeds must lie in the range of frequency, 300 Hz to 310 Hz, got 200 Hz"),
    ({"period_multiple": 0}, "period_multiple must be an integer from 1"),
    ({"tolerance": 0.1}, "tolerance must lie from 1e-14 to 1e-06, got 0.1"),
    ({"largest_amplitude": -1.0}, "largest_amplitude must be positive and finite, got -1"),
    ({"relaxation_time": [1.0, 2.0]}, "relaxation_time must be a single number"),
    ({"stiffness": 1.0}, "unknown parameter 'stiffness'"),
    ({"held_stretch": 2.0}, "held_stretch 2 .* holds no stretch"),
    ({"engine": "numpy"}, "engine must be one of auto, compiled, core, scipy"),
]


@pytest.mark.parametrize("change, message", BAD)
def test_bad_input(change, message):
    given = {"field_amplitude": 1e6, "frequency": (300.0, 310.0)} | change
    with pytest.raises(ValueError, match=message) as error:
        dl.steady_response("equal_biaxial", **given)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("frequency", [(1e-9, 2e-9), (800.0, 0.05)])
def test_a_period_of_endless_vibrations_is_refused(frequency):
    with pytest.raises(ValueError, match=r"frequency must be at least 0\.0919 Hz, 10000 small vibrations"):
        dl.steady_response("equal_biaxial", frequency=frequency, field_amplitude=1e6)
