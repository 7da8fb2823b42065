"""From a description to the equations of motion of its membrane, each part with its unit."""

from __future__ import annotations

from delagrange.derive.equations.derived_equations import check_model_dimensions
from delagrange.derive.equations.electrical_dimensions import check_electrical_dimensions
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion, equations_of_motion
from delagrange.derive.membrane.checks import check_description, check_names
from delagrange.derive.membrane.described_load import load_case_of
from delagrange.derive.membrane.description import Description
from delagrange.derive.membrane.load_cases import LoadCase
from delagrange.derive.membrane.membrane import Membrane, described_membrane
from delagrange.derive.membrane.own_energy import check_functions
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity

_CONSTANT_ENERGIES = (s.KINETIC_ENERGY, s.POTENTIAL_ENERGY)


def description_equations(description: Description) -> EquationsOfMotion:
    """Equations of motion of a described membrane, each part with its unit.

    Raises:
        ValueError: the description is at odds with itself.
        DimensionError: a term has another unit.
    """
    check_description(description)
    model = described_membrane(description)
    load_case = load_case_of(description, model)
    quantities = quantities_of(model, load_case)
    check_names(description.name, quantities)
    for expression in (*load_case.stretches, *(part.expression for part in model.energies.parts)):
        check_functions(f"model {description.name}", expression)
    eom = equations_of_motion(model, load_case, quantities)
    check_model_dimensions(eom)
    check_electrical_dimensions(eom)
    return eom


def quantities_of(model: Membrane, load_case: LoadCase) -> tuple[Quantity, ...]:
    """All quantities that the equations of a model are written in, each once."""
    moving = (*load_case.coordinates, *load_case.internals)
    parts = (part for each in moving for part in (each.value, each.rate, each.acceleration))
    balance = model.charge_balance
    charge = () if balance is None else (balance.charge, balance.rate)
    known = (
        *parts, *charge, *load_case.inputs, *model.parameters, *load_case.parameters, *load_case.reactions,
        *_CONSTANT_ENERGIES,
    )  # fmt: skip
    return tuple(dict.fromkeys(known))
