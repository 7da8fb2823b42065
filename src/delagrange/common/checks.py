"""Checks of what a user gives: each failure is a ValueError of one line that says what is allowed."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

import numpy as np

from delagrange.common.roles import Sign
from delagrange.common.units import in_words, shown, unit_name, with_unit

_REAL_KINDS = (
    "iufO"  # integers, floats, and what Python numbers too large for them make: not bool, complex, text
)


def signed(name: str, value: object, unit: str, sign: Sign) -> float | np.ndarray:
    """`value` as float (or float array), all of it finite and of a sign that is allowed."""
    array = _as_float(name, value, unit)
    if not np.all(np.isfinite(array) & sign.allows(array)):
        allowed = "finite" if sign is Sign.ANY else f"{sign.words} and finite"
        raise ValueError(f"{name} must be {allowed}, got {with_unit(value, unit)}")
    return _scalar_or_array(array)


def finite(name: str, value: object, unit: str) -> float | np.ndarray:
    """`value` as float (or float array), all of it finite."""
    return signed(name, value, unit, Sign.ANY)


def positive(name: str, value: object, unit: str) -> float | np.ndarray:
    """`value` as float (or float array), all of it positive and finite."""
    return signed(name, value, unit, Sign.POSITIVE)


def scalar(name: str, value: float | np.ndarray, unit: str) -> float:
    """`value` as one float."""
    if np.ndim(value) != 0:
        raise ValueError(f"{name} must be a single number, got {with_unit(value, unit)}")
    return float(value)


def within(name: str, value: object, unit: str, low: float, high: float) -> float:
    """`value` as one float in the closed interval from `low` to `high`."""
    number = scalar(name, _scalar_or_array(_as_float(name, value, unit)), unit)
    if not low <= number <= high:
        symbol, words = ("1", f" in {unit}") if in_words(unit) else (unit, "")
        allowed = f"from {with_unit(low, symbol)} to {with_unit(high, symbol)}{words}"
        raise ValueError(f"{name} must lie {allowed}, got {with_unit(value, symbol)}")
    return number


def count(name: str, value: object, low: int, high: int | None = None) -> int:
    """`value` as an integer of at least `low` and, where given, at most `high`."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < low or (high is not None and value > high):
        allowed = f"of at least {low}" if high is None else f"from {low} to {high}"
        raise ValueError(f"{name} must be an integer {allowed}, got {shown(value)}")
    return int(value)


def instance(name: str, value: object, kind: type) -> object:
    """`value` if it is a `kind` of this package."""
    if not isinstance(value, kind):
        raise ValueError(f"{name} must be a delagrange.{kind.__name__}, got {shown(value)}")
    return value


def increasing(name: str, values: object, unit: str, or_decreasing: bool = False) -> np.ndarray:
    """`values` as a one-dimensional array, not empty, finite, strictly increasing or, where it may, decreasing."""
    array = np.atleast_1d(finite(name, values, unit))
    if array.ndim != 1 or array.size == 0:
        raise ValueError(
            f"{name} must be a one-dimensional grid of at least one value in {unit}, got {shown(values)}"
        )
    steps = np.diff(array)
    if not (np.all(steps > 0) or (or_decreasing and np.all(steps < 0))):
        either = " or strictly decreasing" if or_decreasing else ""
        raise ValueError(f"{name} must be strictly increasing{either}, got {with_unit(values, unit)}")
    return array


def distinct(name: str, values: object, unit: str) -> np.ndarray:
    """`values` as a one-dimensional array, not empty, finite, no value twice."""
    array = np.atleast_1d(finite(name, values, unit))
    if array.ndim != 1 or array.size == 0:
        raise ValueError(
            f"{name} must be one value or a one-dimensional grid of them in {unit}, got {shown(values)}"
        )
    if len(np.unique(array)) != len(array):
        raise ValueError(f"{name} must not hold a value twice, got {with_unit(values, unit)}")
    return array


def choice(name: str, value: object, allowed: Iterable[str]) -> str:
    """`value` if it is one of `allowed`."""
    allowed = tuple(allowed)
    if not isinstance(value, str) or value not in allowed:
        raise ValueError(
            f"{name} must be one of {', '.join(allowed)}; got {shown(value)}{did_you_mean(value, allowed)}"
        )
    return value


def did_you_mean(value: object, candidates: Iterable[str]) -> str:
    """`" (did you mean 'density'?)"`, or nothing where no candidate is near."""
    near = get_close_matches(str(value), list(candidates), n=1, cutoff=0.5)
    return f" (did you mean {near[0]!r}?)" if near else ""


def _as_float(name: str, value: object, unit: str) -> np.ndarray:
    try:
        if value is not None and np.asarray(value).dtype.kind in _REAL_KINDS:
            return np.asarray(value, dtype=float)
    except OverflowError:
        raise ValueError(f"{name} must be finite, got {with_unit(value, unit)}") from None
    except (TypeError, ValueError):
        pass
    raise ValueError(f"{name} must be a number in {unit_name(unit)}, got {shown(value)}")


def _scalar_or_array(array: np.ndarray) -> float | np.ndarray:
    return float(array) if array.ndim == 0 else array
