"""`delagrange simulate` and `delagrange sweep`: the calls of the documentation, their files, their tables."""

from __future__ import annotations

import csv
import os
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import delagrange as dl
from delagrange.cli import main
from delagrange.common.progress import Progress


@pytest.fixture(autouse=True)
def wide(monkeypatch):
    """No table is folded, however the tests are run."""
    monkeypatch.setenv("COLUMNS", "120")


def shell(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path}
    arguments = shlex.split(command)
    return subprocess.run(arguments, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def done(capsys, *arguments: str) -> str:
    """What a command prints that must succeed."""
    code = main([*arguments, "--quiet"])
    captured = capsys.readouterr()
    assert (code, captured.err) == (0, "")
    return captured.out


def run_of(tmp_path, capsys, *arguments: str) -> xr.Dataset:
    out = tmp_path / "run.nc"
    done(capsys, "simulate", *arguments, "--out", str(out))
    return xr.load_dataset(out)


def refused(capsys, *arguments: str) -> str:
    assert main(list(arguments)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    (line,) = captured.err.splitlines()
    assert line.startswith("delagrange: error: ")
    return line


def interrupt_after(monkeypatch, calls: int) -> None:
    """Ctrl-C at the given report of progress."""
    reports = iter(range(1, calls))

    def advance_to(self: Progress, done: float) -> None:
        if next(reports, None) is None:
            raise KeyboardInterrupt

    monkeypatch.setattr(Progress, "advance_to", advance_to)


def test_simulate_as_documented(tmp_path):
    command = (
        "delagrange simulate equal-biaxial --force 0.5 --field-amplitude 5e6 --frequency 371 "
        "--duration 0.1 --out run.nc"
    )
    finished = shell(command, tmp_path)
    assert finished.returncode == 0, finished.stderr
    assert "completed at 0.1 s" in finished.stdout
    assert "written: run.nc" in finished.stdout
    assert os.listdir(tmp_path) == ["run.nc"]
    same = dl.simulate("equal_biaxial", force=0.5, field=dl.Sine(5e6, 371.0), duration=0.1)
    with xr.open_dataset(tmp_path / "run.nc") as read:
        xr.testing.assert_identical(read.load(), same)


def test_sweep_as_documented(tmp_path):
    command = (
        "delagrange sweep uniaxial --force 0.2 --force 0.5 --field-amplitude 1e6 --frequency 300:500:1 "
        "--duration 0.1 --out response.nc"
    )
    finished = shell(command, tmp_path)
    assert finished.returncode == 0, finished.stderr
    assert "402" in finished.stderr  # progress
    assert "completed: 402 of 402 runs" in finished.stdout
    response = xr.load_dataset(tmp_path / "response.nc")
    assert dict(response.sizes) == {"force": 2, "frequency": 201}
    np.testing.assert_array_equal(response["frequency"], np.arange(300.0, 501.0))
    some = dl.frequency_response(
        "uniaxial", force=[0.2, 0.5], field_amplitude=1e6, frequency=[300.0, 446.0, 500.0], duration=0.1
    )
    np.testing.assert_array_equal(response["amplitude"].sel(frequency=some["frequency"]), some["amplitude"])
    peak = float(response["amplitude"].sel(force=0.2).max())
    (row,) = [line for line in finished.stdout.splitlines() if line.startswith("0.2 ")]
    assert row.split() == ["0.2", "446", f"{peak:.6g}"]


def test_what_is_measured_reaches_the_file(tmp_path, capsys):
    out = tmp_path / "response.nc"
    text = done(
        capsys, "sweep", "uniaxial", "--field-amplitude", "1e6", "--frequency", "300,310", "--duration", "0.01",
        "--field-phase", "0.5,1", "--initial", "stretch-1=1.1,1.2", "--initial", "stretch_1=1.3",
        "--initial", "stretch_rate_2=-1:1:1", "--averages", "--final-state", "--section-points", "2",
        "--section-phase", "-1", "--engine", "numpy", "--threads", "1", "--step-control", "scipy", "--out", str(out),
    )  # fmt: skip
    assert "completed: 36 of 36 runs" in text
    same = dl.frequency_response(
        "uniaxial", field_amplitude=1e6, frequency=[300.0, 310.0], duration=0.01, field_phase=[0.5, 1.0],
        initial_state={"stretch_1": [1.1, 1.2, 1.3], "stretch_rate_2": [-1.0, 0.0, 1.0]}, averages=True,
        final_state=True, section_points=2, section_phase=-1.0, engine="numpy",
    )  # fmt: skip
    xr.testing.assert_identical(xr.load_dataset(out), same)


def test_trajectories_of_a_sweep_reach_a_table(tmp_path, capsys):
    out = tmp_path / "response.csv"
    done(
        capsys, "sweep", "equal-biaxial", "--field-amplitude", "1e6", "--frequency", "300,310", "--duration", "0.001",
        "--sample-interval", "5e-4", "--initial", "stretch=1.1", "--out", str(out),
    )  # fmt: skip
    with out.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["frequency [Hz]"], row["time [s]"]) for row in rows] == [
        (frequency, time) for frequency in ("300.0", "310.0") for time in ("0.0", "0.0005", "0.001")
    ]
    assert {row["stretch [1]"] for row in rows if row["time [s]"] == "0.0"} == {"1.1"}
    assert rows[0]["initial_stretch [1]"] == "1.1" and rows[0]["field_phase [rad]"] == "0.0"


