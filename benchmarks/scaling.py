"""How time and memory grow: with threads, with trajectories, and what compiling costs."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable

from benchmarks.child import in_child
from benchmarks.timing import core_count

RTOL = 1e-6
QUICK_EVERY = 50  # of the frequencies
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
    print(f"threads {counts}", file=sys.stderr)
    options = {
        "engine": engine,
        "counts": counts,
        "every": QUICK_EVERY if quick else 1,
        "repeats": 3 if quick else 7,
        "least": 0.2 if quick else 1.2,
    }
    found = {"engine": engine, "rtol": RTOL} | in_child("threaded", options | {"rtol": RTOL})
    keep(found)
    return found


def thread_counts(cores: int) -> list[int]:
    """1, 2, 4, ... and the cores themselves."""
    counts = [1]
    while 2 * counts[-1] < cores:
        counts.append(2 * counts[-1])
    return counts if cores == 1 else [*counts, cores]


def compile_time(engine: str, quick: bool, keep: Callable[[dict], None]) -> dict[str, object]:
    """Times [s] of first sweeps with an empty cache of compiled code and with a full one, and of the imports."""
    found = {"engine": engine, "imports": [], "cold": [], "cached": []}
    options = {"engine": engine, "duration": SHORT, "rtol": RTOL}
    for _ in range(1 if quick else 3):
        with tempfile.TemporaryDirectory() as folder:
            print("first sweep, cold", file=sys.stderr)
            cache = {"NUMBA_CACHE_DIR": folder}
            found["cold"].append(in_child("first_sweep", options, cache)["time"])
            for _ in range(2 if quick else 3):
                found["imports"].append(in_child("imports", {}, cache)["time"])
                found["cached"].append(in_child("first_sweep", options, cache)["time"])
        keep(found)
    return found
