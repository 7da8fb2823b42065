"""The springs of a model file: materials by name, or a user's own energy."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import isnan, prod

import sympy as sp

from delagrange.common.quantity_text import read_with_unit
from delagrange.common.units import shown, with_unit
from delagrange.derive.membrane import materials
from delagrange.derive.membrane.materials import ALPHA, MATERIALS, ParameterKind, Spring
from delagrange.derive.membrane.own_energy import own_energy
from delagrange.derive.membrane.strain_energy import StrainEnergy
from delagrange.derive.model_file.entries import Constant, MaterialSpring, OwnSpring, SpringEntry
from delagrange.derive.model_file.expression import FUNCTIONS, read_expression
from delagrange.derive.model_file.expression_tokens import ExpressionError
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation.symbols import Quantity

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
_REST = 1e-12  # of the largest stress: equal in thirty digits, but for rounding of the values


def formula(table: Table, key: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    """The expression that a key writes, with file, line and place in the error."""
    try:
        law = read_expression(table.text(key), names)
    except ExpressionError as error:
        row = f"line {error.line}, " if "\n" in table.text(key) else ""
        table.refuse(f"{key}, {row}column {error.column} of the formula: {error.reason}", key)
    _check_size(table, key, law)
    return law


def constants(table: Table, taken: tuple[str, ...]) -> tuple[Constant, ...]:
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


def read_spring(table: Table) -> SpringEntry:
    """The spring that a table describes, its energy tried.

    Raises:
        ModelError: unknown or missing parameters, a unit that does not fit, a formula that cannot be read,
            an energy that is not stress-free at rest, or a shear modulus at rest that is not positive.
    """
    if table.one_of("material", "energy") == "material":
        entry, key = _material_spring(table), "material"
    else:
        entry, key = _own_spring(table), "energy"
    _check_modulus(table, entry, key)
    return entry


def _material_spring(table: Table) -> MaterialSpring:
    try:
        found = materials.material(table.text("material"))
        terms = sum(name.startswith("ogden_modulus_") for name in table.values) or 1
        kinds = found.kinds(terms if found.kinds_of_term else 1)
    except ValueError as error:
        table.refuse(str(error), "material")
    table.only("material", *(kind.name for kind in kinds), "viscosity", "relaxation_time")
    values = {kind.name: table.value_of(kind.name, kind.of(ALPHA)) for kind in kinds}
    return MaterialSpring(found.name, values, terms if found.kinds_of_term else 1)


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


def at_rest(own: tuple[Constant, ...]) -> dict[sp.Symbol, float]:
    """Values of a user's constants, and of the stretches at rest, by the symbols that their formulas are read in."""
    return {sp.Symbol(each.name): each.value for each in own} | dict.fromkeys(STRETCHES, 1.0)


def assumed(constant: Constant) -> sp.Symbol:
    """A user's constant as the model has it: positive where it is given so, else of either sign."""
    return sp.Symbol(constant.name, **({"positive": True} if constant.value > 0 else {"real": True}))


def _check_validity(table: Table, limit: sp.Expr, own: tuple[Constant, ...]) -> None:
    """Refuse a limit that rest is beyond: every run would be lost before it begins."""
    room = number_at(limit, at_rest(own))
    if not room > 0:
        table.refuse(
            f"validity must be positive and finite at rest, lambda_1 = lambda_2 = lambda_3 = 1, got {room:.6g}",
            "validity",
        )


def _check_rest(table: Table, density: sp.Expr, own: tuple[Constant, ...]) -> None:
    """Refuse an energy that is stressed at rest with the values given; that it never is, is proved afterwards.

    A number settles at once what a proof might take minutes to refuse.
    """
    at = {sp.Symbol(each.name): sp.Float(each.value, 30) for each in own} | dict.fromkeys(STRETCHES, 1)
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