def test_the_summary_has_extrema_with_units(tmp_path, capsys):
    out = tmp_path / "run.nc"
    arguments = ["simulate", "uniaxial", "--force", "0.5", "--duration", "0.01", "--energies"]
    text = done(capsys, *arguments, "--out", str(out))
    run = xr.load_dataset(out)
    for name in ("stretch_1", "thickness_stretch", "total_energy", "force_power"):
        (row,) = [line.split() for line in text.splitlines() if line.split()[:1] == [name]]
        assert run[name].attrs["units"] in row
        assert f"{float(run[name].max()):.6g}" in row and f"{float(run[name].min()):.6g}" in row
    assert done(capsys, *arguments) == text.replace(f"written: {out}\n", "")


def test_hyphens_formulations_and_material_reach_the_model(tmp_path, capsys):
    run = run_of(
        tmp_path, capsys, "pure-shear", "--formulation", "as-printed", "--held-stretch", "2", "--force", "0.1",
        "--density", "1100", "--relaxation-time", "2", "--duration", "1e-3", "--samples", "11",
        "--method", "RK45", "--rtol", "1e-6", "--atol", "1e-8",
    )  # fmt: skip
    assert run.attrs["model"] == "pure_shear_as_printed"
    assert run.sizes["time"] == 11
    assert (run.attrs["held_stretch"], run.attrs["density"]) == (2.0, 1100.0)
    assert run.attrs["viscosity"] == 2.0 * dl.SHENG_2015.shear_modulus_beta
    assert (run.attrs["method"], run.attrs["rtol"], run.attrs["atol"]) == ("RK45", 1e-6, 1e-8)
    free = ["pure-shear", "--lateral-dashpot", "free", "--held-stretch", "2", "--duration", "1e-3"]
    assert run_of(tmp_path, capsys, *free).attrs["model"] == "pure_shear_consistent_free"


