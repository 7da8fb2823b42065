"""Quantities, ranges and tables as a person types them, with errors that name the unit."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from delagrange.common import checks
from delagrange.common.checks import did_you_mean
from delagrange.common.quantity_text import typed_quantity
from delagrange.common.units import unit_name

Values = float | np.ndarray

_LONGEST_RANGE = 1_000_000  # values; longer ones are slips of the step
_SPAN_STEPS = 500  # of a range without a step
_WITHIN = 1e-9  # of a step: rounding that does not cost a range its last value


def number(name: str, text: str | float, unit: str) -> float:
    """The number in `unit` that a text says: bare, or with a unit of its own as `5MV/m`; a default is one already.

    Raises:
        ValueError: it says none, or in a unit of another dimension.
    """
    return typed_quantity(name, text, unit) if isinstance(text, str) else text


def finite(name: str, text: str | float, unit: str) -> float:
    """As `number`, and finite.

    Raises:
        ValueError: as `number`; infinite or not a number.
    """
    return checks.finite(name, number(name, text, unit), unit)


def axis(name: str, texts: list[str], unit: str) -> float | np.ndarray:
    """All values of a repeatable option, each a number, a comma list or a range START:STOP:STEP.

    A range holds STOP where a step lands on it. One value alone is a number.

    Raises:
        ValueError: not a number, or a range that is empty, endless or longer than a million values.
    """
    parts = chain.from_iterable(text.split(",") for text in texts)
    values = np.concatenate([_values(name, part.strip(), unit) for part in parts])
    return float(values[0]) if len(values) == 1 else values


def _values(name: str, text: str, unit: str) -> np.ndarray:
    if ":" not in text:
        return np.array([number(name, text, unit)])
    return _range(name, text, unit)


def _range(name: str, text: str, unit: str) -> np.ndarray:
    start, stop, step = _fields(name, text, f"START:STOP:STEP in {unit_name(unit)}", (unit,) * 3)
    if not np.all(np.isfinite([start, stop, step])) or step <= 0 or stop < start:
        raise ValueError(
            f"{name} range {text!r} in {unit_name(unit)} is empty or endless; START:STOP:STEP needs "
            "START <= STOP, STEP > 0, all finite"
        )
    steps = (stop - start) / step
    if steps >= _LONGEST_RANGE:
        raise ValueError(f"{name} range {text!r} in {unit_name(unit)} has more than {_LONGEST_RANGE} values")
    return start + step * np.arange(int(steps + _WITHIN) + 1)


def _fields(
    name: str, text: str, form: str, units: tuple[str, ...], fewest: int | None = None
) -> list[float]:
    """The numbers between colons, one a unit, of which those after the `fewest` may be left out."""
    parts = text.split(":")
    if not (fewest or len(units)) <= len(parts) <= len(units):
        raise ValueError(f"{name} must be {form}, got {text!r}")
    return [number(f"{name} {text!r}", part, unit) for part, unit in zip(parts, units, strict=False)]


def ramp(name: str, text: str, unit: str) -> list[float]:
    """START, STOP [unit], DURATION and, where given, BEGIN [s], of a ramp in that order.

    Raises:
        ValueError: another form, a number that is not finite, or a duration that is not positive.
    """
    form = f"START:STOP:DURATION or START:STOP:DURATION:BEGIN, START and STOP in {unit}, times in s"
    units = (unit, unit, "s", "s")
    numbers = _fields(name, text, form, units, fewest=3)
    for part, given, its_unit in zip(("start", "stop", "duration", "begin"), numbers, units, strict=False):
        check = checks.positive if part == "duration" else checks.finite
        check(f"{name} {part}", given, its_unit)
    return numbers


def window(name: str, text: str, _unit: str = "s") -> tuple[float, float]:
    """START and STOP [s] of a window.

    Raises:
        ValueError: another form.
    """
    start, stop = _fields(name, text, "START:STOP in s", ("s", "s"))
    return start, stop


@dataclass(frozen=True)
class Span:
    """A range from one end to another, START:STOP or START:STOP:STEP."""

    start: float
    stop: float
    step: float | None

    @property
    def ends(self) -> tuple[float, float]:
        """START and STOP."""
        return self.start, self.stop

    def values(self) -> np.ndarray:
        """Increasing, both ends included as far as steps land on them; 501 of them where no step is given."""
        low, high = sorted(self.ends)
        step = (high - low) / _SPAN_STEPS if self.step is None else self.step
        return low + step * np.arange(int((high - low) / step + _WITHIN) + 1)


def span(name: str, text: str, unit: str) -> float | Span:
    """A number, or the range along which it varies.

    Raises:
        ValueError: neither.
    """
    parts = [number(name, part, unit) for part in text.split(":")]
    if len(parts) == 1:
        return parts[0]
    finite = bool(np.all(np.isfinite(parts)))
    if len(parts) > 3 or not finite or parts[0] == parts[1] or (len(parts) == 3 and parts[2] <= 0):
        raise ValueError(
            f"{name} must be a number or START:STOP or START:STOP:STEP in {unit_name(unit)} with two distinct finite "
            f"ends and STEP > 0, got {text!r}"
        )
    return Span(parts[0], parts[1], parts[2] if len(parts) == 3 else None)


def by_name(option: str, texts: list[str] | None, units: Mapping[str, str], what: str) -> dict[str, Values]:
    """All values of each NAME=VALUES that an option was given, by name; hyphens count as underscores.

    units: by the names that are known; what: that they name

    Raises:
        ValueError: another form, a name without a unit in `units`, or values that are no numbers or ranges.
    """
    collected: dict[str, list[str]] = {}
    known = ", ".join(f"{key} [{unit}]" for key, unit in units.items()) or "none"
    for text in texts or ():
        name, equals, values = text.partition("=")
        name = name.strip().replace("-", "_")
        if not equals:
            raise ValueError(f"{option} must be NAME=VALUES, NAME one of {known}; got {text!r}")
        if name not in units:
            raise ValueError(
                f"{option} {text!r} names no {what}{did_you_mean(name, units)}; known are {known}"
            )
        collected.setdefault(name, []).append(values)
    return {name: axis(f"{option} {name}", values, units[name]) for name, values in collected.items()}


def table(name: str, path: Path, unit: str) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and values [unit] of a CSV file of two columns; one line of headings may come first.

    Raises:
        ValueError: the file cannot be read, a line (named) is not two numbers, there are fewer than two
            lines of them, a number is not finite, or the times do not increase.
    """
    what = f"{name} table {path}"
    rows = _rows(what, path)
    if rows and not any(map(_is_value, rows[0][1], ("s", unit))):
        rows = rows[1:]
    pairs = [_pair(f"{what}, line {k}", row, unit) for k, row in rows]
    if len(pairs) < 2:
        held = f"holds {len(pairs)} line" if pairs else "is empty"
        raise ValueError(f"{what} {held}; needed are two or more lines of time [s] and value [{unit}]")
    times, values = np.array(pairs).T
    return checks.increasing(f"{what}: time", times, "s"), checks.finite(f"{what}: value", values, unit)


def _rows(what: str, path: Path) -> list[tuple[int, list[str]]]:
    """The rows that are not empty, with their numbers; a byte order mark of a spreadsheet is no part of one."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return [(k, row) for k, row in enumerate(csv.reader(file), start=1) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{what} cannot be read: {getattr(error, 'strerror', None) or error}") from error


def _pair(place: str, row: list[str], unit: str) -> tuple[float, float]:
    if len(row) != 2:
        raise ValueError(f"{place}: needed are time [s] and value [{unit}], got {len(row)} columns")
    return number(f"{place}: time", row[0], "s"), number(f"{place}: value", row[1], unit)


def _is_value(text: str, unit: str) -> bool:
    try:
        number("", text, unit)
    except ValueError:
        return False
    return True
