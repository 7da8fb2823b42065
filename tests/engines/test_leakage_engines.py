"""A leaking membrane from its file through every engine that runs it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from electrical_membranes import LEAKY_FILE
from emitted_once import described_in, loaded

import delagrange as dl
from delagrange.cli import main
from delagrange.engines.flow import FlowPath
from delagrange.engines.flow_compiled import flow_compiled
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.problem.dashpots import frozen
from delagrange.problem.problem import make_problem

CURRENT, CHARGE = "nominal_current_density", "nominal_charge_density"
MAXWELL_TIME = 0.01  # [s], 60 pF/m over 6 nS/m


@pytest.fixture(scope="module")
def leaky(tmp_path_factory):
    return loaded(described_in(tmp_path_factory.mktemp("leaky"), "leaky", LEAKY_FILE))


def test_a_file_says_what_leaks(leaky):
    assert leaky.DEFAULTS["conductivity"] == 6e-9
    assert [(entry.name, entry.unit) for entry in leaky.INPUTS] == [("force", "N"), (CURRENT, "A/m^2")]
    assert "Foo et al. (2012)" in leaky.__doc__
    run = dl.simulate(leaky, duration=0.01, samples=51, initial_state=[1.0, 0.0, 1.0, 2e-4], rtol=1e-12)
    np.testing.assert_allclose(run[CHARGE], 2e-4 * np.exp(-run["time"] / MAXWELL_TIME), rtol=1e-9)
    assert run.attrs["nominal_current_density_drive"]


def test_lanes_of_every_engine_agree(leaky):
    given_ = {
        "frequency": 200.0, "field_amplitude": 0.0, "force": 0.1, "duration": 0.01, "final_state": True,
        "inputs": {CURRENT: [0.01, 0.03]}, "initial_state": {CHARGE: [0.0, 2e-4]}, "conductivity": [0.0, 6e-9],
        "rtol": 1e-11, "atol": 1e-14,
    }  # fmt: skip
    found = {
        engine: dl.frequency_response(leaky, engine=engine, **given_) for engine in ("compiled", "numpy")
    }
    assert found["numpy"]["amplitude"].size == 8
    for name in ("amplitude", "final_nominal_charge_density", "final_stretch"):
        np.testing.assert_allclose(found["compiled"][name], found["numpy"][name], rtol=1e-9)
    final = found["compiled"]["final_nominal_charge_density"].squeeze()
    kept = final.sel(conductivity=0.0)
    expected = final[CURRENT] * 0.01 + final["initial_nominal_charge_density"]
    np.testing.assert_allclose(kept, expected.transpose(*kept.dims), rtol=1e-10)


def test_a_sweep_has_the_current_of_its_sine(leaky):
    """Its amplitude, bias and phase are axes, and `frequency` is its own."""
    found = dl.frequency_response(
        leaky, frequency=[150.0, 250.0], current_amplitude=[0.1, 0.3], current_bias=0.05, current_phase=0.4,
        force=0.1, duration=0.01, final_state=True, section_points=1, initial_state="equilibrium",
    )  # fmt: skip
    assert found["amplitude"].dims == ("current_amplitude", "frequency")
    assert (found["current_amplitude"].units, found["current_phase"].units) == ("A/m^2", "rad")
    assert found["frequency"].long_name == "frequency of the current density"
    assert "current_phase" in found["section_time"].definition and "field_amplitude" not in found.coords
    expected = "current_bias + current_amplitude * sin(2 pi frequency t + current_phase)"
    assert found.attrs[f"{CURRENT}_drive"] == expected
    for place in np.ndindex(2, 2):
        one = found.isel(dict(zip(found["amplitude"].dims, place)))
        sine = dl.Sine(float(one["current_amplitude"]), float(one["frequency"]), 0.05, 0.4)
        run = dl.simulate(
            leaky, force=0.1, inputs={CURRENT: sine}, duration=0.01, initial_state="equilibrium"
        )
        assert float(one["final_stretch"]) == pytest.approx(float(run["stretch"][-1]), rel=1e-8)
        assert float(one[f"final_{CHARGE}"]) == pytest.approx(float(run[CHARGE][-1]), rel=1e-7)


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        (
            {"field_amplitude": 1e6},
            "field_amplitude given as 1000000, but the electrical input of leaky is nominal_current_density",
        ),
        (
            {"charge_bias": 1e-4, "current_amplitude": 0.1},
            "charge_bias given as 0.0001, but the electrical input of leaky is nominal_current_density",
        ),
        ({}, "current_amplitude must be a number in A/m\\^2, got none"),
        ({"current_bias": 0.1}, "current_amplitude must be a number in A/m\\^2, got none"),
        (
            {"current_amplitude": 0.1, "inputs": {CURRENT: 0.1}},
            "given by current_amplitude, current_bias, current_ph",
        ),
        ({"current_amplitude": np.inf}, "current_amplitude must be finite"),
    ],
)
def test_another_sine_is_refused(leaky, given_, says):
    with pytest.raises(ValueError, match=says) as refusal:
        dl.frequency_response(leaky, frequency=200.0, duration=0.01, **given_)
    assert "\n" not in str(refusal.value)


def test_a_sweep_of_the_current_by_command(leaky, tmp_path, capsys):
    out = tmp_path / "found.nc"
    arguments = ["--current-amplitude", "0.1,0.2", "--frequency", "150:250:50", "--duration", "2e-3"]
    assert main(["sweep", leaky.__file__, *arguments, "--force", "0.1", "--out", str(out), "--quiet"]) == 0
    assert "current_amplitude [A/m^2]" in capsys.readouterr().out
    assert xr.load_dataset(out)["amplitude"].shape == (2, 3)


def test_what_rests_and_vibrates_under_a_current_by_command(leaky, tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")  # no heading is folded
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    given_ = ["--input", f"{CURRENT}=0:0.4:0.2", "--out", str(out), "--plot", str(plot), "--quiet"]
    assert main(["equilibrium", leaky.__file__, *given_]) == 0
    assert "nominal current density [A/m^2]" in capsys.readouterr().out
    found = xr.load_dataset(out)
    np.testing.assert_allclose(found[CHARGE][:, 0], [0.0, 2e-3, 4e-3], rtol=1e-9, atol=1e-15)
    assert main(["modes", leaky.__file__, *given_]) == 0
    assert "current frequency [Hz]" in capsys.readouterr().out
    assert xr.load_dataset(out)["frequency"].dims == (CURRENT, "mode")
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert main(["equilibrium", leaky.__file__, "--quiet"]) == 0  # up to a current that it chooses
    assert capsys.readouterr().out.count("stable") == 12


def test_a_periodic_response_to_a_current_by_command(leaky, tmp_path, capsys):
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    sine = ["--current-amplitude", "1.0", "--frequency", "430:433", "--most-points", "4"]
    given_ = ["--steady", "--out", str(out), "--plot", str(plot), "--quiet"]
    assert main(["response", leaky.__file__, *sine, *given_]) == 0
    assert "The charge that the current feeds enters squared" in capsys.readouterr().out
    assert np.all(xr.load_dataset(out)["current_amplitude"] == 1.0)
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_tangents_of_the_variational_kernel_are_those_of_scipy(leaky):
    drives = {CURRENT: dl.Sine(0.05, 200.0)}
    problem = frozen(make_problem(leaky, None, {}, None, 0.1, 0.0, drives))
    path = FlowPath(problem, np.array([1.0, 5e3, 1.0, 1e-3]), 1e-11)
    times = np.linspace(0.0, 0.01, 5)
    given_ = (path, np.array([1.0, 0.0, 1.0, 1e-4]), times, np.eye(4))
    ours, theirs = flow_compiled(*given_), flow_by_scipy(*given_)
    np.testing.assert_allclose(ours.state / path.weights, theirs.state / path.weights, atol=1e-9)
    np.testing.assert_allclose(ours.tangent, theirs.tangent, rtol=1e-8, atol=1e-8)
    thickness = 4 * 1e-6 * ours.state[:, 0] ** -6  # its inertia changes with the stretch
    inertia = 2 * 25e-6 + thickness
    expected = -times / MAXWELL_TIME - np.log(inertia / inertia[0])
    np.testing.assert_allclose(ours.divergence, expected, atol=1e-9)
    assert ours.tangent[3, 3] == pytest.approx(np.exp(-0.01 / MAXWELL_TIME), rel=1e-10)
