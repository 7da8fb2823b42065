"""Load cases: what a frame does to the full membrane.

A load case says how the stretches of the full membrane depend on fewer generalised coordinates
(a holonomic constraint), which forces are applied, and which force is a reaction. The three cases
are those of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Fig. 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent

CONSTRAINED_VARIATION = "consistent"
REACTION_IN_POTENTIAL = "as_printed"


@dataclass(frozen=True)
class LoadCase:
    """A constraint on the full membrane, with the loads that are applied to it."""

    name: str  # name of the emitted module
    family: str  # equal_biaxial, uniaxial, pure_shear, biaxial
    title: str
    coordinates: tuple[TimeDependent, ...]  # what moves freely
    internals: tuple[TimeDependent, ...]  # inelastic stretches that flow
    inputs: tuple[Quantity, ...]
    stretches: tuple[sp.Expr, sp.Expr]  # lambda_1, lambda_2 in the coordinates
    inelastic_stretches: tuple[sp.Expr, ...]  # xi_1, xi_2 of each branch in the internals
    forces: tuple[sp.Expr, sp.Expr]  # P_1, P_2: an input or zero, and a reaction where the axis is held
    reactions: tuple[Quantity, ...] = ()
    parameters: tuple[Quantity, ...] = ()  # beyond those of the membrane
    formulation: str = CONSTRAINED_VARIATION
    remark: str = ""  # what a user of the emitted module must know
    start: tuple[sp.Expr, ...] | None = None  # of the coordinates, in the reference state; None: all 1


EQUAL_BIAXIAL = LoadCase(
    name="equal_biaxial",
    family="equal_biaxial",
    title="Dielectric-elastomer membrane under equal-biaxial force",
    coordinates=(s.STRETCH_EB,),
    internals=(s.INELASTIC_STRETCH_EB,),
    inputs=(s.FORCE, s.FIELD),
    stretches=(s.STRETCH_EB.value.symbol, s.STRETCH_EB.value.symbol),
    inelastic_stretches=(s.INELASTIC_STRETCH_EB.value.symbol, s.INELASTIC_STRETCH_EB.value.symbol),
    forces=(s.FORCE.symbol, s.FORCE.symbol),
)

UNIAXIAL = LoadCase(
    name="uniaxial",
    family="uniaxial",
    title="Dielectric-elastomer membrane under uniaxial force",
    coordinates=(s.STRETCH_UA1, s.STRETCH_UA2),
    internals=(s.INELASTIC_STRETCH_UA1, s.INELASTIC_STRETCH_UA2),
    inputs=(s.FORCE, s.FIELD),
    stretches=(s.STRETCH_UA1.value.symbol, s.STRETCH_UA2.value.symbol),
    inelastic_stretches=(s.INELASTIC_STRETCH_UA1.value.symbol, s.INELASTIC_STRETCH_UA2.value.symbol),
    forces=(s.FORCE.symbol, sp.Integer(0)),
)

BIAXIAL = LoadCase(
    name="biaxial",
    family="biaxial",
    title="Dielectric-elastomer membrane under two forces, unconstrained",
    coordinates=(s.STRETCH_1, s.STRETCH_2),
    internals=(s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2),
    inputs=(s.FORCE_1, s.FORCE_2, s.FIELD),
    stretches=(s.STRETCH_1.value.symbol, s.STRETCH_2.value.symbol),
    inelastic_stretches=(s.INELASTIC_STRETCH_1.value.symbol, s.INELASTIC_STRETCH_2.value.symbol),
    forces=(s.FORCE_1.symbol, s.FORCE_2.symbol),
)


def _pure_shear(
    name: str, title: str, formulation: str, *, lateral_dashpot_free: bool, remark: str
) -> LoadCase:
    lateral = s.INELASTIC_STRETCH_PS2.value.symbol if lateral_dashpot_free else s.HELD_STRETCH.symbol
    return LoadCase(
        name=name,
        family="pure_shear",
        title=title,
        coordinates=(s.STRETCH_PS,),
        internals=(s.INELASTIC_STRETCH_PS, *((s.INELASTIC_STRETCH_PS2,) if lateral_dashpot_free else ())),
        inputs=(s.FORCE, s.FIELD),
        stretches=(s.STRETCH_PS.value.symbol, s.HELD_STRETCH.symbol),
        inelastic_stretches=(s.INELASTIC_STRETCH_PS.value.symbol, lateral),
        forces=(s.FORCE.symbol, s.REACTION_2.symbol),
        reactions=(s.REACTION_2,),
        parameters=(s.HELD_STRETCH,),
        formulation=formulation,
        remark=remark,
    )


_HELD_DASHPOT = (
    "The inelastic stretch along the held axis is itself held at the held stretch, as in the paper; Eq. (6) would "
    "give it a rate, which this model ignores."
)

PURE_SHEAR_CONSISTENT = _pure_shear(
    "pure_shear_consistent",
    "Dielectric-elastomer membrane in pure shear, constrained variation",
    CONSTRAINED_VARIATION,
    lateral_dashpot_free=False,
    remark="The frame that holds axis 2 does no work: its force is an output, not part of the potential. "
    + _HELD_DASHPOT,
)

PURE_SHEAR_CONSISTENT_FREE = _pure_shear(
    "pure_shear_consistent_free",
    "Dielectric-elastomer membrane in pure shear, constrained variation, both dashpots free",
    CONSTRAINED_VARIATION,
    lateral_dashpot_free=True,
    remark="The frame that holds axis 2 does no work: its force is an output, not part of the potential. "
    "The inelastic stretch along the held axis flows by Eq. (6).",
)

PURE_SHEAR_AS_PRINTED = _pure_shear(
    "pure_shear_as_printed",
    "Dielectric-elastomer membrane in pure shear, as printed in the paper",
    REACTION_IN_POTENTIAL,
    lateral_dashpot_free=False,
    remark="The paper puts the reaction of the frame, Eq. (19), into the potential before the variation, Eq. (20). "
    "A workless constraint does not allow that step. "
    "This module is for reproducing the paper; use pure_shear_consistent for mechanics. " + _HELD_DASHPOT,
)

EMITTED: tuple[LoadCase, ...] = (
    EQUAL_BIAXIAL, UNIAXIAL, PURE_SHEAR_AS_PRINTED, PURE_SHEAR_CONSISTENT, PURE_SHEAR_CONSISTENT_FREE,
)  # fmt: skip
