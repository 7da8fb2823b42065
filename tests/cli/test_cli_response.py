"""`delagrange response`, as a person types it."""

from __future__ import annotations

import csv

import numpy as np
import pytest
import xarray as xr

import delagrange as dl
from delagrange.cli import main

TRANSIENT = "response equal-biaxial --force 0.5 --field-amplitude 1e6 --frequency 370:390:5 --quiet"
STEADY = (
    "response equal-biaxial --force 0.1 --field-amplitude 4e6 --frequency 412:422 --relaxation-time 0.01 --steady "
    "--dashpots relaxed --largest-amplitude 0.25 --quiet"
)


def run(text: str, *more: str) -> int:
    return main([*text.split(), *more])


def test_without_steady_it_is_the_transient_amplitude(tmp_path, capsys):
    out = tmp_path / "response.nc"
    assert run(TRANSIENT, "--out", str(out)) == 0
    data = xr.load_dataset(out)
    assert list(data["frequency"].values) == [370.0, 375.0, 380.0, 385.0, 390.0]
    assert data.attrs["window_stop"] == 0.1
    assert data["amplitude"].sel(frequency=385.0).item() == pytest.approx(0.11918, abs=2e-4)
    assert "385" in capsys.readouterr().out


def test_steady_branches_with_picture_and_data(tmp_path, capsys):
    out, plot = tmp_path / "steady.nc", tmp_path / "steady.png"
    assert run(STEADY, "--out", str(out), "--plot", str(plot), "--sweeps") == 0
    printed = capsys.readouterr().out
    assert "fold" in printed and "418.871" in printed and "f_n/2" in printed
    assert list(xr.load_dataset(out)["bifurcation_kind"].values) == ["fold", "fold"]
    assert plot.read_bytes().startswith(b"\x89PNG") and plot.stat().st_size > 20000


def test_csv_has_a_row_for_every_point_and_multiplier(tmp_path):
    out = tmp_path / "steady.csv"
    assert run(STEADY, "--out", str(out)) == 0
    with out.open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) % 3 == 0
    assert {row["stability"] for row in rows} == {"stable", "unstable"}
    assert max(float(row["amplitude [1]"]) for row in rows) <= 0.25


@pytest.mark.parametrize("suffix, head", [(".png", b"\x89PNG"), (".pdf", b"%PDF")])
def test_the_transient_can_be_drawn_over_any_load(tmp_path, suffix, head):
    plot = tmp_path / f"force{suffix}"
    text = "response equal-biaxial --force 0:0.4:0.1 --field-amplitude 1e6 --frequency 380 --quiet"
    assert run(text, "--plot", str(plot)) == 0
    assert plot.read_bytes().startswith(head)
    assert [path.name for path in tmp_path.iterdir()] == [plot.name]


def test_where_every_transient_is_lost_there_is_an_empty_picture(tmp_path, capsys):
    plot = tmp_path / "lost.png"
    text = "response equal-biaxial --field-amplitude 1e9 --frequency 100:120:10 --quiet"
    assert run(text, "--plot", str(plot)) == 0
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert "written:" in capsys.readouterr().out


def test_without_any_branch_the_picture_says_so():
    from delagrange.figures.steady_figure import draw_steady

    found = dl.steady_response(
        "equal_biaxial", force=1e9, field_amplitude=1e6, frequency=(100.0, 120.0), seeds=2, resolution=10
    )
    assert found.sizes["branch"] == found.sizes["point"] == 0
    above, below = draw_steady(found).axes
    assert [text.get_text() for text in above.texts][-1:] == ["no periodic motion found"]
    for axes in (above, below):
        low, high = axes.get_ylim()
        assert low < high


BAD = [
    (
        "--frequency 380",
        "exactly one of --force, --field-amplitude, --field-bias, --frequency must be a range",
    ),
    ("--frequency 380:380", "frequency must be a number or START:STOP or START:STOP:STEP in Hz"),
    ("--frequency 380:390:0", "frequency must be a number or START:STOP or START:STOP:STEP in Hz"),
    ("--frequency 380:x", "frequency must be a number in Hz, got 'x'"),
    ("--frequency 380:390 --dashpots relaxed", "--dashpots changes nothing without --steady"),
    ("--frequency 380:390 --sweeps", "--sweeps changes nothing without --steady"),
    ("--frequency 380:390 --steady --sweeps", "--sweeps needs --dashpots relaxed, got frozen"),
    ("--frequency 380:390 --steady --dashpots loose", "dashpots must be one of frozen, relaxed"),
    ("--frequency 380:390 --plot a.svg", "plot file a.svg must end in .png (PNG) or .pdf (PDF)"),
    ("--frequency 380:390 --out a.txt", "output file a.txt must end in"),
]


@pytest.mark.parametrize("text, message", BAD)
def test_bad_input(text, message, capsys):
    assert run(f"response equal-biaxial --field-amplitude 1e6 --quiet {text}") == 2
    assert message in " ".join(capsys.readouterr().err.split())


def test_pieces_of_one_stability_leave_no_gap():
    from delagrange.figures.steady_figure import pieces

    names = np.array(["stable", "stable", "unstable", "stable"])
    assert [(name, piece.start, piece.stop) for name, piece in pieces(names)] == [
        ("stable", 0, 3), ("unstable", 2, 4), ("stable", 3, 5),
    ]  # fmt: skip