@pytest.mark.parametrize(
    ("options", "force", "field"),
    [
        ([], dl.Constant(0.0), dl.Constant(0.0)),
        (["--force", "-0.5", "--field-amplitude", "2e6"], dl.Constant(-0.5), dl.Constant(2e6)),
        (["--force", "0.5", "--force-step-time", "0.004"], dl.Step(0.5, 0.004), dl.Constant(0.0)),
        (["--field-amplitude", "2e6", "--field-step-time", "0"], dl.Constant(0.0), dl.Step(2e6, 0.0)),
        (["--force-ramp", "0:0.5:0.004"], dl.Ramp(0.0, 0.5, 0.004), dl.Constant(0.0)),
        (["--field-ramp", "1e6:3e6:0.004:0.002"], dl.Constant(0.0), dl.Ramp(1e6, 3e6, 0.004, 0.002)),
        (
            ["--force", "0.1", "--force-frequency", "90", "--force-bias", "0.3", "--force-phase", "1"],
            dl.Sine(0.1, 90.0, 0.3, 1.0),
            dl.Constant(0.0),
        ),
        (
            ["--field-amplitude", "1e6", "--frequency", "300", "--field-bias", "2e6", "--phase", "0.5"],
            dl.Constant(0.0),
            dl.Sine(1e6, 300.0, 2e6, 0.5),
        ),
    ],
)
def test_drives_are_what_was_asked_for(tmp_path, capsys, options, force, field):
    run = run_of(tmp_path, capsys, "equal-biaxial", "--duration", "0.01", "--samples", "101", *options)
    same = dl.simulate("equal_biaxial", force=force, field=field, duration=0.01, samples=101)
    assert run.attrs["force_drive"] == str(force)
    assert run.attrs["nominal_electric_field_drive"] == str(field)
    xr.testing.assert_equal(run, same)


@pytest.mark.parametrize("heading", ["", "time [s],value\n"])
def test_a_table_drives_force_and_field(tmp_path, capsys, heading):
    force, field = tmp_path / "force.csv", tmp_path / "field.csv"
    force.write_text(f"{heading}0,0\n0.005,0.4\n0.01,0.1\n", encoding="utf-8")
    field.write_text(f"{heading}0,1e6\n\n0.01, 2e6\n", encoding="utf-8")
    tables = ["--force-csv", str(force), "--field-csv", str(field)]
    run = run_of(tmp_path, capsys, "equal-biaxial", "--duration", "0.01", *tables)
    same = dl.simulate(
        "equal_biaxial",
        force=dl.Tabulated([0.0, 0.005, 0.01], [0.0, 0.4, 0.1]),
        field=dl.Tabulated([0.0, 0.01], [1e6, 2e6]),
        duration=0.01,
    )
    xr.testing.assert_equal(run, same)


def test_a_byte_order_mark_of_a_spreadsheet_costs_no_line(tmp_path, capsys):
    table = tmp_path / "force.csv"
    table.write_bytes("0,0.2\r\n0.005,0.4\r\n0.01,0.1\r\n".encode("utf-8-sig"))
    run = run_of(tmp_path, capsys, "equal-biaxial", "--duration", "0.01", "--force-csv", str(table))
    np.testing.assert_allclose(run["force"].values[[0, 1000, 2000]], [0.2, 0.4, 0.1])


def test_a_field_table_that_is_too_short_is_called_that(tmp_path, capsys):
    table = tmp_path / "field.csv"
    table.write_text("0,0\n0.005,1e6\n", encoding="utf-8")
    line = refused(capsys, *SIMULATE, "--field-csv", str(table))
    assert "field table covers 0 s to 0.005 s and does not cover the run, 0 s to 0.01 s" in line


@pytest.mark.parametrize(
    ("given", "dimensions"), [(["0.2"], ("frequency",)), (["0.2,0.5"], ("force", "frequency"))]
)
def test_a_value_given_once_makes_no_axis(tmp_path, capsys, given, dimensions):
    out = tmp_path / "response.nc"
    done(
        capsys, "sweep", "equal-biaxial", "--force", *given, "--field-amplitude", "1e6", "--frequency", "300,400",
        "--duration", "1e-3", "--out", str(out),
    )  # fmt: skip
    assert xr.load_dataset(out)["amplitude"].dims == dimensions


