"""Whether what the electrodes carry, and what leaks between them, has the units that it must have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.notation.dimensions import DimensionError, check_terms, symbol_dimensions


def check_electrical_dimensions(eom: EquationsOfMotion) -> int:
    """Check the electrical parts of a described model, and say how many there are.

    Raises:
        DimensionError: a term has another unit; the message has the model, the part and the term.
    """
    dimensions = symbol_dimensions(eom.quantities)
    parts = tuple(_parts(eom))
    for name, expression, unit in parts:
        _check(f"{eom.load_case.name}, {name}", expression, Dimension.of_unit(unit), dimensions)
    return len(parts)


def _parts(eom: EquationsOfMotion) -> Iterator[tuple[str, sp.Expr, str]]:
    yield "nominal_electric_field", eom.electrodes.field, "V/m"
    yield "nominal_charge_density", eom.electrodes.charge, "C/m^2"
    if eom.charge_balance is not None:
        yield "nominal_charge_density_rate", eom.charge_balance.law, "A/m^2"
        yield "source_power", eom.charge_balance.source_density, "W/m^3"
        yield "leakage_power", eom.charge_balance.leakage_density, "W/m^3"


def _check(
    name: str, expression: sp.Expr, wanted: Dimension, dimensions: Mapping[sp.Symbol, Dimension]
) -> None:
    try:
        terms = check_terms(expression, dimensions)
    except DimensionError as error:
        raise DimensionError(f"{name}: {error}", error.terms) from error
    for term in terms:
        if term.dimension != wanted:
            message = f"{name}: term {term.term} has dimension {term.dimension}, where {wanted} is expected"
            raise DimensionError(message, (term.term,))
