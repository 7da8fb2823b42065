"""From what a frame does, as a description has it, to the load case that the equations are constrained by."""

from __future__ import annotations

import sympy as sp

from delagrange.derive.membrane.description import (
    BIAXIAL,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    RELATION,
    UNIAXIAL,
    Attachment,
    Description,
    Relation,
)
from delagrange.derive.membrane.load_cases import LoadCase
from delagrange.derive.membrane.membrane import Membrane, branch_internals
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent

_Inelastic = tuple[tuple[TimeDependent, ...], tuple[sp.Expr, ...]]  # what flows, xi of each branch and axis
_FRAME = "The frame does no work: its force is an output, not part of the potential."


def load_case_of(description: Description, model: Membrane) -> LoadCase:
    """The load case of a described membrane.

    Raises:
        ValueError: the load is not known, or does not fit what else is described.
    """
    kinds = {
        EQUAL_BIAXIAL: _equal_biaxial,
        UNIAXIAL: _two_stretches,
        BIAXIAL: _two_stretches,
        PURE_SHEAR: _pure_shear,
        RELATION: _relation,
    }
    kind = description.load.kind
    if kind not in kinds:
        raise ValueError(f"model {description.name}: load {kind!r}; allowed is one of {', '.join(kinds)}")
    return kinds[kind](description, model)


def _single(count: int) -> tuple[TimeDependent, ...]:
    """One inelastic stretch a branch."""
    return tuple(m.inelastic_stretch(number if count > 1 else None, None) for number in range(1, count + 1))


def _both(count: int) -> _Inelastic:
    """Two inelastic stretches a branch, as in the full membrane."""
    flowing = tuple(internal for pair in branch_internals(count)[:count] for internal in pair)
    return flowing, tuple(internal.value.symbol for internal in flowing)


def _equal_biaxial(description: Description, model: Membrane) -> LoadCase:
    _check_alike(description)
    flowing = _single(len(description.branches))
    stretch = m.STRETCH.value.symbol
    return LoadCase(
        name=description.name,
        family=EQUAL_BIAXIAL,
        title=description.title,
        coordinates=(m.STRETCH,),
        internals=flowing,
        inputs=(s.FORCE, model.field),
        stretches=(stretch, stretch),
        inelastic_stretches=tuple(each.value.symbol for each in flowing for _ in (1, 2)),
        forces=(s.FORCE.symbol, s.FORCE.symbol),
    )


def _check_alike(description: Description) -> None:
    """Both axes must be alike, or equal forces would not stretch them equally.

    Raises:
        ValueError: the sides, or what is attached to the edges, differ.
    """
    if not description.body.is_square:
        raise ValueError(
            f"model {description.name}: equal-biaxial load of a membrane whose sides are different quantities; "
            "allowed is a square one, or a load of two forces"
        )
    first, second = (_attached(description.attachments, axis) for axis in (1, 2))
    if first != second:
        raise ValueError(
            f"model {description.name}: equal-biaxial load with other masses or springs on axis 1 than on axis 2; "
            "allowed are the same quantities on both"
        )


def _attached(
    attachments: tuple[Attachment, ...], axis: int
) -> list[tuple[Quantity | None, Quantity | None]]:
    found = [(each.mass, each.stiffness) for each in attachments if each.axis == axis]
    return sorted(found, key=repr)


def _two_stretches(description: Description, model: Membrane) -> LoadCase:
    """Both axes free, under one force or two."""
    uniaxial = description.load.kind == UNIAXIAL
    flowing, inelastic = _both(len(description.branches))
    forces = (s.FORCE,) if uniaxial else (s.FORCE_1, s.FORCE_2)
    along_2 = sp.Integer(0) if uniaxial else s.FORCE_2.symbol
    return LoadCase(
        name=description.name,
        family=description.load.kind,
        title=description.title,
        coordinates=model.coordinates,
        internals=flowing,
        inputs=(*forces, model.field),
        stretches=(s.STRETCH_1.value.symbol, s.STRETCH_2.value.symbol),
        inelastic_stretches=inelastic,
        forces=(forces[0].symbol, along_2),
    )


