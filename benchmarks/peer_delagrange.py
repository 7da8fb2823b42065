"""This package, through its public function, by any of its engines."""

from __future__ import annotations

import numpy as np

import delagrange
from benchmarks.cases import Case
from benchmarks.contestant import Contestant, Run
from delagrange.reproduction.runs.cases import Panel

ABSOLUTE_SHARE = 1e-3  # atol over rtol, as in the defaults of `frequency_response`
_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
_NUMPY_TOLERANCES = (1e-5, 1e-7)  # about an error of 1e-6, since it is slow


def threads_option(engine: str, threads: int = 1) -> dict[str, int]:
    """The argument that says how many threads; only the compiled engine has threads."""
    return {"threads": threads} if engine == "compiled" else {}


def amplitudes(case: Case, tolerance: float, engine: str, threads: int = 1) -> np.ndarray:
    """Amplitudes [1] of all runs, (n_runs,), one call a panel."""
    return np.concatenate([_panel(case, panel, tolerance, engine, threads) for panel in case.panels])


def _panel(case: Case, panel: Panel, tolerance: float, engine: str, threads: int) -> np.ndarray:
    first = panel.loads[0]
    values = {"force": first.force, "field_amplitude": first.field_amplitude}
    values[panel.varied] = [getattr(load, panel.varied) for load in panel.loads]
    response = delagrange.frequency_response(
        case.model, frequency=case.frequency, duration=case.duration, engine=engine,
        rtol=tolerance, atol=tolerance * ABSOLUTE_SHARE, **values, **threads_option(engine, threads),
    )  # fmt: skip
    return response["amplitude"].values.ravel()


def _prepare(engine: str):
    def prepare(case: Case, places: np.ndarray, tolerance: float) -> Run:
        amplitudes(case.thinned(len(case.frequency)), tolerance, engine)  # compiles, where it does
        return lambda: amplitudes(case, tolerance, engine)[places]

    return prepare


COMPILED = Contestant(
    "compiled", "Delagrange, compiled", "frequency_response, engine 'compiled', one thread, dense extrema",
    ("numba",), _TOLERANCES, _prepare("compiled"), engine="compiled",
)  # fmt: skip
NUMPY = Contestant(
    "numpy", "Delagrange, NumPy", "frequency_response, engine 'numpy', DOP853, dense extrema",
    (), _NUMPY_TOLERANCES, _prepare("numpy"), repeats=2, engine="numpy",
)  # fmt: skip
