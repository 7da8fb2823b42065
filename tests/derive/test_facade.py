"""`delagrange.derive` by short names: all are there, each is its file's own, and the import stays light."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from delagrange import derive

ROOT = Path(__file__).resolve().parents[2]
SHOWN = (
    "examples/your_own_membrane.md",
    *(f"examples/{path.name}" for path in (ROOT / "examples").glob("*.py")),
)


@pytest.mark.parametrize("name", derive.__all__)
def test_every_name_is_that_of_its_file(name):
    assert name in dir(derive)
    assert getattr(derive, name) is getattr(import_module(f"delagrange.derive.{derive._HOME[name]}"), name)


def test_no_name_is_that_of_a_room():
    """A room that is imported would take the place of the name."""
    rooms = {path.stem for path in Path(derive.__file__).parent.iterdir()}
    assert not rooms & set(derive.__all__)


def test_the_import_is_light():
    code = "import sys, delagrange.derive; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"sympy", "numpy", "jinja2", "mpmath"} & set(done.stdout.split())


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match=r"module 'delagrange\.derive' has no attribute 'Descripton'"):
        derive.Descripton  # noqa: B018
    with pytest.raises(ImportError):
        exec("from delagrange.derive import no_such_name")


@pytest.mark.parametrize("file", SHOWN)
def test_what_is_shown_imports_by_the_short_names(file):
    text = (ROOT / file).read_text(encoding="utf-8")
    assert re.findall(r"^\s*(?:from|import) delagrange\.derive\.\S+", text, re.MULTILINE) == []
