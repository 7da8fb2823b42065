"""What was measured on: processor, system, versions; no name of the machine, no path."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

from benchmarks.timing import core_count

PACKAGES = ("delagrange", "numpy", "scipy", "xarray", "sympy", "numba", "llvmlite", "heyoka", "matplotlib")


def facts() -> dict[str, object]:
    """Processor, cores that may be used, its vectors, system, versions."""
    return {
        "processor": processor(),
        "cores": core_count(),
        "vectors": vectors(),
        "system": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "packages": {name: _version(name) for name in PACKAGES},
    }


def processor() -> str:
    """The model name, with family and model number where the name alone says little."""
    entries = _cpu_entries()
    name = entries.get("model name") or platform.processor() or platform.machine()
    numbers = [f"{key} {entries[name_]}" for key, name_ in _NUMBERS if name_ in entries]
    return f"{name} ({', '.join(numbers)})" if numbers else name


_NUMBERS = (("family", "cpu family"), ("model", "model"))


def vectors() -> str:
    """The widest vectors of doubles that the processor has."""
    flags = _cpu_entries().get("flags", "").split()
    return "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "other"


def full_width() -> str:
    """The registers that hold those vectors."""
    return {"AVX-512": "zmm", "AVX2": "ymm"}.get(vectors(), "xmm")


def _cpu_entries() -> dict[str, str]:
    """What Linux says of the first processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            lines = file.read().split("\n\n")[0].splitlines()
    except OSError:
        return {}
    return {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
