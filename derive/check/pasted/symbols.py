"""Which LaTeX symbols a pasted equation may use for the quantities of a model.

The table begins with the notation that each quantity carries; a user's own table, such as a file with

    [symbols]
    "\\\\mu_{0}" = "shear_modulus_alpha"
    "x" = "stretch"                               # its dots and d/dt follow
    "c" = { latex = "\\\\frac{\\\\mu_{0}}{\\\\rho}" }     # an abbreviation, in symbols that stand above it

adds to it, and comes first where both have the same symbol.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from types import MappingProxyType

import sympy as sp

from delagrange.common.checks import did_you_mean
from delagrange.common.units import shown
from delagrange.derive.check.pasted.abbreviation import Abbreviation, read_abbreviation
from delagrange.derive.check.pasted.bounds import check_symbol_length
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.printed.symbol_table import GREEK, Name, SymbolTable, name_of, with_rates
from delagrange.derive.printed.tokens import LatexError

_VARIANTS = MappingProxyType({r"\varepsilon": r"\epsilon", r"\epsilon": r"\varepsilon"})
_UNREADABLE = "p"  # the letter of a parameter whose name is a word: p_{stiffness}


@dataclass(frozen=True)
class SymbolEntry:
    """One line of a user's table: a LaTeX symbol and what it stands for."""

    latex: str
    meaning: str  # the name of a quantity of the model, or the LaTeX that the symbol abbreviates
    abbreviates: bool = False
    place: str = ""  # what errors begin with: "file, line 3: "


@dataclass(frozen=True)
class ModelSymbols:
    """The printed symbols of a model."""

    table: SymbolTable
    names: Mapping[sp.Symbol, Name]  # the symbol that each quantity is printed with by default
    abbreviations: tuple[Abbreviation, ...] = ()


def entries_of(symbols: Mapping[str, object]) -> tuple[SymbolEntry, ...]:
    """A user's table from Python: `{"x": "stretch", "c": {"latex": "..."}}`.

    Raises:
        ValueError: a meaning is neither the name of a quantity nor an abbreviation.
    """
    return tuple(entry(latex, meaning, "") for latex, meaning in symbols.items())


def entry(latex: str, meaning: object, place: str) -> SymbolEntry:
    """One entry of a table as TOML or Python gives it; raises as `entries_of`."""
    if isinstance(meaning, str):
        return SymbolEntry(latex, meaning, False, place)
    if isinstance(meaning, Mapping) and set(meaning) == {"latex"} and isinstance(meaning["latex"], str):
        return SymbolEntry(latex, meaning["latex"], True, place)
    raise ValueError(
        f'{place}symbol {shown(latex)} must stand for the name of a quantity or {{ latex = "..." }}, '
        f"got {shown(meaning)}"
    )


def symbols_of_model(eom: EquationsOfMotion, entries: Iterable[SymbolEntry] = ()) -> ModelSymbols:
    """The table of a model, with a user's entries before its own.

    Raises:
        ValueError: an entry is not one symbol, stands twice, or has a meaning that is not known.
    """
    meanings = _meanings(eom)
    names = _own_names(meanings)
    table = {name: quantity for name, meaning in names for name, quantity in with_rates(name, meaning)}
    for name, meaning in _synonyms(names, eom):
        for spelt, quantity in with_rates(name, meaning):
            table.setdefault(spelt, quantity)
    printed = {
        quantity.symbol: name for name, meaning in names for name, quantity in with_rates(name, meaning)
    }
    return _with_entries(ModelSymbols(_frozen(table), MappingProxyType(printed)), meanings, entries, eom)


def _frozen(entries: Mapping[Name, Quantity]) -> SymbolTable:
    return SymbolTable(MappingProxyType(dict(entries)))


_Meaning = Quantity | TimeDependent


def _meanings(eom: EquationsOfMotion) -> tuple[_Meaning, ...]:
    """Everything that has a symbol: what moves, with its rates, then all that does not."""
    moving = (*eom.load_case.coordinates, *eom.load_case.internals)
    parts = {part for each in moving for part in each.parts}
    still = (each for each in eom.quantities if each not in parts)
    return (*moving, *still)


# --- the model's own notation ----------------------------------------------------------------------


def _own_names(meanings: tuple[_Meaning, ...]) -> tuple[tuple[Name, _Meaning], ...]:
    """One symbol for each meaning, no two alike."""
    taken: dict[Name, _Meaning] = {}
    for meaning in meanings:
        quantity = meaning if isinstance(meaning, Quantity) else meaning.value
        free = (name for name in _candidates(quantity) if name not in taken)
        taken[next(free)] = meaning
    return tuple(taken.items())


