"""The structures of `delagrange.h` as ctypes has them, filled from arrays that are checked first: compiled code reads
past an array's end without a word."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping

import numpy as np

_POINTER, _COUNT, _NUMBER, _SIZE, _TEXT = (
    ctypes.c_void_p, ctypes.c_int64, ctypes.c_double, ctypes.c_size_t, ctypes.c_char_p
)  # fmt: skip

LEVEL, SLOPE, AMPLITUDE, FREQUENCY, PHASE = range(5)  # rows of the numbers of a drive; phase in turns
DRIVE_ROWS = 5
COMPLETED, COLLAPSED, DIVERGED, INTERRUPTED, LOCKED, UNRESOLVED = range(6)


def _fields(text: str) -> list[tuple[str, type]]:
    """`name:kind` a field: n a count, x a number, * an array, z a size, s a text."""
    kinds = {"n": _COUNT, "x": _NUMBER, "*": _POINTER, "z": _SIZE, "s": _TEXT}
    return [(name, kinds[kind]) for name, kind in (field.split(":") for field in text.split())]


class Library(ctypes.Structure):
    """What a library is of."""

    _fields_ = _fields(
        "size:z job_size:z model:s digest:s states:n coordinates:n inputs:n parameters:n energies:n lanes:n"
    )


class Runs(ctypes.Structure):
    """Many runs."""

    _fields_ = _fields(
        "runs:n parameters:* parameter_columns:n state:* pieces:* drives:* piece_count:n drive_columns:n rtol:x atol:* "
        "smallest:x largest:x averages:n sample_count:n first_sample:* sample_spacing:* samples:* maximum:* minimum:* "
        "mean:* mean_square:* last_state:* status:* status_time:* steps:* rejections:* stop:*"
    )


class Run(ctypes.Structure):
    """One run."""

    _fields_ = _fields(
        "begun:n parameters:* state:* pieces:* drives:* piece_count:n rtol:x atol:* smallest:x largest:x time_count:n "
        "times:* states:* energies:* last_state:* status:n status_time:x steps:n rejections:n"
    )


class Tangent(ctypes.Structure):
    """One run and its tangent."""

    _fields_ = _fields(
        "begun:n parameters:* state:* drives:* start:x weights:* tolerance:x smallest:x largest:x time_count:n times:* "
        "column_count:n columns:* sources:* normalise:n states:* growth:* divergence:* maximum:* minimum:* "
        "last_state:* last_columns:* status:n status_time:x steps:n rejections:n"
    )


Shape = tuple[int, ...]


def checked_address(
    name: str, array: np.ndarray | None, shape: Shape, dtype: type = np.float64
) -> int | None:
    """Address of an array that is as compiled code takes it to be; None of None.

    Raises:
        ValueError: another type, shape or order.
    """
    if array is None:
        return None
    if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
        got = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
        raise ValueError(f"{name} must be an array of {np.dtype(dtype)} with the shape {shape}, got {got}")
    if not (array.flags.c_contiguous and array.flags.aligned):
        raise ValueError(f"{name} must lie row after row in memory")
    return array.ctypes.data


def filled(
    structure: type, arrays: Mapping[str, tuple[np.ndarray | None, Shape, type]], **numbers: float
) -> ctypes.Structure:
    """The structure with the addresses of the arrays, each given with the shape and type that it must have.

    It keeps the arrays alive. Raises ValueError as `checked_address`.
    """
    job = structure(**numbers)
    for name, (array, shape, dtype) in arrays.items():
        setattr(job, name, checked_address(name, array, shape, dtype))
    job.kept_alive = tuple(array for array, _, _ in arrays.values())
    return job
