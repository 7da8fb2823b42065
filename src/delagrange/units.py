"""Values with their SI units, as text for a person."""

from __future__ import annotations

from numbers import Real

import numpy as np


def with_unit(value: object, unit: str) -> str:
    """`0.5`, `"N"` -> `"0.5 N"`; a pure number (unit `"1"`) stands alone; long arrays are cut short."""
    return f"{_text(value)}" if unit in ("", "1") else f"{_text(value)} {unit}"


def _text(value: object) -> str:
    if isinstance(value, Real) and not isinstance(value, bool):
        return f"{float(value):.12g}"
    if isinstance(value, np.ndarray | list | tuple):
        return _array_text(np.asarray(value, dtype=object).ravel())
    return repr(value)


def _array_text(values: np.ndarray) -> str:
    if len(values) <= 6:
        return "[" + ", ".join(_text(value) for value in values) + "]"
    return f"[{_text(values[0])}, {_text(values[1])}, ... {_text(values[-1])}] ({len(values)} values)"
