"""The compiled kernels by model: found, compiled, kept on disk."""

from __future__ import annotations

import gc
import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType

import numpy as np

from delagrange.model.user_files import beside, import_named, is_users

LANES, VARIATIONAL = "lanes", "variational"  # kinds of kernels, and the last word of their modules' names


def kernel_name(model: ModuleType, kind: str = LANES) -> str | None:
    """Name of the compiled kernel of a kind that stands beside the module of a model, or None where there is none."""
    if is_users(model):
        return beside(model, kind)
    name = f"{model.__name__}_{kind}"
    try:
        return name if name in sys.modules or find_spec(name) is not None else None
    except (ImportError, ValueError):  # a module that is not in a package, or not from a file
        return None


@cache
def why_not_compiled() -> str | None:
    """Why compiled code cannot run on this machine, or None where it can."""
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        return "NUMBA_DISABLE_JIT is set"
    try:
        import_module("numba")
    except Exception as error:  # a missing package, a library that does not load, a NumPy that does not fit
        return f"Numba cannot be imported: {error}"
    return None


@cache
def load_kernel(name: str) -> ModuleType:
    """The kernel of that name, compiled.

    Warns where what was compiled cannot be kept on disk for the next process.

    Raises:
        RuntimeError: it cannot be compiled on this machine.
    """
    try:
        with _no_collection():
            kernel = import_named(name)
            kept = _compile(kernel)
    except Exception as error:
        raise RuntimeError(f"the kernel {name} cannot be compiled here: {error}") from error
    if not kept:
        warnings.warn(
            f"the compiled kernel {name} cannot be kept on disk, and every process will compile it anew; "
            "set NUMBA_CACHE_DIR to a folder that can be written",
            stacklevel=2,
        )
    return kernel


@contextmanager
def _no_collection() -> Iterator[None]:
    """Compiling makes millions of objects that stay; to look for garbage among them costs a tenth of the time."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def _compile(kernel: ModuleType) -> bool:
    """Compile the kernel by giving it nothing to do; whether the machine code is kept on disk."""
    variational = hasattr(kernel, "travel")
    use = compile_tangents if variational else integrate_nothing
    entry = kernel.travel if variational else kernel.integrate
    try:
        use(kernel)
    except OSError:  # a folder that was found, and that cannot be read or written after all
        entry._cache = import_module("numba.core.caching").NullCache()
        use(kernel)
        return False
    return entry.stats.cache_path is not None


def integrate_nothing(kernel: ModuleType) -> None:
    """Call the kernel with arrays of the right types and no trajectory in them."""
    kernel.integrate(
        0,
        0,
        np.zeros((kernel.TABLE_ROWS, 0)),
        np.zeros((1, 5 * kernel.INPUT_COUNT, 1)),
        np.zeros(kernel.INPUT_COUNT, dtype=bool),
        np.zeros((1, 3)),
        np.ones(5),
        False,
        np.zeros((kernel.RESULT_ROWS, 0)),
        np.zeros((0, kernel.STATE_COUNT, 0)),
        np.zeros(1),
        np.zeros(1, dtype=np.int8),
    )


def compile_tangents(kernel: ModuleType) -> None:
    """Call the kernel with arrays of the right types and a single time."""
    size, coordinates = kernel.STATE_COUNT, kernel.COORDINATE_COUNT
    frame = np.zeros(kernel.COLUMN)
    frame[kernel.WEIGHT : kernel.WEIGHT + size] = 1.0
    kernel.travel(
        np.zeros(1),
        np.zeros((0, 2), dtype=np.int64),
        False,
        0,
        frame,
        np.zeros(size + 1),
        np.zeros((1, size)),
        np.zeros((0, 0)),
        np.zeros(1),
        np.zeros((2, coordinates)),
    )