def test_a_lost_run_is_a_result_and_says_so(tmp_path, capsys):
    out = tmp_path / "run.nc"
    lost = ["simulate", "equal-biaxial", "--field-amplitude", "5e7", "--duration", "0.01", "--out", str(out)]
    text = done(capsys, *lost)
    run = xr.load_dataset(out)
    assert run["status"].item() in ("collapsed", "diverged")
    assert run["status"].item() in text and "completed" not in text


def test_csv_of_a_run_reads_back(tmp_path, capsys):
    out = tmp_path / "run.csv"
    done(capsys, "simulate", "uniaxial", "--force", "0.5", "--duration", "0.01", "--out", str(out))
    with out.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    run = dl.simulate("uniaxial", force=0.5, duration=0.01)
    assert list(rows[0])[:2] == ["time [s]", "stretch_1 [1]"]
    for name, unit in (("time", "s"), ("stretch_1", "1"), ("stretch_rate_1", "1/s"), ("force", "N")):
        np.testing.assert_array_equal([float(row[f"{name} [{unit}]"]) for row in rows], run[name])


def test_axes_of_a_sweep(tmp_path, capsys):
    out = tmp_path / "response.nc"
    text = done(
        capsys, "sweep", "pure-shear", "--held-stretch", "1.5,2", "--force", "0.1",
        "--field-amplitude", "1e6:2e6:5e5", "--frequency", "300,400", "--frequency", "500",
        "--relaxation-time", "400,1e9", "--duration", "5e-3", "--window", "2e-3:5e-3", "--out", str(out),
    )  # fmt: skip
    response = xr.load_dataset(out)
    sizes = {"field_amplitude": 3, "held_stretch": 2, "relaxation_time": 2, "frequency": 3}
    assert dict(response.sizes) == sizes
    assert response["force"].item() == 0.1
    np.testing.assert_array_equal(response["field_amplitude"], [1e6, 1.5e6, 2e6])
    assert (response.attrs["window_start"], response.attrs["window_stop"]) == (2e-3, 5e-3)
    peaks = dl.peaks(response)
    rows = [line.split() for line in text.splitlines() if len(line.split()) == 5 and line[0].isdigit()]
    assert len(rows) == peaks["peak_amplitude"].size == 12
    printed = [float(row[-1]) for row in rows]
    np.testing.assert_allclose(printed, peaks["peak_amplitude"].values.ravel(), rtol=1e-5)


def test_the_paper_s_numerics_are_within_reach(tmp_path, capsys):
    out = tmp_path / "response.nc"
    done(
        capsys, "sweep", "equal-biaxial", "--force", "0.5", "--field-amplitude", "1e6", "--frequency", "385",
        "--duration", "0.01", "--method", "RK45", "--rtol", "1e-3", "--atol", "1e-6", "--step-control", "ode45",
        "--extrema", "samples", "--out", str(out),
    )  # fmt: skip
    attributes = xr.load_dataset(out).attrs
    assert (attributes["method"], attributes["step_control"], attributes["extrema"]) == (
        "RK45",
        "ode45",
        "samples",
    )


def test_diverging_points_are_counted_and_the_others_stand(tmp_path, capsys):
    out = tmp_path / "response.csv"
    sweep = ["sweep", "equal-biaxial", "--force", "0.1", "--frequency", "300:400:50", "--duration", "5e-3"]
    text = done(capsys, *sweep, "--field-amplitude", "1e6,8e7", "--out", str(out))
    with out.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert "completed: 3 of 6 runs" in text
    kinds = [row["status"] for row in rows]
    assert kinds[:3] == ["completed"] * 3
    assert set(kinds[3:]) <= {"collapsed", "diverged"}
    alone = dl.frequency_response(
        "equal_biaxial", force=0.1, field_amplitude=1e6, frequency=[300.0, 350.0, 400.0], duration=5e-3
    )
    np.testing.assert_array_equal([float(row["amplitude [1]"]) for row in rows[:3]], alone["amplitude"])
    assert all(np.isnan(float(row["amplitude [1]"])) for row in rows[3:])


