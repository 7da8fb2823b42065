"""Single trajectories: physics that must come out, status, drives, methods, an independent witness."""

from __future__ import annotations

import heyoka
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.problem.problem import make_problem
from delagrange.problem.trajectory import choose_method
from delagrange.run.simulation import output_times

MODELS = {
    "equal_biaxial": {},
    "uniaxial": {},
    "pure_shear_as_printed": {"held_stretch": 2.0},
    "pure_shear_consistent": {"held_stretch": 2.0},
    "pure_shear_consistent_free": {"held_stretch": 2.0},
}
HARD = {"rtol": 1e-12, "atol": 1e-14}
FROZEN = {"viscosity": 1e18}


def _frequency_of_crossings(run: xr.Dataset) -> float:
    """Frequency [Hz] from the upward zeros of the rate, by linear interpolation."""
    time, rate = run["time"].values, run["stretch_rate"].values
    up = np.flatnonzero((rate[:-1] < 0) & (rate[1:] >= 0))
    zeros = time[up] - rate[up] * (time[up + 1] - time[up]) / (rate[up + 1] - rate[up])
    return (len(zeros) - 1) / (zeros[-1] - zeros[0])


def test_small_vibration_of_the_undeformed_membrane():
    p = dl.SHENG_2015
    stiffness = 18 * (p.shear_modulus_alpha + p.shear_modulus_beta)
    inertia = p.density * p.half_thickness**2 * (2 + (p.half_length / p.half_thickness) ** 2)
    expected = np.sqrt(stiffness / inertia) / (2 * np.pi)
    assert expected == pytest.approx(918.9, abs=0.05)
    run = dl.simulate(
        "equal_biaxial", duration=0.05, initial_state=[1 + 1e-6, 0, 1], samples=100_001, **FROZEN, **HARD
    )
    assert _frequency_of_crossings(run) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("model", MODELS)
@settings(max_examples=3, deadline=None)
@given(force=st.floats(0.05, 0.3), field=st.floats(0.0, 3e6))
def test_energy_is_conserved_with_frozen_dashpots(model, force, field):
    run = dl.simulate(
        model,
        force=force,
        field=field,
        duration=0.01,
        samples=101,
        energies=True,
        **MODELS[model],
        **FROZEN,
        **HARD,
    )
    energy = run["total_energy"].values
    scale = np.abs(run["kinetic_energy"]).max().item() + np.abs(run["potential_energy"]).max().item()
    assert run.attrs["status"] == "completed"
    assert np.ptp(energy) < 1e-9 * scale


@pytest.mark.parametrize(
    "model", ["equal_biaxial", "uniaxial", "pure_shear_consistent", "pure_shear_consistent_free"]
)
@settings(max_examples=3, deadline=None)
@given(force=st.floats(0.05, 0.3), field=st.floats(0.0, 3e6), relaxation_time=st.floats(1e-3, 1e-1))
def test_energy_falls_at_the_rate_the_dashpots_dissipate(model, force, field, relaxation_time):
    run = dl.simulate(
        model, force=force, field=field, duration=0.01, samples=4001, energies=True,
        relaxation_time=relaxation_time, **MODELS[model], **HARD,
    )  # fmt: skip
    power, time = run["dashpot_power"].values, run["time"].values
    dissipated = np.sum((power[:-2:2] + 4 * power[1:-1:2] + power[2::2]) * (time[2] - time[0]) / 6)
    assert power.min() >= 0
    loss = run["total_energy"].values[0] - run["total_energy"].values[-1]
    assert dissipated > 0
    assert loss == pytest.approx(dissipated, rel=1e-6)


@settings(max_examples=10, deadline=None)
@given(stretch=st.floats(0.7, 2.0), start=st.floats(0.7, 2.0), relaxation_time=st.floats(1e-3, 10.0))
def test_dashpot_at_a_held_stretch_follows_its_closed_law(stretch, start, relaxation_time):
    """w = (xi / lambda)^2 obeys dw/dt = (1 - w^3) / (3 tau)."""
    model = dl.load_model("equal_biaxial")
    problem = make_problem(model, dl.SHENG_2015, {"relaxation_time": relaxation_time}, None, 0.0, 0.0)
    xi = start * stretch
    rate = problem.rhs(0.0, np.array([stretch, 0.0, xi]))[2]
    w = (xi / stretch) ** 2
    assert 2 * xi * rate / stretch**2 == pytest.approx(
        (1 - w**3) / (3 * relaxation_time), rel=1e-12, abs=1e-12
    )


