"""Numbers, ranges and tables as a person types them, with errors that name the unit."""

from __future__ import annotations

import csv
from collections.abc import Callable
from itertools import chain
from pathlib import Path

import numpy as np
import typer

from delagrange.common import checks
from delagrange.common.units import unit_name

_LONGEST_RANGE = 1_000_000  # values; longer ones are slips of the step
_WITHIN = 1e-9  # of a step: rounding that does not cost a range its last value


def number(name: str, text: str, unit: str) -> float:
    """The number that `text` says.

    Raises:
        ValueError: it says none.
    """
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{name} must be a number in {unit_name(unit)}, got {text!r}") from None


def reader(unit: str) -> Callable[[str], float]:
    """What Typer calls to read an option in the given unit."""

    def read(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            raise typer.BadParameter(f"{text!r} is not a number in {unit_name(unit)}") from None

    return read


def axis(name: str, texts: list[str] | None, unit: str) -> float | np.ndarray | None:
    """All values of a repeatable option, each a number, a comma list or a range START:STOP:STEP.

    A range holds STOP where a step lands on it. One value alone is a number, none at all None.

    Raises:
        ValueError: not a number, or a range that is empty, endless or longer than a million values.
    """
    if not texts:
        return None
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
    """START, STOP [unit], DURATION and, where given, BEGIN [s] of a ramp.

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


def window(text: str | None) -> tuple[float, float] | None:
    """START and STOP [s] of a window.

    Raises:
        ValueError: another form.
    """
    if text is None:
        return None
    start, stop = _fields("window", text, "START:STOP in s", ("s", "s"))
    return start, stop


def table(name: str, path: Path, unit: str) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and values [unit] of a CSV file of two columns; one line of headings may come first.

    Raises:
        ValueError: the file cannot be read, a line (named) is not two numbers, there are fewer than two
            lines of them, a number is not finite, or the times do not increase.
    """
    what = f"{name} table {path}"
    rows = _rows(what, path)
    if rows and not any(map(_is_number, rows[0][1])):
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


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
