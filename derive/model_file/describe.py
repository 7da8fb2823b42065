"""From what a model file says to the description that the derivation starts from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType

import sympy as sp

from delagrange.common.roles import Sign
from delagrange.derive.membrane.description import (
    Attachment,
    Body,
    Description,
    Dielectric,
    Load,
    MaxwellBranch,
    Permittivity,
    Relation,
    constant_permittivity,
    numbered,
)
from delagrange.derive.membrane.materials import ALPHA, Spring, branch
from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.model_file.entries import (
    AttachmentEntry,
    BodyEntry,
    BranchEntry,
    Constant,
    DielectricEntry,
    LoadEntry,
    ModelFile,
    RelationEntry,
)
from delagrange.derive.model_file.expression import read_expression
from delagrange.derive.model_file.relation_coordinate import is_positive
from delagrange.derive.model_file.springs import STRETCH_NAMES, STRETCHES, energy_of, values_of
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent, moving, quantity

_DIELECTRIC, _RELATION = "permittivity", "relation"  # what the names of their constants begin with


def describe(model: ModelFile) -> Description:
    """The description of a membrane, with the file's values as its defaults."""
    springs = _branch_springs(model)
    return Description(
        name=model.name,
        title=model.title,
        load=_load(model.load),
        equilibrium_spring=energy_of(model.equilibrium_spring, ALPHA),
        branches=tuple(_branch(*each) for each in zip(model.branches, springs, strict=True)),
        body=_body(model.body),
        dielectric=_dielectric(model.dielectric),
        parallel_viscosity=None if model.parallel_viscosity is None else m.PARALLEL_VISCOSITY,
        medium_damping=None if model.medium_damping is None else m.MEDIUM_DAMPING,
        attachments=tuple(each for entry in model.attachments for each in _attachments(entry)),
        defaults=MappingProxyType(dict(_defaults(model, springs))),
        sources=model.sources,
    )


def _branch_springs(model: ModelFile) -> tuple[Spring, ...]:
    count = len(model.branches)
    return tuple(branch(number, of=count) for number in range(1, count + 1))


def _branch(entry: BranchEntry, spring: Spring) -> MaxwellBranch:
    return MaxwellBranch(energy_of(entry.spring, spring), _viscosity(spring))


def _viscosity(spring: Spring) -> Quantity:
    return s.VISCOSITY if spring.number is None else numbered(s.VISCOSITY, spring.number)


def _body(entry: BodyEntry) -> Body:
    return Body() if entry.half_length_2 is None else Body(m.HALF_LENGTH_1, m.HALF_LENGTH_2)


def _dielectric(entry: DielectricEntry) -> Dielectric:
    leakage = None if entry.conductivity is None else m.CONDUCTIVITY
    if not isinstance(entry.permittivity, str):
        return Dielectric(constant_permittivity(), entry.control, leakage)
    quantities = _quantities(_DIELECTRIC, entry.constants)
    law = read_expression(entry.permittivity, {**STRETCH_NAMES, **_symbols(entry.constants, quantities)})

    def of_stretches(stretches: Stretches) -> sp.Expr:
        return law.subs(dict(zip(STRETCHES, stretches, strict=True)), simultaneous=True)

    return Dielectric(Permittivity(quantities, of_stretches), entry.control, leakage)


def _quantities(prefix: str, constants: tuple[Constant, ...]) -> tuple[Quantity, ...]:
    """The user's constants as quantities of the model: `a` of a relation is `relation_a`."""
    return tuple(
        quantity(
            f"{prefix}_{each.name}",
            f"{prefix}_{each.name}",
            each.name,
            rf"\mathrm{{{each.name.replace('_', '')}}}",
            each.unit,
            f"parameter {each.name} of the {prefix}",
            positive=each.value > 0,
        )
        for each in constants
    )


def _symbols(constants: tuple[Constant, ...], quantities: tuple[Quantity, ...]) -> Mapping[str, sp.Symbol]:
    return {each.name: own.symbol for each, own in zip(constants, quantities, strict=True)}


