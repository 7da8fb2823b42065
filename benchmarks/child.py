"""What is measured in a process of its own: `python -m benchmarks.child TASK JSON` prints JSON.

A fresh process has no compiled code, no memory used before, and as many threads as it is asked for.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parents[1]


def in_child(task: str, options: Mapping[str, object], environment: Mapping[str, str] | None = None) -> dict:
    """Run a task in a fresh process.

    Raises:
        RuntimeError: it failed; the message is the last line of what it wrote.
    """
    command = [sys.executable, "-m", "benchmarks.child", task, json.dumps(options)]
    variables = os.environ | dict(environment or {})
    done = subprocess.run(command, cwd=ROOT, env=variables, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise RuntimeError(f"{task} {dict(options)} failed: {last}")
    return json.loads(done.stdout)


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


def first_calls(engine: str, duration: float, rtol: float) -> dict:
    """Times [s] of the imports, of the first small sweep and of the same once more."""
    from benchmarks.timing import timed

    names = ("delagrange.response", "numba") if engine == "compiled" else ("delagrange.response",)
    imports = timed(lambda: [import_module(name) for name in names])[0]
    sweep = _sweep(engine, 4, 4, duration, rtol)
    return {"imports": imports, "first": timed(sweep)[0], "second": timed(sweep)[0]}


def threaded(engine: str, threads: int, every: int, repeats: int, rtol: float) -> dict:
    """Times [s] of the whole equal-biaxial case on so many threads."""
    from benchmarks.cases import CASES
    from benchmarks.peer_delagrange import amplitudes
    from benchmarks.timing import timed

    case = CASES["equal_biaxial"].thinned(every)
    amplitudes(case.thinned(len(case.frequency)), rtol, engine, threads)
    times = [timed(lambda: amplitudes(case, rtol, engine, threads))[0] for _ in range(repeats)]
    return {"threads": threads, "runs": len(case.runs), "times": times}


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
    "first_calls": first_calls,
    "threaded": threaded,
}

if __name__ == "__main__":
    print(json.dumps(TASKS[sys.argv[1]](**json.loads(sys.argv[2]))))
