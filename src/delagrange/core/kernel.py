"""The compiled core of a model, called from Python.

    core = load_core(model)
    core.runs(...).integrate(0, 100, progress)

Every array is checked before compiled code sees it, and those that are written must be there, of their shapes; what
they mean is said in `delagrange.h`.
"""

from __future__ import annotations

import ctypes
import threading
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np

from delagrange.core.build import Header, load_library, read_header
from delagrange.core.compiler import NoCompiler
from delagrange.core.structures import DRIVE_ROWS, INTERRUPTED, Library, Run, Runs, Tangent, filled

__all__ = ["Core", "NoCompiler", "load_core"]

_STRUCTURES = {"lanes": Runs, "trajectory": Run, "tangents": Tangent}
_DESCRIBE = {"lanes": "delagrange_lanes", "trajectory": "delagrange_one", "tangents": "delagrange_tangents"}
_DOUBLE, _WHOLE, _BYTE = np.float64, np.int64, np.int8


@cache
def load_core(model: ModuleType) -> Core | None:
    """The core for a model with a header beside its module; None where there is none. Nothing is compiled yet.

    Raises:
        ValueError: the header is not that of the module.
    """
    path = getattr(model, "__file__", None)
    header = None if path is None else read_header(Path(path))
    if header is None:
        return None
    names = len(model.STATE), model.COORDINATE_COUNT, len(model.INPUTS), len(model.PARAMETERS)
    return Core(header, *names)


