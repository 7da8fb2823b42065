"""The loaded equilibrium as the state at t = 0: held prestretch or dead loads first, then actuation."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from electrical_membranes import CONDUCTIVITY, PERMITTIVITY, emitted
from hypothesis import given, settings
from hypothesis import strategies as st
from user_membranes import write_membrane

import delagrange as dl
from delagrange.cli import main
from delagrange.equilibrium import start as start_module

HARD = {"rtol": 1e-12, "atol": 1e-15}
CURRENT, CHARGE = "nominal_current_density", "nominal_charge_density"
PULL = {"force_1": 0.3, "force_2": 0.1}


@pytest.fixture(scope="module")
def membrane(tmp_path_factory):
    """Pulled by a force along each axis, with two branches."""
    return dl.load(write_membrane(tmp_path_factory.mktemp("loaded"), "membrane"))


PRELOADED = {  # model (None: the fixture), loads, and what freezes its dashpots
    "held prestretch": (
        "pure_shear",
        {"held_stretch": 2.0, "force": 0.3},
        {"viscosity": 1e15},
    ),
    "dead loads": (None, {"inputs": PULL}, {"viscosity_1": 1e15, "viscosity_2": 1e15}),
}


@pytest.fixture(params=PRELOADED)
def preloaded(request, membrane):
    model, loads, freezing = PRELOADED[request.param]
    return model or membrane, loads, freezing


def states_of(model, run: xr.Dataset) -> np.ndarray:
    return np.array([run[entry.name] for entry in dl.load_model(model).STATE])


# --- a run ---------------------------------------------------------------------------------------------


def test_without_field_it_stays_put(preloaded):
    model, loads, _ = preloaded
    run = dl.simulate(model, duration=0.05, samples=101, initial_state="equilibrium", **loads)
    states = states_of(model, run)
    assert np.max(np.abs(states - states[:, :1])) < 1e-9
    assert states[:, 0] == pytest.approx(list(dl.rest_state(model, **loads).values()), abs=0)
    assert run.attrs["initial_state"].startswith("loaded equilibrium")


def test_a_field_then_moves_it_about_the_loaded_equilibrium_with_the_periods_of_its_modes(preloaded):
    """Each mode is seen alone where the motion is taken apart by the shapes of all."""
    model, loads, freezing = preloaded
    count, field, start = dl.load_model(model).COORDINATE_COUNT, 1e5, dl.rest_state(model, **loads)
    run = dl.simulate(
        model,
        duration=0.02,
        samples=20001,
        field=field,
        initial_state="equilibrium",
        **loads,
        **freezing,
        **HARD,
    )
    modes = dl.modes(model, field=field, dashpots="frozen", initial_state=start, **loads)
    states, middle = states_of(model, run), list(modes.data_vars[name] for name in list(start)[:count])
    apart = np.linalg.inv(modes["shape"].values)
    places = apart @ (states[:count] - np.array(middle, dtype=float)[:, None])
    rates = apart @ states[count : 2 * count]
    for place, rate, frequency in zip(places, rates, modes["frequency"].values, strict=True):
        assert np.max(place) == pytest.approx(-np.min(place), rel=1e-3)
        turns = turning_times(run["time"].values, rate)
        assert np.mean(np.diff(turns[::2])) == pytest.approx(1 / frequency, rel=1e-5)


def turning_times(time: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """When a rate changes its sign, by a line between samples."""
    before = np.flatnonzero(rate[:-1] * rate[1:] < 0)
    return time[before] - rate[before] * (time[before + 1] - time[before]) / (rate[before + 1] - rate[before])


@pytest.mark.parametrize(
    ("force", "at_start"),
    [
        (dl.Sine(0.1, 300.0, bias=0.4, phase=1.0), 0.4),
        (dl.Ramp(0.2, 0.5, 1e-3), 0.2),
        (dl.Ramp(0.2, 0.5, 1e-3, begin=2e-3), 0.2),
        (dl.Step(0.5, time=1e-3, before=0.1), 0.1),
        (dl.Tabulated([0.0, 1.0], [0.3, 0.9]), 0.3),
    ],
)
def test_a_drive_counts_as_it_is_at_the_start(force, at_start):
    run = dl.simulate("equal_biaxial", duration=3e-3, force=force, field=3e6, initial_state="equilibrium")
    expected = dl.rest_state("equal_biaxial", force=at_start)
    assert {name: run[name][0].item() for name in expected} == expected


def test_values_by_name_are_those_of_an_array():
    given_ = {"duration": 2e-3, "samples": 21, "force": 0.1}
    named = dl.simulate("equal_biaxial", initial_state={"inelastic_stretch": 1.1, "stretch": 1.2}, **given_)
    array = dl.simulate("equal_biaxial", initial_state=[1.2, 0.0, 1.1], **given_)
    xr.testing.assert_identical(named, array)
    assert "initial_state" not in named.attrs


def test_charge_and_current_are_off_before():
    for driven, name, value in (("charge", CHARGE, 1e-3), ("current", CURRENT, 1.0)):
        module = emitted(driven)
        run = dl.simulate(
            module, duration=1e-3, force=0.2, inputs={name: value}, initial_state="equilibrium", samples=11
        )
        expected = dl.rest_state(module, force=0.2)
        assert {key: run[key][0].item() for key in expected} == expected
        assert expected.get(CHARGE, 0.0) == 0.0 and abs(run["stretch"][-1] - run["stretch"][0]) > 1e-7


def test_the_kind_of_a_motion_from_there():
    found = dl.classify(
        "equal_biaxial", force=0.5, initial_state="equilibrium", duration=0.1, tolerance=1e-9, engine="scipy"
    )
    assert found["verdict"].item() == "at rest"
    assert found["section_stretch"][0].item() == dl.rest_state("equal_biaxial", force=0.5)["stretch"]
    assert found.attrs["initial_state"].startswith("loaded equilibrium")


# --- where it rests ------------------------------------------------------------------------------------


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
def test_it_rests_where_the_modes_are(membrane, dashpots):
    for model, loads in (("uniaxial", {"force": 0.4}), (membrane, {"inputs": PULL})):
        rest = dl.rest_state(model, field=2e6, dashpots=dashpots, **loads)
        modes = dl.modes(model, field=2e6, dashpots=dashpots, **loads)
        assert list(rest) == [entry.name for entry in dl.load_model(model).STATE]
        assert rest == pytest.approx({name: modes[name].item() for name in rest}, rel=1e-12)


@given(force=st.floats(-1.0, 3.0), held_stretch=st.floats(0.7, 4.0), field=st.floats(-1e6, 1e6))
@settings(max_examples=8)
def test_nothing_moves_there(force, held_stretch, field):
    rest = dl.rest_state("pure_shear", force=force, held_stretch=held_stretch, field=field)
    stored = list(rest.values())
    run = dl.simulate(
        "pure_shear", force=force, held_stretch=held_stretch, field=field, duration=5e-3, samples=11,
        initial_state=rest,
    )  # fmt: skip
    assert states_of("pure_shear", run)[:, -1] == pytest.approx(stored, abs=1e-9)
    more = dl.rest_state("pure_shear", force=force + 0.1, held_stretch=held_stretch, field=field)
    assert more["stretch"] > rest["stretch"]


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
@pytest.mark.parametrize("current", [3e-2, -3e-2])
def test_under_a_current_as_much_leaks(current, dashpots):
    """The charge D of a constant permittivity leaks with conductivity / permittivity D; all else is even in it."""
    rest = dl.rest_state(emitted("current"), force=0.2, inputs={CURRENT: current}, dashpots=dashpots)
    charge = current * PERMITTIVITY / CONDUCTIVITY
    assert rest.pop(CHARGE) == pytest.approx(charge, rel=1e-12)
    kept = dl.rest_state(emitted("charge"), force=0.2, inputs={CHARGE: charge}, dashpots=dashpots)
    assert rest == pytest.approx(kept, rel=1e-12)


def test_what_does_not_leak_rests_without_current_alone():
    kept = dl.rest_state(emitted("charge"), force=0.2)
    assert dl.rest_state(emitted("current"), force=0.2, conductivity=0.0) == pytest.approx(
        kept | {CHARGE: 0.0}, rel=1e-12
    )
    text = refusal(dl.rest_state, emitted("current"), inputs={CURRENT: 1e-2}, conductivity=0.0)
    assert f"no stable equilibrium under force = 0 N and {CURRENT} = 0.01 A/m^2" in text


# --- a sweep -------------------------------------------------------------------------------------------


def test_every_run_of_a_sweep_has_its_own_which_is_solved_once(monkeypatch):
    solved, solve = [], start_module.resting_state
    monkeypatch.setattr(
        start_module, "resting_state", lambda problem, *more: solved.append(problem) or solve(problem, *more)
    )
    axes = {"held_stretch": [1.5, 2.0], "shear_modulus_alpha": [1.5e4, 1.8e4, 2.1e4]}
    found = dl.frequency_response(
        "pure_shear", force=0.2, field_amplitude=[1e5, 3e6], frequency=[200.0, 300.0, 400.0], duration=2e-3,
        sample_interval=1e-3, initial_state="equilibrium", engine="numpy", **axes,
    )  # fmt: skip
    assert len(solved) == 6
    assert found["initial_stretch"].dims == tuple(axes)
    assert found.attrs["initial_state"].startswith("loaded equilibrium")
    np.testing.assert_array_equal(*xr.broadcast(found["stretch"].isel(time=0), found["initial_stretch"]))
    one = found.isel(held_stretch=1, shear_modulus_alpha=0, field_amplitude=1, frequency=2)
    run = dl.simulate(
        "pure_shear", held_stretch=2.0, force=0.2, shear_modulus_alpha=1.5e4, field=dl.Sine(3e6, 400.0),
        duration=2e-3, time=[0.0, 1e-3, 2e-3], initial_state="equilibrium",
    )  # fmt: skip
    for name in ("stretch", "inelastic_stretch"):
        np.testing.assert_allclose(one[name], run[name], rtol=1e-9)


def test_chunks_of_a_sweep_begin_where_they_should(monkeypatch):
    """Drives of the force count with their values at t = 0, whatever the place of a run in the grid."""
    monkeypatch.setattr("delagrange.run.sweep.lanes_at_a_time", lambda *_: 3)
    found = dl.frequency_response(
        "equal_biaxial", force=dl.Sine(0.1, 50.0, bias=0.3), field_amplitude=1e5, frequency=[200.0, 300.0],
        duration=1e-4, sample_interval=1e-4, initial_state="equilibrium", engine="numpy",
        shear_modulus_beta=[3e4, 4e4, 5e4, 6e4],
    )  # fmt: skip
    for modulus in found["shear_modulus_beta"].values:
        expected = dl.rest_state("equal_biaxial", force=0.3, shear_modulus_beta=modulus)["stretch"]
        at_start = found["stretch"].sel(shear_modulus_beta=modulus).isel(time=0)
        np.testing.assert_array_equal(at_start, expected)


# --- none ----------------------------------------------------------------------------------------------


def refusal(call, *arguments, **given_) -> str:
    with pytest.raises(ValueError) as raised:
        call(*arguments, **given_)
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_too_large_a_load_is_named_with_the_largest_that_holds(membrane):
    text = refusal(dl.rest_state, "equal_biaxial", force=50.0)
    assert "equal_biaxial has no stable equilibrium under force = 50 N and field = 0 V/m" in text
    largest = float(text.split("up to force = ")[1].split()[0])
    assert text.endswith("where it ends (limit: a principal stretch below 0.001)")  # through the thickness
    held = dl.rest_state("equal_biaxial", force=0.999999 * largest)["stretch"]
    assert held == pytest.approx(dl.Limits().smallest_stretch ** -0.5, rel=0.03)  # a step of the curve
    assert "no stable equilibrium" in refusal(dl.rest_state, "equal_biaxial", force=1.05 * largest)
    narrow = {"limits": dl.Limits(largest_stretch=2.0), "inputs": {"force_1": 0.1, "force_2": 9.0}}
    text = refusal(dl.rest_state, membrane, **narrow)
    assert "force_2 = 9 N" in text and "one up to force_2 = " in text and "a stretch beyond 2)" in text


def test_beyond_pull_in_the_field_is_named():
    text = refusal(dl.rest_state, "equal_biaxial", force=0.2, field=3e7)
    limit = dl.pull_in("equal_biaxial", force=0.2, dashpots="relaxed")["field"].item()
    assert "field = 30000000 V/m: there is one up to" in text and text.endswith("the limit point")
    assert float(text.split("up to field = ")[1].split()[0]) == pytest.approx(limit, rel=1e-6)


def test_a_run_without_it_is_refused():
    sweep = {"frequency": 300.0, "field_amplitude": 1e6, "duration": 1e-3, "initial_state": "equilibrium"}
    for call, given_ in (
        (dl.simulate, {"duration": 1e-3, "force": 50.0, "initial_state": "equilibrium"}),
        (dl.frequency_response, {"force": [0.1, 50.0], **sweep}),
        (dl.classify, {"force": 50.0, "initial_state": "equilibrium"}),
    ):
        assert "no stable equilibrium under force = 50 N" in refusal(call, "equal_biaxial", **given_)
        wrong = given_ | {"initial_state": "rest", "force": 0.1}
        assert "must be 'equilibrium' or map names" in refusal(call, "equal_biaxial", **wrong)


# --- commands ------------------------------------------------------------------------------------------


def test_by_command(tmp_path, capsys):
    out = tmp_path / "found.nc"
    runs = {
        "simulate": ["--force", "0.2", "--field-amplitude", "1e6", "--samples", "11"],
        "sweep": [
            "--force",
            "0.2",
            "--field-amplitude",
            "1e6",
            "--frequency",
            "300",
            "--sample-interval",
            "1e-3",
        ],
    }
    expected = dl.rest_state("equal_biaxial", force=0.2)["stretch"]
    for command, loads in runs.items():
        arguments = [command, "equal-biaxial", "--duration", "1e-3", "--initial", "equilibrium", *loads]
        assert main([*arguments, "--out", str(out), "--quiet"]) == 0
        stored = xr.load_dataset(out)
        assert stored["stretch"].isel(time=0).values == pytest.approx(expected, abs=0)
        assert stored.attrs["initial_state"].startswith("loaded equilibrium")
    assert (
        main(
            ["simulate", "equal-biaxial", "--duration", "1e-3", "--initial", "stretch=1.3", "--out", str(out)]
        )
        == 0
    )
    assert xr.load_dataset(out)["stretch"][0] == 1.3
    capsys.readouterr()


WRONG = {
    "both": (["--initial", "equilibrium", "--initial", "stretch=1.1"], "says the whole state"),
    "many": (["--initial", "stretch=1.1,1.2"], "initial stretch must be a single number"),
    "load": (["--initial", "equilibrium", "--force", "50"], "no stable equilibrium under force = 50 N"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_command_is_refused_in_one_line(capsys, case):
    arguments, says = WRONG[case]
    assert main(["simulate", "equal-biaxial", "--duration", "1e-3", *arguments, "--quiet"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert says in line
