"""What is measured in a process of its own: `python -m benchmarks.tasks TASK JSON` prints JSON.

Registered apart from what starts the process (`benchmarks.child`), so that a measurement may be both: what starts
a task, and what the task does.
"""

from __future__ import annotations

import json
import math
import resource
import sys
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from time import perf_counter

from benchmarks.child import ROOT


def ensemble(engine: str, frequencies: int, amplitudes: int, duration: float, rtol: float) -> dict:
    """Time [s] and memory [byte] of one sweep over frequency and field amplitude, after a small one."""
    from benchmarks.timing import timed

    sweep = _sweep(engine, frequencies, amplitudes, duration, rtol)
    _sweep(engine, 4, 4, duration, rtol)()  # imports and compiles
    before = peak_memory()
    time, result = timed(sweep)
    return {
        "trajectories": frequencies * amplitudes,
        "time": time,
        "before": before,
        "peak": peak_memory(),
        "result": int(result.nbytes),
    }


def first_sweep(engine: str, duration: float, rtol: float) -> dict:
    """Time [s] from before the package is imported to the end of a sweep of one run."""
    begin = perf_counter()
    import delagrange

    threads = {"threads": 1} if engine == "compiled" else {}
    delagrange.frequency_response(
        "equal_biaxial", force=0.5, field_amplitude=1e6, frequency=200.0, duration=duration, engine=engine,
        rtol=rtol, atol=1e-3 * rtol, **threads,
    )  # fmt: skip
    return {"time": perf_counter() - begin}


def imports() -> dict:
    """Time [s] of the imports that a sweep needs whatever its engine."""
    begin = perf_counter()
    for name in ("delagrange", "numpy", "xarray"):
        import_module(name)
    return {"time": perf_counter() - begin}


def threaded(engine: str, counts: list[int], every: int, repeats: int, rtol: float, least: float) -> dict:
    """Times [s] of the equal-biaxial case on so many threads, counts in turn, the case run often enough that it
    takes `least` [s] on one thread."""
    from benchmarks.cases import CASES
    from benchmarks.peer_delagrange import amplitudes
    from benchmarks.timing import timed

    case = CASES["equal_biaxial"].thinned(every)
    amplitudes(case.thinned(len(case.frequency)), rtol, engine)  # compiles
    sweeps = math.ceil(least / timed(lambda: amplitudes(case, rtol, engine))[0])
    times: dict[int, list[float]] = {count: [] for count in counts}
    for _ in range(repeats):
        for count in counts:
            run = partial(_repeat, sweeps, partial(amplitudes, case, rtol, engine, count))
            times[count].append(timed(run)[0])
    runs = sweeps * len(case.runs)
    rows = [{"threads": count, "runs": runs, "times": some} for count, some in times.items()]
    return {"sweeps": sweeps, "counts": rows}


def _repeat(times: int, run: Callable[[], object]) -> None:
    for _ in range(times):
        run()


def steady_response(quick: bool) -> dict:
    """Time [s] of a curve of 400 points (one branch, both ways from one start), and how many it has in all."""
    import delagrange
    from benchmarks.timing import one_core, timed

    with one_core():
        time, found = timed(
            lambda: delagrange.steady_response(
                "equal_biaxial", force=0.5, field_amplitude=1e6, frequency=(100.0, 800.0),
                most_points=40 if quick else 400,
            )
        )  # fmt: skip
    return {"time": time, "size": int(found.sizes["point"])}


def lyapunov_spectrum(quick: bool) -> dict:
    """Time [s] of the spectrum of the uniaxial membrane at 424 Hz, and the time followed [s]."""
    import delagrange
    from benchmarks.timing import one_core, timed

    duration = 2.0 if quick else 20.0
    with one_core():
        time, _ = timed(
            lambda: delagrange.lyapunov_spectrum(
                "uniaxial", force=0.5, field=delagrange.Sine(5e6, 424.0), duration=duration
            )
        )
    return {"time": time, "size": duration}


def own_membrane(quick: bool) -> dict:
    """Time [s] from a model file to a swept response, derivation and compilation included, and how many runs it has."""
    import tempfile

    from benchmarks.timing import one_core, timed

    with one_core(), tempfile.TemporaryDirectory() as folder:
        time, found = timed(lambda: _derived_and_swept(Path(folder), 3 if quick else 90))
    return {"time": time, "size": int(found["amplitude"].size)}


def _derived_and_swept(folder: Path, runs: int):
    import numpy as np

    import delagrange
    from delagrange.derive.emit.write_together import write_together
    from delagrange.derive.model_file.file import read_model_file
    from delagrange.derive.pipeline import derive_description

    description = read_model_file(ROOT / "tests" / "models" / "gent_three_branches.toml")
    write_together(derive_description(description), folder)
    return delagrange.frequency_response(
        delagrange.load(folder / f"{description.name}.py"), force=0.1, field_amplitude=4e6,
        frequency=np.linspace(50.0, 500.0, runs), duration=0.3, threads=1,
    )  # fmt: skip


def kinds(quick: bool) -> dict:
    """Time [s] of all verdicts on two processes, and how many there are."""
    import tempfile
    from pathlib import Path

    from benchmarks.timing import timed
    from delagrange.reproduction.runs.all_runs import run_all
    from delagrange.reproduction.runs.runs import kind_jobs

    wanted = kind_jobs()[:1] if quick else kind_jobs()
    with tempfile.TemporaryDirectory() as folder:
        time, runs = timed(lambda: run_all(wanted, Path(folder)))
    return {"time": time, "size": sum(one.sizes["frequency"] for one in runs.datasets.values())}


def assembly(models: list[str]) -> dict:
    """Arithmetic instructions of the kernels of models, by registers."""
    from benchmarks.vector_width import of_kernels

    return of_kernels(models)


def _sweep(
    engine: str, frequencies: int, amplitudes: int, duration: float, rtol: float
) -> Callable[[], object]:
    import numpy as np

    import delagrange
    from benchmarks.peer_delagrange import ABSOLUTE_SHARE, threads_option

    return lambda: delagrange.frequency_response(
        "equal_biaxial", force=0.5, field_amplitude=np.linspace(1e6, 5e6, amplitudes),
        frequency=np.linspace(100.0, 800.0, frequencies), duration=duration, engine=engine,
        rtol=rtol, atol=rtol * ABSOLUTE_SHARE, **threads_option(engine),
    )  # fmt: skip


def peak_memory() -> int:
    """Largest resident memory of this process so far [byte].

    Linux hands the parent's peak down through `getrusage`, so that a child would start at the size of its
    parent; /proc/self/status has the child's own.
    """
    try:
        with open("/proc/self/status", encoding="utf-8") as file:
            line = next(line for line in file if line.startswith("VmHWM:"))
        return int(line.split()[1]) * 1024
    except (OSError, StopIteration):
        unit = 1 if sys.platform == "darwin" else 1024
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


TASKS: Mapping[str, Callable[..., dict]] = {
    "ensemble": ensemble,
    "first_sweep": first_sweep,
    "imports": imports,
    "threaded": threaded,
    "assembly": assembly,
    "steady_response": steady_response,
    "lyapunov_spectrum": lyapunov_spectrum,
    "own_membrane": own_membrane,
    "kinds": kinds,
}

if __name__ == "__main__":
    print(json.dumps(TASKS[sys.argv[1]](**json.loads(sys.argv[2]))))
