"""`delagrange figures` and `delagrange reproduce`: what is asked for is passed on, what comes back is told."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import xarray as xr

from delagrange.cli import main
from delagrange.reproduction import reproduce as reproduction
from delagrange.reproduction.figures import gallery


def test_one_figure_is_drawn_with_its_data(tmp_path, capsys):
    folder = tmp_path / "new" / "figures"
    assert main(["figures", "--out", str(folder), "--only", "5", "--quiet"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    drawn = sorted(path.name for path in folder.iterdir() if path.is_file())
    assert drawn == [f"figure_05.{suffix}" for suffix in ("csv", "nc", "pdf", "png")]
    assert captured.out == f"written: 4 files in {folder}\n"
    assert xr.load_dataset(folder / "figure_05.nc").sizes


@pytest.mark.parametrize(("only", "numbers"), [([], None), (["--only", "7, 4,7"], (7, 4))])
def test_the_figures_asked_for_are_passed_on(tmp_path, monkeypatch, only, numbers):
    asked = []
    monkeypatch.setattr(
        gallery, "draw_all", lambda out, wanted, progress: asked.append((out, wanted, progress)) or ()
    )
    assert main(["figures", "--out", str(tmp_path), *only]) == 0
    assert asked == [(tmp_path, numbers, True)]


@pytest.mark.parametrize("only", ["", "4,", "four", "4.0", "13", "4:7"])
def test_other_figures_are_refused(tmp_path, capsys, only):
    assert main(["figures", "--out", str(tmp_path / "figures"), "--only", only]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(
        "delagrange: error: only must be figure numbers among 4, 5, 6, 7, 8, 9, 10, 11, 12, got"
    )
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("status", [0, 1])
def test_reproduce_ends_with_the_status_of_its_checks(tmp_path, monkeypatch, status):
    asked = []
    monkeypatch.setattr(
        reproduction, "reproduce", lambda out, progress: asked.append((out, progress)) or status
    )
    assert main(["reproduce", "--out", str(tmp_path / "out"), "--quiet"]) == status
    assert asked == [(tmp_path / "out", False)]


@pytest.mark.parametrize(("command", "home"), [("figures", gallery), ("reproduce", reproduction)])
def test_ctrl_c_says_what_is_left(tmp_path, monkeypatch, capsys, command, home):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(home, "draw_all" if command == "figures" else "reproduce", interrupted)
    assert main([command, "--out", str(tmp_path)]) == 130
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("delagrange: interrupted: ") and str(tmp_path) in line


def test_a_disk_that_fills_up_meanwhile_is_one_line(tmp_path, monkeypatch, capsys):
    def full(out: Path, *_):
        raise OSError(28, "No space left on device", str(out / "figure_04.png"))

    monkeypatch.setattr(gallery, "draw_all", full)
    assert main(["figures", "--out", str(tmp_path)]) == 2
    told = f"delagrange: error: {tmp_path / 'figure_04.png'}: No space left on device\n"
    assert capsys.readouterr().err == told