@pytest.mark.parametrize("field", [0.6, 0.75])
def test_quasi_static_pull_in_of_the_neo_hookean_membrane(field):
    """Ideal dielectric, no force: no equilibrium above 0.68736 sqrt(mu / epsilon), rest below; here with a
    slow ramp, a short relaxation time and a soft spring beta, so that the ramp is quasi-static."""
    p = dl.SHENG_2015.replace(shear_modulus_beta=1.0, relaxation_time=1.0)
    top = field * np.sqrt(p.shear_modulus_alpha / p.permittivity)
    run = dl.simulate("equal_biaxial", field=dl.Ramp(0.0, top, 0.2), duration=0.25, parameters=p, rtol=1e-7)
    assert run.attrs["status"] == ("completed" if field < 0.68736 else "collapsed")


@pytest.mark.parametrize("model", MODELS)
def test_trajectories_agree_with_an_independent_taylor_integrator(model):
    """heyoka (Biscani & Izzo 2021, Mon. Not. R. Astron. Soc. 504, 2614) on the emitted equations."""
    module = dl.load_model(model)
    force, amplitude, frequency, duration = 0.2, 2e6, 380.0, 0.02
    run = dl.simulate(
        module, force=force, field=dl.Sine(amplitude, frequency), duration=duration, samples=201,
        **MODELS[model], **HARD,
    )  # fmt: skip
    problem = make_problem(module, dl.SHENG_2015, {}, MODELS[model].get("held_stretch"), force, 0.0)
    names = [entry.name for entry in module.STATE]
    symbols = np.array(heyoka.make_vars(*names), dtype=object)
    field = amplitude * heyoka.sin(2 * np.pi * frequency * heyoka.time)
    system = list(zip(symbols, module.rhs(symbols, (force, field), problem.parameters)))
    start = [float(value) for value in module.reference_state(problem.parameters)]
    integrator = heyoka.taylor_adaptive(system, start, tol=1e-16)
    witness = np.array(integrator.propagate_grid(run["time"].values)[-1])
    assert run.attrs["status"] == "completed"
    for place, name in enumerate(names):
        scale = np.abs(witness[:, place]).max()
        np.testing.assert_allclose(run[name].values, witness[:, place], rtol=0, atol=1e-8 * scale)


@pytest.mark.parametrize(
    ("options", "status"),
    [
        ({"field": 5e7}, "collapsed"),
        ({"force": 0.5, "field": dl.Sine(5e6, 371.0)}, "completed"),
        ({"force": 400.0, "limits": dl.Limits(smallest_stretch=1e-6, largest_stretch=5.0)}, "diverged"),
        ({"field": 1e3, "initial_state": [40.0, 0.0, 1.0]}, "collapsed"),
        ({"field": 1e60}, "collapsed"),
    ],
)
def test_status(options, status):
    run = dl.simulate("equal_biaxial", duration=0.01, samples=501, **options)
    assert run["status"].item() == run.attrs["status"] == status
    time = run["status_time"].item()
    after = run["time"].values > time
    assert np.all(np.isnan(run["stretch"].values[after]))
    assert np.all(np.isfinite(run["stretch"].values[~after]))
    assert after.any() == (status != "completed")


def test_loss_is_found_at_the_limit_itself():
    limits = dl.Limits(smallest_stretch=0.1)
    grid = np.linspace(0, 1e-3, 20_001)
    run = dl.simulate("equal_biaxial", field=5e7, duration=1e-3, time=grid, limits=limits, **HARD)
    thickness = run["thickness_stretch"].values
    last = np.flatnonzero(np.isfinite(thickness))[-1]
    assert run["time"].values[last] <= run["status_time"].item() < run["time"].values[last + 1]
    assert thickness[last] == pytest.approx(0.1, rel=0.05) and thickness[last] >= 0.1


@settings(max_examples=4, deadline=None)
@given(jump=st.floats(1e-3, 9e-3), force=st.floats(0.1, 0.8))
def test_a_step_is_two_runs_put_together(jump, force):
    whole = dl.simulate("equal_biaxial", force=dl.Step(force, time=jump), field=2e6, duration=0.01, **HARD)
    first = dl.simulate("equal_biaxial", field=2e6, duration=jump, samples=2, **HARD)
    names = ("stretch", "stretch_rate", "inelastic_stretch")
    state = [first[name].values[-1] for name in names]
    rest = dl.simulate(
        "equal_biaxial", force=force, field=2e6, duration=0.01 - jump, samples=2, initial_state=state, **HARD
    )
    for name in names:
        assert whole[name].values[-1] == pytest.approx(rest[name].values[-1], rel=1e-9)


