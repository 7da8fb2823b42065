"""What frames do: from the load of a description to the load case that its equations are constrained by.

A new kind of load is one function here and its line in `LOADS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import sympy as sp

from delagrange.derive.membrane.description import (
    BIAXIAL,
    CONSTRAINED_VARIATION,
    EQUAL_BIAXIAL,
    FREE,
    PURE_SHEAR,
    REACTION_IN_POTENTIAL,
    RELATION,
    UNIAXIAL,
    Attachment,
    Description,
    Relation,
)
from delagrange.derive.membrane.load_case import LoadCase
from delagrange.derive.membrane.membrane import Membrane, branch_internals
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent

_FORMULATIONS = (CONSTRAINED_VARIATION, REACTION_IN_POTENTIAL)
_WORKLESS = "The frame does no work: its force is an output, not part of the potential."
_INSERTED = (
    "The force of the frame is put into the potential before the variation, a step that a workless constraint "
    "does not allow; the formulation for mechanics is the consistent one."
)


def load_case_of(description: Description, model: Membrane) -> LoadCase:
    """The load case of a description.

    Raises:
        ValueError: the load is not known, or does not fit what else is described.
    """
    load, name = description.load, description.name
    if load.kind not in LOADS:
        raise ValueError(f"model {name}: load {load.kind!r}; allowed is one of {', '.join(LOADS)}")
    if load.kind != FREE and len(model.coordinates) != 2:
        raise ValueError(f"model {name}: load {load.kind!r} of a body without two axes; allowed is {FREE!r}")
    if load.formulation not in _FORMULATIONS:
        raise ValueError(
            f"model {name}: formulation {load.formulation!r}; allowed are {', '.join(_FORMULATIONS)}"
        )
    case = LOADS[load.kind](description, model)
    if load.formulation == REACTION_IN_POTENTIAL:
        _check_held(case)
    return case


def _check_held(case: LoadCase) -> None:
    """That every force of the frame is all that pulls along an axis whose stretch is constant.

    Raises:
        ValueError: one is not, so that there is no potential to put it into.
    """
    moving = {coordinate.value.symbol for coordinate in case.coordinates}
    held = [force for force, stretch in zip(case.forces, case.stretches, strict=True)
            if not stretch.free_symbols & moving]  # fmt: skip
    if not case.reactions or any(reaction.symbol not in held for reaction in case.reactions):
        raise ValueError(
            f"model {case.name}: formulation {case.formulation!r} of a load that holds no axis alone; allowed is "
            f"{CONSTRAINED_VARIATION}"
        )


def _load_case(
    description: Description,
    model: Membrane,
    *,
    coordinates: tuple[TimeDependent, ...],
    internals: tuple[TimeDependent, ...],
    inputs: tuple[Quantity, ...],
    stretches: Callable[..., tuple[sp.Expr, ...]],
    inelastic: Callable[..., tuple[sp.Expr, ...]],
    **parts,
) -> LoadCase:
    """A load case in the notation of its description; stretches are made of the coordinates as written there."""
    notation, load = description.notation, description.load
    moving = _written(description.name, "coordinates", notation.coordinates, coordinates)
    flowing = _written(description.name, "inelastic stretches", notation.internals, internals)
    remark = parts.pop("remark", "")
    return LoadCase(
        name=description.name,
        family=load.kind,
        title=description.title,
        coordinates=moving,
        internals=flowing,
        inputs=(*inputs, model.field),
        stretches=stretches(*(each.value.symbol for each in moving)),
        inelastic_stretches=inelastic(*(each.value.symbol for each in flowing)),
        formulation=load.formulation,
        remark=description.remark or remark,
        **parts,
    )


def _written(
    model: str, what: str, own: tuple[TimeDependent, ...], usual: tuple[TimeDependent, ...]
) -> tuple[TimeDependent, ...]:
    if own and len(own) != len(usual):
        raise ValueError(
            f"model {model}: its notation has {len(own)} {what}; allowed are the {len(usual)} of its load"
        )
    return own or usual


def _all(*symbols: sp.Symbol) -> tuple[sp.Symbol, ...]:
    return symbols


def _one_a_branch(count: int) -> tuple[TimeDependent, ...]:
    return tuple(m.inelastic_stretch(number if count > 1 else None, None) for number in range(1, count + 1))


def _all_of_branches(description: Description, model: Membrane) -> tuple[TimeDependent, ...]:
    """As many inelastic stretches a branch as in the full membrane."""
    pairs = branch_internals(len(description.branches), len(model.coordinates))
    return tuple(internal for pair in pairs for internal in pair)


# --- the kinds -------------------------------------------------------------------------------------


def _equal_biaxial(description: Description, model: Membrane) -> LoadCase:
    _check_alike(description)
    return _load_case(
        description,
        model,
        coordinates=(m.STRETCH,),
        internals=_one_a_branch(len(description.branches)),
        inputs=(s.FORCE,),
        stretches=lambda stretch: (stretch, stretch),
        inelastic=lambda *flowing: tuple(xi for xi in flowing for _ in (1, 2)),
        forces=(s.FORCE.symbol, s.FORCE.symbol),
    )


def _check_alike(description: Description) -> None:
    """Both axes must be alike, or equal forces would not stretch them equally.

    Raises:
        ValueError: the body, or what is attached to its edges, differs.
    """
    if description.body.unlike:
        raise ValueError(
            f"model {description.name}: equal-biaxial load of a membrane whose {description.body.unlike}; "
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


def _free(description: Description, model: Membrane) -> LoadCase:
    """Every coordinate of the body free, under the force that works on it."""
    forces = tuple(force.symbol for force in model.forces)
    return _unconstrained(description, model, model.forces, forces)


def _uniaxial(description: Description, model: Membrane) -> LoadCase:
    return _unconstrained(description, model, (s.FORCE,), (s.FORCE.symbol, sp.Integer(0)))


def _unconstrained(
    description: Description, model: Membrane, inputs: tuple[Quantity, ...], forces: tuple[sp.Expr, ...]
) -> LoadCase:
    return _load_case(
        description,
        model,
        coordinates=model.coordinates,
        internals=_all_of_branches(description, model),
        inputs=inputs,
        stretches=_all,
        inelastic=_all,
        forces=forces,
    )


def _pure_shear(description: Description, model: Membrane) -> LoadCase:
    count, free = len(description.branches), description.load.lateral_dashpots_free
    held = s.HELD_STRETCH.symbol
    holds = "The inelastic stretches along the held axis are themselves held at the held stretch."
    flows = "The inelastic stretches along the held axis flow."
    frame = _WORKLESS if description.load.formulation == CONSTRAINED_VARIATION else _INSERTED
    return _load_case(
        description,
        model,
        coordinates=(m.STRETCH,),
        internals=_along_and_across(description, model) if free else _one_a_branch(count),
        inputs=(s.FORCE,),
        stretches=lambda stretch: (stretch, held),
        inelastic=_all if free else lambda *flowing: tuple(xi for along in flowing for xi in (along, held)),
        forces=(s.FORCE.symbol, s.REACTION_2.symbol),
        reactions=(s.REACTION_2,),
        parameters=(s.HELD_STRETCH,),
        remark=frame + (f" {flows if free else holds}" if count else ""),
    )


def _along_and_across(description: Description, model: Membrane) -> tuple[TimeDependent, ...]:
    """With one branch, the one along the force has no number, as where the other is held."""
    if len(description.branches) != 1:
        return _all_of_branches(description, model)
    return (m.inelastic_stretch(None, None), m.inelastic_stretch(None, 2))


def _relation(description: Description, model: Membrane) -> LoadCase:
    relation = description.load.relation
    if relation is None:
        raise ValueError(f"model {description.name}: a load of the kind 'relation' needs the relation")
    check_relation(description.name, relation)
    if description.notation.coordinates:
        raise ValueError(
            f"model {description.name}: its notation has a coordinate; allowed is that of its relation alone"
        )
    applied, reactions = _applied(relation), _reactions(relation)
    return _load_case(
        description,
        model,
        coordinates=(relation.coordinate,),
        internals=_all_of_branches(description, model),
        inputs=tuple(force for force in applied if force is not None),
        stretches=lambda _: relation.stretches,
        inelastic=_all,
        forces=(_total(applied[0], reactions[0]), _total(applied[1], reactions[1])),
        reactions=tuple(reaction for reaction in reactions if reaction is not None),
        parameters=relation.parameters,
        remark=_WORKLESS if description.load.formulation == CONSTRAINED_VARIATION else _INSERTED,
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


LOADS: Mapping[str, Callable[[Description, Membrane], LoadCase]] = MappingProxyType(
    {
        EQUAL_BIAXIAL: _equal_biaxial,
        UNIAXIAL: _uniaxial,
        BIAXIAL: _free,
        PURE_SHEAR: _pure_shear,
        RELATION: _relation,
        FREE: _free,
    }
)
