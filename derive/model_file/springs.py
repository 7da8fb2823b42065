"""The springs of a model file: materials by name, or a user's own energy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan

import sympy as sp

from delagrange.common.units import with_unit
from delagrange.derive.membrane import materials
from delagrange.derive.membrane.materials import ParameterKind, Spring
from delagrange.derive.membrane.own_energy import own_energy
from delagrange.derive.membrane.strain_energy import StrainEnergy
from delagrange.derive.model_file.formulas import (
    STRETCH_NAMES,
    STRETCHES,
    Constant,
    Constants,
    at_rest,
    constants,
    formula,
    in_quantities,
    names_of,
    numbers_of,
    upright,
    values_of,
)
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation.symbols import Quantity

_REST = 1e-12  # of the largest stress: equal in thirty digits, but for rounding of the values


@dataclass(frozen=True)
class ReadSpring:
    """A spring of the membrane with the values of its parameters."""

    energy: StrainEnergy
    values: Mapping[str, float]  # by name [SI]

    @property
    def modulus_at_rest(self) -> float:
        """Shear modulus at rest [Pa]."""
        at = {each.symbol: sp.Float(self.values[each.name], 30) for each in self.energy.parameters}
        stretch = sp.Symbol("stretch_a", positive=True)
        sheared = self.energy.density((stretch, 1 / stretch, sp.Integer(1)))
        return float(sp.N(sheared.diff(stretch, 2).subs({**at, stretch: 1}) / 4))


def read_spring(table: Table, spring: Spring) -> ReadSpring:
    """The spring that a table describes, its energy tried.

    Raises:
        ModelError: unknown or missing parameters, a unit that does not fit, a formula that cannot be read,
            an energy that is not stress-free at rest, or a shear modulus at rest that is not positive.
    """
    key = table.one_of("material", "energy")
    found = _material_spring(table, spring) if key == "material" else _own_spring(table, spring)
    modulus = found.modulus_at_rest
    if not (modulus > 0 and modulus < float("inf")):
        table.refuse(
            f"the shear modulus of {table.title} at rest must be positive and finite, its energy has "
            f"{with_unit(modulus, 'Pa')}",
            key,
        )
    return found


def _material_spring(table: Table, spring: Spring) -> ReadSpring:
    try:
        found = materials.material(table.text("material"))
        named = sum(name.startswith("ogden_modulus_") for name in table.values) or 1
        terms = named if found.kinds_of_term else 1
        kinds = found.kinds(terms)
    except ValueError as error:
        table.refuse(str(error), "material")
    table.only("material", *(kind.name for kind in kinds), "viscosity", "relaxation_time")
    quantities = {kind.name: kind.of(spring) for kind in kinds}
    values = {made.name: table.value_of(name, made) for name, made in quantities.items()}
    return ReadSpring(found(spring, terms), values)


def _own_spring(table: Table, spring: Spring) -> ReadSpring:
    table.only("energy", "parameters", "validity", "source", "viscosity", "relaxation_time")
    own = constants(table.table("parameters"), tuple(STRETCH_NAMES))
    names = {**STRETCH_NAMES, **names_of(own)}
    density = formula(table, "energy", names)
    _check_rest(table, density, own)
    limit = formula(table, "validity", names) if "validity" in table else None
    if limit is not None:
        _check_validity(table, limit, own)
    for each in own:
        if each.symbol not in density.free_symbols:
            table.table("parameters").refuse(
                f"parameter {each.name!r} does not occur in the energy", each.name
            )
    source = table.plain_text("source") if "source" in table else "given by the user"
    try:
        made = tuple(_quantity(each, spring) for each in own)
        laws = (None if law is None else in_quantities(law, own, made) for law in (density, limit))
        density, limit = laws
        energy = own_energy("own", density, STRETCHES, made, source, limit)
    except ValueError as error:
        table.refuse(str(error), "energy")
    return ReadSpring(energy, values_of(own, made))


def _check_validity(table: Table, limit: sp.Expr, own: Constants) -> None:
    """Refuse a limit that rest is beyond: every run would be lost before it begins."""
    room = number_at(limit, at_rest(own))
    if not room > 0:
        table.refuse(
            f"validity must be positive and finite at rest, lambda_1 = lambda_2 = lambda_3 = 1, got {room:.6g}",
            "validity",
        )


def _check_rest(table: Table, density: sp.Expr, own: Constants) -> None:
    """Refuse an energy that is stressed at rest with the values given; that it never is, is proved afterwards.

    A number settles at once what a proof might take minutes to refuse.
    """
    at = {symbol: sp.Float(value, 30) for symbol, value in numbers_of(own).items()} | dict.fromkeys(
        STRETCHES, 1
    )
    known = not isnan(number_at(density, at_rest(own)))
    stresses = [sp.N(density.diff(stretch).subs(at), 30) for stretch in STRETCHES] if known else []
    if not known or not all(stress.is_extended_real and stress.is_finite for stress in stresses):
        table.refuse(
            "energy has no finite real stresses at rest, lambda_1 = lambda_2 = lambda_3 = 1", "energy"
        )
    largest = max(abs(stress) for stress in stresses)
    if max(stresses) - min(stresses) > _REST * largest:
        found = ", ".join(f"{float(stress):.6g}" for stress in stresses)
        table.refuse(
            "energy is not stress-free at rest: at lambda_1 = lambda_2 = lambda_3 = 1 its principal stresses "
            f"are {found} in the unit of the energy; allowed are equal ones, which a pressure balances",
            "energy",
        )


def _quantity(constant: Constant, spring: Spring) -> Quantity:
    """The quantity that a user's constant is in a spring: `a` of the equilibrium spring is `a_alpha`.

    Raises:
        ValueError: the name is that of a known parameter with another unit.
    """
    kind = ParameterKind(
        constant.name,
        f"own_{constant.name}",
        constant.name,
        upright(constant.name),
        constant.unit,
        f"parameter {constant.name} of {{}}",
        positive=constant.value > 0,
    )
    quantity = kind.of(spring)
    if quantity.unit != constant.unit:
        raise ValueError(
            f"parameter {constant.name!r} must be in {quantity.unit}, got one in {constant.unit}"
        )
    return quantity
