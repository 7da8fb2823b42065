"""A TOML file as tables that know their place, so that each error names the file, the line and the key.

`tomllib` keeps no lines of values; they are found by scanning the text for headings and keys.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from delagrange.common.checks import did_you_mean
from delagrange.common.quantity_text import read_quantity
from delagrange.common.roles import Sign
from delagrange.common.units import shown, with_unit
from delagrange.derive.notation.symbols import Quantity

Keys = tuple[str | int, ...]  # ("branch", 1, "viscosity"): the array's second table

_LARGEST = 200_000  # bytes of a file
_MOST_DOTS = 2000  # in a file; the standard reader takes minutes for keys of very many parts
_HEADING = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"""\s*([A-Za-z0-9_."'-]+(?:\s*\.\s*[A-Za-z0-9_"'-]+)*)\s*=""")


class ModelError(ValueError):
    """What a model file says and must not, with file, line and key, in one line."""


@dataclass(frozen=True)
class Table:
    """A table of the file."""

    file: str
    lines: Mapping[Keys, int]  # line, from 1, of each heading and key
    keys: Keys  # where the table stands; () for the file as a whole
    values: Mapping[str, Any]

    def __contains__(self, key: str) -> bool:
        return key in self.values

    @property
    def title(self) -> str:
        """The table's name for an error: "[[branch]] 2"."""
        if not self.keys:
            return "the file"
        *stem, last = self.keys
        return f"[[{_dotted(stem)}]] {last + 1}" if isinstance(last, int) else f"[{_dotted(self.keys)}]"

    def refuse(self, reason: str, key: str | None = None) -> NoReturn:
        """Raise the error for the table, or for one of its keys."""
        keys = self.keys if key is None else (*self.keys, key)
        line = next((self.lines[keys[:n]] for n in range(len(keys), -1, -1) if keys[:n] in self.lines), 1)
        raise ModelError(f"{self.file}, line {line}: {' '.join(reason.split())}")

    def only(self, *allowed: str) -> None:
        """Refuse keys that have no meaning here, with the nearest one that has."""
        for key in self.values:
            if key not in allowed:
                near = did_you_mean(key, allowed)
                self.refuse(
                    f"unknown key {shown(key)} in {self.title}{near}; allowed are {', '.join(allowed)}", key
                )

    def one_of(self, *keys: str) -> str:
        """The one key of several that is there."""
        there = [key for key in self.values if key in keys]
        if len(there) != 1:
            found = f"has {' and '.join(there)}" if there else "has none of them"
            self.refuse(
                f"{self.title} must have one of {', '.join(keys)}, and {found}", there[-1] if there else None
            )
        return there[0]

    def needed(self, key: str) -> Any:
        if key not in self:
            self.refuse(f"{self.title} needs a value of {key}")
        return self.values[key]

    def value_of(self, key: str, quantity: Quantity) -> float:
        """The value of a key that stands for a quantity of the model, in its SI unit.

        Raises:
            ModelError: as `number`.
        """
        return self.number(key, quantity.unit, quantity.sign)

    def number(self, key: str, unit: str, sign: Sign = Sign.POSITIVE) -> float:
        """The value of a key in an SI unit; it may carry a unit of its own ("42 kPa").

        Raises:
            ModelError: it is missing, no number, of another dimension, or of a sign that is not allowed.
        """
        value = self.needed(key)
        try:
            number = read_quantity(key, value, unit)
        except ValueError as error:
            self.refuse(str(error), key)
        if not sign.allows(number):
            given = shown(value) if isinstance(value, str) else with_unit(value, unit)
            self.refuse(f"{key} must be {sign.words}, got {given}", key)
        return number

    def text(self, key: str) -> str:
        value = self.needed(key)
        if not isinstance(value, str) or not value.strip():
            self.refuse(f"{key} must be a text that is not empty, got {shown(value)}", key)
        return value

    def plain_text(self, key: str, value: object = None) -> str:
        """A text that can stand in a comment of emitted code: one line, no quotation marks, no backslash."""
        text = self.text(key) if value is None else value
        fine = (
            isinstance(text, str)
            and 0 < len(text) <= 200
            and text.isprintable()
            and not set(text) & set('"\\`{}')
        )
        if not fine:
            allowed = 'up to 200 printable characters in one line, without " \\ ` { }'
            self.refuse(f"{key} must be a text of {allowed}, got {shown(text)}", key)
        return text

    def choice(self, key: str, allowed: Iterable[str], default: str | None = None) -> str:
        """A text that is one of those allowed."""
        allowed = tuple(allowed)
        value = self.needed(key) if default is None else self.values.get(key, default)
        if not isinstance(value, str) or value not in allowed:
            near = did_you_mean(value, allowed)
            self.refuse(f"{key} must be one of {', '.join(allowed)}; got {shown(value)}{near}", key)
        return value

    def choice_of_name(self, key: str, form: re.Pattern[str], taken: Iterable[str]) -> str:
        """A text that can be the name of something new."""
        name = self.text(key)
        if not form.fullmatch(name):
            self.refuse(f"{key} must be a name of the form {form.pattern}, got {shown(name)}", key)
        if name in taken:
            self.refuse(f"{key} cannot be {name!r}: that has a meaning of its own", key)
        return name

    def sequence(self, key: str) -> list:
        value = self.needed(key)
        if not isinstance(value, list) or not value:
            self.refuse(f"{key} must be a list that is not empty, got {shown(value)}", key)
        return value

    def table(self, key: str) -> Table:
        """The table of a name; an empty one, at this place, where there is none."""
        value = self.values.get(key, {})
        if not isinstance(value, dict):
            self.refuse(
                f"{key} must be a table, written [{_dotted((*self.keys, key))}], got {shown(value)}", key
            )
        return Table(self.file, self.lines, (*self.keys, key), value)

    def tables(self, key: str) -> tuple[Table, ...]:
        """The tables of an array in their order; none where there is no array."""
        value = self.values.get(key, [])
        if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
            self.refuse(
                f"{key} must be tables, each written [[{_dotted((*self.keys, key))}]], got {shown(value)}",
                key,
            )
        return tuple(
            Table(self.file, self.lines, (*self.keys, key, number), each) for number, each in enumerate(value)
        )


def read_toml(path: Path) -> Table:
    """The tables of a file.

    Raises:
        ModelError: it cannot be read, is larger than 200 kB, or is no TOML.
    """
    text = text_of(path, "model file")
    if text.count(".") > _MOST_DOTS:
        raise ModelError(f"{path}: more than {_MOST_DOTS} dots, which no model file has")
    try:
        values = tomllib.loads(text)
    except RecursionError:
        raise ModelError(f"{path}: values are nested too deep") from None
    except ValueError as error:
        raise ModelError(f"{path}: not understood as TOML: {' '.join(str(error).split())}") from None
    return Table(str(path), lines_of(text), (), values)


def text_of(path: Path, kind: str) -> str:
    """The text of a user's file.

    Raises:
        ModelError: it cannot be read, or is larger than 200 kB, which no `kind` of file is.
    """
    try:
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise ModelError(f"{path}: larger than {_LARGEST} bytes, which no {kind} is")
        return content.decode("utf-8-sig")
    except OSError as error:
        raise ModelError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ModelError(f"{path}: cannot be read: byte {error.start} is no UTF-8") from None


def lines_of(text: str) -> dict[Keys, int]:
    """The line, from 1, of each heading and each key of a TOML text."""
    lines: dict[Keys, int] = {}
    table: Keys = ()
    counts: dict[Keys, int] = {}
    for number, line in _outside_of_long_texts(text):
        if heading := _HEADING.match(line):
            table = _absolute(_keys(heading[2]), counts, is_array=heading[1] == "[[")
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            lines.setdefault((*table, *_keys(key[1])), number)
    return lines


def _absolute(keys: Keys, counts: dict[Keys, int], *, is_array: bool) -> Keys:
    """Put in the number of each array's table: a heading below an array is in its last table."""
    found: Keys = ()
    for place, key in enumerate(keys):
        found = (*found, key)
        if is_array and place == len(keys) - 1:
            counts[found] = counts.get(found, -1) + 1
        if found in counts:
            found = (*found, counts[found])
    return found


def _keys(text: str) -> Keys:
    return tuple(part.strip().strip("\"'") for part in text.split("."))


def _outside_of_long_texts(text: str) -> Iterator[tuple[int, str]]:
    """The lines with their numbers, without those that continue a text in three quotes."""
    closing = ""
    for number, line in enumerate(text.split("\n"), start=1):
        if not closing:
            yield number, line
            closing = next((mark for mark in ('"""', "'''") if line.count(mark) % 2), "")
        elif line.count(closing) % 2:
            closing = ""


def _dotted(keys: Iterable[str | int]) -> str:
    return ".".join(str(key) for key in keys if isinstance(key, str))
