"""Checks of what a user gives: each failure is a ValueError of one line that says what is allowed."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

import numpy as np

from delagrange.units import with_unit


def finite(name: str, value: object, unit: str) -> float | np.ndarray:
    """`value` as float (or float array), all of it finite."""
    array = _as_float(name, value, unit)
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, got {with_unit(value, unit)}")
    return _scalar_or_array(array)


def positive(name: str, value: object, unit: str) -> float | np.ndarray:
    """`value` as float (or float array), all of it positive and finite."""
    array = _as_float(name, value, unit)
    if not np.all(np.isfinite(array) & (array > 0)):
        raise ValueError(f"{name} must be positive and finite, got {with_unit(value, unit)}")
    return _scalar_or_array(array)


def scalar(name: str, value: float | np.ndarray, unit: str) -> float:
    """`value` as one float."""
    if np.ndim(value) != 0:
        raise ValueError(f"{name} must be a single number, got {with_unit(value, unit)}")
    return float(value)


def within(name: str, value: object, unit: str, low: float, high: float) -> float:
    """`value` as one float in the closed interval from `low` to `high`."""
    number = scalar(name, _scalar_or_array(_as_float(name, value, unit)), unit)
    if not low <= number <= high:
        allowed = f"from {with_unit(low, unit)} to {with_unit(high, unit)}"
        raise ValueError(f"{name} must lie {allowed}, got {with_unit(value, unit)}")
    return number


def count(name: str, value: object, low: int) -> int:
    """`value` as an integer of at least `low`."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < low:
        raise ValueError(f"{name} must be an integer of at least {low}, got {value!r}")
    return int(value)


def increasing(name: str, values: object, unit: str) -> np.ndarray:
    """`values` as a one-dimensional array, not empty, finite, strictly increasing."""
    array = np.atleast_1d(finite(name, values, unit))
    if array.ndim != 1 or array.size == 0:
        raise ValueError(
            f"{name} must be a one-dimensional grid of at least one value in {unit}, got {values!r}"
        )
    if np.any(np.diff(array) <= 0):
        raise ValueError(f"{name} must be strictly increasing, got {with_unit(values, unit)}")
    return array


def distinct(name: str, values: object, unit: str) -> np.ndarray:
    """`values` as a one-dimensional array, not empty, finite, no value twice."""
    array = np.atleast_1d(finite(name, values, unit))
    if array.ndim != 1 or array.size == 0:
        raise ValueError(
            f"{name} must be one value or a one-dimensional grid of them in {unit}, got {values!r}"
        )
    if len(np.unique(array)) != len(array):
        raise ValueError(f"{name} must not hold a value twice, got {with_unit(values, unit)}")
    return array


def choice(name: str, value: object, allowed: Iterable[str]) -> str:
    """`value` if it is one of `allowed`."""
    allowed = tuple(allowed)
    if value not in allowed:
        raise ValueError(
            f"{name} must be one of {', '.join(allowed)}; got {value!r}{did_you_mean(value, allowed)}"
        )
    return str(value)


def did_you_mean(value: object, candidates: Iterable[str]) -> str:
    """`" (did you mean 'density'?)"`, or nothing where no candidate is near."""
    near = get_close_matches(str(value), list(candidates), n=1, cutoff=0.5)
    return f" (did you mean {near[0]!r}?)" if near else ""


def _as_float(name: str, value: object, unit: str) -> np.ndarray:
    if isinstance(value, bool | np.bool_ | str) or value is None:
        raise ValueError(f"{name} must be a number in {_unit_name(unit)}, got {value!r}")
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be a number in {_unit_name(unit)}, got {value!r}") from None


def _unit_name(unit: str) -> str:
    return "unit 1" if unit == "1" else unit


def _scalar_or_array(array: np.ndarray) -> float | np.ndarray:
    return float(array) if array.ndim == 0 else array