def test_ctrl_c_keeps_what_a_sweep_has_done(tmp_path, capsys, monkeypatch):
    out = tmp_path / "response.nc"
    interrupt_after(monkeypatch, calls=2)
    code = main(
        ["sweep", "equal-biaxial", "--force", "0.1", "--field-amplitude", "1e6",
         "--frequency", "1:700:1", "--duration", "2e-4", "--rtol", "1e-3", "--atol", "1e-6",
         "--engine", "scipy", "--out", str(out), "--quiet"]
    )  # fmt: skip
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    status = xr.load_dataset(out)["status"]
    left = int((status == "interrupted").sum())
    assert code == 130
    assert 0 < left < 700 and int((status == "completed").sum()) == 700 - left
    told = f"{left} of 700 runs were not computed and are in {out} with that status"
    assert line == f"delagrange: interrupted: {told}"


def test_ctrl_c_in_a_run_leaves_no_half_a_file(tmp_path, capsys, monkeypatch):
    interrupt_after(monkeypatch, calls=3)
    out = tmp_path / "run.nc"
    assert main(["simulate", "uniaxial", "--force", "0.5", "--duration", "0.1", "--out", str(out)]) == 130
    assert "interrupted: the run was not finished, nothing was written" in capsys.readouterr().err
    assert os.listdir(tmp_path) == []


