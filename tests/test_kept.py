"""What the tests keep: made once whoever asks, told apart by all that it is made from, and as it was made."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import kept as module
import pytest
from described import described
from kept import digest, forget_old, kept, pickled, placed

from delagrange.derive.membrane.description import EQUAL_BIAXIAL
from delagrange.derive.membrane.materials import ALPHA, MATERIALS

ASKING = """
import sys, time, pathlib
sys.path.insert(0, sys.argv[1])
import kept
kept.FOLDER = pathlib.Path(sys.argv[2])
def make():
    with (kept.FOLDER / "made").open("a") as file:
        file.write("once\\n")
    time.sleep(0.5)
    return "found"
print(kept.kept("something", "a subject", make))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "FOLDER", tmp_path)
    return tmp_path


def test_processes_that_ask_at_the_same_time_make_it_once(tmp_path):
    command = [sys.executable, "-c", ASKING, str(Path(module.__file__).parent), str(tmp_path)]
    asking = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [process.communicate(timeout=60)[0] for process in asking] == ["found\n"] * 3
    assert (tmp_path / "made").read_text() == "once\n"


def test_another_name_subject_or_source_is_made_anew(folder, monkeypatch):
    assert [kept("number", 1, lambda: 5), kept("number", 1, lambda: 6)] == [5, 5]
    assert kept("number", 2, lambda: 7) == 7 and kept("other", 1, lambda: 8) == 8
    source = folder / "sources" / "source.py"
    source.parent.mkdir()
    monkeypatch.setattr(module, "SOURCES", (source.parent,))
    monkeypatch.setattr(module, "ROOT", folder)
    for text, found in (("x = 1", 9), ("x = 2", 10)):
        source.write_text(text)
        module._digest_of_sources.cache_clear()
        module._digest_of_file.cache_clear()
        assert kept("number", 1, lambda found=found: found) == found
    module._digest_of_sources.cache_clear()
    module._digest_of_file.cache_clear()


def test_what_cannot_be_made_is_not_kept(folder):
    with pytest.raises(ZeroDivisionError):
        kept("number", 1, lambda: 1 / 0)
    assert kept("number", 1, lambda: 5) == 5


def test_a_function_is_told_by_what_it_holds():
    def adding(number):
        return lambda x: x + number

    assert digest(adding(1)) == digest(adding(1)) != digest(adding(2))
    assert digest(lambda x: x + 1) != digest(lambda x: x + 2)
    assert digest(lambda x: (lambda y: y + 1)) != digest(lambda x: (lambda y: y + 2))
    both = [described(EQUAL_BIAXIAL, name, "Gent") for name in ("Gent", "Gent", "neo-Hookean")]
    assert digest(both[0]) == digest(both[1]) != digest(both[2])


def test_a_strain_energy_is_kept_whole():
    energy = MATERIALS["Gent"](ALPHA)
    found = pickle.loads(pickled(energy))
    assert (found.name, found.parameters) == (energy.name, energy.parameters)
    assert found.density((2, 1, 0.5)) == energy.density((2, 1, 0.5))
    assert found.validity((2, 1, 0.5)) == energy.validity((2, 1, 0.5))


def test_modules_are_placed_once_and_old_ones_forgotten(folder, monkeypatch):
    place = placed((("a.py", "x = 1"),))
    written = (place / "a.py").stat().st_mtime_ns
    assert placed((("a.py", "x = 1"),)) == place and (place / "a.py").stat().st_mtime_ns == written
    other = placed((("a.py", "x = 2"),))
    assert other != place
    os.utime(other, (0, 0))
    monkeypatch.setattr(module, "MOST_MODELS", 1)
    forget_old()
    assert list((folder / "models").iterdir()) == [place]
