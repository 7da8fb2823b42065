"""The guide for a membrane of one's own, followed word for word: its files, its commands, its Python."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import pytest

from delagrange.cli import main

GUIDE = Path(__file__).parents[1] / "examples" / "your_own_membrane.md"
KEYS = (
    "half_length_1", "half_length_2", "half_thickness", "density", "material", "energy", "validity", "source",
    "viscosity", "relaxation_time", "permittivity_formula", "control", "conductivity", "parallel_viscosity", "medium",
    "axis", "mass", "stiffness",
)  # fmt: skip
_BLOCK = re.compile(r"^```(\w+)(?: +(\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_EXIT_CODE = re.compile(r"  # exit code (\d)$")


@dataclass(frozen=True)
class Block:
    """A fenced block of the guide."""

    kind: str  # toml, console, python
    file: str  # that a toml block is saved as
    text: str
    line: int  # in the guide


@dataclass(frozen=True)
class Command:
    """A command of a console block, and lines that it prints."""

    arguments: tuple[str, ...]
    exit_code: int
    says: tuple[str, ...]


def blocks() -> list[Block]:
    text = GUIDE.read_text(encoding="utf-8")
    return [
        Block(*found.groups(""), text[: found.start()].count("\n") + 1) for found in _BLOCK.finditer(text)
    ]


def commands(block: Block) -> list[Command]:
    """Each line that begins with "$ "; the lines below it are printed by it."""
    parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
    assert parts[0] == "", f"line {block.line}: a console block begins with a command"
    return [_command(part) for part in parts[1:]]


def _command(text: str) -> Command:
    line, *says = text.splitlines()
    code = _EXIT_CODE.search(line)
    program, *arguments = shlex.split(line[: code.start()] if code else line)
    assert program == "delagrange"
    return Command(tuple(arguments), int(code[1]) if code else 0, tuple(says))


def plain(text: str) -> str:
    """Without the width of columns and of the terminal."""
    return " ".join(text.split())


def run(command: Command, capsys) -> None:
    assert main(list(command.arguments)) == command.exit_code, command.arguments
    printed = capsys.readouterr()
    for line in command.says:
        assert plain(line) in plain(printed.out + printed.err), command.arguments


def test_the_guide_is_followed_word_for_word(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    names: dict[str, object] = {}  # of the pieces of Python, which go on where the one before ended
    with mpl.rc_context():
        for block in blocks():
            if block.kind == "toml":
                Path(block.file).write_text(block.text, encoding="utf-8")
            elif block.kind == "python":
                exec(compile(block.text, f"{GUIDE.name}, line {block.line}", "exec"), names)
            else:
                for command in commands(block):
                    run(command, capsys)
    for made in ("run.nc", "sweep.nc", "branches.png", "response.png", "my_models/third_lanes.py"):
        assert Path(made).stat().st_size > 1000
    assert not Path("my_models/wrong.py").exists()


def test_the_guide_shows_every_command_that_takes_a_model():
    shown = {
        command.arguments[0] for block in blocks() if block.kind == "console" for command in commands(block)
    }
    needed = ("derive", "simulate", "sweep", "equilibrium", "modes", "response", "classify", "verify")
    assert shown == set(needed)
    assert {block.kind for block in blocks()} == {"toml", "console", "python"}


def test_the_guide_names_every_material_and_every_key():
    from delagrange.derive.membrane.materials import MATERIALS
    from delagrange.derive.model_file import file as model_file
    from delagrange.derive.model_file import loads as model_loads

    text = GUIDE.read_text(encoding="utf-8")
    for name, material in MATERIALS.items():
        assert f"| {name} |" in text
        for kind in material.kinds():
            assert f"`{kind.name}`" in text or kind.name.startswith("yeoh_coefficient_")
    for key in (*model_loads.KEYS, *model_file._TABLES, *KEYS):
        assert key in text


@pytest.mark.parametrize("link", re.findall(r"\]\(([^)#]+)\)", GUIDE.read_text(encoding="utf-8")))
def test_what_the_guide_links_to_is_there(link):
    assert link.startswith("http") or (GUIDE.parent / link).exists()
