"""The road of a described membrane: description -> membrane -> equations -> kernel -> text of its modules."""

from __future__ import annotations

import re
from difflib import get_close_matches
from itertools import combinations
from keyword import iskeyword

from delagrange.derive.emit.lanes_module import emit_lanes
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.variational_module import emit_variational
from delagrange.derive.equations.derived_equations import check_model_dimensions
from delagrange.derive.equations.electrical_dimensions import check_electrical_dimensions
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion, equations_of_motion
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.kernel.lane_spec import lane_spec
from delagrange.derive.kernel.spec import KernelSpec, Origin
from delagrange.derive.kernel.variational_spec import variational_spec
from delagrange.derive.membrane.described_load import load_case_of
from delagrange.derive.membrane.description import CHARGE, VOLTAGE, Description
from delagrange.derive.membrane.load_cases import LoadCase
from delagrange.derive.membrane.membrane import Membrane, described_membrane
from delagrange.derive.membrane.own_energy import check_functions
from delagrange.derive.membrane.strain_energy import StrainEnergy
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity

_COMMAND = "delagrange derive"
_LEAKAGE = "Foo et al. (2012), J. Appl. Phys. 111, 034102"
_NAMES_IN_CODE = (  # beside the values and functions of a module: what its functions and kernels are written with
    "state", "inputs", "parameters", "np", "numba", "work", "rows", "out", "k", "columns", "frame", "sources", "vector",
    "rates", "reference_state", "volume", "least", "most",
)  # fmt: skip
_NUMBERED_IN_CODE = re.compile("(constant|factor|product|reciprocal|shared|room)(_[0-9]+)?")
_CONSTANT_ENERGIES = (s.KINETIC_ENERGY, s.POTENTIAL_ENERGY)


def derive_description(description: Description) -> tuple[tuple[str, str], ...]:
    """File name and text of the modules of a described membrane: NumPy, lanes, variational kernel.

    Raises:
        ValueError: the description is not whole, or at odds with itself.
        DimensionError: a term of what is derived has another unit than the others.
    """
    return emitted(description_spec(description))


def emitted(spec: KernelSpec) -> tuple[tuple[str, str], ...]:
    """File name and text of what is emitted for a model: its NumPy module and its two compiled kernels."""
    return (
        (f"{spec.name}.py", emit(spec)),
        (f"{spec.name}_lanes.py", emit_lanes(lane_spec(spec))),
        (f"{spec.name}_variational.py", emit_variational(variational_spec(spec))),
    )


def description_spec(description: Description) -> KernelSpec:
    """The description of the modules of a membrane."""
    eom = description_equations(description)
    _check_defaults(description, eom)
    sources = _sources(description)
    _check_texts(description, sources, eom.quantities)
    origin = Origin(_COMMAND, _body_text(description), "", sources, _start_text(eom.load_case))
    spec = kernel(eom, (), origin, description.defaults)
    _check_taken(spec)
    return spec


def description_equations(description: Description) -> EquationsOfMotion:
    """Equations of motion of a described membrane, each part with its unit.

    Raises:
        ValueError: the description is at odds with itself.
        DimensionError: a term has another unit.
    """
    _check_whole(description)
    model = described_membrane(description)
    load_case = load_case_of(description, model)
    quantities = quantities_of(model, load_case)
    _check_names(description.name, quantities)
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


# --- what a description must be ----------------------------------------------------------------


def _check_whole(description: Description) -> None:
    name = description.name
    if not name.isidentifier() or not name.isascii() or iskeyword(name):
        raise ValueError(
            f"model name {name!r}; allowed is a name of letters, digits and _ that Python can import"
        )
    if description.dielectric.control not in (VOLTAGE, CHARGE):
        control = description.dielectric.control
        raise ValueError(
            f"model {name}: electrodes under {control!r} control; allowed are {VOLTAGE}, {CHARGE}"
        )
    if description.dielectric.leakage is not None and description.dielectric.control != CHARGE:
        raise ValueError(
            f"model {name}: leakage under voltage control changes no motion, since the source holds the field; "
            f"allowed is leakage under {CHARGE} control"
        )
    for attachment in description.attachments:
        if attachment.axis not in (1, 2):
            raise ValueError(
                f"model {name}: something is attached to axis {attachment.axis}; allowed are 1 and 2"
            )


def _check_names(model: str, quantities: tuple[Quantity, ...]) -> None:
    """No two quantities may share a symbol or a name in code.

    Raises:
        ValueError: two do, or a name is none that code can use.
    """
    for quantity in quantities:
        if not quantity.name.isidentifier() or iskeyword(quantity.name):
            raise ValueError(
                f"model {model}: quantity {quantity.name!r}; allowed is a name that code can use"
            )
    for one, other in combinations(quantities, 2):
        if one.name == other.name or one.symbol == other.symbol:
            raise ValueError(
                f"model {model}: {one.name} ({one.meaning}) and {other.name} ({other.meaning}) share a name or "
                "symbol; allowed are names of their own"
            )


def _check_texts(
    description: Description, sources: tuple[str, ...], quantities: tuple[Quantity, ...]
) -> None:
    """What stands between quotation marks in emitted code must not end there.

    Raises:
        ValueError: a title, a source, or what a quantity says of itself is not such a text.
    """
    said = [text for each in quantities for text in (each.text, each.unit, each.meaning)]
    for text in (description.title, *sources, *said):
        if not text.isprintable() or set(text) & set('"\\'):
            raise ValueError(
                f"model {description.name}: the text {text!a}; allowed are printable characters in one line, "
                'without " and \\'
            )


def _check_taken(spec: KernelSpec) -> None:
    """No quantity may have a name that emitted code gives to something else.

    Raises:
        ValueError: one has.
    """
    functions = [function.name for function in spec.functions]
    values = [each.name for function in spec.functions for each in function.assignments]
    for quantity in (*spec.state, *spec.inputs, *spec.parameters):
        name = quantity.name
        if name in (*functions, *values, *_NAMES_IN_CODE) or _NUMBERED_IN_CODE.fullmatch(name):
            raise ValueError(
                f"model {spec.name}: quantity {name!r} ({quantity.meaning}) has the name of something else "
                "in emitted code; choose another name"
            )


def _check_defaults(description: Description, eom: EquationsOfMotion) -> None:
    names = [parameter.name for parameter in eom.parameters]
    for name in description.defaults:
        if name not in names:
            near = get_close_matches(name, names, n=1, cutoff=0.0)
            raise ValueError(
                f"model {description.name}: default of {name}, which is no parameter of it; nearest is {near[0]}"
            )


# --- what a module says of itself ----------------------------------------------------------------


def _body_text(description: Description) -> str:
    sides = "A square membrane of sides 2 L" if description.body.is_square else (
        "A rectangular membrane of sides 2 L_1 and 2 L_2"
    )  # fmt: skip
    return f"{sides} and thickness 2 H in the reference state"


def _start_text(load_case: LoadCase) -> str:
    if load_case.start is None:
        return ""
    return "State at rest where the relation between the stretches begins; dashpots have relaxed to the stretches."


def _sources(description: Description) -> tuple[str, ...]:
    energies: list[StrainEnergy] = [description.equilibrium_spring]
    energies += [branch.energy for branch in description.branches]
    own = [f"{energy.name}: {energy.source}" for energy in energies if energy.source]
    leakage = [] if description.dielectric.leakage is None else [f"leakage: {_LEAKAGE}"]
    return tuple(dict.fromkeys([*own, *leakage, *description.sources]))
