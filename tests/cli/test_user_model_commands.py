"""A user's model in every command: by its path, its parameters by --parameter, its inputs by --input."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from user_membranes import write_membrane

import delagrange as dl
from delagrange.cli import main

SINE = ["--field-amplitude", "1e6", "--frequency"]
COMMANDS = {
    "simulate": ["--duration", "1e-3", "--input", "force_1=0.3"],
    "sweep": ["--duration", "1e-3", *SINE, "300:320:10", "--input", "force_1=0.1,0.2"],
    "equilibrium": ["--field", "0,1e6", "--dashpots", "frozen", "--input", "force-1=0.3"],
    "modes": ["--input", "force_1=0.3,0.4"],
    "response": ["--duration", "1e-3", *SINE, "300:320:10", "--input", "force_1=0.3"],
    "classify": ["--duration", "0.01", "--tolerance", "1e-6", "--input", "force_1=0.3"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_membrane(tmp_path_factory.mktemp("user"), "two_branches").parent


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_runs_a_model_by_its_path(capsys, tmp_path, folder, command):
    out = tmp_path / "found.nc"
    quiet = ["--quiet", "--parameter", "modulus_beta_2=2e4", "--density", "1100", "--out", str(out)]
    assert main([command, str(folder), *COMMANDS[command], *quiet]) == 0
    assert "two_branches" in capsys.readouterr().out
    stored = xr.load_dataset(out)
    for name, value in (("modulus_beta_2", 2e4), ("density", 1100.0)):
        assert float(stored.coords[name] if name in stored.coords else stored.attrs[name]) == value


@pytest.mark.parametrize("command", ["equilibrium", "modes"])
def test_its_picture_is_drawn(capsys, tmp_path, folder, command):
    plot = tmp_path / "drawn.png"
    assert main([command, str(folder), *COMMANDS[command], "--plot", str(plot), "--quiet"]) == 0
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_ranges_of_its_parameters_make_axes(tmp_path, folder):
    out = tmp_path / "found.nc"
    given = ["--parameter", "viscosity-1=210,420", "--parameter", "modulus_alpha=1e4:2e4:1e4"]
    assert main(["modes", str(folder), *given, "--out", str(out), "--quiet"]) == 0
    expected = dl.modes(folder, viscosity_1=[210.0, 420.0], modulus_alpha=[1e4, 2e4])["frequency"]
    np.testing.assert_array_equal(xr.load_dataset(out)["frequency"], expected)


REFUSED = {
    "parameter": (
        ["--parameter", "modulus_alfa=1"],
        "names no parameter of the model (did you mean 'modulus_alpha'?)",
    ),
    "input": (["--input", "force=1"], "names no input of the model (did you mean 'force_2'?)"),
    "form": (["--input", "force_1"], "input must be NAME=VALUES"),
    "number": (["--parameter", "density=heavy"], "parameter density must be a number in kg/m^3"),
    "twice": (
        ["--parameter", "density=1e3", "--density", "1e3"],
        "by --density and by --parameter; give one",
    ),
    "of another model": (["--viscosity", "1"], "unknown parameter 'viscosity'"),
    "force": (["--force", "1"], "give force_1, force_2 by inputs={...} (--input on the command line)"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_one_line_and_exit_code_2(capsys, folder, case):
    arguments, says = REFUSED[case]
    assert main(["simulate", str(folder), "--duration", "1e-3", *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert says in line


@pytest.mark.parametrize("many", [["--input", "force_1=0.1,0.2"], ["--parameter", "modulus_alpha=1e4,2e4"]])
@pytest.mark.parametrize("command", ["equilibrium", "response"])
def test_a_command_of_single_values_refuses_many(capsys, folder, command, many):
    driven = [*SINE, "300:320:10"] if command == "response" else []
    assert main([command, str(folder), *driven, *many, "--quiet"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{many[1].partition('=')[0]} must be a single number, got [" in line


def test_the_built_in_models_take_them_too(capsys):
    given = ["--parameter", "relaxation_time=1", "--input", "force=0.2", "--quiet"]
    assert main(["simulate", "uniaxial", "--duration", "1e-3", *given]) == 0
    assert main(["simulate", "nowhere/model.py", "--duration", "1e-3"]) == 2
    assert "nowhere/model.py: no such file or folder" in capsys.readouterr().err


@pytest.mark.parametrize("command", COMMANDS)
def test_a_model_is_loaded_once(monkeypatch, folder, command):
    loads = []
    load = dl.load
    monkeypatch.setattr("delagrange.model.load.load", lambda path: loads.append(path) or load(path))
    assert main([command, str(folder), *COMMANDS[command], "--quiet"]) == 0
    assert len(loads) == 1