SIMULATE = ("simulate", "equal-biaxial", "--duration", "0.01")
SWEEP = ("sweep", "equal-biaxial", "--duration", "0.01", "--field-amplitude", "1e6", "--frequency", "300")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([*SIMULATE, "--density", "-1"], ["density", "-1 kg/m^3", "positive"]),
        ([*SIMULATE, "--viscosity", "nan"], ["viscosity", "nan Pa s", "finite"]),
        ([*SIMULATE, "--relaxation-time", "0"], ["relaxation_time", "0 s", "positive"]),
        ([*SIMULATE, "--relaxation-time", "1", "--viscosity", "1"], ["relaxation_time", "viscosity"]),
        ([*SIMULATE, "--force", "inf"], ["--force must be finite, got inf N"]),
        (
            [*SIMULATE, "--field-amplitude", "nan", "--frequency", "300"],
            ["--field-amplitude must be finite, got nan V/m"],
        ),
        (
            [*SIMULATE, "--field-amplitude", "1", "--frequency", "9", "--field-bias", "inf"],
            ["--field-bias must be finite, got inf V/m"],
        ),
        (
            [*SIMULATE, "--force", "1", "--force-frequency", "9", "--force-phase", "nan"],
            ["--force-phase must be finite, got nan rad"],
        ),
        (
            [*SIMULATE, "--force", "1", "--force-step-time", "inf"],
            ["--force-step-time must be finite, got inf s"],
        ),
        ([*SIMULATE, "--field-ramp", "0:nan:1"], ["field-ramp stop must be finite, got nan V/m"]),
        (
            [*SIMULATE, "--half-length", "1e300", "--force", "1"],
            ["double precision", "half_length = 1e+300 m"],
        ),
        ([*SWEEP, "--half-length", "1e300"], ["double precision", "half_length = 1e+300 m"]),
        ([*SIMULATE, "--samples", "1000000000000"], ["samples", "from 2 to 10000000", "1e+12"]),
        (
            [
                "simulate",
                "pure-shear-as-printed",
                "--formulation",
                "consistent",
                "--held-stretch",
                "2",
                "--duration",
                "0.01",
            ],
            ["formulation 'consistent'", "pure_shear_as_printed", "'as_printed'"],
        ),
        ([*SIMULATE, "--duration", "1e-10"], ["duration", "1e-09 s to 1000000 s", "1e-10 s"]),
        (
            ["simulate", "triaxial", "--duration", "1"],
            ["'triaxial'", "equal_biaxial", "uniaxial", "pure_shear"],
        ),
        ([*SIMULATE, "--formulation", "printed"], ["formulation", "'printed'"]),
        (
            ["simulate", "pure-shear", "--held-stretch", "2", "--duration", "1", "--formulation", "printed"],
            ["formulation", "'printed'", "consistent", "as_printed"],
        ),
        (["simulate", "pure-shear", "--duration", "1"], ["held_stretch", "[1]", "missing"]),
        (
            ["simulate", "pure-shear", "--duration", "1", "--held-stretch", "0"],
            ["held_stretch", "0", "positive"],
        ),
        ([*SIMULATE, "--held-stretch", "2"], ["held_stretch", "2"]),
        (["simulate", "uniaxial", "--duration", "0"], ["duration", "1e-09 s to 1000000 s", "0 s"]),
        ([*SIMULATE, "--rtol", "1"], ["rtol", "1e-13", "0.01"]),
        ([*SIMULATE, "--atol", "-1"], ["atol must lie from 1e-18 to 0.01 in the unit of each", ", got -1"]),
        ([*SIMULATE, "--method", "Euler"], ["method", "'Euler'", "DOP853", "Radau"]),
        ([*SIMULATE, "--samples", "1"], ["samples", "got 1", "from 2"]),
        ([*SIMULATE, "--field-amplitude", "1e6", "--frequency", "-3"], ["frequency", "-3 Hz", "positive"]),
        ([*SIMULATE, "--frequency", "300"], ["--frequency", "300 Hz", "--field-amplitude"]),
        (
            [*SIMULATE, "--field-amplitude", "1e6", "--field-bias", "1"],
            ["--field-bias", "1 V/m", "--frequency"],
        ),
        ([*SIMULATE, "--field-amplitude", "1e6", "--phase", "1"], ["--field-phase", "1 rad", "--frequency"]),
        ([*SIMULATE, "--force-step-time", "1"], ["--force-step-time", "1 s", "--force"]),
        ([*SIMULATE, "--force", "1", "--force-ramp", "0:1:1"], ["force [N]", "--force and --force-ramp"]),
        ([*SIMULATE, "--force-ramp", "0:1"], ["force-ramp", "START:STOP:DURATION", "'0:1'", "N", "s"]),
        ([*SIMULATE, "--force-ramp", "0:b:1"], ["force-ramp", "'b'", "N"]),
        ([*SIMULATE, "--field-ramp", "0:1:0"], ["duration", "0 s", "positive"]),
        ([*SIMULATE, "--out", "run.txt"], ["run.txt", ".nc", ".csv"]),
        ([*SIMULATE, "--out", "no/such/folder/run.nc"], ["run.nc", "no/such/folder", "No such file"]),
        ([*SWEEP, "--frequency", "200"], ["frequency", "increasing", "Hz"]),
        ([*SWEEP, "--frequency", "500:300:1"], ["frequency", "'500:300:1'", "Hz", "empty"]),
        ([*SWEEP, "--frequency", "300:500:0"], ["frequency", "'300:500:0'", "STEP > 0"]),
        ([*SWEEP, "--frequency", ""], ["frequency", "Hz", "''"]),
        ([*SWEEP, "--frequency", "0:1e9:1e-3"], ["frequency", "1000000 values"]),
        ([*SWEEP, "--force", "0.1,0.1"], ["force", "twice", "0.1"]),
        ([*SWEEP, "--window", "0.005"], ["window", "START:STOP", "s", "'0.005'"]),
        ([*SWEEP, "--window", "0:1"], ["window", "0.01 s"]),
        ([*SWEEP, "--held-stretch", "2,3"], ["held_stretch", "holds no stretch"]),
        ([*SWEEP, "--density", "1,-1"], ["density", "kg/m^3", "positive"]),
        ([*SWEEP, "--extrema", "all"], ["extrema", "'all'", "dense"]),
        ([*SWEEP, "--field-phase", "x"], ["--field-phase", "rad", "'x'"]),
        ([*SWEEP, "--initial", "1.1"], ["initial must be NAME=VALUES", "stretch [1]", "'1.1'"]),
        ([*SWEEP, "--initial", "strech=1.1"], ["'strech=1.1'", "did you mean 'stretch'", "[1/s]"]),
        ([*SWEEP, "--initial", "stretch=wide"], ["initial stretch", "unit 1", "'wide'"]),
        ([*SWEEP, "--initial", "stretch_rate=fast"], ["initial stretch_rate", "1/s", "'fast'"]),
        ([*SWEEP, "--initial", "stretch=0"], ["initial_state stretch", "positive", "0"]),
        ([*SWEEP, "--section-points", "100"], ["section_points must be at most", "got 100", "Hz"]),
        ([*SWEEP, "--section-phase", "1"], ["section_phase 1 rad", "section_points"]),
        ([*SWEEP, "--sample-interval", "1"], ["sample_interval", "0.01 s", "got 1 s"]),
        ([*SWEEP, "--threads", "0"], ["threads", "at least 1", "0"]),
        ([*SWEEP, "--engine", "abacus"], ["engine", "'abacus'", "auto", "numpy", "scipy"]),
        (["figures", "--only", "3"], ["only", "'3'", "4, 5, 6"]),
    ],
)
def test_bad_input_is_one_line_that_names_it(tmp_path, capsys, monkeypatch, arguments, says):
    monkeypatch.chdir(tmp_path)
    line = refused(capsys, *arguments)
    assert all(part in line for part in says), line
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("0,0\n0.005,1\n", ["force table covers", "0.005 s", "0.01 s"]),
        ("0,0\n0.02,1\n0.01,1\n", ["force table", "time must be strictly increasing", "s"]),
        ("0,0\n0.02,nan\n", ["force table", "value must be finite", "nan", " N"]),
        ("0,0\n", ["force table", "holds 1 line", "two or more", "time [s]", "value [N]"]),
        ("0,x\n0,0\n0.02,1\n", ["force table", "line 1: value", "N", "'x'"]),
        ("x,0\n0,0\n0.02,1\n", ["force table", "line 1: time", "s", "'x'"]),
        ("0,0\n0.02,x\n", ["line 2", "value", "N", "'x'"]),
        ("0,0,0\n", ["line 1", "3 columns"]),
        ("time,force\n", ["empty", "time [s]", "[N]"]),
        ("", ["empty"]),
    ],
)
def test_a_bad_table_is_named(tmp_path, capsys, content, says):
    table = tmp_path / "force.csv"
    table.write_text(content, encoding="utf-8")
    line = refused(capsys, *SIMULATE, "--force-csv", str(table))
    assert all(part in line for part in says), line


def test_a_missing_table_is_named(tmp_path, capsys):
    line = refused(capsys, *SIMULATE, "--field-csv", str(tmp_path / "none.csv"))
    assert "field table" in line and "none.csv" in line and "No such file" in line


@pytest.mark.parametrize("command", ["figures", "reproduce", "derive"])
def test_a_folder_that_cannot_be_written_is_refused_first(tmp_path, capsys, command):
    taken = tmp_path / "taken"
    taken.write_text("a file", encoding="utf-8")
    for folder in (taken, taken / "below"):
        line = refused(capsys, command, "--out", str(folder))
        assert f"output folder {folder} cannot be written" in line


def test_nothing_is_computed_for_a_file_that_cannot_be_written(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("delagrange.run.simulation.integrate", lambda *_: pytest.fail("integrated"))
    line = refused(capsys, *SIMULATE, "--out", str(tmp_path / "missing" / "run.nc"))
    assert "cannot be written" in line
