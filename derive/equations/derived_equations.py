"""The derived equations one by one, each as `left - right = 0` for something that a paper may print."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.common.roles import Role
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.equations.reactions import at_rest
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import (
    DimensionError,
    TermDimension,
    check_terms,
    symbol_dimensions,
)
from delagrange.derive.notation.symbols import Quantity


@dataclass(frozen=True)
class DerivedEquation:
    """A derived equation: `residual` is zero and linear in `unknown`, the quantity that it gives."""

    model: str
    quantity: str  # e.g. "equation_of_motion_1"
    unknown: Quantity
    residual: sp.Expr
    quantities: tuple[Quantity, ...]  # all that the residual may be written in
    validity: tuple[sp.Expr, ...] = ()  # [1], each positive where the residual holds


@dataclass(frozen=True)
class _Made:
    """One expression of a model, its name in messages, and the dimension that it has to have."""

    name: str
    expression: sp.Expr
    dimension: Dimension


def derived_equations(eom: EquationsOfMotion) -> Mapping[str, DerivedEquation]:
    """Every equation that one model gives, by the name of what it states."""
    load_case = eom.load_case
    stated: dict[str, tuple[Quantity, sp.Expr]] = {
        "kinetic_energy": (s.KINETIC_ENERGY, s.KINETIC_ENERGY.symbol - eom.kinetic_energy),
        "potential_energy": (s.POTENTIAL_ENERGY, s.POTENTIAL_ENERGY.symbol - eom.potential_energy),
    }
    if load_case.reactions:
        residual = s.POTENTIAL_ENERGY.symbol - eom.potential_with_reactions
        stated["potential_with_reactions"] = (s.POTENTIAL_ENERGY, residual)
    for number, (c, residual) in enumerate(zip(load_case.coordinates, eom.residuals, strict=True), start=1):
        stated[f"equation_of_motion_{number}"] = (c.acceleration, residual)
    for number, (i, rate) in enumerate(zip(load_case.internals, eom.internal_rates, strict=True), start=1):
        stated[f"dashpot_rate_{number}"] = (i.rate, i.rate.symbol - rate)
    for number, (reaction, force) in enumerate(
        zip(load_case.reactions, eom.reaction_forces, strict=True), start=1
    ):
        name = f"reaction_force_{number}" if len(load_case.reactions) > 1 else "reaction_force"
        stated[name] = (reaction, reaction.symbol - force)
    if (balance := eom.charge_balance) is not None:
        stated["charge_rate"] = (balance.rate, balance.rate.symbol - balance.law)
    return {
        name: DerivedEquation(load_case.name, name, unknown, residual, eom.quantities, eom.validity)
        for name, (unknown, residual) in (stated | _static_balances(eom)).items()
    }


def _static_balances(eom: EquationsOfMotion) -> dict[str, tuple[Quantity, sp.Expr]]:
    """The equations of motion at rest, of the coordinates that an applied force works on."""
    inputs = [each for each in eom.load_case.inputs if each.role is Role.FORCE]
    stated = {}
    for number, residual in enumerate(eom.residuals, start=1):
        force = next((each for each in inputs if residual.has(each.symbol)), None)
        if force is not None:
            static = at_rest(residual, eom.load_case.coordinates)
            stated[f"static_balance_{number}"] = (force, static)
    return stated


def check_dimensions(equation: DerivedEquation) -> tuple[TermDimension, ...]:
    """The dimension of every term of a derived equation; what stands in brackets is checked where it stands.

    Raises:
        DimensionError: a term has not the dimension of the others, or all of them not that of a
            residual that the unknown makes: J for an equation of motion or a balance at rest, the unknown's unit else.
    """
    varied = equation.quantity.startswith(("equation_of_motion", "static_balance"))
    unit = "J" if varied else equation.unknown.unit
    made = _Made(equation.quantity, equation.residual, Dimension.of_unit(unit))
    return _check(equation.model, made, symbol_dimensions(equation.quantities))


def check_model_dimensions(eom: EquationsOfMotion) -> int:
    """Check every part of a model that a module is emitted from, and say how many there are.

    These are the energies [J], the mass matrix [kg m^2], the forces [J], the powers [W], the
    stresses on the dashpots [Pa], the reactions and the forces on the edges, each in its own unit, the flow of the
    internal variables [1/s], what the electrodes carry and let through, and the Jacobians, whose entry (i, j) has
    the unit of the rate of state i over that of state or input j.

    Raises:
        DimensionError: a term has another unit; the message has the model, the part and the term.
    """
    dimensions = symbol_dimensions(eom.quantities)
    parts = [made for made in _parts(eom) if made.expression != 0]  # a zero has every unit
    for made in parts:
        _check(eom.load_case.name, made, dimensions)
    return len(parts)


def _parts(eom: EquationsOfMotion) -> Iterator[_Made]:
    energy, power = (Dimension.of_unit(unit) for unit in ("J", "W"))
    yield _Made("kinetic_energy", eom.kinetic_energy, energy)
    for part in eom.energies.parts:
        yield _Made(f"potential_energy, {part.name}", part.expression, energy)
    yield from _entries("mass_matrix", eom.mass_matrix, Dimension.of_unit("kg m^2"))
    for term in eom.force_terms:
        yield from _entries(term.name, term.vector, energy)
    yield from _numbered("internal_rate", eom.internal_rates, Dimension.of_unit("1/s"))
    yield from _forces("reaction_force", eom.reaction_forces, eom.load_case.reactions)
    yield from _forces("static_reaction_force", eom.static_reaction_forces, eom.load_case.reactions)
    yield from _forces("edge_force", eom.edge_forces, eom.membrane.forces)
    yield _Made("force_power", eom.force_power, power)
    for number, dashpot in enumerate(eom.dissipation.dashpots, start=1):
        branch = f"_{number}" if len(eom.dissipation.dashpots) > 1 else ""
        yield from _numbered(f"deviatoric_stress{branch}", dashpot.deviators, Dimension.of_unit("Pa"))
    yield from _numbered("validity", eom.validity, Dimension())
    yield _Made("dashpot_power", eom.dashpot_power, power)
    yield from _electrical_parts(eom)
    yield from _jacobian_entries(eom)


def _electrical_parts(eom: EquationsOfMotion) -> Iterator[_Made]:
    """What the electrodes carry, and what leaks between them."""
    yield _Made("nominal_electric_field", eom.electrodes.field, Dimension.of_unit("V/m"))
    yield _Made("nominal_charge_density", eom.electrodes.charge, Dimension.of_unit("C/m^2"))
    if (balance := eom.charge_balance) is not None:
        yield _Made("nominal_charge_density_rate", balance.law, Dimension.of_unit("A/m^2"))
        yield _Made("source_power", balance.source_density, Dimension.of_unit("W/m^3"))
        yield _Made("leakage_power", balance.leakage_density, Dimension.of_unit("W/m^3"))


def _forces(name: str, expressions: tuple[sp.Expr, ...], forces: tuple[Quantity, ...]) -> Iterator[_Made]:
    for number, (expression, force) in enumerate(zip(expressions, forces, strict=True), start=1):
        yield _Made(f"{name}_{number}", expression, Dimension.of_unit(force.unit))


def _numbered(name: str, expressions: tuple[sp.Expr, ...], dimension: Dimension) -> Iterator[_Made]:
    for number, expression in enumerate(expressions, start=1):
        yield _Made(f"{name}_{number}", expression, dimension)


def _entries(name: str, matrix: sp.ImmutableMatrix, dimension: Dimension) -> Iterator[_Made]:
    for i, j in product(range(matrix.rows), range(matrix.cols)):
        yield _Made(f"{name}[{i}, {j}]", matrix[i, j], dimension)


def _jacobian_entries(eom: EquationsOfMotion) -> Iterator[_Made]:
    state = tuple(Dimension.of_unit(quantity.unit) for quantity in eom.state)
    second = Dimension.of_unit("s")
    inputs = tuple(Dimension.of_unit(quantity.unit) for quantity in eom.load_case.inputs)
    for (i, row), (j, column) in product(enumerate(state), repeat=2):
        yield _Made(f"jacobian[{i}, {j}]", eom.jacobian[i, j], row / second / column)
    for (i, row), (j, column) in product(enumerate(state), enumerate(inputs)):
        yield _Made(f"input_jacobian[{i}, {j}]", eom.input_jacobian[i, j], row / second / column)


def _check(model: str, made: _Made, dimensions: Mapping[sp.Symbol, Dimension]) -> tuple[TermDimension, ...]:
    try:
        terms = check_terms(made.expression, dimensions)
    except DimensionError as error:
        raise DimensionError(f"{model}, {made.name}: {error}", error.terms) from error
    if wrong := tuple(term for term in terms if term.dimension != made.dimension):
        raise DimensionError(
            f"{model}, {made.name}: term {wrong[0].term} has dimension {wrong[0].dimension}, "
            f"where {made.dimension} is expected",
            tuple(term.term for term in wrong),
        )
    return terms