def _load(entry: LoadEntry) -> Load:
    relation = None if entry.relation is None else _relation(entry.relation)
    return Load(entry.kind, entry.lateral_dashpots_free, relation)


def _relation(entry: RelationEntry) -> Relation:
    coordinate = _coordinate(entry)
    quantities = _quantities(_RELATION, entry.constants)
    names = {entry.coordinate: coordinate.value.symbol, **_symbols(entry.constants, quantities)}
    start = Fraction(repr(entry.start))
    return Relation(
        coordinate=coordinate,
        stretches=(read_expression(entry.lambda_1, names), read_expression(entry.lambda_2, names)),
        start=sp.Rational(start.numerator, start.denominator),
        forces=(1 in entry.forces, 2 in entry.forces),
        parameters=quantities,
    )


def _coordinate(entry: RelationEntry) -> TimeDependent:
    """The coordinate of a relation with its rates; it is positive only where it is known to be."""
    name = entry.coordinate
    own = f"coordinate_{name}"  # no name of emitted code begins so
    latex, meaning = name.replace("_", ""), f"coordinate {name} of the relation"
    coordinate = moving(own, own, name, latex, meaning)
    if is_positive(entry):
        return coordinate
    of_any_sign = replace(coordinate.value, symbol=sp.Symbol(own), sign=Sign.ANY)
    return replace(coordinate, value=of_any_sign)


def _attachments(entry: AttachmentEntry) -> tuple[Attachment, ...]:
    """One on each axis; on all four edges alike, one quantity stands for both axes."""
    axes = (1, 2) if entry.axis is None else (entry.axis,)
    return tuple(Attachment(axis, *_attached(entry, axis)) for axis in axes)


def _attached(entry: AttachmentEntry, axis: int) -> tuple[Quantity | None, Quantity | None]:
    mass = m.EDGE_MASS if entry.axis is None else m.EDGE_MASSES[axis - 1]
    stiffness = m.EDGE_STIFFNESS if entry.axis is None else m.EDGE_STIFFNESSES[axis - 1]
    return (None if entry.mass is None else mass, None if entry.stiffness is None else stiffness)


def _defaults(model: ModelFile, springs: tuple[Spring, ...]) -> dict[str, float]:
    """Values of all parameters by their names in the model [SI]."""
    values = _body_values(model.body) | _dielectric_values(model.dielectric)
    values |= values_of(model.equilibrium_spring, ALPHA)
    for entry, spring in zip(model.branches, springs, strict=True):
        values |= values_of(entry.spring, spring) | {_viscosity(spring).name: entry.viscosity}
    values |= {
        m.PARALLEL_VISCOSITY.name: model.parallel_viscosity,
        m.MEDIUM_DAMPING.name: model.medium_damping,
        s.HELD_STRETCH.name: model.load.held_stretch,
    }
    for entry in model.attachments:
        values |= _attachment_values(entry)
    if model.load.relation is not None:
        values |= _constant_values(_RELATION, model.load.relation.constants)
    return {name: value for name, value in values.items() if value is not None}


def _body_values(entry: BodyEntry) -> dict[str, float | None]:
    body = _body(entry)
    return {
        body.half_length_1.name: entry.half_length_1,
        **({} if entry.half_length_2 is None else {body.half_length_2.name: entry.half_length_2}),
        body.half_thickness.name: entry.half_thickness,
        body.density.name: entry.density,
    }


def _dielectric_values(entry: DielectricEntry) -> dict[str, float | None]:
    leakage = {m.CONDUCTIVITY.name: entry.conductivity}
    if isinstance(entry.permittivity, str):
        return _constant_values(_DIELECTRIC, entry.constants) | leakage
    return {s.PERMITTIVITY.name: entry.permittivity} | leakage


def _attachment_values(entry: AttachmentEntry) -> dict[str, float | None]:
    own = _attachments(entry)[0]
    return {
        part.name: value
        for part, value in ((own.mass, entry.mass), (own.stiffness, entry.stiffness))
        if part is not None
    }


def _constant_values(prefix: str, constants: tuple[Constant, ...]) -> dict[str, float | None]:
    return {f"{prefix}_{each.name}": each.value for each in constants}
