"""On what registers the compiled kernel does its arithmetic, by its assembly."""

from __future__ import annotations

import re
import tempfile

from benchmarks.cases import CASES
from benchmarks.child import in_child
from benchmarks.machine import full_width

NOT_FULL = "NOT vectorised at full width"
_ARITHMETIC = re.compile(
    r"^\s+v?(?:fn?m(?:add|sub)\d{3}|add|sub|mul|div|sqrt)(?P<kind>[ps])d\s+(?P<operands>.*)$", re.MULTILINE
)
_PACKED = ("zmm", "ymm", "xmm")


def arithmetic(assembly: str) -> dict[str, int]:
    """Arithmetic instructions on doubles: packed, by register, and scalar."""
    counts = dict.fromkeys((*_PACKED, "scalar"), 0)
    for found in _ARITHMETIC.finditer(assembly):
        registers = (name for name in _PACKED if f"%{name}" in found["operands"])
        counts["scalar" if found["kind"] == "s" else next(registers, "xmm")] += 1
    return counts


def summary(counts: dict[str, int], full: str) -> dict[str, object]:
    """The width of most packed arithmetic, its share of all arithmetic, and whether it is the machine's."""
    width = max(_PACKED, key=counts.__getitem__)
    total = sum(counts.values())
    packed = counts[width] > 0
    return {
        "counts": counts,
        "width": width if packed else "none",
        "share": counts[width] / total if total else 0.0,
        "full": packed and _PACKED.index(width) <= _PACKED.index(full),
    }


def of_kernels(models: list[str]) -> dict[str, dict[str, int]]:
    """Arithmetic of freshly compiled kernels, by model; in a process with an empty cache of compiled code,
    since what comes from the cache has no assembly."""
    from delagrange.model.kernels import kernel_name, load_kernel
    from delagrange.model.load import load_model

    kernels = {model: load_kernel(kernel_name(load_model(model))) for model in models}
    return {
        model: arithmetic("\n".join(kernel.integrate.inspect_asm().values()))
        for model, kernel in kernels.items()
    }


def measured() -> dict[str, object]:
    """Both models' kernels; JSON."""
    models = [case.model for case in CASES.values()]
    with tempfile.TemporaryDirectory() as folder:
        counts = in_child("assembly", {"models": models}, {"NUMBA_CACHE_DIR": folder})
    full = full_width()
    return {"machine_width": full, "models": {model: summary(one, full) for model, one in counts.items()}}


def failures(numbers: dict) -> list[str]:
    """A line for every model whose kernel does not use the machine's width."""
    machine = numbers["machine_width"]
    return [
        f"{NOT_FULL}: {model}, {one['width']} where the machine has {machine}"
        for model, one in numbers["models"].items()
        if not one["full"]
    ]
