"""What may go wrong with compiled code: no Numba, no folder for its cache, Ctrl-C, numbers beyond sense."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
import time
import warnings
import zipfile
from dataclasses import dataclass
from importlib import import_module, invalidate_caches
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import xarray as xr

import delagrange as dl
from delagrange.drives.drive import Drive
from delagrange.engines import threads
from delagrange.engines.compiled import integrate_compiled
from delagrange.engines.engines import Numerics
from delagrange.engines.lanes import Interrupted
from delagrange.model import kernels
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem, make_problem
from delagrange.run.sweep import make_settings

POINT = {"frequency": [300.0], "field_amplitude": 1e6, "duration": 1e-3}
GENERATED = Path(dl.load_model("equal_biaxial").__file__).parent


def child(code, *arguments, **environment):
    """Output and errors of a Python process."""
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


@pytest.fixture
def forgetful():
    """What is known about this machine's compiler is found out anew, before and after."""
    for known in (kernels.why_not_compiled, kernels.load_kernel):
        known.cache_clear()
    yield
    for known in (kernels.why_not_compiled, kernels.load_kernel):
        known.cache_clear()


# --- no compiler -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("obstacle", "reason"),
    [
        ("switched off", "NUMBA_DISABLE_JIT is set"),
        ("missing", "Numba cannot be imported: import of numba halted"),
        ("broken kernel", "the kernel .*equal_biaxial_lanes cannot be compiled here: no such instruction"),
    ],
)
def test_without_a_compiler_auto_is_numpy_and_says_so(obstacle, reason, monkeypatch, forgetful):
    if obstacle == "switched off":
        monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    if obstacle == "missing":
        monkeypatch.setitem(sys.modules, "numba", None)
    if obstacle == "broken kernel":
        monkeypatch.setattr(kernels, "integrate_nothing", broken)
    with pytest.warns(
        UserWarning, match=f"compiled code cannot run here .{reason}.*engine 'numpy', more slowly"
    ):
        response = dl.frequency_response("equal_biaxial", **POINT)
    assert response.attrs["engine"] == "numpy" and response["status"].item() == "completed"
    with pytest.raises(
        ValueError, match=f"engine 'compiled' cannot run this: .*{reason}.*use 'numpy', or 'auto'"
    ):
        dl.frequency_response("equal_biaxial", engine="compiled", **POINT)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        same = dl.frequency_response("equal_biaxial", engine="numpy", **POINT)
    xr.testing.assert_identical(same, response)


def broken(kernel):
    raise NotImplementedError("no such instruction")


def test_the_interpreter_alone_runs_a_sweep():
    """In a process of its own, as a user would switch the compiler off."""
    code = (
        "import delagrange as dl; from delagrange.cli import main; import sys;"
        "sys.exit(main('sweep equal-biaxial --field-amplitude 1e6 --frequency 300 --duration 1e-3 -q'.split()))"
    )
    output, errors = child(code.replace(" -q", " --quiet"), NUMBA_DISABLE_JIT="1")
    assert "completed: 1 of 1 runs" in output
    assert "NUMBA_DISABLE_JIT is set" in errors and "'numpy'" in errors


def test_numba_is_imported_only_where_it_is_needed():
    code = (
        "import sys, delagrange as dl; dl.simulate('equal_biaxial', duration=1e-4);"
        "dl.frequency_response('equal_biaxial', engine='numpy', frequency=300., field_amplitude=1e6, duration=1e-4);"
        "print('numba' in sys.modules)"
    )
    assert child(code)[0].strip() == "False"


def test_a_module_without_a_kernel_runs_on_numpy_silently():
    source = dl.load_model("equal_biaxial")
    own = ModuleType("my_own")
    vars(own).update({name: value for name, value in vars(source).items() if not name.startswith("__")})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        response = dl.frequency_response(own, **POINT)
    assert response.attrs["engine"] == "numpy"
    with pytest.raises(ValueError, match="no kernel stands beside the module of the model equal_biaxial"):
        dl.frequency_response(own, engine="compiled", **POINT)


@dataclass(frozen=True)
class Bell(Drive):
    """A drive of a user's own."""

    height: float = 0.3

    def at(self, time):
        return self.height * np.exp(-(((time - 5e-4) / 1e-4) ** 2))


class BellOnTop(dl.Constant):
    """One made from a known drive."""

    def at(self, time):
        return self.value + Bell().at(time)


