"""The core built by other compilers, widths and levels than this machine would choose, and runs for it."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
from dataclasses import fields
from importlib import resources
from importlib.util import find_spec
from pathlib import Path

import numpy as np

import delagrange as dl
from delagrange.core import build, kernel
from delagrange.core.kernel import Core, load_core
from delagrange.core.levels import processor_level
from delagrange.engines import core_engine
from delagrange.engines.engines import Numerics
from delagrange.engines.lanes import Outcome, Sampling, empty_outcome
from delagrange.engines.numpy_engine import integrate_lanes, segments
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem, make_problem
from delagrange.run.sweep import make_settings

CORE = Path(str(resources.files("delagrange.core"))) / "c"
GENERATED = Path(str(resources.files("delagrange.generated")))
MODELS = tuple(dl.model_names())
PLAIN = ("-O2", "-ffp-contract=off", "-fPIC", "-shared")
NARROW = dl.Limits(0.2, 2.2)  # so that lanes of every model leave them at some field


def compilers() -> dict[str, tuple[str, ...]]:
    """The C compilers that are here by what they are called."""
    found = {name: (path,) for name in ("gcc", "clang") if (path := shutil.which(name))}
    if find_spec("ziglang") is not None:
        found["zig"] = (sys.executable, "-m", "ziglang", "cc")
    return found


def march(compiler: str) -> str:
    """What asks a compiler for this processor's level."""
    level = processor_level()
    if level is None:
        return "-O2"
    return f"-march={level.replace('-', '_') if compiler == 'zig' else level}"


def compiled(
    source: Path, output: Path, *options: str, header: Path, command: tuple[str, ...] = ("gcc",)
) -> str:
    """What the compiler says while it compiles a source of the core, or a program, with the header of a model.

    Raises:
        AssertionError: it fails.
    """
    folders = (f"-I{CORE}", f"-I{header.parent}", f'-DDELAGRANGE_MODEL="{header.name}"')
    done = subprocess.run(
        [*command, *folders, str(source), "-o", str(output), *options, "-lm"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


def core_of(model: str, part: str, folder: Path, *options: str, command: tuple[str, ...] = ("gcc",)) -> Core:
    """The core of a model whose part is built so."""
    name = f"{model}-{part}-{abs(hash((options, command)))}.so"
    header = GENERATED / f"{model}.h"
    compiled(CORE / f"{part}.c", folder / name, *PLAIN, *options, header=header, command=command)
    core = load_core(dl.load_model(model))
    own = Core(core.header, core.states, core.coordinates, core.inputs, core.parameters)
    library = ctypes.CDLL(str(folder / name))
    kernel._declare(library, part)
    own._parts[part] = library
    return own


def problem_of(model: str, force, field, **materials) -> Problem:
    held = 1.5 if "shear" in model else None
    return make_problem(dl.load_model(model), dl.SHENG_2015, materials, held, force, field)


def start_of(problem: Problem, lanes: int) -> np.ndarray:
    reference = np.asarray(problem.model.reference_state(problem.parameters), dtype=float)
    return np.broadcast_to(reference.reshape(len(reference), -1), (len(reference), lanes)).copy()


def settings_of(
    duration=8e-3, rtol=1e-8, window=None, limits=NARROW, averages=True, threads=1, engine="compiled"
):
    control = {"compiled": "pi", "numpy": "scipy"}[engine]
    numerics = Numerics("DOP853", engine, control, "dense")
    return make_settings(duration, window, rtol, max(1e-3 * rtol, 1e-16), numerics, limits, averages, threads)


def even_samples(lanes: int, duration: float, count: int) -> Sampling:
    return Sampling(np.zeros(lanes), np.full(lanes, duration / (count - 1)), count)


def integrated(core: Core, problem: Problem, state: np.ndarray, settings, sampling=None) -> Outcome:
    """All lanes in one call of a core, on this thread."""
    lanes = state.shape[1]
    count = 0 if sampling is None else sampling.count
    found = empty_outcome(state, problem.model.COORDINATE_COUNT, loss.INTERRUPTED, count)
    spans = list(segments(problem, settings))
    stop = np.zeros(1, dtype=np.int8)
    call = core_engine._call(core, problem, state, settings, sampling, spans, found, stop)
    call.integrate(0, lanes, np.zeros(1))
    return found


def by_numpy(problem: Problem, state: np.ndarray, settings, sampling=None) -> Outcome:
    return integrate_lanes(problem, state, settings, sampling)


def mixed_lanes(model: str, count: int, rng) -> Problem:
    """Easy, hard and lost lanes in random order."""
    amplitude = rng.permutation(np.geomspace(1e4, 2e8, count))
    field = dl.Sine(amplitude, rng.uniform(50.0, 1500.0, count), rng.uniform(-1e6, 1e6, count), 0.4)
    return problem_of(model, rng.uniform(0.0, 0.6, count), field)


def assert_same_bits(first: Outcome, second: Outcome, lanes=slice(None)) -> None:
    for entry in fields(first):
        ours, theirs = getattr(first, entry.name)[..., lanes], getattr(second, entry.name)
        np.testing.assert_array_equal(ours, theirs, err_msg=entry.name)


def header_of(text: str, folder: Path) -> build.Header:
    return build.Header(folder.name, text.encode())
