"""`delagrange verify` and `delagrange derive`: the verdicts shown, and that a departure is a failure."""

from __future__ import annotations

import contextlib
import io
import os
import shlex
import subprocess
import sys
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest

from delagrange.cli import main
from delagrange.cli.verdicts import as_markdown, colour
from delagrange.derive import pipeline
from delagrange.derive.report import detail, rows, summary
from delagrange.derive.verdict import Outcome


@pytest.fixture(scope="module")
def derived(tmp_path_factory):
    """One real `delagrange derive`: its folder, what it printed, and what it had walked."""
    folder, printed, walks = tmp_path_factory.mktemp("modules"), io.StringIO(), []
    walk = pipeline.walk
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(printed):
        patch.setenv("COLUMNS", "80")
        patch.setattr(pipeline, "walk", lambda: walks.append(walk()) or walks[0])
        code = main(["derive", "--out", str(folder), "--quiet"])
    assert code == 0
    return folder, printed.getvalue(), walks[0]


@pytest.fixture
def verdicts(derived, monkeypatch):
    """The verdicts; `verify` and `derive` find them again without deriving."""
    walked = derived[2]
    monkeypatch.setattr(pipeline, "walk", lambda: walked)
    monkeypatch.setattr(pipeline, "check", lambda: walked.verdicts)
    return walked.verdicts


@pytest.fixture(autouse=True)
def narrow(monkeypatch):
    """The tables fit a terminal of 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")


def rows_in(text: str) -> list[list[str]]:
    """The cells of the rows of a table: they stand two spaces apart."""
    split = [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in text.splitlines()]
    return [cells for cells in split if cells and cells[0].startswith("(")]


def markdown_cells(line: str) -> list[str]:
    """The cells of a row as a Markdown reader shows them: a backslash makes the next mark a letter."""
    cells, marks = [""], iter(line)
    for mark in marks:
        if mark == "|":
            cells.append("")
        else:
            cells[-1] += next(marks) if mark == "\\" else mark
    return [cell.strip() for cell in cells[1:-1]]


def test_verify_as_documented(derived, tmp_path):
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        shlex.split("delagrange verify"), env=os.environ | {"PATH": path}, cwd=tmp_path,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert rows_in(done.stdout) == [list(row[:4]) for row in rows(derived[2].verdicts)]
    assert summary(derived[2].verdicts) in done.stdout
    assert done.stdout.endswith("all as recorded\n")


def test_every_printed_equation_has_a_verdict(verdicts, capsys):
    assert main(["verify", "--brief", "--quiet"]) == 0
    shown = {cells[0] for cells in rows_in(capsys.readouterr().out)}
    assert shown == {f"({number})" for number in range(4, 23)}


def test_details_are_added_not_exchanged(verdicts, capsys):
    assert main(["verify", "--quiet"]) == 0
    brief = capsys.readouterr().out
    assert main(["verify", "--details", "--quiet"]) == 0
    details = capsys.readouterr().out
    assert set(brief.splitlines()) <= set(details.splitlines())
    words = "".join(details.split())
    assert all("".join(detail(verdict).split()) in words for verdict in verdicts)


def test_a_departure_from_the_record_fails(verdicts, monkeypatch, capsys):
    (equal,) = [v for v in verdicts if v.number == "13"]
    changed = tuple(replace(v, outcome=Outcome.DIFFERS) if v is equal else v for v in verdicts)
    monkeypatch.setattr(pipeline, "check", lambda: changed)
    assert main(["verify", "--quiet"]) == 1
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    assert line.startswith("not as recorded: Eq. (13) against uniaxial: found differs")
    assert "all as recorded" not in captured.out


@pytest.mark.parametrize("lost", range(3))
def test_a_lost_verdict_fails(verdicts, monkeypatch, capsys, lost):
    monkeypatch.setattr(pipeline, "check", lambda: verdicts[:lost] + verdicts[lost + 1 :])
    assert main(["verify", "--quiet"]) == 1
    assert f"Eq. ({verdicts[lost].number})" in capsys.readouterr().err


def test_colours_are_by_outcome(verdicts):
    shades = {(verdict.outcome, bool(verdict.corrections)): colour(verdict) for verdict in verdicts}
    assert shades == {
        (Outcome.EQUAL, False): "green",
        (Outcome.SCALED, False): "cyan",
        (Outcome.DIFFERS, False): "red",
        (Outcome.DIFFERS, True): "yellow",
        (Outcome.MISSING, False): "dim",
    }


def test_verify_writes_markdown(verdicts, tmp_path, capsys):
    out = tmp_path / "verdicts.md"
    assert main(["verify", "--details", "--markdown", str(out), "--quiet"]) == 0
    assert f"written: {out}" in capsys.readouterr().out
    lines = out.read_text(encoding="utf-8").splitlines()
    assert len(lines) == len(verdicts) + 2
    for line, row in zip(lines[2:], rows(verdicts), strict=True):
        assert markdown_cells(line) == list(row)
    assert out.read_text(encoding="utf-8") == as_markdown(verdicts, details=True)


def test_markdown_that_cannot_be_written_is_refused_before_deriving(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(pipeline, "check", lambda: pytest.fail("derived"))
    assert main(["verify", "--markdown", str(tmp_path)]) == 2
    assert "it is a folder" in capsys.readouterr().err


def test_derive_writes_the_modules_that_are_checked_in(derived):
    folder, printed, walked = derived
    package = resources.files("delagrange.generated")
    assert sorted(os.listdir(folder)) == sorted(name for name, _ in walked.modules)
    for name, _ in walked.modules:
        assert (folder / name).read_bytes() == package.joinpath(name).read_bytes()
    assert f"written: {len(walked.modules)} modules in {folder}" in printed
    assert rows_in(printed) == [list(row[:4]) for row in rows(walked.verdicts)]


def test_derive_check_finds_a_stale_module(verdicts, derived, tmp_path, capsys):
    for name, text in derived[2].modules:
        (tmp_path / name).write_text(text, encoding="utf-8", newline="\n")
    assert main(["derive", "--check", "--out", str(tmp_path), "--quiet"]) == 0
    edited = tmp_path / derived[2].modules[0][0]
    edited.write_text(edited.read_text(encoding="utf-8") + "\n", encoding="utf-8", newline="\n")
    before = edited.read_bytes()
    capsys.readouterr()
    assert main(["derive", "--check", "--out", str(tmp_path), "--quiet"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"stale: {edited}")
    assert edited.read_bytes() == before
    edited.unlink()
    assert main(["derive", "--check", "--out", str(tmp_path), "--quiet"]) == 1


@pytest.mark.parametrize("name", ["none", "file"])
def test_a_folder_to_check_must_be_there(tmp_path, monkeypatch, capsys, name):
    monkeypatch.setattr(pipeline, "walk", lambda: pytest.fail("derived"))
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["derive", "--check", "--out", str(tmp_path / name), "--quiet"]) == 2
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    assert f"folder {tmp_path / name} cannot be read" in line and captured.out == ""


def test_ctrl_c_while_deriving(monkeypatch, capsys):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(pipeline, "check", interrupted)
    assert main(["verify", "--quiet"]) == 130
    assert capsys.readouterr().err == "delagrange: interrupted: nothing was written\n"
