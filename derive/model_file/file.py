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

A value is a number in SI units, or a text with its unit. `loads` says what a load may hold.
"""

from __future__ import annotations

import keyword
import math
import re
import sys
from importlib import resources
from pathlib import Path
from types import MappingProxyType

from delagrange.common.units import shown, with_unit
from delagrange.derive.membrane.body import Body
from delagrange.derive.membrane.description import (
    EQUAL_BIAXIAL,
    Attachment,
    Description,
    Load,
    MaxwellBranch,
    numbered,
)
from delagrange.derive.membrane.materials import ALPHA, Spring, branch
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.model_file.dielectric import read_dielectric
from delagrange.derive.model_file.loads import held_axes, read_load
from delagrange.derive.model_file.springs import ReadSpring, read_spring
from delagrange.derive.model_file.toml_table import Table, read_toml
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity

Values = dict[str, float]  # of parameters by name [SI]

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
_DAMPING = (("parallel_viscosity", m.PARALLEL_VISCOSITY), ("medium", m.MEDIUM_DAMPING))


def read_model_file(path: Path) -> Description:
    """Read and check a model file: the membrane that it describes, with its values as defaults.

    Raises:
        ModelError: anything in it that is not understood, is missing, does not fit, or does not make a
            membrane; one line with the file, the line and the reason.
    """
    whole = read_toml(path)
    whole.only("name", "title", "sources", *_TABLES)
    load, of_load = read_load(_present(whole, "load"))
    name, title, sources = _name(whole), whole.plain_text("title"), _sources(whole)
    body, of_body = _body(_present(whole, "body"), load)
    equilibrium = _equilibrium_spring(_present(whole, "equilibrium_spring"))
    branches, of_branches = _branches(whole)
    dielectric, of_dielectric = read_dielectric(_present(whole, "dielectric"))
    damping = _damping(whole)
    attachments, of_attachments = _attachments(whole, load)
    values = of_body | of_dielectric | equilibrium.values | of_branches | damping | of_load | of_attachments
    return Description(
        name=name,
        title=title,
        load=load,
        equilibrium_spring=equilibrium.energy,
        branches=branches,
        body=body,
        dielectric=dielectric,
        parallel_viscosity=m.PARALLEL_VISCOSITY if m.PARALLEL_VISCOSITY.name in damping else None,
        medium_damping=m.MEDIUM_DAMPING if m.MEDIUM_DAMPING.name in damping else None,
        attachments=attachments,
        defaults=MappingProxyType(values),
        sources=sources,
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
    built_in = (each.name.removesuffix(".py") for each in resources.files("delagrange.generated").iterdir())
    if name in sys.stdlib_module_names or name in (*_MODULES, *built_in):
        whole.refuse(f"name {name!r} is that of another module; choose one of your own", "name")
    return name


def _sources(whole: Table) -> tuple[str, ...]:
    if "sources" not in whole:
        return ()
    return tuple(whole.plain_text("sources", each) for each in whole.sequence("sources"))


def _body(table: Table, load: Load) -> tuple[Body, Values]:
    table.only("half_length", "half_length_1", "half_length_2", "half_thickness", "density")
    square = table.one_of("half_length", "half_length_1") == "half_length"
    if square and "half_length_2" in table:
        table.refuse("half_length and half_length_2 over-determine the body; a rectangle has half_length_1 "
                     "and half_length_2", "half_length_2")  # fmt: skip
    if not square and load.kind == EQUAL_BIAXIAL:
        table.refuse(
            "the sides of a membrane under equal-biaxial load are equal: give half_length", "half_length_1"
        )
    body = rectangle() if square else rectangle(m.HALF_LENGTH_1, m.HALF_LENGTH_2)
    return body, {each.name: table.value_of(each.name, each) for each in body.parameters}


def _equilibrium_spring(table: Table) -> ReadSpring:
    for key in ("viscosity", "relaxation_time"):
        if key in table:
            table.refuse(f"the equilibrium spring has no dashpot: {key} belongs in a [[branch]]", key)
    return read_spring(table, ALPHA)


def _branches(whole: Table) -> tuple[tuple[MaxwellBranch, ...], Values]:
    tables = whole.tables("branch")
    if len(tables) > MOST_BRANCHES:
        tables[MOST_BRANCHES].refuse(f"a membrane has at most {MOST_BRANCHES} branches, got {len(tables)}")
    made = [_branch(table, branch(number, of=len(tables))) for number, table in enumerate(tables, start=1)]
    return tuple(each for each, _ in made), {
        name: value for _, values in made for name, value in values.items()
    }


def _branch(table: Table, spring: Spring) -> tuple[MaxwellBranch, Values]:
    read, viscosity = read_spring(table, spring), _viscosity(spring)
    values = {**read.values, viscosity.name: _viscosity_value(table, read)}
    return MaxwellBranch(read.energy, viscosity), values


def _viscosity(spring: Spring) -> Quantity:
    return s.VISCOSITY if spring.number is None else numbered(s.VISCOSITY, spring.number)


def _viscosity_value(table: Table, spring: ReadSpring) -> float:
    """In Pa s, as it stands or from the relaxation time."""
    if table.one_of("viscosity", "relaxation_time") == "viscosity":
        return table.value_of("viscosity", s.VISCOSITY)
    time, modulus = table.number("relaxation_time", "s"), spring.modulus_at_rest
    viscosity = time * modulus
    if not 0 < viscosity < math.inf:
        table.refuse(
            f"relaxation_time = {with_unit(time, 's')} makes a viscosity of {with_unit(viscosity, 'Pa s')} with the "
            f"shear modulus {with_unit(modulus, 'Pa')}; allowed is one that is positive and finite",
            "relaxation_time",
        )
    return viscosity


def _damping(whole: Table) -> Values:
    table = whole.table("damping")
    table.only(*(key for key, _ in _DAMPING))
    return {made.name: table.value_of(key, made) for key, made in _DAMPING if key in table}


def _attachments(whole: Table, load: Load) -> tuple[tuple[Attachment, ...], Values]:
    found: list[Attachment] = []
    values: Values = {}
    for table in whole.tables("attachment"):
        attachments, own = _attachment(table, held_axes(load))
        if load.kind == EQUAL_BIAXIAL and len(attachments) == 1:
            table.refuse("under equal-biaxial load all four edges carry the same: leave the axis out", "axis")
        if {each.axis for each in attachments} & {each.axis for each in found}:
            table.refuse(f"{table.title} over-determines edges that another one is on already")
        found += attachments
        values |= own
    return tuple(found), values


def _attachment(table: Table, held: tuple[int, ...]) -> tuple[tuple[Attachment, ...], Values]:
    """One on each axis; on all four edges alike, one quantity stands for both axes."""
    table.only("axis", "mass", "stiffness")
    axis = table.values.get("axis")
    if axis is not None and (isinstance(axis, bool) or axis not in (1, 2)):
        table.refuse(f"axis must be 1 or 2, got {shown(axis)}", "axis")
    if axis in held or (axis is None and held):
        table.refuse(f"the edges normal to axis {held[0]} are held: nothing attached to them moves", "axis")
    if "mass" not in table and "stiffness" not in table:
        table.refuse(f"{table.title} needs a mass, a stiffness or both")
    both = (m.EDGE_MASS, m.EDGE_STIFFNESS)
    mass, stiffness = both if axis is None else (m.EDGE_MASSES[axis - 1], m.EDGE_STIFFNESSES[axis - 1])
    given = {key: made for key, made in (("mass", mass), ("stiffness", stiffness)) if key in table}
    axes = (1, 2) if axis is None else (int(axis),)
    values = {made.name: table.value_of(key, made) for key, made in given.items()}
    return tuple(Attachment(each, **given) for each in axes), values
