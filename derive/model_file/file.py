"""A user's membrane from a TOML file: every table, key, unit and formula checked as it is read.

    name = "gent_strip"
    title = "Gent membrane with one branch under uniaxial force"

    [body]
    half_length = "5 mm"                  # or half_length_1 and half_length_2
    half_thickness = "1 mm"
    density = "1200 kg/m^3"

    [equilibrium_spring]
    material = "Gent"                     # or energy = "a/2*(I_1 - 3)" with [equilibrium_spring.parameters]
    shear_modulus = "18 kPa"
    locking = 110

    [[branch]]                            # none, one or several
    material = "neo-Hookean"
    shear_modulus = "42 kPa"
    relaxation_time = "400 s"             # or viscosity, in Pa s

    [dielectric]
    permittivity = "61.98 pF/m"           # or permittivity_formula, with [dielectric.parameters]
    control = "voltage"                   # or "charge", alone or with a current that leaks:
                                          # conductivity = "1e-12 S/m"

    [damping]
    parallel_viscosity = "20 Pa s"        # a Kelvin-Voigt dashpot
    medium = "3 Pa s/m"                   # drag of the medium on both faces

    [load]
    kind = "uniaxial"                     # equal_biaxial, biaxial, pure_shear, relation

    [[attachment]]
    axis = 1                              # without it, on all four edges
    mass = "0.1 g"
    stiffness = "2 N/m"

A value is a number in SI units, or a text with its unit. `derive.model_loads` says what a load may hold.
"""

from __future__ import annotations

import keyword
import math
import re
import sys
from pathlib import Path

import sympy as sp

from delagrange.common.dimension import Dimension
from delagrange.common.units import shown, with_unit
from delagrange.derive.membrane.description import CHARGE, EQUAL_BIAXIAL, VOLTAGE
from delagrange.derive.membrane.load_cases import EMITTED
from delagrange.derive.membrane.own_energy import check_functions
from delagrange.derive.model_file.entries import (
    AttachmentEntry,
    BodyEntry,
    BranchEntry,
    Constant,
    DielectricEntry,
    LoadEntry,
    ModelFile,
)
from delagrange.derive.model_file.loads import held_axes, read_load
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.springs import (
    STRETCH_NAMES,
    STRETCHES,
    assumed,
    at_rest,
    constants,
    formula,
    modulus_at_rest,
    plain_text,
    read_spring,
)
from delagrange.derive.model_file.toml_table import Table, read_toml
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import dimension_of
from delagrange.derive.notation.symbols import Quantity

MOST_BRANCHES = 9  # more would make the names of inelastic stretches ambiguous
_NAME = re.compile("[a-z][a-z0-9_]{0,39}")
_MODULES = (
    "delagrange",
    "numpy",
    "numba",
    "scipy",
    "sympy",
    "xarray",
    "matplotlib",
)  # that a folder would hide
_KERNELS = ("_lanes", "_variational")  # endings of the kernels beside a module
_TABLES = ("body", "equilibrium_spring", "branch", "dielectric", "damping", "load", "attachment")


def read_model_file(path: Path) -> ModelFile:
    """Read and check a model file.

    Raises:
        ModelError: anything in it that is not understood, is missing, does not fit, or does not make a
            membrane; one line with the file, the line and the reason.
    """
    whole = read_toml(path)
    whole.only("name", "title", "sources", *_TABLES)
    load = read_load(_present(whole, "load"))
    return ModelFile(
        name=_name(whole),
        title=plain_text(whole, "title"),
        sources=_sources(whole),
        body=_body(_present(whole, "body"), load),
        equilibrium_spring=_equilibrium_spring(_present(whole, "equilibrium_spring")),
        branches=_branches(whole),
        dielectric=_dielectric(_present(whole, "dielectric")),
        parallel_viscosity=_damping(whole, "parallel_viscosity", m.PARALLEL_VISCOSITY),
        medium_damping=_damping(whole, "medium", m.MEDIUM_DAMPING),
        load=load,
        attachments=_attachments(whole, load),
    )


def _present(whole: Table, name: str) -> Table:
    if name not in whole:
        whole.refuse(f"the file needs a table [{name}]")
    return whole.table(name)


def _name(whole: Table) -> str:
    name = whole.text("name")
    if not _NAME.fullmatch(name) or keyword.iskeyword(name) or name.endswith(_KERNELS):
        allowed = "up to 40 of a-z, 0-9 and _, the first a letter, no word of Python, not ending in "
        whole.refuse(f"name must be {allowed}{' or '.join(_KERNELS)}, got {shown(name)}", "name")
    if name in sys.stdlib_module_names or name in (*_MODULES, *(case.name for case in EMITTED)):
        whole.refuse(f"name {name!r} is that of another module; choose one of your own", "name")
    return name


def _sources(whole: Table) -> tuple[str, ...]:
    if "sources" not in whole:
        return ()
    return tuple(plain_text(whole, "sources", each) for each in whole.sequence("sources"))


def _body(table: Table, load: LoadEntry) -> BodyEntry:
    table.only("half_length", "half_length_1", "half_length_2", "half_thickness", "density")
    square = table.one_of("half_length", "half_length_1") == "half_length"
    if square and "half_length_2" in table:
        table.refuse("half_length and half_length_2 over-determine the body; a rectangle has half_length_1 "
                     "and half_length_2", "half_length_2")  # fmt: skip
    if not square and load.kind == EQUAL_BIAXIAL:
        table.refuse(
            "the sides of a membrane under equal-biaxial load are equal: give half_length", "half_length_1"
        )
    return BodyEntry(
        table.value_of("half_length" if square else "half_length_1", s.HALF_LENGTH),
        None if square else table.value_of("half_length_2", m.HALF_LENGTH_2),
        table.value_of("half_thickness", s.HALF_THICKNESS),
        table.value_of("density", s.DENSITY),
    )