def test_a_drive_that_no_kernel_follows_runs_on_numpy_silently():
    for drive in (Bell(), BellOnTop(0.1)):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            response = dl.frequency_response("equal_biaxial", force=drive, **POINT)
        assert response.attrs["engine"] == "numpy"
        run = dl.simulate(
            "equal_biaxial", force=drive, field=dl.Sine(1e6, 300.0), duration=1e-3, samples=4001
        )
        assert response["maximum"].item() == pytest.approx(run["stretch"].max().item(), rel=1e-7)
        with pytest.raises(ValueError, match="which is not made of lines and sines"):
            dl.frequency_response("equal_biaxial", force=drive, engine="compiled", **POINT)


# --- the cache ---------------------------------------------------------------------------------------


def test_a_new_process_uses_what_was_compiled_before():
    dl.frequency_response("uniaxial", engine="compiled", **POINT)
    code = (
        "import delagrange as dl\n"
        "dl.frequency_response('uniaxial', engine='compiled', frequency=300., field_amplitude=1e6, duration=1e-3)\n"
        "from delagrange.generated import uniaxial_lanes\n"
        "stats = uniaxial_lanes.integrate.stats\n"
        "print(sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))"
    )
    assert child(code)[0].split() == ["1", "0"]


def test_a_kernel_has_one_signature():
    """Whatever is asked for, nothing is compiled a second time."""
    kernel = import_module("delagrange.generated.equal_biaxial_lanes")
    for more in (
        {},
        {"averages": True},
        {"sample_interval": 1e-4},
        {"section_points": 0 + 1, "duration": 0.01},
    ):
        dl.frequency_response(
            "equal_biaxial", engine="compiled", force=dl.Ramp(0.0, 0.1, 1e-4), **(POINT | more)
        )
    dl.frequency_response("equal_biaxial", engine="compiled", force=[0.1, 0.2], **POINT)
    assert len(kernel.integrate.signatures) == 1


STAND_IN = """
@_cached
def integrate(
    first, last, table, drives, vibrates, pieces, numerics, averages, results, samples, progress, stop
):
    progress[0] = 1.0
"""


def decorators():
    """What a real kernel is compiled by, as it stands in its text."""
    text = (GENERATED / "equal_biaxial_lanes.py").read_text(encoding="utf-8")
    wanted = {"_OPTIONS", "_CONTRACTED", "_compiled", "_cached"}
    yield "import numba"
    yield "STATE_COUNT, INPUT_COUNT, TABLE_ROWS, RESULT_ROWS = 3, 2, 5, 7"
    for node in ast.parse(text).body:
        names = {
            getattr(node, "name", None),
            *(ast.unparse(target) for target in getattr(node, "targets", ())),
        }
        if names & wanted:
            yield ast.get_source_segment(text, node)


