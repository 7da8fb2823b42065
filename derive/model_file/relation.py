"""A user's own relation between the stretches: both follow one coordinate.

The coordinate is any real number, or positive where a stretch says so. To take it for positive makes formulas shorter,
(q^2)^a = q^(2 a), and wrong wherever it is not. One that may be negative has a symbol without any assumption: of a real
one SymPy makes |q|^(2 a), whose derivatives are no formulas.
"""

from __future__ import annotations

import keyword
import math
import re
from dataclasses import dataclass, replace
from fractions import Fraction

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.common.roles import Sign
from delagrange.common.units import shown
from delagrange.derive.membrane.description import Relation
from delagrange.derive.model_file.expression import FUNCTIONS
from delagrange.derive.model_file.formulas import (
    Constants,
    constants,
    formula,
    in_quantities,
    names_of,
    numbers_of,
    quantities_of,
    values_of,
)
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation.dimensions import dimension_of
from delagrange.derive.notation.symbols import TimeDependent, moving

_COORDINATE = re.compile("[a-z][a-z0-9_]{0,29}")
_STRETCHES = ("lambda_1", "lambda_2")
_NO_SLOPE = 1e-12  # of a stretch over the relative change of the coordinate: round-off


@dataclass(frozen=True)
class _Formulas:
    """Both stretches as they were read."""

    coordinate: sp.Symbol
    stretches: tuple[sp.Expr, sp.Expr]
    own: Constants

    @property
    def held(self) -> tuple[int, ...]:
        """Axes whose stretch does not change."""
        return tuple(
            axis for axis, stretch in enumerate(self.stretches, 1) if not stretch.has(self.coordinate)
        )


def read_relation(table: Table, taken: tuple[str, ...]) -> tuple[Relation, dict[str, float]]:
    """The relation that a table describes, and the values of its parameters by name; its names must not be `taken`.

    Raises:
        ModelError: it leaves no freedom, cannot be read, or gives a stretch that is not positive at the start.
    """
    name = table.choice_of_name("coordinate", _COORDINATE, (*keyword.kwlist, *FUNCTIONS, *taken))
    own = constants(table.table("parameters"), (name,))
    start = table.number("start", "1", Sign.ANY) if "start" in table else 1.0
    forces = _axes(table)
    read = _read(table, name, own, start)
    _check(table, read, start)
    for axis in forces:
        if axis in read.held:
            table.refuse(f"a force along axis {axis} moves nothing: lambda_{axis} does not change", "forces")
    made = quantities_of("relation", own)
    coordinate = _coordinate(name, bool(read.coordinate.is_positive))
    first, second = (
        in_quantities(law, own, made).xreplace({read.coordinate: coordinate.value.symbol})
        for law in read.stretches
    )
    exact = Fraction(repr(start))
    relation = Relation(
        coordinate=coordinate,
        stretches=(first, second),
        start=sp.Rational(exact.numerator, exact.denominator),
        forces=(1 in forces, 2 in forces),
        parameters=made,
    )
    return relation, values_of(own, made)


def _axes(table: Table) -> tuple[int, ...]:
    given = table.values.get("forces", [1])
    fine = isinstance(given, list) and all(type(axis) is int and axis in (1, 2) for axis in given)
    if not fine or len(set(given)) != len(given):
        table.refuse(
            f"forces must be a list of the axes 1 and 2, each once at most, got {shown(given)}", "forces"
        )
    return tuple(sorted(given))


def _read(table: Table, name: str, own: Constants, start: float) -> _Formulas:
    """Both stretches, in a coordinate that is positive where one of them says so.

    Raises:
        ModelError: a formula cannot be read.
    """
    any_sign = sp.Symbol(name)
    first, second = (formula(table, key, {name: any_sign, **names_of(own)}) for key in _STRETCHES)
    if start > 0 and any(_needs_positive(stretch, any_sign) for stretch in (first, second)):
        positive = sp.Symbol(name, positive=True)
        first, second = (stretch.xreplace({any_sign: positive}) for stretch in (first, second))
        return _Formulas(positive, (first, second), own)
    return _Formulas(any_sign, (first, second), own)


def _needs_positive(stretch: sp.Expr, coordinate: sp.Symbol) -> bool:
    """Whether a stretch is a positive constant times the coordinate to a power, a number that is no even integer.

    Of a negative coordinate that is negative, or no real number, as no stretch is.
    """
    factor, power = stretch.as_independent(coordinate, as_Add=False)
    base, exponent = power.as_base_exp()
    return bool(factor.is_positive and base == coordinate and exponent.is_Rational and not exponent.is_even)


def _check(table: Table, read: _Formulas, start: float) -> None:
    q = read.coordinate
    if len(read.held) == 2:
        table.refuse(f"the relation leaves no freedom: neither stretch depends on {q.name}", "lambda_1")
    _check_numbers(table, read)
    at = numbers_of(read.own) | {q: start}
    for key, stretch in zip(_STRETCHES, read.stretches, strict=True):
        value = number_at(stretch, at)
        if not value > 0:
            found = f"got {value:.12g} at {q.name} = {start:.12g}"
            table.refuse(f"{key} must be positive and finite at the start, {found}", key)
    slopes = [number_at(stretch.diff(q), at) for stretch in read.stretches]
    for key, slope in zip(_STRETCHES, slopes, strict=True):
        if math.isnan(slope):
            table.refuse(f"{key} has no finite slope at the start, {q.name} = {start:.12g}", key)
    if all(abs(slope) * max(abs(start), 1.0) < _NO_SLOPE for slope in slopes):
        table.refuse(
            f"the relation leaves no freedom at the start: no stretch changes with {q.name} there", "start"
        )


def _check_numbers(table: Table, read: _Formulas) -> None:
    dimensions = {read.coordinate: Dimension()}
    dimensions |= {each.symbol: Dimension.of_unit(each.unit) for each in read.own}
    for key, stretch in zip(_STRETCHES, read.stretches, strict=True):
        try:
            found = dimension_of(stretch, dimensions)
        except ValueError as error:
            table.refuse(f"{key}: {error}", key)
        if not found.is_number:
            table.refuse(f"{key} has the dimension {found}; a stretch is a pure number", key)


def _coordinate(name: str, positive: bool) -> TimeDependent:
    """The coordinate with its rates; it is positive only where it is known to be."""
    own = f"coordinate_{name}"  # no name of emitted code begins so
    coordinate = moving(own, own, name, name.replace("_", ""), f"coordinate {name} of the relation")
    if positive:
        return coordinate
    of_any_sign = replace(coordinate.value, symbol=sp.Symbol(own), sign=Sign.ANY)
    return replace(coordinate, value=of_any_sign)
