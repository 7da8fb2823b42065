"""`import delagrange` is light: nothing heavy before it is needed, and never the derivation."""

from __future__ import annotations

import subprocess
import sys

import delagrange


def _modules_after(statement: str) -> set[str]:
    code = f"import sys; {statement}; print(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_import_loads_nothing_heavy():
    loaded = _modules_after("import delagrange")
    assert "delagrange" in loaded
    assert not loaded & {
        "numba",
        "numpy",
        "scipy",
        "xarray",
        "matplotlib",
        "sympy",
        "jinja2",
        "typer",
        "rich",
        "pandas",
    }


def test_a_run_and_a_sweep_need_no_sympy_and_no_matplotlib():
    loaded = _modules_after(
        "import delagrange as dl; dl.simulate('equal_biaxial', duration=1e-4); "
        "dl.frequency_response('uniaxial', frequency=300., field_amplitude=1e6, duration=1e-4)"
    )
    assert "xarray" in loaded
    assert not loaded & {"sympy", "matplotlib", "delagrange.derive", "jinja2"}


def test_every_name_is_there():
    assert set(delagrange.__all__) <= set(dir(delagrange))
    for name in delagrange.__all__:
        assert getattr(delagrange, name) is not None
    assert delagrange.__version__.count(".") == 2


def test_simulate_stays_a_function_after_its_module_is_imported():
    import delagrange.analysis.motion.sections
    import delagrange.run.simulation

    assert callable(delagrange.simulate)


def test_unknown_name_is_an_attribute_error():
    assert not hasattr(delagrange, "no_such_name")
