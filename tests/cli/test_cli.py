"""The command line as a whole: help, start-up, exit codes, colours."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from dataclasses import fields
from importlib.metadata import entry_points
from itertools import pairwise
from pathlib import Path

import pytest
import typer

import delagrange
from delagrange.cli import main
from delagrange.cli.app import application
from delagrange.cli.results import Interrupted, interruptible
from delagrange.common.units import with_unit
from delagrange.model.parameters import CHANGEABLE_UNITS, SHENG_2015, Parameters

COMMANDS = ("verify", "derive", "simulate", "sweep", "figures", "reproduce")
HEAVY = {"sympy", "scipy", "xarray", "matplotlib", "netCDF4", "jinja2", "pandas"}


def run(command: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A command of a shell, with the `delagrange` of this Python first on its path."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    unset = ("NO_COLOR", "FORCE_COLOR", "COLUMNS")
    inherited = {name: value for name, value in os.environ.items() if name not in unset}
    settings = inherited | {"PATH": path} | environment
    return subprocess.run(shlex.split(command), capture_output=True, text=True, env=settings, check=False)


def colours(text: str) -> list[str]:
    """The escape sequences in `text` that set a colour."""
    codes = [part.split("m")[0].split(";") for part in text.split("\x1b[")[1:]]
    return [code for group in codes for code in group if code.isdigit() and 30 <= int(code) <= 107]


def help_of(capsys, *arguments: str) -> str:
    assert main([*arguments, "--help"]) == 0
    return capsys.readouterr().out


def options_in(text: str) -> dict[str, str]:
    """What a wide help says of each option, by the option."""
    lines = [line.strip("│ *") for line in text.splitlines() if line.startswith("│")]
    split = [line.split(maxsplit=1) for line in lines if line.startswith("--")]
    return {option.split(",")[0]: described for option, described in split}


def option_of(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def loaded_after(*arguments: str) -> set[str]:
    code = (
        "import json, sys\nfrom delagrange.cli import main\nstatus = main(sys.argv[1:])\n"
        "print(json.dumps([status, sorted(sys.modules)]), file=sys.stderr)"
    )
    command = [sys.executable, "-c", code, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    status, modules = json.loads(done.stderr)
    assert status == 0 and done.stdout
    return set(modules)


@pytest.mark.parametrize("arguments", [["--help"], ["sweep", "--help"], ["verify", "--help"], ["--version"]])
def test_help_starts_without_anything_heavy(arguments):
    loaded = loaded_after(*arguments)
    assert "delagrange.cli.app" in loaded
    assert not loaded & HEAVY
    own = {name for name in loaded if name.startswith(("delagrange.derive.", "delagrange.generated."))}
    assert own <= {"delagrange.generated.equal_biaxial"}  # which says what the parameters are


def test_a_run_needs_no_derivation():
    loaded = loaded_after("simulate", "uniaxial", "--duration", "1e-4", "--quiet")
    assert "scipy" in loaded
    assert not loaded & {"sympy", "jinja2", "matplotlib"}


def test_version_is_that_of_the_package(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"delagrange {delagrange.__version__}\n"


def test_the_installed_script_is_main():
    (script,) = entry_points(group="console_scripts", name="delagrange")
    assert script.value == "delagrange.cli:main"
    assert script.load() is main


def test_python_m_is_the_same_command():
    done = run(f"{sys.executable} -m delagrange --version")
    assert (done.returncode, done.stdout) == (0, f"delagrange {delagrange.__version__}\n")
    assert run(f"{sys.executable} -m delagrange simulate nothing --duration 1").returncode == 2


def test_without_arguments_the_help_comes(capsys):
    assert main([]) == 0
    text = capsys.readouterr().out
    assert all(command in text for command in COMMANDS)
    assert "SI units" in text


@pytest.mark.parametrize("command", COMMANDS)
def test_every_help_has_an_example_and_fits_a_terminal(capsys, monkeypatch, command):
    monkeypatch.setenv("COLUMNS", "80")
    text = help_of(capsys, command)
    assert "Example" in text
    assert f"delagrange {command}" in text
    body = [line.rstrip() for line in text.split("╭")[0].splitlines()]
    continued = [after for before, after in pairwise(body) if before.endswith("\\")]
    assert all(line.startswith(" " * 7) for line in continued)  # an example is not torn by the margin


@pytest.mark.parametrize("command", ["simulate", "sweep"])
def test_every_quantity_has_its_unit_in_the_help(capsys, monkeypatch, command):
    monkeypatch.setenv("COLUMNS", "240")
    described = options_in(help_of(capsys, command))
    units = {"--force": "N", "--field-amplitude": "V/m", "--field-bias": "V/m", "--frequency": "Hz"}
    units |= {"--duration": "s"} | {option_of(name): unit for name, unit in CHANGEABLE_UNITS.items()}
    for option, unit in units.items():
        assert described[option].startswith(f"{unit} "), option  # in the column of what is to be given
        assert f"in {unit}" in described[option], option


def test_the_defaults_in_the_help_are_the_paper_s(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "240")
    described = options_in(help_of(capsys, "simulate"))
    for name, unit in CHANGEABLE_UNITS.items():
        assert f"[default: ({with_unit(getattr(SHENG_2015, name), unit)})]" in described[option_of(name)]


@pytest.mark.parametrize("command", ["simulate", "sweep"])
def test_every_material_parameter_has_an_option(command):
    (function,) = [c.callback for c in application().registered_commands if c.callback.__name__ == command]
    names = {entry.name for entry in fields(Parameters) if entry.name != "source"} | {"relaxation_time"}
    assert names <= set(function.__annotations__)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["simulat"], "No such command 'simulat'"),
        (["simulate"], "Missing argument"),
        (["simulate", "uniaxial"], "Missing option '--duration'"),
        (["simulate", "uniaxial", "--duration"], "--duration"),
        (["simulate", "uniaxial", "--duration", "0.1", "--forse", "1"], "--forse"),
        (["simulate", "uniaxial", "--duration", "long"], "--duration must be a number in s, got 'long'"),
        (
            ["simulate", "uniaxial", "--duration", "0.1", "--force", "a"],
            "--force must be a number in N, got 'a'",
        ),
        (["simulate", "uniaxial", "--duration", "0.1", "--samples", "1.5"], "--samples"),
        (["--verbose"], "--verbose"),
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_2(capsys, arguments, says):
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    (line,) = captured.err.splitlines()
    assert line.startswith("delagrange: error: ")
    assert says in line


def test_a_usage_error_is_what_typer_says_it_is():
    with pytest.raises(typer.BadParameter.__base__):
        typer.main.get_command(application()).main(["--nonsense"], standalone_mode=False)


def test_interruption_is_told_with_its_consequence():
    with pytest.raises(Interrupted, match="half of it is lost"), interruptible("half of it is lost"):
        raise KeyboardInterrupt


def test_colours_follow_no_color():
    command = "delagrange simulate equal-biaxial --duration 1e-4 --quiet"
    coloured, plain = run(command, FORCE_COLOR="1"), run(command, FORCE_COLOR="1", NO_COLOR="1")
    assert coloured.returncode == plain.returncode == 0
    assert "32" in colours(coloured.stdout)  # "completed" is green
    assert not colours(plain.stdout)
    assert "\x1b" not in run(command).stdout  # nobody can see colours in a pipe


def test_a_terminal_without_greek_letters_is_no_error():
    done = run("delagrange simulate equal-biaxial --duration 1e-4 --quiet", PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert "?_EB" in done.stdout
