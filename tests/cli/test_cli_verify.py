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
from delagrange.derive.check.report import detail, rows, summary
from delagrange.derive.check.verdict import Outcome


@pytest.fixture(scope="module")
def derived(walked, tmp_path_factory):
    """One `delagrange derive`: its folder, what it printed, and what it had walked."""
    folder, printed = tmp_path_factory.mktemp("modules"), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(printed):
        patch.setenv("COLUMNS", "80")
        patch.setattr(pipeline, "walk", lambda: walked)
        code = main(["derive", "--out", str(folder), "--quiet"])
    assert code == 0
    return folder, printed.getvalue(), walked


@pytest.fixture
def verdicts(derived, monkeypatch):
    """The verdicts; `verify` and `derive` find them again without deriving."""
    walked = derived[2]
    monkeypatch.setattr(pipeline, "walk", lambda: walked)
    monkeypatch.setattr(pipeline, "check", lambda: walked)
    return walked.verdicts


def found(monkeypatch, walked, verdicts) -> None:
    """Let `verify` find these verdicts on the paper."""
    (checked,) = walked.checked
    changed = replace(walked, checked=(replace(checked, verdicts=verdicts),))
    monkeypatch.setattr(pipeline, "check", lambda: changed)


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


def test_a_departure_from_the_record_fails(derived, verdicts, monkeypatch, capsys):
    (equal,) = [v for v in verdicts if v.number == "13"]
    changed = tuple(replace(v, outcome=Outcome.DIFFERS) if v is equal else v for v in verdicts)
    found(monkeypatch, derived[2], changed)
    assert main(["verify", "--quiet"]) == 1
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    assert line.startswith("not as recorded: Eq. (13) against uniaxial: found differs")
    assert "all as recorded" not in captured.out


@pytest.mark.parametrize("lost", range(3))
def test_a_lost_verdict_fails(derived, verdicts, monkeypatch, capsys, lost):
    found(monkeypatch, derived[2], verdicts[:lost] + verdicts[lost + 1 :])
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


# --- equations of one's own -----------------------------------------------------------------------------

RATE = r"\dot{\xi} = \frac{\mu^\beta}{6\eta}(\lambda^2 \xi^{-1} - \lambda^{-4} \xi^5)"
GENT = str(Path(__file__).parents[1] / "models" / "gent_two_branches.toml")


def test_a_pasted_equation_that_is_equal(capsys):
    both = ["--equation", RATE, "--equation", rf"2 {RATE}"]
    assert main(["verify", "equal-biaxial", *both, "--brief", "--quiet"]) == 1
    first, second = rows_in(capsys.readouterr().out)
    assert first == ["(1)", "dashpot rate 1", "equal_biaxial", "equal"]
    assert second[-1] == "differs"
    assert main(["verify", "equal-biaxial", "--equation", RATE, "--quiet"]) == 0


def test_a_pasted_equation_that_differs_is_explained_unless_brief(tmp_path, capsys):
    wrong, out = RATE.replace("6", "3"), tmp_path / "verdicts.md"
    assert main(["verify", "equal-biaxial", "--equation", wrong, "--markdown", str(out), "--quiet"]) == 1
    words = " ".join(capsys.readouterr().out.split())
    assert "without partner" in words and "one edit mends it: coefficient" in words
    (line,) = out.read_text(encoding="utf-8").splitlines()[2:]
    assert markdown_cells(line)[:4] == ["(1)", "dashpot rate 1", "equal_biaxial", "differs"]
    assert main(["verify", "equal-biaxial", "--equation", wrong, "--brief", "--quiet"]) == 1
    assert "without partner" not in capsys.readouterr().out


def test_a_file_of_equations_with_a_table_of_symbols(tmp_path, capsys):
    equations, symbols = tmp_path / "equations.toml", tmp_path / "symbols.toml"
    equations.write_text("[[equation]]\nnumber = '12'\nlatex = '''T = m \\dot{x}^2'''\n", encoding="utf-8")
    mass = r"\frac{8}{3}\rho L^2 H (L^2 + 2 H^2 x^{-6})"
    symbols.write_text(f"[symbols]\nx = 'stretch'\nm = {{ latex = '{mass}' }}\n", encoding="utf-8")
    arguments = ["verify", GENT, "--equations", str(equations), "--symbols", str(symbols), "--quiet"]
    assert main(arguments) == 0
    assert rows_in(capsys.readouterr().out) == [["(12)", "kinetic energy", "gent_two_branches", "equal"]]
    symbols.write_text("[symbols]\nx = 'strech'\n", encoding="utf-8")
    assert main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{symbols}, line 2: symbol x stands for 'strech'" in line and "did you mean 'stretch'" in line


def test_a_model_is_listed_to_copy_from(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["verify", "pure-shear", "--formulation", "as_printed", "--quiet"]) == 0
    printed = capsys.readouterr().out
    assert "Symbols of pure_shear_as_printed" in printed and r"\lambda_{2p}" in printed
    lines = printed.splitlines()
    reaction = lines[lines.index("reaction_force:") + 1].strip()
    arguments = ["verify", "pure-shear", "--formulation", "as_printed", "--equation", reaction, "--quiet"]
    assert main(arguments) == 0
    assert main([*arguments[:2], *arguments[4:]]) == 1  # the consistent reaction has the thickness inertia


def test_a_described_model_is_listed(capsys):
    assert main(["verify", GENT, "--quiet"]) == 0
    printed = capsys.readouterr().out
    assert r"\mu_{2}^{\beta}" in printed and "\nequation_of_motion_1:\n" in printed


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--equation", "T = 1"], "--equation needs a MODEL"),
        (["equal-biaxial", "--quantity", "kinetic_energy"], "--quantity says what each --equation states"),
        (["equal-biaxial", "--symbols", "s.toml"], "--symbols needs equations"),
        (["equal-biaxal", "--equation", "T = 1"], "did you mean 'equal_biaxial'"),
        (["biaxial", "--formulation", "consistent"], "biaxial has one formulation"),
        (["model.py", "--equation", "T = 1"], "a module holds code, not its derivation"),
        ([GENT, "--formulation", "consistent"], "choose a built-in model"),
        (["none.toml", "--equation", "T = 1"], "none.toml: cannot be read"),
        (["uniaxial", "--equations", "none.toml"], "none.toml: cannot be read"),
        (["uniaxial", "--equation", "T = q"], "column 5: found 'q'"),
        (["uniaxial", "--equation", "T = 1", "--quantity", "energy"], "is no equation of uniaxial"),
    ],
)
def test_what_cannot_be_checked_is_refused_in_one_line(arguments, reason, capsys):
    assert main(["verify", *arguments, "--quiet"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert reason in line
