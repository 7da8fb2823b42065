"""Which engines of this package there are to be measured."""

from __future__ import annotations

from delagrange import checks
from delagrange.engines import ENGINES


def has_compiled_engine() -> bool:
    return "compiled" in ENGINES


def chosen_engine(name: str | None) -> str:
    """The engine asked for; else the compiled one, or NumPy's where there is none.

    Raises:
        ValueError: there is no such engine.
    """
    if name is None:
        return "compiled" if has_compiled_engine() else "numpy"
    return checks.choice("engine", name, ENGINES)