@pytest.fixture
def stand_in(tmp_path, monkeypatch, forgetful):
    """Name of a kernel with nothing in it, which compiles in no time; its folder is `tmp_path`."""
    name = f"stand_in_{abs(hash(tmp_path))}_lanes"
    (tmp_path / f"{name}.py").write_text("\n\n".join((*decorators(), STAND_IN)), encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    invalidate_caches()
    yield name
    sys.modules.pop(name, None)


def test_a_kernel_is_kept_beside_its_source(stand_in, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kernel = kernels.load_kernel(stand_in)
    assert Path(kernel.integrate.stats.cache_path) == tmp_path / "__pycache__"
    assert kernels.load_kernel(stand_in) is kernel
    assert list((tmp_path / "__pycache__").glob("*.nbc"))


def test_no_folder_for_the_cache_is_a_warning(stand_in, monkeypatch):
    caching = import_module("numba.core.caching")
    monkeypatch.setattr(caching.CacheImpl, "_locator_classes", [])
    with pytest.warns(UserWarning, match="cannot be kept on disk.*set NUMBA_CACHE_DIR to a folder"):
        kernel = kernels.load_kernel(stand_in)
    kernels.integrate_nothing(kernel)


@pytest.mark.parametrize("operation", ["load", "save"])
def test_a_folder_that_turns_out_unusable_is_a_warning(operation, stand_in, monkeypatch):
    """One that is taken away or fills up after it was found: reading or writing fails late."""
    caching = import_module("numba.core.caching")

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(caching.IndexDataCacheFile, operation, fail)
    with pytest.warns(UserWarning, match="cannot be kept on disk"):
        kernel = kernels.load_kernel(stand_in)
    progress = np.zeros(1)
    arrays = np.zeros((5, 0)), np.zeros((1, 10, 1)), np.zeros(2, dtype=bool), np.zeros((1, 3)), np.ones(5)
    results = np.zeros((7, 0)), np.zeros((0, 3, 0)), progress, np.zeros(1, dtype=np.int8)
    kernel.integrate(0, 0, *arrays, False, *results)
    assert progress[0] == 1.0 and len(kernel.integrate.signatures) == 1


def test_a_kernel_in_an_archive_runs_without_any_folder(tmp_path):
    """Model and kernel imported from a zip, where no folder of the user's can be written."""
    with zipfile.ZipFile(tmp_path / "models.zip", "w") as archive:
        for name in ("equal_biaxial.py", "equal_biaxial_lanes.py"):
            archive.writestr(name, (GENERATED / name).read_text(encoding="utf-8"))
    file = tmp_path / "file"
    file.write_text("no folder")
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import equal_biaxial; import delagrange as dl\n"
        "r = dl.frequency_response(equal_biaxial, frequency=[300.], field_amplitude=1e6, duration=1e-3)\n"
        "print(equal_biaxial.__file__, r.attrs['engine'], repr(r['amplitude'].item()))"
    )
    nowhere = {name: str(file / "x") for name in ("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR")}
    output, errors = child(code, str(tmp_path / "models.zip"), **nowhere)
    place, engine, amplitude = output.split()
    assert "models.zip" in place and engine == "compiled"
    assert "cannot be kept on disk" in errors
    assert (
        float(amplitude)
        == dl.frequency_response("equal_biaxial", engine="compiled", **POINT)["amplitude"].item()
    )


# --- from the keyboard -------------------------------------------------------------------------------

TELLING = """
import signal, sys, time
from delagrange.cli import main
from delagrange.engines import compiled
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where these tests were started in the background
run = compiled.run_on_threads
def told(*given):
    print("running", flush=True)
    try:
        return run(*given)
    finally:
        print("ended", time.monotonic(), flush=True)
compiled.run_on_threads = told
sys.exit(main())
"""


def test_control_c_ends_a_long_sweep_at_once_and_keeps_what_was_finished(tmp_path):
    """Runs that pull in end at once; the others would take hours."""
    dl.frequency_response("equal_biaxial", engine="compiled", **POINT)  # compiled before
    out = tmp_path / "response.nc"
    command = [
        sys.executable, "-c", TELLING, "sweep", "equal-biaxial", "--field-amplitude", "5e7,1e6",
        "--frequency", "300:500:1", "--duration", "10000", "--out", str(out),
    ]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "running\n"
            time.sleep(1.0)
            sent = time.monotonic()
            process.send_signal(signal.SIGINT)
            output, errors = process.communicate(timeout=20)
        finally:
            process.kill()
    ended = float(output.splitlines()[0].removeprefix("ended "))
    assert 0 <= ended - sent < 1.0
    assert process.returncode == 130
    response = xr.load_dataset(out)
    status = response["status"].values
    assert np.all(status[0] == "collapsed") and np.all(status[1] == "interrupted")
    assert np.all(np.isfinite(response["maximum"][0])) and np.all(np.isnan(response["maximum"][1]))
    assert np.all(response["status_time"][0] > 0)
    last = errors.strip().splitlines()[-1]
    assert (
        last
        == f"delagrange: interrupted: 201 of 402 runs were not computed and are in {out} with that status"
    )


def test_what_had_ended_before_an_interruption_is_whole(monkeypatch):
    """Steps that wait to be looked into when the sweep is interrupted belong to runs that have ended."""
    lanes, model = 2000, dl.load_model("equal_biaxial")
    field = dl.Sine(np.full(lanes, 3e6), np.linspace(100.0, 800.0, lanes))
    problem = make_problem(model, None, {}, None, 0.5, field)
    state = np.repeat(np.array([[1.0], [0.0], [1.0]]), lanes, axis=1)
    numerics = Numerics("DOP853", "compiled", "pi", "dense")
    chosen = make_settings(0.1, None, 1e-9, 1e-12, numerics, dl.Limits(), threads=1)
    whole = integrate_compiled(problem, state, chosen)

    def interrupt(done):
        if done > 200:
            raise KeyboardInterrupt

    monkeypatch.setattr(threads, "LOOK", 1e-3)
    with pytest.raises(Interrupted) as caught:
        integrate_compiled(problem, state, chosen, None, interrupt)
    part = caught.value.outcome
    ended = part.status == loss.COMPLETED
    assert 100 < np.sum(ended) < lanes
    np.testing.assert_array_equal(part.maximum[:, ended], whole.maximum[:, ended])
    np.testing.assert_array_equal(part.minimum[:, ended], whole.minimum[:, ended])
    assert np.all(np.isnan(part.maximum[:, ~ended]))


def test_an_error_in_one_thread_stops_the_others(monkeypatch):
    kernel = import_module("delagrange.generated.equal_biaxial_lanes")

    class Failing(ModuleType):
        def __getattr__(self, name):
            return getattr(kernel, name)

        @staticmethod
        def integrate(first, last, *arrays):
            if first > 0:
                raise MemoryError("no memory")
            kernel.integrate(first, last, *arrays)

    monkeypatch.setattr("delagrange.engines.compiled.load_kernel", lambda name: Failing("failing"))
    began = time.monotonic()
    with pytest.raises(MemoryError, match="no memory"):
        dl.frequency_response(
            "equal_biaxial",
            engine="compiled",
            frequency=np.arange(300.0, 500.0),
            field_amplitude=1e6,
            duration=1e4,
        )
    assert time.monotonic() - began < 5.0


# --- bad numbers -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rtol": 1e-14}, "rtol must lie from 1e-13 to 0.01, got 1e-14"),
        ({"rtol": 0.1}, "rtol must lie from 1e-13 to 0.01, got 0.1"),
        ({"rtol": float("nan")}, "rtol must lie from 1e-13 to 0.01, got nan"),
        ({"atol": 0.0}, "atol must lie from 1e-18 to 0.01"),
        ({"threads": 0}, "threads must be an integer of at least 1, got 0"),
        ({"threads": -2}, "threads must be an integer of at least 1, got -2"),
        ({"threads": 2.5}, "threads must be an integer of at least 1, got 2.5"),
    ],
)
def test_numerics_that_make_no_sense_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        dl.frequency_response("equal_biaxial", engine="compiled", **(POINT | options))


