"""How time and memory grow: with threads, with trajectories, and what compiling costs."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable

from benchmarks.child import in_child
from benchmarks.timing import core_count

RTOL = 1e-6
SHORT = 0.01  # duration of the runs of the large ensembles [s]
GRIDS = ((50, 20), (100, 100), (500, 200), (1000, 1000))  # frequencies x amplitudes: 10^3 to 10^6


def ensembles(engine: str, quick: bool, keep: Callable[[dict], None]) -> dict[str, object]:
    """Time [s] and memory [byte] over the number of trajectories, each in a fresh process."""
    found = {"engine": engine, "rtol": RTOL, "duration": SHORT, "sizes": []}
    for frequencies, amplitudes in GRIDS[:2] if quick else GRIDS:
        print(f"ensemble of {frequencies * amplitudes} trajectories", file=sys.stderr)
        options = {"engine": engine, "frequencies": frequencies, "amplitudes": amplitudes}
        found["sizes"].append(in_child("ensemble", options | {"duration": SHORT, "rtol": RTOL}))
        keep(found)
    return found


def threads(engine: str, quick: bool, keep: Callable[[dict], None]) -> dict[str, object]:
    """Times [s] of the equal-biaxial case on one thread, two, and so on up to the cores there are.

    The NumPy engine has no threads: it is measured on one.
    """
    counts = thread_counts(core_count()) if engine == "compiled" else [1]
    found = {"engine": engine, "rtol": RTOL, "counts": []}
    for count in counts:
        print(f"{count} threads", file=sys.stderr)
        options = {
            "engine": engine,
            "threads": count,
            "every": 50 if quick else 1,
            "repeats": 3 if quick else 7,
        }
        found["counts"].append(in_child("threaded", options | {"rtol": RTOL}))
        keep(found)
    return found


def thread_counts(cores: int) -> list[int]:
    """1, 2, 4, ... and the cores themselves."""
    counts = [1]
    while 2 * counts[-1] < cores:
        counts.append(2 * counts[-1])
    return counts if cores == 1 else [*counts, cores]


def compile_time(engine: str, quick: bool, keep: Callable[[dict], None]) -> dict[str, object]:
    """Times [s] of first calls with an empty cache of compiled code and with a full one, in fresh processes."""
    found = {"engine": engine}
    options = {"engine": engine, "duration": SHORT, "rtol": RTOL}
    with tempfile.TemporaryDirectory() as folder:
        for name in ("cold", "cached"):
            print(f"first calls, {name}", file=sys.stderr)
            found[name] = in_child("first_calls", options, {"NUMBA_CACHE_DIR": folder})
            keep(found)
    return found