def _equilibrium_spring(table: Table):
    for key in ("viscosity", "relaxation_time"):
        if key in table:
            table.refuse(f"the equilibrium spring has no dashpot: {key} belongs in a [[branch]]", key)
    return read_spring(table)


def _branches(whole: Table) -> tuple[BranchEntry, ...]:
    tables = whole.tables("branch")
    if len(tables) > MOST_BRANCHES:
        tables[MOST_BRANCHES].refuse(f"a membrane has at most {MOST_BRANCHES} branches, got {len(tables)}")
    return tuple(_branch(table) for table in tables)


def _branch(table: Table) -> BranchEntry:
    spring = read_spring(table)
    if table.one_of("viscosity", "relaxation_time") == "viscosity":
        return BranchEntry(spring, table.value_of("viscosity", s.VISCOSITY))
    time, modulus = table.number("relaxation_time", "s"), modulus_at_rest(spring)
    viscosity = time * modulus
    if not 0 < viscosity < math.inf:
        table.refuse(
            f"relaxation_time = {with_unit(time, 's')} makes a viscosity of {with_unit(viscosity, 'Pa s')} with the "
            f"shear modulus {with_unit(modulus, 'Pa')}; allowed is one that is positive and finite",
            "relaxation_time",
        )
    return BranchEntry(spring, viscosity)


def _dielectric(table: Table) -> DielectricEntry:
    table.only("permittivity", "permittivity_formula", "parameters", "control", "conductivity")
    control = table.choice("control", (VOLTAGE, CHARGE), default=VOLTAGE)
    conductivity = _conductivity(table, control)
    if table.one_of("permittivity", "permittivity_formula") == "permittivity":
        if "parameters" in table:
            table.refuse("parameters belong to a permittivity_formula, and there is none", "parameters")
        return DielectricEntry(table.value_of("permittivity", s.PERMITTIVITY), (), control, conductivity)
    own = constants(table.table("parameters"), tuple(STRETCH_NAMES))
    symbols = {each.name: sp.Symbol(each.name) for each in own}
    law = formula(table, "permittivity_formula", {**STRETCH_NAMES, **symbols})
    dimensions = {stretch: Dimension() for stretch in STRETCHES}
    dimensions |= {symbols[each.name]: Dimension.of_unit(each.unit) for each in own}
    _check_permittivity(table, law, dimensions, own)
    return DielectricEntry(table.text("permittivity_formula"), own, control, conductivity)


def _conductivity(table: Table, control: str) -> float | None:
    if "conductivity" not in table:
        return None
    if control != CHARGE:
        table.refuse(f"conductivity needs control = {shown(CHARGE)}: under voltage control the source holds the "
                     "field, and leakage changes no motion", "conductivity")  # fmt: skip
    return table.value_of("conductivity", m.CONDUCTIVITY)


def _check_permittivity(
    table: Table, law: sp.Expr, dimensions: dict[sp.Symbol, Dimension], own: tuple[Constant, ...]
) -> None:
    key = "permittivity_formula"
    try:
        check_functions("the formula", law.subs({sp.Symbol(each.name): assumed(each) for each in own}))
        found = dimension_of(law, dimensions)
    except ValueError as error:
        table.refuse(f"{key}: {error}", key)
    if found != Dimension.of_unit("F/m"):
        table.refuse(f"{key} has the dimension {found}; needed is F/m ({Dimension.of_unit('F/m')})", key)
    if not (value := number_at(law, at_rest(own))) > 0:
        table.refuse(f"{key} must be positive and finite at rest, got {with_unit(value, 'F/m')}", key)


def _damping(whole: Table, key: str, quantity: Quantity) -> float | None:
    table = whole.table("damping")
    table.only("parallel_viscosity", "medium")
    return table.value_of(key, quantity) if key in table else None


def _attachments(whole: Table, load: LoadEntry) -> tuple[AttachmentEntry, ...]:
    found: list[AttachmentEntry] = []
    for table in whole.tables("attachment"):
        entry = _attachment(table, held_axes(load))
        if load.kind == EQUAL_BIAXIAL and entry.axis is not None:
            table.refuse("under equal-biaxial load all four edges carry the same: leave the axis out", "axis")
        if any(entry.axis is None or other.axis in (None, entry.axis) for other in found):
            table.refuse(f"{table.title} over-determines edges that another one is on already")
        found.append(entry)
    return tuple(found)


def _attachment(table: Table, held: tuple[int, ...]) -> AttachmentEntry:
    table.only("axis", "mass", "stiffness")
    axis = table.values.get("axis")
    if axis is not None and (isinstance(axis, bool) or axis not in (1, 2)):
        table.refuse(f"axis must be 1 or 2, got {shown(axis)}", "axis")
    if axis in held or (axis is None and held):
        table.refuse(f"the edges normal to axis {held[0]} are held: nothing attached to them moves", "axis")
    if "mass" not in table and "stiffness" not in table:
        table.refuse(f"{table.title} needs a mass, a stiffness or both")
    return AttachmentEntry(
        None if axis is None else int(axis),
        table.value_of("mass", m.EDGE_MASS) if "mass" in table else None,
        table.value_of("stiffness", m.EDGE_STIFFNESS) if "stiffness" in table else None,
    )
