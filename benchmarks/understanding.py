"""How long the questions take that a user asks of a motion, or of a membrane of her own: each in a fresh process."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable

from benchmarks.child import in_child

QUESTIONS = {
    "steady_response": "one response curve of 400 points with stability, one core",
    "lyapunov_spectrum": "Lyapunov spectrum of uniaxial over 20 s of motion, one core",
    "own_membrane": "uniaxial Gent membrane with three branches: from its file to a sweep of 90 runs, one core",
    "kinds": "kinds of motion of the nine cases of Figs. 6, 9 and 12 (twelve with both formulations), two cores",
}


def measured(quick: bool, keep: Callable[[dict], None]) -> None:
    """Times [s] beyond the imports, with an empty cache of compiled code and then with a full one."""
    found: dict[str, object] = {}
    for question, text in QUESTIONS.items():
        print(text, file=sys.stderr)
        with tempfile.TemporaryDirectory() as folder:
            cache = {"NUMBA_CACHE_DIR": folder}
            times = [in_child(question, {"quick": quick}, cache) for _ in range(2 if quick else 4)]
        found[question] = {
            "text": text,
            "first": times[0]["time"],
            "again": [one["time"] for one in times[1:]],
            "size": times[0]["size"],
        }
        keep(found)
