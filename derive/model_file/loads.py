"""The load of a model file: what a frame holds, which forces it applies, or a relation of the user's own.

kind = "equal_biaxial" | "uniaxial" | "biaxial"

kind = "pure_shear"
held_stretch = 2                      # at which axis 2 is held
lateral_dashpots = "free"             # or "held": whether dashpots flow along axis 2

kind = "relation"                     # both stretches follow one coordinate
coordinate = "q"
lambda_1 = "q"
lambda_2 = "q^-a"
start = 1                             # value of q in the reference state, any number
forces = [1]                          # axes along which forces are applied
[load.parameters]
a = 0.3
"""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Mapping

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.common.roles import Sign
from delagrange.common.units import shown
from delagrange.derive.membrane.description import BIAXIAL, EQUAL_BIAXIAL, PURE_SHEAR, RELATION, UNIAXIAL
from delagrange.derive.model_file.entries import Constant, LoadEntry, RelationEntry
from delagrange.derive.model_file.expression import FUNCTIONS, read_expression
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.relation_coordinate import is_positive, symbols_of
from delagrange.derive.model_file.springs import constants, formula
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import dimension_of

_KEYS = {
    EQUAL_BIAXIAL: (),
    UNIAXIAL: (),
    BIAXIAL: (),
    PURE_SHEAR: ("held_stretch", "lateral_dashpots"),
    RELATION: ("coordinate", "lambda_1", "lambda_2", "start", "forces", "parameters"),
}
_ALL_KEYS = ("kind", *(key for keys in _KEYS.values() for key in keys))
_THICKNESS = ("lambda_3",)
_COORDINATE = re.compile("[a-z][a-z0-9_]{0,29}")
_NO_SLOPE = 1e-12  # of a stretch over the relative change of the coordinate: round-off


def read_load(table: Table) -> LoadEntry:
    """The load that a table describes.

    Raises:
        ModelError: an unknown kind or key, a key that over-determines the stretches, or a relation that
            leaves no freedom, cannot be read, or gives a stretch that is not positive at the start.
    """
    kind = table.choice("kind", _KEYS)
    _refuse_more_than_enough(table, kind)
    table.only("kind", *_KEYS[kind])
    if kind == RELATION:
        return LoadEntry(kind, relation=_relation(table))
    if kind != PURE_SHEAR:
        return LoadEntry(kind)
    dashpots = table.choice("lateral_dashpots", ("free", "held"), default="free")
    return LoadEntry(kind, table.value_of("held_stretch", s.HELD_STRETCH), dashpots == "free")


def _refuse_more_than_enough(table: Table, kind: str) -> None:
    for key in table.values:
        if key in _THICKNESS:
            table.refuse(
                f"{key} over-determines the load: it follows from lambda_1 lambda_2 lambda_3 = 1", key
            )
        if key in _ALL_KEYS and key not in ("kind", *_KEYS[kind]):
            belongs = next(other for other, keys in _KEYS.items() if key in keys)
            reason = (
                f"{key} belongs to a load of the kind {belongs} and over-determines one of the kind {kind}"
            )
            table.refuse(reason, key)


def held_axes(load: LoadEntry) -> tuple[int, ...]:
    """Axes whose stretch does not change."""
    if load.kind == PURE_SHEAR:
        return (2,)
    if load.relation is None:
        return ()
    names = symbols_of(load.relation, positive=False)
    q = names[load.relation.coordinate]
    texts = (load.relation.lambda_1, load.relation.lambda_2)
    return tuple(axis for axis, text in enumerate(texts, 1) if not read_expression(text, names).has(q))


def _relation(table: Table) -> RelationEntry:
    coordinate = table.choice_of_name("coordinate", _COORDINATE, (*keyword.kwlist, *FUNCTIONS, *_ALL_KEYS))
    own = constants(table.table("parameters"), (coordinate,))
    entry = RelationEntry(
        coordinate,
        table.text("lambda_1"),
        table.text("lambda_2"),
        table.number("start", "1", Sign.ANY) if "start" in table else 1.0,
        _axes(table),
        own,
    )
    _check_relation(table, entry)
    held = held_axes(LoadEntry(RELATION, relation=entry))
    for axis in entry.forces:
        if axis in held:
            table.refuse(f"a force along axis {axis} moves nothing: lambda_{axis} does not change", "forces")
    return entry


def _axes(table: Table) -> tuple[int, ...]:
    given = table.values.get("forces", [1])
    fine = isinstance(given, list) and all(type(axis) is int and axis in (1, 2) for axis in given)
    if not fine or len(set(given)) != len(given):
        table.refuse(
            f"forces must be a list of the axes 1 and 2, each once at most, got {shown(given)}", "forces"
        )
    return tuple(sorted(given))


def _check_relation(table: Table, entry: RelationEntry) -> None:
    symbols, stretches = _formulas(table, entry)
    q = symbols[entry.coordinate]
    if not any(stretch.has(q) for stretch in stretches):
        table.refuse(f"the relation leaves no freedom: neither stretch depends on {q.name}", "lambda_1")
    _check_numbers(table, stretches, q, {symbols[each.name]: each for each in entry.constants})
    at = {symbols[each.name]: each.value for each in entry.constants} | {q: entry.start}
    for key, stretch in zip(("lambda_1", "lambda_2"), stretches, strict=True):
        value = number_at(stretch, at)
        if not value > 0:
            found = f"got {value:.12g} at {q.name} = {entry.start:.12g}"
            table.refuse(f"{key} must be positive and finite at the start, {found}", key)
    slopes = [number_at(stretch.diff(q), at) for stretch in stretches]
    for key, slope in zip(("lambda_1", "lambda_2"), slopes, strict=True):
        if math.isnan(slope):
            table.refuse(f"{key} has no finite slope at the start, {q.name} = {entry.start:.12g}", key)
    if all(abs(slope) * max(abs(entry.start), 1.0) < _NO_SLOPE for slope in slopes):
        table.refuse(
            f"the relation leaves no freedom at the start: no stretch changes with {q.name} there", "start"
        )


def _formulas(table: Table, entry: RelationEntry) -> tuple[Mapping[str, sp.Symbol], list[sp.Expr]]:
    """The coordinate and the constants by name, and both stretches in them.

    Raises:
        ModelError: a formula that cannot be read.
    """
    keys = ("lambda_1", "lambda_2")
    symbols = symbols_of(entry, positive=False)
    stretches = [formula(table, key, symbols) for key in keys]
    if is_positive(entry):
        symbols = symbols_of(entry, positive=True)
        stretches = [formula(table, key, symbols) for key in keys]
    return symbols, stretches


def _check_numbers(
    table: Table, stretches: list[sp.Expr], q: sp.Symbol, own: dict[sp.Symbol, Constant]
) -> None:
    dimensions = {q: Dimension()} | {symbol: Dimension.of_unit(each.unit) for symbol, each in own.items()}
    for key, stretch in zip(("lambda_1", "lambda_2"), stretches, strict=True):
        try:
            found = dimension_of(stretch, dimensions)
        except ValueError as error:
            table.refuse(f"{key}: {error}", key)
        if not found.is_number:
            table.refuse(f"{key} has the dimension {found}; a stretch is a pure number", key)