@dataclass(frozen=True)
class Core:
    """Compiled code for the equations of one model; each of its parts is compiled, or found, when first asked for."""

    header: Header
    states: int
    coordinates: int
    inputs: int
    parameters: int
    _parts: dict[str, ctypes.CDLL] = field(default_factory=dict, repr=False, compare=False)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False, compare=False)

    def part(self, name: str) -> ctypes.CDLL:
        """The library of "lanes", "trajectory" or "tangents".

        Raises:
            NoCompiler: it cannot be compiled on this machine.
        """
        with self._lock:
            if name not in self._parts:
                self._parts[name] = self._loaded(name)
            return self._parts[name]

    def described(self, name: str) -> Library:
        """What the library of a part says of itself."""
        return _described(self.part(name), name)

    def _loaded(self, name: str) -> ctypes.CDLL:
        library = load_library(name, self.header)
        told = _described(library, name)
        sizes = told.states, told.coordinates, told.inputs, told.parameters
        known = ctypes.sizeof(Library), ctypes.sizeof(_STRUCTURES[name])
        if (
            sizes != (self.states, self.coordinates, self.inputs, self.parameters)
            or (told.size, told.job_size) != known
        ):
            raise NoCompiler(f"the machine code of {self.header.model} is not of this module")
        _declare(library, name)
        return library

    def runs(
        self,
        parameters: np.ndarray,
        state: np.ndarray,
        pieces: np.ndarray,
        drives: np.ndarray,
        *,
        rtol: float,
        atol: np.ndarray,
        smallest: float,
        largest: float,
        averages: bool,
        results: dict[str, np.ndarray],
        samples: np.ndarray | None = None,
        first_sample: np.ndarray | None = None,
        sample_spacing: np.ndarray | None = None,
        stop: np.ndarray | None = None,
    ) -> RunsCall:
        """Runs that are ready to be integrated, part by part, on as many threads as one likes.

        results: arrays to be written into, by their names in `delagrange_runs`.
        """
        library, runs = self.part("lanes"), state.shape[-1]
        own, count = parameters.shape[-1], 0 if samples is None else len(samples)
        columns, rows = drives.shape[-1], (self.coordinates, runs)
        given = {
            "parameters": (parameters, (self.parameters, runs if own > 1 else 1), _DOUBLE),
            "state": (state, (self.states, runs), _DOUBLE),
            "pieces": (checked_pieces(pieces), (len(pieces), 3), _DOUBLE),
            "drives": (drives, (len(pieces), DRIVE_ROWS, self.inputs, runs if columns > 1 else 1), _DOUBLE),
            "atol": (atol, (self.states,), _DOUBLE),
            "samples": (samples if count else None, (count, self.states, runs), _DOUBLE),
            "first_sample": (first_sample if count else None, (runs,), _DOUBLE),
            "sample_spacing": (sample_spacing if count else None, (runs,), _DOUBLE),
            "stop": (stop, (1,), _BYTE),
        }
        shapes = {
            "maximum": (rows, _DOUBLE), "minimum": (rows, _DOUBLE), "mean": (rows, _DOUBLE),
            "mean_square": (rows, _DOUBLE), "last_state": ((self.states, runs), _DOUBLE),
            "status": ((runs,), _WHOLE), "status_time": ((runs,), _DOUBLE), "steps": ((runs,), _WHOLE),
            "rejections": ((runs,), _WHOLE),
        }  # fmt: skip
        written = {name: (results[name], *shape) for name, shape in shapes.items()}
        if count and (first_sample is None or sample_spacing is None):
            raise ValueError("samples need the time of the first one and their spacing")
        job = filled(
            Runs, given | written, runs=runs, parameter_columns=own, piece_count=len(pieces), drive_columns=columns,
            rtol=rtol, smallest=smallest, largest=largest, averages=int(averages), sample_count=count,
        )  # fmt: skip
        return RunsCall(library, job, int(_described(library, "lanes").lanes))

    def run(
        self,
        parameters: np.ndarray,
        state: np.ndarray,
        pieces: np.ndarray,
        drives: np.ndarray,
        times: np.ndarray,
        *,
        rtol: float,
        atol: np.ndarray,
        smallest: float,
        largest: float,
    ) -> RunCall:
        """One run that is ready to be integrated; its state is wanted at `times`, (n_times,) [s]."""
        library = self.part("trajectory")
        energies = np.full((len(times), int(_described(library, "trajectory").energies)), np.nan)
        states, last = np.full((len(times), self.states), np.nan), np.full(self.states, np.nan)
        pieces = checked_pieces(pieces)
        if len(times) and (
            np.any(np.diff(times) <= 0) or times[0] < pieces[0, 0] or times[-1] > pieces[-1, 1]
        ):
            raise ValueError("times must increase, from the start of the run to its end at most")
        arrays = {
            "parameters": (parameters, (self.parameters,), _DOUBLE),
            "state": (state, (self.states,), _DOUBLE),
            "pieces": (pieces, (len(pieces), 3), _DOUBLE),
            "drives": (drives, (len(pieces), DRIVE_ROWS, self.inputs), _DOUBLE),
            "atol": (atol, (self.states,), _DOUBLE),
            "times": (times, (len(times),), _DOUBLE),
            "states": (states, states.shape, _DOUBLE),
            "energies": (energies, energies.shape, _DOUBLE),
            "last_state": (last, (self.states,), _DOUBLE),
        }
        job = filled(
            Run, arrays, piece_count=len(pieces), rtol=rtol, smallest=smallest, largest=largest, time_count=len(times),
            status=INTERRUPTED,
        )  # fmt: skip
        return RunCall(
            library, job, states, energies, last, workspace(library.delagrange_trajectory_workspace())
        )

    def tangent(
        self,
        parameters: np.ndarray,
        state: np.ndarray,
        drives: np.ndarray,
        times: np.ndarray,
        columns: np.ndarray,
        sources: np.ndarray,
        *,
        weights: np.ndarray,
        tolerance: float,
        smallest: float,
        largest: float,
        normalise: bool,
    ) -> TangentCall:
        """One run and its tangent, ready to travel.

        drives: (DRIVE_ROWS, n_inputs), at all times; columns: (n_columns, n_state); sources: (n_columns, 2) of int64.
        """
        library = self.part("tangents")
        count, n = len(columns), len(times)
        if n < 1 or np.any(np.diff(times) <= 0):
            raise ValueError("times must increase")
        if np.any(sources >= np.array([max(self.inputs, 1), DRIVE_ROWS])) or np.any(
            np.any(sources < 0, 1) != np.all(sources < 0, 1)
        ):
            raise ValueError("sources must be an input and a row of its drive, or -1, -1")
        states, divergence = np.full((n, self.states), np.nan), np.full(n, np.nan)
        states[0], divergence[0] = state, 0.0
        extrema = np.array([state[: self.coordinates], state[: self.coordinates]])
        growth = np.full((n - 1, count), np.nan if normalise else 0.0)
        last, last_columns = np.full(self.states, np.nan), np.full((count, self.states), np.nan)
        outcome = TangentOutcome(states, growth, divergence, extrema[0], extrema[1], last, last_columns)
        arrays = {
            "parameters": (parameters, (self.parameters,), _DOUBLE),
            "state": (state, (self.states,), _DOUBLE),
            "drives": (drives, (DRIVE_ROWS, self.inputs), _DOUBLE),
            "weights": (weights, (self.states,), _DOUBLE),
            "times": (times, (n,), _DOUBLE),
            "columns": (columns, (count, self.states), _DOUBLE),
            "sources": (sources, (count, 2), _WHOLE),
            "states": (states, states.shape, _DOUBLE),
            "growth": (growth, growth.shape, _DOUBLE),
            "divergence": (divergence, (n,), _DOUBLE),
            "maximum": (extrema[0], (self.coordinates,), _DOUBLE),
            "minimum": (extrema[1], (self.coordinates,), _DOUBLE),
            "last_state": (last, (self.states,), _DOUBLE),
            "last_columns": (last_columns, last_columns.shape, _DOUBLE),
        }
        job = filled(
            Tangent,
            arrays,
            start=float(times[0]),
            tolerance=tolerance,
            smallest=smallest,
            largest=largest,
            time_count=n,
            column_count=count,
            normalise=int(normalise),
            status=INTERRUPTED,
        )
        return TangentCall(library, job, outcome, workspace(library.delagrange_tangents_workspace(count)))


