"""Which level of instructions this processor has, as compilers name them."""

from __future__ import annotations

import platform
from collections.abc import Iterable
from pathlib import Path

_LEVELS = (  # the best first; by the names of Linux, and by NumPy's where there is no such list
    (
        "x86-64-v4",
        frozenset(
            [
                "avx512f",
                "avx512bw",
                "avx512cd",
                "avx512dq",
                "avx512vl",
                "avx2",
                "bmi1",
                "bmi2",
                "f16c",
                "fma",
                "movbe",
            ]
        ),
    ),
    ("x86-64-v3", frozenset(["avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"])),
    ("x86-64-v2", frozenset(["cx16", "popcnt", "sse4_1", "sse4_2", "ssse3"])),
)
_NUMPY = (
    ("x86-64-v4", ("AVX512_SKX", "FMA3", "AVX2")),
    ("x86-64-v3", ("FMA3", "AVX2", "F16C")),
    ("x86-64-v2", ("SSE42", "POPCNT", "SSSE3")),
)


def processor_level() -> str | None:
    """`x86-64-v4`, `-v3` or `-v2`; None for any other processor, which has one level only."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return None
    flags = _linux_flags()
    return level_of(flags) if flags else _numpy_level()


def level_of(flags: Iterable[str]) -> str | None:
    """The best level whose instructions are all there."""
    there = frozenset(flags)
    return next((name for name, needed in _LEVELS if needed <= there), None)


def _linux_flags() -> frozenset[str]:
    """What Linux says that every core of this machine has; nothing where it does not say."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return frozenset()
    cores = [frozenset(line.partition(":")[2].split()) for line in lines if line.startswith("flags")]
    return frozenset.intersection(*cores) if cores else frozenset()


def _numpy_level() -> str | None:
    try:
        from numpy._core._multiarray_umath import __cpu_features__ as features
    except ImportError:
        return None
    return next((name for name, needed in _NUMPY if all(features.get(each) for each in needed)), None)
