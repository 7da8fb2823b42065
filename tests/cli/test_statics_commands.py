"""`delagrange equilibrium` and `delagrange modes`: their tables, files and figures."""

from __future__ import annotations

import csv

import numpy as np
import pytest
import xarray as xr
from gent_membrane import gent_membrane

import delagrange as dl
from delagrange.analysis.rest.critical_map import FAST, SLOW, SUDDEN, critical_map
from delagrange.cli import main
from delagrange.figures.equilibrium_figure import draw_critical_map, draw_equilibria
from delagrange.figures.modes_figure import draw_modes


@pytest.fixture(autouse=True)
def wide(monkeypatch):
    monkeypatch.setenv("COLUMNS", "140")


def done(capsys, *arguments: str) -> str:
    code = main(list(arguments))
    captured = capsys.readouterr()
    assert (code, captured.err) == (0, "")
    return captured.out


def refused(capsys, *arguments: str) -> str:
    assert main(list(arguments)) == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line


def test_equilibrium_prints_branches_and_limit_points(capsys, tmp_path):
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    text = done(
        capsys, "equilibrium", "equal-biaxial", "--field", "0:2e7:1e7", "--dashpots", "frozen",
        "--out", str(out), "--plot", str(plot),
    )  # fmt: skip
    assert "pull-in at 2.138637e+07 V/m (42772.75 V)" in text
    assert "branch 1: limit: a principal stretch below 0.001" in text
    assert f"written: {out}" in text and f"written: {plot}" in text
    assert plot.read_bytes().startswith(b"\x89PNG")
    expected = dl.equilibria("equal_biaxial", field=[0.0, 1e7, 2e7], dashpots="frozen")
    stored = xr.load_dataset(out)
    np.testing.assert_array_equal(stored["stretch"], expected["stretch"])
    np.testing.assert_array_equal(stored["curve_field"], expected["curve_field"])
    assert stored["field"].attrs["units"] == "V/m"


def test_equilibrium_without_field_goes_a_little_beyond_pull_in(capsys, tmp_path):
    out = tmp_path / "found.csv"
    done(capsys, "equilibrium", "uniaxial", "--force", "0.5", "--dashpots", "frozen", "--out", str(out))
    with out.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    fields = sorted({float(row["field [V/m]"]) for row in rows})
    limit = float(dl.pull_in("uniaxial", force=0.5)["field"])
    assert fields[0] == 0 and fields[-2] < limit < fields[-1] < 1.1 * limit
    assert {row["stability"] for row in rows} == {"stable", "saddle", "no equilibrium"}


def test_a_map_over_the_force(capsys, tmp_path):
    out, plot = tmp_path / "map.nc", tmp_path / "map.pdf"
    text = done(
        capsys, "equilibrium", "equal-biaxial", "--map-force", "0:0.5:0.5", "--quiet", "--out", str(out),
        "--plot", str(plot),
    )  # fmt: skip
    assert "static, dashpots relaxed [V/m]" in text
    assert plot.read_bytes().startswith(b"%PDF")
    stored = xr.load_dataset(out)
    np.testing.assert_array_equal(
        stored["field"].sel(load=FAST), dl.pull_in("equal_biaxial", force=[0.0, 0.5])["field"]
    )
    assert np.all(stored["field"].sel(load=SLOW) < stored["field"].sel(load=SUDDEN))
    assert np.all(stored["field"].sel(load=SUDDEN) < stored["field"].sel(load=FAST))


def test_modes_prints_frequencies(capsys, tmp_path):
    out, plot = tmp_path / "modes.nc", tmp_path / "modes.png"
    text = done(
        capsys, "modes", "uniaxial", "--force", "0,0.5", "--dashpots", "relaxed", "--out", str(out), "--plot", str(plot)
    )  # fmt: skip
    assert "decay [1/s]" in text and "field frequency [Hz]" in text
    assert plot.stat().st_size > 0
    expected = dl.modes("uniaxial", force=[0.0, 0.5], dashpots="relaxed")
    np.testing.assert_array_equal(xr.load_dataset(out)["frequency"], expected["frequency"])
    assert "918.8815" in done(capsys, "modes", "equal-biaxial")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("equilibrium", "pure-shear", "--field", "1e6"), "held_stretch [1] is missing"),
        (("equilibrium", "equal-biaxial", "--field", "1e6", "--voltage", "1e3"), "got both"),
        (
            ("equilibrium", "equal-biaxial", "--field", "1e6", "--plot", "x.jpg"),
            "plot file x.jpg must end in .png",
        ),
        (
            ("equilibrium", "equal-biaxial", "--field", "1e6", "--dashpots", "loose"),
            "dashpots must be one of",
        ),
        (("equilibrium", "equal-biaxial", "--map-force", "0:1"), "map-force must be START:STOP:STEP in N"),
        (("modes", "equal-biaxial", "--force", "much"), "force must be a number in N"),
        (("modes", "equal-biaxial", "--dashpots", "evolving"), "dashpots must be one of frozen, relaxed"),
    ],
)
def test_bad_input(capsys, arguments, message):
    assert message in refused(capsys, *arguments)


def test_the_figure_shows_every_branch_and_limit():
    found = dl.equilibria(gent_membrane(), field=np.linspace(0, 1.5e7, 4), dashpots="frozen")
    axes = draw_equilibria(found).axes[0]
    assert {line.get_linestyle() for line in axes.get_lines()} == {"-", "--", "None"}
    marked = next(line for line in axes.get_lines() if line.get_marker() == "o")
    np.testing.assert_allclose(marked.get_xdata(), found["limit_field"] / 1e6)
    assert axes.get_xlabel().endswith("[MV/m]") and axes.get_ylabel().endswith("[1]")


def test_figures_of_what_has_no_equilibrium_are_empty():
    axes = draw_equilibria(dl.equilibria("equal_biaxial", force=1e4, field=1e7)).axes[0]
    assert all(len(line.get_xdata()) == 0 for line in axes.get_lines())


def test_the_map_shows_where_there_is_no_limit_point():
    critical = critical_map("pure_shear", force=[0.0, 0.3], held_stretch=2.0)
    left = draw_critical_map(critical).axes[0]
    reached = [line for line in left.get_lines() if line.get_marker() == "^"]
    assert sum(len(line.get_xdata()) for line in reached if np.any(np.isfinite(line.get_ydata()))) == 4


def test_the_figure_of_modes_has_a_curve_for_each():
    found = dl.modes("uniaxial", force=[0.0, 0.5], field=np.linspace(0, 1e7, 5))
    axes = draw_modes(found).axes[0]
    lines = axes.get_lines()
    assert [line.get_label() for line in lines[:2]] == ["mode 1, $P$ = 0 N", "mode 2, $P$ = 0 N"]
    np.testing.assert_allclose(lines[3].get_ydata(), found["frequency"][1, :, 1])
    with pytest.raises(ValueError, match="needs something that varies"):
        draw_modes(dl.modes("uniaxial"))