def _candidates(quantity: Quantity) -> Iterator[Name]:
    """The quantity's notation where it is one symbol, else p with its name as a subscript."""
    with suppress(LatexError):
        yield name_of(_single_symbol(quantity.latex))
    plain = quantity.name.replace("_", ",")
    yield Name(_UNREADABLE, plain)
    number = 2
    while True:
        yield Name(_UNREADABLE, f"{plain},{number}")
        number += 1


def _single_symbol(latex: str) -> str:
    r"""The notation of a user's own name as one symbol: `\mathrm{mu}_{3}` is `\mu_{3}`, `theta` is `\theta`."""
    end = min((at for mark in "_^" if (at := latex.find(mark)) >= 0), default=len(latex))
    word = latex[:end]
    if word.startswith(r"\mathrm{"):
        word = word.removeprefix(r"\mathrm{").removesuffix("}")
    return f"\\{word}{latex[end:]}" if f"\\{word}" in GREEK else f"{word}{latex[end:]}"


def _synonyms(
    names: tuple[tuple[Name, _Meaning], ...], eom: EquationsOfMotion
) -> Iterator[tuple[Name, _Meaning]]:
    for name, meaning in names:
        for spelt in (name, *_short_names(meaning, name, eom)):
            yield from ((variant, meaning) for variant in _spellings(spelt))


def _spellings(name: Name) -> Iterator[Name]:
    r"""Other ways to write a symbol: `\epsilon`, `\mu_{\alpha}` for `\mu^{\alpha}`, `\xi_{12}` for `\xi_{1,2}`."""
    yield name
    if name.letter in _VARIANTS:
        yield replace(name, letter=_VARIANTS[name.letter])
    if name.label and not name.subscript:
        yield replace(name, subscript=name.label, label="")
    if "," in name.subscript:
        yield replace(name, subscript=name.subscript.replace(",", ""))


def _short_names(meaning: _Meaning, name: Name, eom: EquationsOfMotion) -> Iterator[Name]:
    r"""`\lambda` for the only stretch, `\lambda_1` for the first of two; so for inelastic stretches."""
    for moving in (eom.load_case.coordinates, eom.load_case.internals):
        if meaning in moving and len(moving) == 1:
            yield Name(name.letter)
        if meaning in moving and len(moving) == len(eom.load_case.coordinates) == 2:
            yield Name(name.letter, str(moving.index(meaning) + 1))


# --- a user's table ----------------------------------------------------------------------------------


def _with_entries(
    symbols: ModelSymbols,
    meanings: tuple[_Meaning, ...],
    entries: Iterable[SymbolEntry],
    eom: EquationsOfMotion,
) -> ModelSymbols:
    known = _by_name(meanings)
    table, found, seen = dict(symbols.table.entries), [], set()
    for each in entries:
        name = _key(each)
        if name in seen:
            raise ValueError(f"{each.place}symbol {each.latex} stands twice in the table of symbols")
        seen.add(name)
        if each.abbreviates:
            own = read_abbreviation(name, each.meaning, _frozen(table), tuple(found), each.place)
            found.append(own)
            table[name] = own.placeholder
        else:
            table.update(with_rates(name, _meaning(each, name, known, eom.load_case.name)))
    return ModelSymbols(_frozen(table), symbols.names, tuple(found))


def _by_name(meanings: tuple[_Meaning, ...]) -> dict[str, _Meaning]:
    """What a user's table may name; a coordinate brings its rates, which have names of their own as well."""
    rates = (part for each in meanings if isinstance(each, TimeDependent)
             for part in (each.rate, each.acceleration))  # fmt: skip
    known: dict[str, _Meaning] = {part.name: part for part in rates}
    for each in meanings:
        known[each.name if isinstance(each, Quantity) else each.value.name] = each
    return known


def _key(each: SymbolEntry) -> Name:
    try:
        check_symbol_length(each.latex)
        return name_of(each.latex)
    except ValueError as error:
        raise ValueError(f"{each.place}symbol {shown(each.latex)} is not one symbol: {error}") from None


def _meaning(each: SymbolEntry, name: Name, known: Mapping[str, _Meaning], model: str) -> _Meaning:
    if each.meaning not in known:
        near = did_you_mean(each.meaning, known) or f"; known are {', '.join(known)}"
        raise ValueError(
            f"{each.place}symbol {each.latex} stands for {shown(each.meaning)}, no quantity of {model}{near}"
        )
    meaning = known[each.meaning]
    if name.dots and isinstance(meaning, TimeDependent):
        raise ValueError(
            f"{each.place}symbol {each.latex} has dots and stands for {each.meaning}; give the symbol without "
            "dots, its rates follow"
        )
    return meaning
