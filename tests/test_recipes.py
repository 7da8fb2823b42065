"""The recipes of docs/where_things_go.md, followed word for word in a copy of the tree, and what they promise."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "where_things_go.md"
COPIED = ("derive", "generated", "src", "pyproject.toml")
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_FILE = re.compile(r"`([\w/]+\.py)`")
_MODEL = """
name = "{name}"
title = "Soft membrane"
[body]
half_length = "5 cm"
half_thickness = "0.5 mm"
density = "1.2 g/cm^3"
[dielectric]
permittivity = "5e-11 F/m"
[equilibrium_spring]
{spring}
[load]
kind = "{kind}"
"""


@dataclass(frozen=True)
class Step:
    """A file that a recipe makes, or lines of one that it changes."""

    kind: str  # python: the whole file, diff: some lines
    file: str
    text: str

    def follow(self, tree: Path) -> None:
        place = tree / self.file
        if self.kind == "python":
            assert not place.exists(), f"{self.file} is no new file"
            place.parent.mkdir(exist_ok=True)
            place.write_text(self.text, encoding="utf-8")
            return
        lines = self.text.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] == "-")
        new = "".join(line[1:] for line in lines if line[0] == "+")
        before = place.read_text(encoding="utf-8")
        assert before.count(old) == 1, f"{self.file} holds {before.count(old)} times:\n{old}"
        place.write_text(before.replace(old, new), encoding="utf-8")


def steps() -> list[Step]:
    """Each block belongs to the last file that the text before it names."""
    text, found = PAGE.read_text(encoding="utf-8"), []
    for block in _BLOCK.finditer(text):
        if block[1] in ("python", "diff"):
            *_, file = _FILE.findall(_BLOCK.sub("", text[: block.start()]))
            found.append(Step(block[1], file, block[2]))
    return found


@pytest.fixture(scope="module")
def tree(tmp_path_factory) -> Path:
    """A copy of the tree in which every recipe was followed."""
    copy = tmp_path_factory.mktemp("tree")
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, copy / name, symlinks=True, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, copy / name)
    for step in steps():
        step.follow(copy)
    return copy


def said(tree: Path, *command: str, code: int = 0) -> str:
    """What a command prints that runs in the copy."""
    environment = {"PYTHONPATH": str(tree / "src"), "PATH": "/usr/bin:/bin", "HOME": str(tree)}
    done = subprocess.run(
        [sys.executable, *command], cwd=tree, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_each_recipe_has_steps():
    files = [step.file for step in steps()]
    for place in ("membrane/materials", "membrane/loads", "papers/letter_2020/paper", "emit/targets", "cli/compliance"):
        assert any(place in file for file in files), f"no step in {place}"


def test_what_is_written_is_tidy_and_in_its_room(tree):
    said(tree, "-m", "ruff", "check", "--config", str(ROOT / "pyproject.toml"), *(step.file for step in steps()))
    said(tree, "-c", "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports())")


def test_a_strain_energy_a_load_and_a_target_are_there(tree):
    """One membrane with the new energy under the new load, in all targets; its rates are worked out by hand."""
    model = tree / "soft.toml"
    spring = 'material = "exponential"\nshear_modulus = "20 kPa"\nstiffening = 0.2'
    model.write_text(_MODEL.format(name="soft", spring=spring, kind="two_to_one"), encoding="utf-8")
    said(tree, "-m", "delagrange", "derive", str(model), "--out", str(tree / "models"))
    assert "rate of stretch_rate_2 = " in (tree / "models" / "soft_rates.txt").read_text(encoding="utf-8")
    statics = """
import math, sys
sys.path.insert(0, "models")
import soft
state, P = (1.3, 1.1, 0.0, 0.0), 0.2
values = [soft.DEFAULTS[entry.name] for entry in soft.PARAMETERS]
l1, l2 = state[:2]
L, H, mu, b = 0.05, 5e-4, 2e4, 0.2
I1 = l1**2 + l2**2 + (l1 * l2) ** -2
stress = mu * math.exp(b * (I1 - 3))  # 2 dW/dI1
expected = [4 * L * H * stress * (l1 - l1**-3 * l2**-2), 4 * L * H * stress * (l2 - l2**-3 * l1**-2)]
found = soft.edge_forces(state, (P, 0.0), values)
assert all(math.isclose(a, e, rel_tol=1e-12) for a, e in zip(found, expected)), (found, expected)
power = soft.force_power((*state[:2], 0.3, 0.7), (P, 0.0), values)
assert math.isclose(power, 2 * L * (P * 0.3 + P / 2 * 0.7), rel_tol=1e-12), power
"""
    said(tree, "-c", statics)


def test_a_paper_is_found_and_judged(tree):
    text = said(tree, "-m", "delagrange.derive", "--out", str(tree / "derived"), code=1)
    assert re.search(r"letter_2020 +differs", text)
    assert "Eq. (1) against letter_2020: found differs" in text
    said(tree, "-m", "delagrange.derive", "--record", "--out", str(tree / "derived"))
    assert "letter_2020" in (tree / "derive" / "papers" / "letter_2020" / "verdicts.json").read_text(encoding="utf-8")
    assert (tree / "derived" / "letter_2020.py").is_file()


def test_an_analysis_is_a_command_with_its_figure(tree):
    """Against the equilibrium found under a little more force."""
    out = tree / "compliance.nc"
    command = ("compliance", "equal-biaxial", "--force", "0:200mN:100mN", "--out", str(out), "--plot", "compliance.png")
    said(tree, "-m", "delagrange", *command)
    assert (tree / "compliance.png").stat().st_size > 1000
    slope = """
import delagrange as dl, numpy as np, xarray as xr
found = xr.load_dataset("compliance.nc")["compliance"].sel(coordinate="stretch").values
more, less = (dl.rest_state("equal_biaxial", force=0.1 + d)["stretch"] for d in (1e-4, -1e-4))
assert np.isclose(found[1], (more - less) / 2e-4, rtol=1e-6), (found, more, less)
"""
    said(tree, "-c", slope)
