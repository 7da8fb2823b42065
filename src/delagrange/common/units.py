"""Values with their SI units, as text for a person."""

from __future__ import annotations

from numbers import Real

import numpy as np

_LONGEST = 120  # characters of a foreign object's own text


def with_unit(value: object, unit: str) -> str:
    """`0.5`, `"N"` -> `"0.5 N"`, in one line; a pure number (unit `"1"`) stands alone.

    A unit in words ("the unit of ...") follows an "in". Long arrays are cut short.
    """
    if unit in ("", "1"):
        return shown(value)
    return f"{shown(value)} {'in ' if in_words(unit) else ''}{unit}"


def in_words(unit: str) -> bool:
    """Whether a unit is told in words ("the unit of ...") and not by its symbol."""
    return unit.startswith("the ")


def unit_name(unit: str) -> str:
    """The unit for a reader: `"1"` is a pure number."""
    return "unit 1" if unit == "1" else unit


def shown(value: object) -> str:
    """Whatever a user gave, in one line."""
    if isinstance(value, Real) and not isinstance(value, bool | np.bool_):
        return _number_text(value)
    if isinstance(value, np.ndarray | list | tuple):
        return _array_text(np.asarray(value, dtype=object))
    text = " ".join(line.strip() for line in repr(value).splitlines())
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _number_text(number: Real) -> str:
    try:
        return f"{float(number):.12g}"
    except OverflowError:
        return "more than 1.8e308" if number > 0 else "less than -1.8e308"


def _array_text(array: np.ndarray) -> str:
    """The values, and the shape where it is no plain row."""
    values = [shown(value) for value in (array.ravel() if array.size <= 6 else _ends(array))]
    if array.size > 6:
        values.insert(2, "...")
    shape = f" of shape {array.shape}" if array.ndim > 1 else ""
    count = f" ({array.size} values)" if array.size > 6 else ""
    return f"[{', '.join(values)}]{shape}{count}"


def _ends(array: np.ndarray) -> np.ndarray:
    return array.ravel()[[0, 1, -1]]