def _pure_shear(description: Description, model: Membrane) -> LoadCase:
    count, free = len(description.branches), description.load.lateral_dashpots_free
    flowing, inelastic = _both_along_and_across(count) if free else _only_along(count)
    held = "The inelastic stretches along the held axis are themselves held at the held stretch."
    flows = "The inelastic stretches along the held axis flow."
    return LoadCase(
        name=description.name,
        family=PURE_SHEAR,
        title=description.title,
        coordinates=(m.STRETCH,),
        internals=flowing,
        inputs=(s.FORCE, model.field),
        stretches=(m.STRETCH.value.symbol, s.HELD_STRETCH.symbol),
        inelastic_stretches=inelastic,
        forces=(s.FORCE.symbol, s.REACTION_2.symbol),
        reactions=(s.REACTION_2,),
        parameters=(s.HELD_STRETCH,),
        remark=_FRAME + (f" {flows if free else held}" if count else ""),
    )


def _only_along(count: int) -> _Inelastic:
    flowing = _single(count)
    return flowing, tuple(xi for each in flowing for xi in (each.value.symbol, s.HELD_STRETCH.symbol))


def _both_along_and_across(count: int) -> _Inelastic:
    """With one branch, the names are those of the built-in model."""
    if count != 1:
        return _both(count)
    flowing = (m.inelastic_stretch(None, None), m.inelastic_stretch(None, 2))
    return flowing, tuple(each.value.symbol for each in flowing)


def _relation(description: Description, model: Membrane) -> LoadCase:
    relation = description.load.relation
    if relation is None:
        raise ValueError(f"model {description.name}: a load of the kind 'relation' needs the relation")
    check_relation(description.name, relation)
    flowing, inelastic = _both(len(description.branches))
    applied = _applied(relation)
    reactions = _reactions(relation)
    return LoadCase(
        name=description.name,
        family=RELATION,
        title=description.title,
        coordinates=(relation.coordinate,),
        internals=flowing,
        inputs=(*(force for force in applied if force is not None), model.field),
        stretches=relation.stretches,
        inelastic_stretches=inelastic,
        forces=(_total(applied[0], reactions[0]), _total(applied[1], reactions[1])),
        reactions=tuple(reaction for reaction in reactions if reaction is not None),
        parameters=relation.parameters,
        remark=_FRAME,
        start=(relation.start,),
    )


def _applied(relation: Relation) -> tuple[Quantity | None, Quantity | None]:
    """The force along each axis; a single one is called `force`."""
    names = (s.FORCE_1, s.FORCE_2) if all(relation.forces) else (s.FORCE, s.FORCE)
    first, second = (name if pulls else None for name, pulls in zip(names, relation.forces, strict=True))
    return first, second


def _reactions(relation: Relation) -> tuple[Quantity | None, Quantity | None]:
    """A force of the frame along both axes, or along the held one alone: on the other it would do work."""
    coordinate = relation.coordinate.value.symbol
    moves = [stretch.has(coordinate) for stretch in relation.stretches]
    if all(moves):
        return m.REACTIONS[0], m.REACTIONS[1]
    return (None, m.REACTIONS[1]) if moves[0] else (m.REACTIONS[0], None)


def _total(*forces: Quantity | None) -> sp.Expr:
    return sp.Add(*(force.symbol for force in forces if force is not None))


def check_relation(model: str, relation: Relation) -> None:
    """That a relation leaves one freedom, and is made of its coordinate and its parameters.

    Raises:
        ValueError: it does not.
    """
    coordinate = relation.coordinate.value
    quantities = (coordinate, *relation.parameters)
    known = {quantity.symbol for quantity in quantities}
    if not any(stretch.has(coordinate.symbol) for stretch in relation.stretches):
        raise ValueError(
            f"model {model}: the relation leaves no freedom: no stretch depends on {coordinate.name}"
        )
    for axis, stretch in enumerate(relation.stretches, start=1):
        for symbol in sorted(stretch.free_symbols - known, key=str):
            allowed = ", ".join(quantity.name for quantity in quantities)
            raise ValueError(f"model {model}: lambda_{axis} depends on {symbol}; allowed are {allowed}")
    for symbol in sorted(relation.start.free_symbols - (known - {coordinate.symbol}), key=str):
        raise ValueError(
            f"model {model}: the start of {coordinate.name} depends on {symbol}; allowed are parameters"
        )
