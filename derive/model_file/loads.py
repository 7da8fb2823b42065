"""The load of a model file: what a frame holds, which forces it applies, or a relation of the user's own.

kind = "equal_biaxial" | "uniaxial" | "biaxial"

kind = "pure_shear"
held_stretch = 2                      # at which axis 2 is held
lateral_dashpots = "free"             # or "held": whether dashpots flow along axis 2
formulation = "consistent"            # or "as_printed": the force of the frame is put into the potential

kind = "relation"                     # both stretches follow one coordinate
coordinate = "q"
lambda_1 = "q"
lambda_2 = "q^-a"
start = 1                             # value of q in the reference state, any number
forces = [1]                          # axes along which forces are applied
[load.parameters]
a = 0.3
"""

from __future__ import annotations

from delagrange.derive.membrane.description import (
    CONSTRAINED_VARIATION,
    FREE,
    PURE_SHEAR,
    REACTION_IN_POTENTIAL,
    RELATION,
    Load,
)
from delagrange.derive.membrane.loads import LOADS
from delagrange.derive.model_file.relation import read_relation
from delagrange.derive.model_file.toml_table import Table
from delagrange.derive.notation import symbols as s

_KINDS = tuple(kind for kind in LOADS if kind != FREE)  # of a rectangle; all of its coordinates free are `biaxial`
_KEYS = {  # beside the kind, of those that have some
    PURE_SHEAR: ("held_stretch", "lateral_dashpots", "formulation"),
    RELATION: ("coordinate", "lambda_1", "lambda_2", "start", "forces", "parameters"),
}
KEYS = ("kind", *(key for keys in _KEYS.values() for key in keys))
_THICKNESS = ("lambda_3",)


def read_load(table: Table) -> tuple[Load, dict[str, float]]:
    """The load that a table describes, and the values of its parameters by name [SI].

    Raises:
        ModelError: an unknown kind or key, a key that over-determines the stretches, or a relation that
            leaves no freedom, cannot be read, or gives a stretch that is not positive at the start.
    """
    kind = table.choice("kind", _KINDS)
    _refuse_more_than_enough(table, kind)
    table.only("kind", *_KEYS.get(kind, ()))
    if kind == RELATION:
        relation, values = read_relation(table, KEYS)
        return Load(kind, relation=relation), values
    if kind != PURE_SHEAR:
        return Load(kind), {}
    dashpots = table.choice("lateral_dashpots", ("free", "held"), default="free")
    formulations = (CONSTRAINED_VARIATION, REACTION_IN_POTENTIAL)
    formulation = table.choice("formulation", formulations, default=CONSTRAINED_VARIATION)
    values = {s.HELD_STRETCH.name: table.value_of("held_stretch", s.HELD_STRETCH)}
    return Load(kind, dashpots == "free", formulation=formulation), values


def _refuse_more_than_enough(table: Table, kind: str) -> None:
    for key in table.values:
        if key in _THICKNESS:
            table.refuse(
                f"{key} over-determines the load: it follows from lambda_1 lambda_2 lambda_3 = 1", key
            )
        if key in KEYS and key not in ("kind", *_KEYS.get(kind, ())):
            belongs = next(other for other, keys in _KEYS.items() if key in keys)
            reason = (
                f"{key} belongs to a load of the kind {belongs} and over-determines one of the kind {kind}"
            )
            table.refuse(reason, key)


def held_axes(load: Load) -> tuple[int, ...]:
    """Axes whose stretch does not change."""
    if load.kind == PURE_SHEAR:
        return (2,)
    if load.relation is None:
        return ()
    q = load.relation.coordinate.value.symbol
    return tuple(axis for axis, stretch in enumerate(load.relation.stretches, 1) if not stretch.has(q))