def test_a_table_and_a_ramp_of_the_same_shape_agree():
    ramp = dl.Ramp(0.0, 3e6, duration=4e-3, begin=1e-3)
    table = dl.Tabulated([0.0, 1e-3, 5e-3, 1e-2], [0.0, 0.0, 3e6, 3e6])
    runs = [dl.simulate("uniaxial", force=0.3, field=field, duration=1e-2, **HARD) for field in (ramp, table)]
    xr.testing.assert_allclose(runs[0].drop_attrs(), runs[1].drop_attrs(), rtol=1e-10)


@pytest.mark.parametrize("method", ["RK45", "Radau", "BDF", "LSODA", "auto"])
def test_methods_agree_at_a_short_relaxation_time(method):
    options = {
        "force": 0.5,
        "field": dl.Sine(5e6, 371.0),
        "duration": 0.01,
        "relaxation_time": 1e-3,
        "samples": 11,
    }
    reference = dl.simulate("equal_biaxial", **options, **HARD)
    run = dl.simulate("equal_biaxial", method=method, rtol=1e-8, atol=1e-11, **options)
    np.testing.assert_allclose(run["stretch"], reference["stretch"], rtol=1e-5)


def test_auto_goes_implicit_when_the_dashpot_is_fast():
    model = dl.load_model("equal_biaxial")
    for relaxation_time, method in ((400.0, "DOP853"), (1e-7, "Radau")):
        problem = make_problem(model, dl.SHENG_2015, {"relaxation_time": relaxation_time}, None, 0.1, 0.0)
        assert choose_method(problem, np.array([1.0, 0.0, 1.0])) == method


def test_error_is_proportional_to_the_tolerance():
    options = {"force": 0.5, "field": dl.Sine(3e6, 371.0), "duration": 0.02, "samples": 2}
    exact = dl.simulate("equal_biaxial", rtol=1e-13, atol=1e-16, **options)["stretch"].values[-1]
    tolerances = 10.0 ** -np.arange(4, 11)
    errors = [
        abs(
            dl.simulate("equal_biaxial", rtol=rtol, atol=rtol * 1e-3, **options)["stretch"].values[-1] - exact
        )
        for rtol in tolerances
    ]
    assert np.all(errors < 1e3 * tolerances)
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.8 < slope < 1.3


def test_pure_shear_gives_its_reaction_and_names_its_formulation():
    run = dl.simulate("pure-shear", force=0.1, held_stretch=2.0, duration=0.01)
    assert run.attrs["formulation"] == "consistent"
    assert run["reaction_force_2"].attrs["units"] == "N"
    printed = dl.simulate("pure_shear", formulation="as_printed", force=0.1, held_stretch=2.0, duration=0.01)
    assert printed.attrs["formulation"] == "as_printed"
    assert not np.allclose(run["stretch"], printed["stretch"])


def test_dataset_says_what_it_is_and_survives_the_disk(tmp_path):
    run = dl.simulate(
        "uniaxial", force=0.5, field=dl.Sine(1e6, 438.0), duration=1e-3, energies=True, density=1100.0
    )
    for name, data in run.variables.items():
        if name != "status":
            assert data.attrs["units"] and data.attrs["long_name"]
    assert run.attrs["density"] == 1100.0 and "density = 1100 kg/m^3" in run.attrs["parameters_source"]
    assert run.attrs["nominal_electric_field_drive"].startswith("Sine(amplitude=1000000")
    assert (run.attrs["rtol"], run.attrs["method"]) == (1e-9, "DOP853")
    run.to_netcdf(tmp_path / "run.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "run.nc"), run)


def test_output_times_are_the_users():
    times = np.array([0.0, 1e-4, 7e-4])
    run = dl.simulate("equal_biaxial", force=0.1, duration=1e-3, time=times)
    np.testing.assert_array_equal(run["time"], times)
    assert dl.simulate("equal_biaxial", duration=1e-3, samples=7).sizes["time"] == 7
    assert dl.simulate("equal_biaxial", duration=1e-3).sizes["time"] == 2001
    assert dl.simulate("equal_biaxial", duration=0.1).sizes["time"] == 4001


def test_the_spacing_of_the_output_times_is_the_documented_one():
    for duration in (1e-3, 0.1, 3.0, 25.0):
        assert np.diff(output_times(None, None, duration)).max() <= 25e-6 * (1 + 1e-9)
    assert len(output_times(None, None, 25.0)) == len(output_times(None, None, 100.0)) == 1_000_001


def test_progress_goes_to_standard_error(capsys):
    dl.simulate("equal_biaxial", duration=1e-3, progress=True)
    captured = capsys.readouterr()
    assert captured.out == "" and "simulate" in captured.err
