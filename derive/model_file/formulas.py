"""What a user writes down: formulas, and the constants in them, read once and as they are meant.

A constant is positive in a formula where its value is, so that roots and powers come out short; its symbol bears the
user's own name until the formula has passed all checks, so that errors speak in the user's words.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import prod

import sympy as sp

from delagrange.common.quantity_text import read_with_unit
from delagrange.common.units import shown
from delagrange.derive.model_file.expression import FUNCTIONS, read_expression
from delagrange.derive.model_file.expression_tokens import ExpressionError
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation.symbols import Quantity, quantity

STRETCHES = sp.symbols("lambda_1 lambda_2 lambda_3", positive=True)
STRETCH_NAMES: Mapping[str, sp.Expr] = {
    **{symbol.name: symbol for symbol in STRETCHES},
    "I_1": sum((stretch**2 for stretch in STRETCHES), sp.Integer(0)),
    "I_2": sum((stretch**-2 for stretch in STRETCHES), sp.Integer(0)),
}
_NAME = re.compile("[A-Za-z][A-Za-z0-9_]{0,29}")
_MOST_OPERATIONS = 150  # of an energy: the worst found within it takes 20 s to read, a usual one 0.3 s
_DEEPEST_FUNCTIONS = 4
_MOST_TERMS = 300  # of a formula, multiplied out: a derivation of 1000 terms takes half a minute


@dataclass(frozen=True)
class Constant:
    """A user's own constant."""

    name: str
    value: float  # [unit]
    unit: str  # SI

    @property
    def symbol(self) -> sp.Symbol:
        """What stands for it where a formula is read."""
        return sp.Symbol(self.name, **({"positive": True} if self.value > 0 else {"real": True}))


Constants = tuple[Constant, ...]


def constants(table: Table, taken: tuple[str, ...]) -> Constants:
    """A user's constants, each with the SI unit of its value; none may bear a name that is taken."""
    return tuple(_constant(table, name, taken) for name in table.values)


def _constant(table: Table, name: str, taken: tuple[str, ...]) -> Constant:
    if not _NAME.fullmatch(name):
        allowed = "up to 30 ASCII letters, digits and _, the first a letter"
        table.refuse(f"the name of a parameter must be {allowed}, got {shown(name)}", name)
    if name in (*taken, *FUNCTIONS):
        table.refuse(f"{name!r} cannot be the name of a parameter: it has a meaning of its own", name)
    try:
        value, unit = read_with_unit(name, table.values[name])
    except ValueError as error:
        table.refuse(str(error), name)
    return Constant(name, value, unit)


def names_of(own: Constants) -> dict[str, sp.Symbol]:
    """What the names of constants stand for in a formula."""
    return {each.name: each.symbol for each in own}


def numbers_of(own: Constants) -> dict[sp.Symbol, float]:
    return {each.symbol: each.value for each in own}


def at_rest(own: Constants) -> dict[sp.Symbol, float]:
    """Values of a user's constants, and of the stretches at rest, by the symbols that formulas are read in."""
    return numbers_of(own) | dict.fromkeys(STRETCHES, 1.0)


def quantities_of(prefix: str, own: Constants) -> tuple[Quantity, ...]:
    """The user's constants as quantities of the model: `a` of a relation is `relation_a`."""
    return tuple(
        quantity(
            f"{prefix}_{each.name}",
            f"{prefix}_{each.name}",
            each.name,
            upright(each.name),
            each.unit,
            f"parameter {each.name} of the {prefix}",
            positive=each.value > 0,
        )
        for each in own
    )


def upright(name: str) -> str:
    """A user's name in LaTeX."""
    return rf"\mathrm{{{name.replace('_', '')}}}"


def in_quantities(law: sp.Expr, own: Constants, quantities: tuple[Quantity, ...]) -> sp.Expr:
    """A formula as it was read, in the symbols of the model."""
    return law.xreplace({each.symbol: made.symbol for each, made in zip(own, quantities, strict=True)})


def values_of(own: Constants, quantities: tuple[Quantity, ...]) -> dict[str, float]:
    """Values by the names of the model [SI]."""
    return {made.name: each.value for each, made in zip(own, quantities, strict=True)}


def formula(table: Table, key: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    """The expression that a key writes, with file, line and place in the error."""
    try:
        law = read_expression(table.text(key), names)
    except ExpressionError as error:
        row = f"line {error.line}, " if "\n" in table.text(key) else ""
        table.refuse(f"{key}, {row}column {error.column} of the formula: {error.reason}", key)
    _check_size(table, key, law)
    return law


def _check_size(table: Table, key: str, law: sp.Expr) -> None:
    """Refuse a formula whose derivatives would take minutes."""
    operations, depth = int(law.count_ops()), _function_depth(law)
    if operations > _MOST_OPERATIONS or depth > _DEEPEST_FUNCTIONS:
        allowed = (
            f"{_MOST_OPERATIONS} operations, functions and powers {_DEEPEST_FUNCTIONS} deep in each other"
        )
        table.refuse(
            f"{key} has {operations} operations, {depth} deep in each other; allowed are {allowed}", key
        )
    if (terms := _terms(law)) > _MOST_TERMS:
        table.refuse(f"{key}, multiplied out, has {terms} terms; allowed are {_MOST_TERMS}", key)


def _terms(law: sp.Expr) -> int:
    """How many terms a formula has when its products of sums are multiplied out, powers left as they stand."""
    parts = [_terms(part) for part in law.args]
    if not parts:
        return 1
    return sum(parts) if law.is_Add else prod(parts)


def _function_depth(law: sp.Expr) -> int:
    """How deep functions and powers with other exponents than integers stand in each other."""
    own = law.is_Function or (law.is_Pow and not law.exp.is_Integer)
    return int(own) + max((_function_depth(part) for part in law.args), default=0)
