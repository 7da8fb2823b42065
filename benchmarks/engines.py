"""Which engines of this package there are to be measured."""

from __future__ import annotations

from delagrange.common import checks
from delagrange.engines.engines import ENGINES
from delagrange.model.kernels import why_not_compiled


def has_compiled_engine() -> bool:
    """Whether the compiled engine can run on this machine."""
    return "compiled" in ENGINES and why_not_compiled() is None


def chosen_engine(name: str | None) -> str:
    """The engine asked for; else the compiled one, or NumPy's where there is none.

    Raises:
        ValueError: there is no such engine.
    """
    if name is None:
        return "compiled" if has_compiled_engine() else "numpy"
    return checks.choice("engine", name, ENGINES)