def _own_spring(table: Table) -> OwnSpring:
    table.only("energy", "parameters", "validity", "source", "viscosity", "relaxation_time")
    own = constants(table.table("parameters"), tuple(STRETCH_NAMES))
    names = {**STRETCH_NAMES, **{each.name: sp.Symbol(each.name) for each in own}}
    density = formula(table, "energy", names)
    _check_rest(table, density, own)
    if "validity" in table:
        _check_validity(table, formula(table, "validity", names), own)
    for each in own:
        if sp.Symbol(each.name) not in density.free_symbols:
            table.table("parameters").refuse(
                f"parameter {each.name!r} does not occur in the energy", each.name
            )
    source = plain_text(table, "source") if "source" in table else OwnSpring.source
    entry = OwnSpring(table.text("energy"), own, table.values.get("validity"), source)
    try:
        energy_of(entry, ALPHA)
    except ValueError as error:
        table.refuse(str(error), "energy")
    return entry


def plain_text(table: Table, key: str, value: object = None) -> str:
    """A text that can stand in a comment of emitted code: one line, no quotation marks, no backslash."""
    text = table.text(key) if value is None else value
    fine = (
        isinstance(text, str)
        and 0 < len(text) <= 200
        and text.isprintable()
        and not set(text) & set('"\\`{}')
    )
    if not fine:
        allowed = 'up to 200 printable characters in one line, without " \\ ` { }'
        table.refuse(f"{key} must be a text of {allowed}, got {shown(text)}", key)
    return text


def energy_of(entry: SpringEntry, spring: Spring) -> StrainEnergy:
    """The strain energy of a spring of the membrane.

    Raises:
        ValueError: an own energy breaks its unit or is not stress-free at rest.
    """
    if isinstance(entry, MaterialSpring):
        found = MATERIALS[entry.material]
        return found(spring, entry.terms) if found.kinds_of_term else found(spring)
    quantities = tuple(own_quantity(each, spring) for each in entry.constants)
    names = {**STRETCH_NAMES, **{c.name: q.symbol for c, q in zip(entry.constants, quantities, strict=True)}}
    return own_energy(
        "own",
        read_expression(entry.energy, names),
        STRETCHES,
        quantities,
        entry.source,
        None if entry.validity is None else read_expression(entry.validity, names),
    )


def values_of(entry: SpringEntry, spring: Spring) -> dict[str, float]:
    """Values of the parameters of a spring by their names in the model [SI]."""
    if isinstance(entry, OwnSpring):
        return {own_quantity(each, spring).name: each.value for each in entry.constants}
    kinds = MATERIALS[entry.material].kinds(entry.terms)
    return {kind.of(spring).name: entry.values[kind.name] for kind in kinds}


def own_quantity(constant: Constant, spring: Spring) -> Quantity:
    """The quantity that a user's constant is in a spring: `a` of the equilibrium spring is `a_alpha`.

    Raises:
        ValueError: the name is that of a known parameter with another unit.
    """
    kind = ParameterKind(
        constant.name,
        f"own_{constant.name}",
        constant.name,
        rf"\mathrm{{{constant.name.replace('_', '')}}}",
        constant.unit,
        f"parameter {constant.name}",
        positive=constant.value > 0,
    )
    quantity = kind.of(spring)
    if quantity.unit != constant.unit:
        raise ValueError(
            f"parameter {constant.name!r} must be in {quantity.unit}, got one in {constant.unit}"
        )
    return quantity


def modulus_at_rest(entry: SpringEntry) -> float:
    """Shear modulus of a spring at rest [Pa], with its values put in."""
    energy, values = energy_of(entry, ALPHA), values_of(entry, ALPHA)
    at = {quantity.symbol: sp.Float(values[quantity.name], 30) for quantity in energy.parameters}
    return float(sp.N(energy.shear_modulus.subs(at)))


def _check_modulus(table: Table, entry: SpringEntry, key: str) -> None:
    modulus = modulus_at_rest(entry)
    if not (modulus > 0 and modulus < float("inf")):
        table.refuse(
            f"the shear modulus of {table.title} at rest must be positive and finite, its energy has "
            f"{with_unit(modulus, 'Pa')}",
            key,
        )