@dataclass(frozen=True)
class RunsCall:
    """Runs that are ready to be integrated."""

    library: ctypes.CDLL
    job: Runs
    lanes: int  # that advance side by side

    def integrate(self, first: int, last: int, progress: np.ndarray) -> None:
        """Integrate the runs `first` to `last` (not included); progress: (1,), runs' worth of time done."""
        if not 0 <= first <= last <= self.job.runs or progress.shape != (1,) or progress.dtype != _DOUBLE:
            raise ValueError(f"runs {first} to {last} of {self.job.runs}, or no place for the progress")
        room = workspace(self.library.delagrange_lanes_workspace())
        self.library.delagrange_integrate(
            ctypes.byref(self.job), first, last, progress.ctypes.data, room.ctypes.data
        )


@dataclass(frozen=True)
class RunCall:
    """One run on its way."""

    library: ctypes.CDLL
    job: Run
    states: np.ndarray  # (n_times, n_state), NaN from a loss on
    energies: np.ndarray  # (n_times, n_energies) [J and W], as the header of the model lists them; likewise
    last_state: np.ndarray  # (n_state,)
    room: np.ndarray

    def go_on(self, budget: int) -> bool:
        """Some more steps; whether there are more to do."""
        self.library.delagrange_trajectory(ctypes.byref(self.job), budget, self.room.ctypes.data)
        return self.job.status == INTERRUPTED


@dataclass(frozen=True)
class TangentOutcome:
    """What is written while a tangent travels; see `delagrange.h`."""

    states: np.ndarray
    growth: np.ndarray
    divergence: np.ndarray
    maximum: np.ndarray
    minimum: np.ndarray
    last_state: np.ndarray
    last_columns: np.ndarray


@dataclass(frozen=True)
class TangentCall:
    """A run and its tangent on their way."""

    library: ctypes.CDLL
    job: Tangent
    outcome: TangentOutcome
    room: np.ndarray

    def go_on(self, budget: int) -> bool:
        """Some more steps; whether there are more to do."""
        self.library.delagrange_travel(ctypes.byref(self.job), budget, self.room.ctypes.data)
        return self.job.status == INTERRUPTED


def workspace(size: int) -> np.ndarray:
    """So many bytes."""
    return np.empty(size, dtype=np.uint8)


def checked_pieces(pieces: np.ndarray) -> np.ndarray:
    """Pieces of time, (n_pieces, 3), each of which begins where the one before ends.

    Raises:
        ValueError: there are none, or they do not.
    """
    if (
        pieces.ndim != 2
        or not len(pieces)
        or np.any(pieces[:, 0] >= pieces[:, 1])
        or np.any(pieces[1:, 0] != pieces[:-1, 1])
    ):
        raise ValueError("pieces of time must follow each other, each with an end after its start")
    return pieces


def _described(library: ctypes.CDLL, name: str) -> Library:
    told = Library()
    getattr(library, _DESCRIBE[name])(ctypes.byref(told))
    return told


def _declare(library: ctypes.CDLL, name: str) -> None:
    """Types of the functions that ctypes would not guess."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    if name == "lanes":
        library.delagrange_lanes_workspace.restype = ctypes.c_size_t
        library.delagrange_integrate.argtypes = [pointer, count, count, pointer, pointer]
        library.delagrange_integrate.restype = None
    elif name == "trajectory":
        library.delagrange_trajectory_workspace.restype = ctypes.c_size_t
        library.delagrange_trajectory.argtypes = [pointer, count, pointer]
        library.delagrange_trajectory.restype = None
    else:
        library.delagrange_tangents_workspace.argtypes = [count]
        library.delagrange_tangents_workspace.restype = ctypes.c_size_t
        library.delagrange_travel.argtypes = [pointer, count, pointer]
        library.delagrange_travel.restype = None
