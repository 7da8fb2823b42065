"""The derived equations one by one, each as `left - right = 0` for something that a paper may print."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from delagrange.derive import symbols as s
from delagrange.derive.dimensions import (
    Dimension,
    DimensionError,
    TermDimension,
    check_terms,
    symbol_dimensions,
)
from delagrange.derive.euler_lagrange import EquationsOfMotion
from delagrange.derive.symbols import Quantity


@dataclass(frozen=True)
class DerivedEquation:
    """A derived equation: `residual` is zero and linear in `unknown`, the quantity that it gives."""

    model: str
    quantity: str  # e.g. "equation_of_motion_1"
    unknown: Quantity
    residual: sp.Expr


def derived_equations(eom: EquationsOfMotion) -> Mapping[str, DerivedEquation]:
    """Every equation that one model gives, by the name of what it states."""
    load_case = eom.load_case
    stated: dict[str, tuple[Quantity, sp.Expr]] = {
        "kinetic_energy": (s.KINETIC_ENERGY, s.KINETIC_ENERGY.symbol - eom.kinetic_energy),
        "potential_energy": (s.POTENTIAL_ENERGY, s.POTENTIAL_ENERGY.symbol - eom.potential_energy),
        "potential_with_reactions": (
            s.POTENTIAL_ENERGY,
            s.POTENTIAL_ENERGY.symbol - eom.potential_with_reactions,
        ),
    }
    for number, (c, residual) in enumerate(zip(load_case.coordinates, eom.residuals, strict=True), start=1):
        stated[f"equation_of_motion_{number}"] = (c.acceleration, residual)
    for number, (i, rate) in enumerate(zip(load_case.internals, eom.internal_rates, strict=True), start=1):
        stated[f"dashpot_rate_{number}"] = (i.rate, i.rate.symbol - rate)
    for reaction, force in zip(load_case.reactions, eom.reaction_forces, strict=True):
        stated["reaction_force"] = (reaction, reaction.symbol - force)
    return {
        name: DerivedEquation(load_case.name, name, unknown, residual)
        for name, (unknown, residual) in stated.items()
    }


def check_dimensions(equation: DerivedEquation) -> tuple[TermDimension, ...]:
    """The dimension of every term of a derived equation.

    Raises:
        DimensionError: a term has not the dimension of the others, or all of them not that of a
            residual that the unknown makes: J for an equation of motion, the unknown's unit else.
    """
    terms = check_terms(sp.expand(equation.residual), symbol_dimensions())
    unit = "J" if equation.quantity.startswith("equation_of_motion") else equation.unknown.unit
    expected = Dimension.of_unit(unit)
    if wrong := tuple(term for term in terms if term.dimension != expected):
        raise DimensionError(
            f"{equation.model}, {equation.quantity}: term {wrong[0].term} has dimension {wrong[0].dimension}, "
            f"where {expected} is expected",
            tuple(term.term for term in wrong),
        )
    return terms
