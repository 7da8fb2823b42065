"""From a description to its equations of motion, each of them and each part with its unit."""

from __future__ import annotations

from delagrange.derive.equations.derived_equations import (
    check_dimensions,
    check_model_dimensions,
    derived_equations,
)
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion, equations_of_motion, quantities_of
from delagrange.derive.membrane.checks import check_description, check_names
from delagrange.derive.membrane.description import Description
from delagrange.derive.membrane.loads import load_case_of
from delagrange.derive.membrane.membrane import membrane
from delagrange.derive.membrane.own_energy import check_functions


def description_equations(description: Description) -> EquationsOfMotion:
    """The equations of motion of a membrane, whosever it is.

    Raises:
        ValueError: the description is at odds with itself.
        DimensionError: a derived term breaks the unit of its equation, or a part that is emitted has another unit.
    """
    check_description(description)
    model = membrane(description)
    load_case = load_case_of(description, model)
    check_names(description.name, quantities_of(model, load_case))
    for expression in (*load_case.stretches, *(part.expression for part in model.energies.parts)):
        check_functions(f"model {description.name}", expression)
    eom = equations_of_motion(model, load_case)
    check_model_dimensions(eom)
    for equation in derived_equations(eom).values():
        check_dimensions(equation)
    return eom
