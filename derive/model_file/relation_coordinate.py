"""The coordinate of a user's relation between the stretches: any real number, or positive where a stretch says so.

To take a coordinate for positive makes formulas shorter, (q^2)^a = q^(2 a), and wrong wherever it is not. One that may
be negative has a symbol without any assumption: of a real one SymPy makes |q|^(2 a), whose derivatives are no formulas.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from delagrange.derive.model_file.entries import RelationEntry
from delagrange.derive.model_file.expression import read_expression


def symbols_of(entry: RelationEntry, *, positive: bool) -> Mapping[str, sp.Symbol]:
    """The coordinate, then the constants of a relation, by name; a constant given as positive stays so."""
    own = {each.name: _symbol(each.name, each.value > 0) for each in entry.constants}
    return {entry.coordinate: _symbol(entry.coordinate, positive), **own}


def is_positive(entry: RelationEntry) -> bool:
    """Whether the coordinate is positive in every state that the membrane can be in.

    It is where a stretch is a positive constant times the coordinate to a power, a number that is no even integer:
    of a negative coordinate that is negative, or no real number, as no stretch is.
    """
    names = symbols_of(entry, positive=False)
    coordinate = names[entry.coordinate]
    texts = (entry.lambda_1, entry.lambda_2)
    return entry.start > 0 and any(
        _needs_positive(read_expression(text, names), coordinate) for text in texts
    )


def _needs_positive(stretch: sp.Expr, coordinate: sp.Symbol) -> bool:
    factor, power = stretch.as_independent(coordinate, as_Add=False)
    base, exponent = power.as_base_exp()
    return bool(factor.is_positive and base == coordinate and exponent.is_Rational and not exponent.is_even)


def _symbol(name: str, positive: bool) -> sp.Symbol:
    return sp.Symbol(name, positive=True) if positive else sp.Symbol(name)
