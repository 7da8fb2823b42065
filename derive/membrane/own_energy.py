"""A strain energy that a user writes down in SymPy, checked before anything is derived from it."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp
from sympy.core.function import Application

from delagrange.common.checks import did_you_mean
from delagrange.common.dimension import Dimension
from delagrange.derive.membrane.strain_energy import StrainEnergy, Stretches, rest_stresses
from delagrange.derive.notation.dimensions import DimensionError, dimension_of
from delagrange.derive.notation.printer import FUNCTIONS
from delagrange.derive.notation.symbols import Quantity


def own_energy(
    name: str,
    expression: sp.Expr,
    stretches: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    parameters: tuple[Quantity, ...],
    source: str = "given by the user",
    validity: sp.Expr | None = None,
) -> StrainEnergy:
    """A strain energy that a user writes down.

    Args:
        name: what it is called.
        expression: the density [J/m^3] in the symbols of `stretches` and `parameters`.
        stretches: what stands for the principal stretches [1], taken as independent.
        parameters: its constants.
        source: where it comes from.
        validity: [1], positive where the density holds; None: everywhere.

    Raises:
        ValueError: a symbol is neither a stretch nor a parameter, a function that no law may have, a
            unit does not fit, or the energy is not stress-free at rest.
    """
    _check_symbols(name, expression, stretches, parameters)
    check_functions(f"energy {name!r}", expression)
    _check_dimension(name, expression, stretches, parameters, "Pa")
    if validity is not None:
        _check_symbols(f"limit of {name}", validity, stretches, parameters)
        check_functions(f"the limit of energy {name!r}", validity)
        _check_dimension(f"limit of {name}", validity, stretches, parameters, "1")

    def of(formula: sp.Expr) -> Callable[[Stretches], sp.Expr]:
        return lambda at: formula.subs(dict(zip(stretches, at, strict=True)), simultaneous=True)

    energy = StrainEnergy(
        name, parameters, of(expression), source, None if validity is None else of(validity)
    )
    stresses = rest_stresses(energy)
    if any(stress != 0 for stress in stresses):
        shown = ", ".join(str(stress) for stress in stresses)
        raise ValueError(
            f"energy {name!r} is not stress-free at rest: at lambda_1 = lambda_2 = lambda_3 = 1 its principal "
            f"stresses less their mean are {shown} Pa; allowed are equal principal stresses"
        )
    return energy


def check_functions(what: str, expression: sp.Expr) -> None:
    """That there is a name for each function; an absolute value, the root of a square, has a kink and none.

    Raises:
        ValueError: one has no name.
    """
    for function in sorted(expression.atoms(Application), key=str):
        if not isinstance(function, tuple(FUNCTIONS)):
            hint = " (the root of a square)" if isinstance(function, sp.Abs) else ""
            raise ValueError(f"{what} has {function}{hint}; allowed are sqrt, {', '.join(sorted(FUNCTIONS.values()))}")


def _check_symbols(
    name: str, expression: sp.Expr, stretches: tuple[sp.Symbol, ...], parameters: tuple[Quantity, ...]
) -> None:
    known = {*stretches, *(parameter.symbol for parameter in parameters)}
    for unknown in sorted(expression.free_symbols - known, key=str):
        allowed = ", ".join(sorted(map(str, known)))
        hint = did_you_mean(unknown, map(str, known))
        raise ValueError(f"energy {name!r} has the unknown symbol {unknown}{hint}; allowed are {allowed}")


def _check_dimension(
    name: str,
    expression: sp.Expr,
    stretches: tuple[sp.Symbol, ...],
    parameters: tuple[Quantity, ...],
    unit: str,
) -> None:
    dimensions = {stretch: Dimension() for stretch in stretches}
    dimensions |= {parameter.symbol: Dimension.of_unit(parameter.unit) for parameter in parameters}
    try:
        found = dimension_of(expression, dimensions)
    except DimensionError as error:
        raise ValueError(f"energy {name!r} breaks its unit: {error}") from None
    if found != (allowed := Dimension.of_unit(unit)):
        raise ValueError(f"energy {name!r} has the dimension {found}; allowed is that of {unit}, {allowed}")
