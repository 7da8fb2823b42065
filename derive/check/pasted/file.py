"""Files of equations to check, and of what their symbols stand for. Nothing in them is run.

A TOML file of equations, which may hold their symbols as well:

    citation = "Author (year), journal, doi"

    [[equation]]
    number = "9"
    latex = '\\ddot{x} + c x = 0'              # three quotes for several lines
    quantity = "equation_of_motion_1"         # optional: what it states
    note = "as printed"                       # optional

    [symbols]                                 # also in a file of its own
    "x" = "stretch"

Any other file is text: one equation a line; lines that are empty or begin with # say nothing.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from delagrange.derive.check.pasted.check import PastedEquation
from delagrange.derive.check.pasted.symbols import SymbolEntry, entry
from delagrange.derive.model_file.toml_table import Keys, ModelError, Table, read_toml, text_of

MOST_EQUATIONS = 200
_ADDRESS = (
    "citation",
    "source",
    "address",
    "note",
)  # of the file as a whole: for a reader, not for the check


@dataclass(frozen=True)
class PastedFile:
    """What a file holds."""

    equations: tuple[PastedEquation, ...]
    symbols: tuple[SymbolEntry, ...] = ()


def read_equations(path: Path) -> PastedFile:
    """The equations of a file, and their symbols where it says them.

    Raises:
        ModelError: it cannot be read, is not understood, or holds no equation or too many.
    """
    found = _of_toml(path) if path.suffix == ".toml" else PastedFile(_of_text(path))
    if not 1 <= len(found.equations) <= MOST_EQUATIONS:
        raise ModelError(f"{path}: holds {len(found.equations)} equations; allowed are 1 to {MOST_EQUATIONS}")
    return found


def read_symbols(path: Path) -> tuple[SymbolEntry, ...]:
    """The table [symbols] of a TOML file.

    Raises:
        ModelError: it cannot be read, has no such table, or an entry has no meaning.
    """
    whole = read_toml(path)
    whole.only("symbols", "equation", *_ADDRESS)
    if "symbols" not in whole:
        whole.refuse("the file needs a table [symbols]")
    return _symbols(path, whole)


def _of_toml(path: Path) -> PastedFile:
    whole = read_toml(path)
    whole.only("equation", "symbols", *_ADDRESS)
    equations = tuple(_equation(table) for table in whole.tables("equation"))
    return PastedFile(equations, _symbols(path, whole))


def _equation(table: Table) -> PastedEquation:
    table.only("number", "latex", "quantity", *_ADDRESS)
    texts = {key: table.text(key) for key in table.values}
    latex = table.text("latex")
    line = table.lines.get((*table.keys, "latex"), 1)
    return PastedEquation(
        latex, texts.get("number", "").strip(), texts.get("quantity"), texts.get("note", ""),
        f"{table.file}, line {line}: ",
    )  # fmt: skip


def _of_text(path: Path) -> tuple[PastedEquation, ...]:
    lines = enumerate(text_of(path, "file of equations").splitlines(), start=1)
    return tuple(
        PastedEquation(line.strip(), place=f"{path}, line {number}: ")
        for number, line in lines
        if line.strip() and not line.lstrip().startswith("#")
    )


def _symbols(path: Path, whole: Table) -> tuple[SymbolEntry, ...]:
    table = whole.table("symbols")
    placed = replace(table, lines={**table.lines, **_lines_of_symbols(text_of(path, "file of equations"))})
    return tuple(_symbol(placed, key, meaning) for key, meaning in table.values.items())


def _symbol(table: Table, key: str, meaning: object) -> SymbolEntry:
    line = next((table.lines[keys] for keys in ((*table.keys, key), table.keys) if keys in table.lines), 1)
    try:
        return entry(key, meaning, f"{table.file}, line {line}: ")
    except ValueError as error:
        raise ModelError(str(error)) from None


def _lines_of_symbols(text: str) -> dict[Keys, int]:
    """The line of each symbol: what stands before its =, read as TOML, so that its quotes are understood."""
    lines: dict[Keys, int] = {}
    for number, line in enumerate(text.split("\n"), start=1):
        before, equals, _ = line.partition("=")
        if equals:
            for key in _keys(before):
                lines.setdefault(("symbols", key), number)
    return lines


def _keys(text: str) -> tuple[str, ...]:
    try:
        return tuple(tomllib.loads(f"{text} = 0"))
    except (ValueError, RecursionError):
        return ()
