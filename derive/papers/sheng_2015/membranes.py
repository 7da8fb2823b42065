"""The membranes of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, in the paper's notation.

Both springs are neo-Hookean, and the load cases are those of Fig. 3. Eqs. (4)-(6) speak of the membrane under two
forces, which nothing constrains. The equations as printed stand beside, and are not read here.
"""

from __future__ import annotations

from dataclasses import replace

from delagrange.derive.membrane.description import (
    BIAXIAL,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    REACTION_IN_POTENTIAL,
    UNIAXIAL,
    Description,
    Load,
    MaxwellBranch,
    Notation,
)
from delagrange.derive.membrane.strain_energy import neo_hookean
from delagrange.derive.notation import symbols as s
from delagrange.derive.papers.sheng_2015 import symbols as own

_NOTATION = Notation(source=own.CITATION)
_WORKLESS = "The frame that holds axis 2 does no work: its force is an output, not part of the potential. "
_HELD_DASHPOT = (
    "The inelastic stretch along the held axis is itself held at the held stretch, as in the paper; Eq. (6) would "
    "give it a rate, which this model ignores."
)

_TWO_FORCES = Description(
    name="biaxial",
    title="Dielectric-elastomer membrane under two forces, unconstrained",
    load=Load(BIAXIAL),
    equilibrium_spring=neo_hookean(s.SHEAR_MODULUS_ALPHA),
    branches=(MaxwellBranch(neo_hookean(s.SHEAR_MODULUS_BETA), s.VISCOSITY),),
    defaults=None,
    notation=_NOTATION,
)

_EQUAL_BIAXIAL = replace(
    _TWO_FORCES,
    name="equal_biaxial",
    title="Dielectric-elastomer membrane under equal-biaxial force",
    load=Load(EQUAL_BIAXIAL),
    notation=replace(_NOTATION, coordinates=(own.STRETCH_EB,), internals=(own.INELASTIC_STRETCH_EB,)),
)

_UNIAXIAL = replace(
    _TWO_FORCES,
    name="uniaxial",
    title="Dielectric-elastomer membrane under uniaxial force",
    load=Load(UNIAXIAL),
    notation=replace(
        _NOTATION,
        coordinates=(own.STRETCH_UA1, own.STRETCH_UA2),
        internals=(own.INELASTIC_STRETCH_UA1, own.INELASTIC_STRETCH_UA2),
    ),
)

_PURE_SHEAR = replace(
    _TWO_FORCES,
    name="pure_shear_consistent",
    title="Dielectric-elastomer membrane in pure shear, constrained variation",
    load=Load(PURE_SHEAR, lateral_dashpots_free=False),
    notation=replace(_NOTATION, coordinates=(own.STRETCH_PS,), internals=(own.INELASTIC_STRETCH_PS,)),
    remark=_WORKLESS + _HELD_DASHPOT,
)

_PURE_SHEAR_FREE = replace(
    _PURE_SHEAR,
    name="pure_shear_consistent_free",
    title="Dielectric-elastomer membrane in pure shear, constrained variation, both dashpots free",
    load=Load(PURE_SHEAR, lateral_dashpots_free=True),
    notation=replace(_PURE_SHEAR.notation, internals=(own.INELASTIC_STRETCH_PS, own.INELASTIC_STRETCH_PS2)),
    remark=_WORKLESS + "The inelastic stretch along the held axis flows by Eq. (6).",
)

_PURE_SHEAR_AS_PRINTED = replace(
    _PURE_SHEAR,
    name="pure_shear_as_printed",
    title="Dielectric-elastomer membrane in pure shear, as printed in the paper",
    load=Load(PURE_SHEAR, lateral_dashpots_free=False, formulation=REACTION_IN_POTENTIAL),
    remark="The paper puts the reaction of the frame, Eq. (19), into the potential before the variation, Eq. (20). "
    "A workless constraint does not allow that step. "
    "This module is for reproducing the paper; use pure_shear_consistent for mechanics. " + _HELD_DASHPOT,
)

DESCRIPTIONS = (
    _TWO_FORCES, _EQUAL_BIAXIAL, _UNIAXIAL, _PURE_SHEAR_AS_PRINTED, _PURE_SHEAR, _PURE_SHEAR_FREE,
)  # fmt: skip
NOT_EMITTED = (_TWO_FORCES.name,)
