"""The dielectric of a model file: its permittivity, what drives its electrodes, and whether it leaks."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.common.units import shown, with_unit
from delagrange.derive.membrane.description import (
    CHARGE,
    VOLTAGE,
    Dielectric,
    Permittivity,
    constant_permittivity,
)
from delagrange.derive.membrane.own_energy import check_functions
from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.model_file.formulas import (
    STRETCH_NAMES,
    STRETCHES,
    Constants,
    at_rest,
    constants,
    formula,
    in_quantities,
    names_of,
    quantities_of,
    values_of,
)
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import dimension_of

_KEY = "permittivity_formula"


def read_dielectric(table: Table) -> tuple[Dielectric, dict[str, float]]:
    """The dielectric that a table describes, and the values of its parameters by name [SI].

    Raises:
        ModelError: unknown or missing keys, a unit that does not fit, leakage under voltage control, or a formula
            that cannot be read or gives no permittivity.
    """
    table.only("permittivity", _KEY, "parameters", "control", "conductivity")
    control = table.choice("control", (VOLTAGE, CHARGE), default=VOLTAGE)
    leakage = _conductivity(table, control)
    permittivity, values = _permittivity(table)
    conductor = m.CONDUCTIVITY if leakage else None
    return Dielectric(permittivity, control, conductor), values | leakage


def _conductivity(table: Table, control: str) -> dict[str, float]:
    if "conductivity" not in table:
        return {}
    if control != CHARGE:
        table.refuse(f"conductivity needs control = {shown(CHARGE)}: under voltage control the source holds the "
                     "field, and leakage changes no motion", "conductivity")  # fmt: skip
    return {m.CONDUCTIVITY.name: table.value_of("conductivity", m.CONDUCTIVITY)}


def _permittivity(table: Table) -> tuple[Permittivity, dict[str, float]]:
    if table.one_of("permittivity", _KEY) == "permittivity":
        if "parameters" in table:
            table.refuse("parameters belong to a permittivity_formula, and there is none", "parameters")
        return constant_permittivity(), {s.PERMITTIVITY.name: table.value_of("permittivity", s.PERMITTIVITY)}
    own = constants(table.table("parameters"), tuple(STRETCH_NAMES))
    law = formula(table, _KEY, {**STRETCH_NAMES, **names_of(own)})
    _check(table, law, own)
    made = quantities_of("permittivity", own)
    return Permittivity(made, _of_stretches(in_quantities(law, own, made))), values_of(own, made)


def _of_stretches(law: sp.Expr) -> Callable[[Stretches], sp.Expr]:
    def at(stretches: Stretches) -> sp.Expr:
        return law.subs(dict(zip(STRETCHES, stretches, strict=True)), simultaneous=True)

    return at


def _check(table: Table, law: sp.Expr, own: Constants) -> None:
    dimensions = {stretch: Dimension() for stretch in STRETCHES}
    dimensions |= {each.symbol: Dimension.of_unit(each.unit) for each in own}
    try:
        check_functions("the formula", law)
        found = dimension_of(law, dimensions)
    except ValueError as error:
        table.refuse(f"{_KEY}: {error}", _KEY)
    if found != Dimension.of_unit("F/m"):
        table.refuse(f"{_KEY} has the dimension {found}; needed is F/m ({Dimension.of_unit('F/m')})", _KEY)
    if not (value := number_at(law, at_rest(own))) > 0:
        table.refuse(f"{_KEY} must be positive and finite at rest, got {with_unit(value, 'F/m')}", _KEY)
