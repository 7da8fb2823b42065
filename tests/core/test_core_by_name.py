"""`engine="core"`: sweeps and motions by the integrator in C, as a user asks for it."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

import delagrange as dl
from delagrange.cli import main
from delagrange.core import compiler, kernel

SWEEP = {"force": [0.2, 0.5], "field_amplitude": 1e6, "frequency": np.arange(300.0, 450.0, 25.0), "duration": 0.02}


def test_a_sweep_is_that_of_the_witness():
    """To the tolerance; it says which engine it was."""
    found = dl.frequency_response("equal_biaxial", engine="core", averages=True, rtol=1e-9, atol=1e-12, **SWEEP)
    exact = dl.frequency_response("equal_biaxial", engine="scipy", averages=True, rtol=1e-11, atol=1e-13, **SWEEP)
    assert found.attrs["engine"] == "core" and found.attrs["step_control"] == "pi"
    for name in ("amplitude", "maximum", "root_mean_square"):
        np.testing.assert_allclose(found[name], exact[name], rtol=1e-7)


def test_the_exponents_are_those_of_the_witness():
    given = {"force": 0.5, "field": dl.Sine(5e6, 371.0), "duration": 0.5, "dashpots": "frozen"}
    ours, theirs = (dl.lyapunov_spectrum("equal_biaxial", engine=name, **given) for name in ("core", "scipy"))
    np.testing.assert_allclose(ours["lyapunov_exponents"], theirs["lyapunov_exponents"], rtol=1e-4, atol=1e-4)


def test_the_command_takes_it(tmp_path, capsys):
    out = tmp_path / "response.csv"
    given = ["--force", "0.2", "--field-amplitude", "1MV/m", "--frequency", "300:320:10", "--duration", "5ms"]
    assert main(["sweep", "equal-biaxial", *given, "--engine", "core", "--out", str(out), "--quiet"]) == 0
    assert out.is_file() and capsys.readouterr().err == ""


@pytest.mark.parametrize("call", [dl.frequency_response, dl.lyapunov_spectrum])
def test_a_module_without_a_header_is_refused(call, tmp_path):
    alone = tmp_path / "alone.py"
    shutil.copy(Path(dl.load_model("equal_biaxial").__file__), alone)
    given = {"field_amplitude": 1e6, "frequency": 300.0} if call is dl.frequency_response else {"field": 1e6}
    with pytest.raises(ValueError, match="engine 'core' cannot run this: no header stands beside the module"):
        call(dl.load(alone), engine="core", duration=1e-3, **given)


def test_a_machine_without_a_compiler_is_told(monkeypatch, tmp_path):
    """In one line, before anything is computed."""
    monkeypatch.setenv(compiler.CHOICE, str(tmp_path / "none"))
    monkeypatch.setenv("DELAGRANGE_CACHE_DIR", str(tmp_path / "cache"))
    kernel.load_core.cache_clear()
    try:
        with pytest.raises(ValueError, match=r"engine 'core' cannot run this: .*none"):
            dl.frequency_response("uniaxial", engine="core", **SWEEP)
    finally:
        kernel.load_core.cache_clear()
