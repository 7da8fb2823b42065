"""Models of users: found by path, with kernels beside them, and refused in one line where they are none."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from user_membranes import write_membrane

import delagrange as dl
from delagrange import generated
from delagrange.model.kernels import LANES, VARIATIONAL, kernel_name
from delagrange.model.load import load_model
from delagrange.model.parameters import MATERIAL_UNITS

BUILT_IN = Path(generated.__path__[0])
DEFAULTS = {name: getattr(dl.SHENG_2015, name) for name in MATERIAL_UNITS}
RUN = {"duration": 2e-3, "force": 0.3, "field": 1e6}
SWEEP = {
    "duration": 2e-3,
    "frequency": [300.0, 400.0],
    "field_amplitude": 1e6,
    "force": 0.2,
    "engine": "compiled",
}


def copy_of(folder: Path, name: str = "my_membrane", **defaults: float) -> Path:
    """The built-in equal-biaxial model with its kernels, as a user's own."""
    folder.mkdir(parents=True, exist_ok=True)
    for ending in ("", "_lanes", "_variational"):
        shutil.copy(BUILT_IN / f"equal_biaxial{ending}.py", folder / f"{name}{ending}.py")
    path = folder / f"{name}.py"
    path.write_text(
        f"{path.read_text(encoding='utf-8')}\nDEFAULTS = {DEFAULTS | defaults}\n", encoding="utf-8"
    )
    return path


def test_a_copy_runs_as_the_model_it_is_a_copy_of(tmp_path):
    path = copy_of(tmp_path)
    expected = dl.simulate("equal_biaxial", **RUN)
    for model in (path, str(path), tmp_path, dl.load(path), dl.load(str(tmp_path))):
        np.testing.assert_array_equal(dl.simulate(model, **RUN)["stretch"], expected["stretch"])


def test_a_name_without_slash_is_the_folder_where_one_is_there(tmp_path, monkeypatch):
    copy_of(tmp_path / "my_models")
    monkeypatch.chdir(tmp_path)
    assert load_model("my_models").__file__ == str(tmp_path / "my_models" / "my_membrane.py")


@pytest.fixture(scope="module")
def compiled(tmp_path_factory) -> Path:
    """The folder of a model whose ensemble kernel has been compiled there."""
    folder = tmp_path_factory.mktemp("compiled")
    copy_of(folder)
    dl.frequency_response(dl.load(folder), **SWEEP)
    return folder


def test_both_kernels_are_found_and_run(compiled):
    model = dl.load(compiled)
    for kind in (LANES, VARIATIONAL):
        assert kernel_name(model, kind).endswith(f".my_membrane_{kind}")
    swept, expected = dl.frequency_response(model, **SWEEP), dl.frequency_response("equal_biaxial", **SWEEP)
    assert swept.attrs["engine"] == "compiled"
    np.testing.assert_array_equal(swept["amplitude"], expected["amplitude"])


def test_what_was_compiled_is_found_by_another_process_in_another_place(compiled, tmp_path):
    """Machine code on disk remembers the name of its module, which must not depend on the folder."""
    moved = tmp_path / "moved"
    shutil.copytree(compiled, moved)  # with the times of the files, and what was compiled
    script = (
        "import sys, delagrange as dl\n"
        "from delagrange.model.kernels import kernel_name, load_kernel\n"
        "kernel = load_kernel(kernel_name(dl.load(sys.argv[1])))\n"
        "print(kernel.__file__, sum(kernel.integrate.stats.cache_hits.values()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(moved)], capture_output=True, text=True, check=True
    )
    file, hits = done.stdout.split()
    assert Path(file).parent == moved
    assert int(hits) == 1


def test_a_file_that_has_changed_is_another_model(tmp_path, monkeypatch):
    """Within a second and of the same length, too, which is all that bytecode kept on disk knows of a file."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    path = copy_of(tmp_path, density=1.0e3)
    before = dl.load(path)
    copy_of(tmp_path, density=1.1e3)
    after = dl.load(path)
    assert (before.DEFAULTS["density"], after.DEFAULTS["density"]) == (1.0e3, 1.1e3)
    assert dl.load(path) is after


def test_a_kernel_that_has_changed_since_is_not_run_for_the_old_model(tmp_path):
    path = copy_of(tmp_path)
    lanes = tmp_path / "my_membrane_lanes.py"
    lanes.write_text(lanes.read_text(encoding="utf-8") + "\n# one\n", encoding="utf-8")
    model = dl.load(path)
    lanes.write_text(lanes.read_text(encoding="utf-8") + "\n# another\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"my_membrane_lanes\.py has changed since its model was loaded"):
        dl.frequency_response(model, **SWEEP)
    assert kernel_name(dl.load(path)) != kernel_name(model)


def test_two_models_of_one_name_do_not_meet(tmp_path):
    first, second = (copy_of(tmp_path / str(k), density=1e3 * k) for k in (1, 2))
    densities = [dl.simulate(path, duration=1e-3).attrs["density"] for path in (first, second, first)]
    assert densities == [1e3, 2e3, 1e3]


REFUSED = {
    "nothing there": (lambda at: at / "nothing.py", r"nothing\.py: no such file or folder"),
    "no Python": (lambda at: _text(at / "model.toml", "x = 1"), r"model\.toml must be a Python file"),
    "dotted": (lambda at: _text(at / "my.model.py", "x = 1"), "whose name has no dot"),
    "no model": (
        lambda at: _text(at / "script.py", "raise SystemExit"),
        r"script\.py is not a model: it lacks MODEL",
    ),
    "broken": (
        lambda at: _text(at / "broken.py", "def rhs(:"),
        r"broken\.py cannot be imported: SyntaxError",
    ),
    "raises": (
        lambda at: _text(at / "star.py", "from math import *\n1 / 0"),
        "ZeroDivisionError: division by zero",
    ),
    "a kernel": (
        lambda at: copy_of(at).with_name("my_membrane_lanes.py"),
        r"the model of this kernel is .*my_membrane\.py",
    ),
    "empty folder": (lambda at: at, "holds no model; needed is one"),
    "two models": (
        lambda at: (copy_of(at), copy_of(at, "other"))[0].parent,
        r"holds 2 models, my_membrane\.py, other\.py; give one",
    ),
}


def _text(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_model_is_refused_in_one_line(tmp_path, case):
    make, says = REFUSED[case]
    path = make(tmp_path)
    for load in (dl.load, load_model):
        with pytest.raises(ValueError, match=says) as refusal:
            load(path)
        assert "\n" not in str(refusal.value)


def test_other_files_in_the_folder_are_not_run(tmp_path):
    write_membrane(tmp_path, "mine", branches=1)
    _text(tmp_path / "run.py", "raise SystemExit('run')")
    assert dl.load(tmp_path).MODEL == "mine"