def test_both_ends_of_the_tolerance_are_taken():
    for rtol in (1e-13, 1e-2):
        response = dl.frequency_response(
            "equal_biaxial", engine="compiled", rtol=rtol, atol=1e-3 * rtol, **POINT
        )
        assert response["status"].item() == "completed"


BEYOND = {
    "length": {"half_length": [1e300, 5e-3]},
    "no thickness": {"half_thickness": [1e-300, 1e-3]},
    "density": {"density": [1e308, 1.2e3]},
    "hardly a density": {"density": [1e-300, 1.2e3]},
    "no viscosity": {"viscosity": [1e-320, 1.68e7]},
    "permittivity": {"permittivity": [1e300, 6.198e-11]},
    "force": {"force": [1e15, 0.0]},
    "field": {"field_bias": [1e15, 0.0]},
    "stretch": {"initial_state": {"stretch": [1e300, 1.0]}},
    "hardly a stretch": {"initial_state": {"stretch": [1e-300, 1.0]}},
    "rate": {"initial_state": {"stretch_rate": [1e300, 0.0]}},
    "inelastic stretch": {"initial_state": {"inelastic_stretch": [1e-300, 1.0]}},
}


def test_a_lane_beyond_double_precision_ends_and_leaves_its_neighbour_alone():
    """In a process of its own that can be ended, should one of them crawl for ever."""
    code = (
        "import sys, delagrange as dl\n"
        "for case, values in eval(sys.argv[1]).items():\n"
        "    r = dl.frequency_response('equal_biaxial', engine='compiled', frequency=[300.], duration=1e-3,\n"
        "        **({'field_amplitude': 1e6, 'averages': True, 'sample_interval': 1e-4} | values))\n"
        "    print(case, r['status'].values.ravel()[1], repr(r['amplitude'].values.ravel()[1].item()), sep=';')"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, repr(BEYOND)], capture_output=True, text=True, timeout=30
    )
    assert done.returncode == 0, done.stderr
    found = [line.split(";") for line in done.stdout.splitlines()]
    assert [case for case, _, _ in found] == list(BEYOND)
    alone = dl.frequency_response("equal_biaxial", engine="compiled", sample_interval=1e-4, **POINT)
    for case, status, amplitude in found:
        assert (status, float(amplitude)) == ("completed", alone["amplitude"].item()), case


def test_a_kernel_that_is_not_there_is_named():
    own = ModuleType("my_own")
    own.MODEL = "my_own"
    problem = Problem(own, (), ())
    with pytest.raises(RuntimeError, match="the model my_own has no compiled kernel beside its module"):
        integrate_compiled(problem, np.ones((1, 1)), None)
