"""What a membrane is, as a person describes it: the pieces that the derivation starts from.

A description holds no equation of motion and no load-specific symbol of the paper. Energies and quantities
are given whole; `derive.pipeline.derive_description` walks the road from here to emitted modules.

Names of quantities: a membrane with one Maxwell branch has `shear_modulus_beta`, `viscosity`,
`inelastic_stretch_1`; with several, the number of the branch follows the name of a parameter
(`shear_modulus_beta_2`, `viscosity_2`) and precedes the axis of a stretch (`inelastic_stretch_2_1`: branch 2,
axis 1). `numbered` gives a quantity its number.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import sympy as sp

from delagrange.derive.membrane.strain_energy import StrainEnergy, Stretches
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent

VOLTAGE, CHARGE = "voltage", "charge"  # what the electrodes are driven by
EQUAL_BIAXIAL, UNIAXIAL, BIAXIAL, PURE_SHEAR, RELATION = (
    "equal_biaxial", "uniaxial", "biaxial", "pure_shear", "relation",
)  # fmt: skip


@dataclass(frozen=True)
class Body:
    """A rectangular membrane of sides 2 L_1, 2 L_2 and thickness 2 H in the reference state."""

    half_length_1: Quantity = s.HALF_LENGTH
    half_length_2: Quantity = s.HALF_LENGTH  # the same quantity for a square membrane
    half_thickness: Quantity = s.HALF_THICKNESS
    density: Quantity = s.DENSITY

    @property
    def is_square(self) -> bool:
        return self.half_length_1 == self.half_length_2


@dataclass(frozen=True)
class MaxwellBranch:
    """A Maxwell branch: a spring in series with a Newtonian dashpot."""

    energy: StrainEnergy
    viscosity: Quantity  # [Pa s]


@dataclass(frozen=True)
class Permittivity:
    """Permittivity [F/m] as a function of the principal stretches."""

    parameters: tuple[Quantity, ...]
    of_stretches: Callable[[Stretches], sp.Expr]


def constant_permittivity(permittivity: Quantity = s.PERMITTIVITY) -> Permittivity:
    """A permittivity that no stretch changes."""
    return Permittivity((permittivity,), lambda _: permittivity.symbol)


@dataclass(frozen=True)
class Dielectric:
    """How the membrane polarises, whether it leaks, and what its electrodes are driven by.

    `voltage`: the input is the nominal electric field [V/m], voltage over reference thickness. `charge`: it is
    the nominal charge density [C/m^2], charge of an electrode over its area in the reference state. With leakage,
    which only charge control allows, the charge density is part of the state, and the input is the nominal current
    density [A/m^2], current to an electrode over that area.
    """

    permittivity: Permittivity = field(default_factory=constant_permittivity)
    control: str = VOLTAGE
    leakage: Quantity | None = None  # conductivity of the elastomer [S/m]


@dataclass(frozen=True)
class Relation:
    """A user's holonomic relation: both stretches as functions of one coordinate."""

    coordinate: TimeDependent
    stretches: tuple[sp.Expr, sp.Expr]  # lambda_1, lambda_2 of the coordinate's value and the parameters
    start: sp.Expr = sp.S.One  # value of the coordinate in the state of reference
    forces: tuple[bool, bool] = (True, False)  # whether an applied force pulls along axes 1, 2
    parameters: tuple[Quantity, ...] = ()  # that the relation brings


@dataclass(frozen=True)
class Load:
    """What a frame does to the membrane, and which forces are applied."""

    kind: str
    lateral_dashpots_free: bool = True  # in pure shear: whether dashpots flow along the held axis
    relation: Relation | None = None  # of the kind `relation`


@dataclass(frozen=True)
class Attachment:
    """What sits on the two edges normal to an axis: a mass and a spring on each, or one of them.

    The springs are relaxed in the reference state of the membrane and act along the axis.
    """

    axis: int  # 1 or 2
    mass: Quantity | None = None  # of each edge [kg]
    stiffness: Quantity | None = None  # of the spring on each edge [N/m]


@dataclass(frozen=True)
class Description:
    """A membrane, whole."""

    name: str  # of the emitted module: an identifier
    title: str
    load: Load
    equilibrium_spring: StrainEnergy
    branches: tuple[MaxwellBranch, ...] = ()
    body: Body = field(default_factory=Body)
    dielectric: Dielectric = field(default_factory=Dielectric)
    parallel_viscosity: Quantity | None = None  # of a Kelvin-Voigt dashpot beside all springs [Pa s]
    medium_damping: Quantity | None = None  # traction on the two faces over their velocity [Pa s/m]
    attachments: tuple[Attachment, ...] = ()
    defaults: Mapping[str, float] = field(
        default_factory=lambda: MappingProxyType({})
    )  # values of parameters by name [their SI units]
    sources: tuple[str, ...] = ()  # where energies and values come from


def numbered(quantity: Quantity, number: int) -> Quantity:
    """The quantity of branch `number` of several: `shear_modulus_beta` becomes `shear_modulus_beta_2`."""
    head, caret, label = quantity.latex.partition("^")
    stem, underscore, subscript = head.partition("_")
    within = f"{subscript.strip('{}')},{number}" if underscore else str(number)
    assumptions = {"positive": True} if quantity.symbol.is_positive else {"real": True}
    return replace(
        quantity,
        symbol=sp.Symbol(f"{quantity.symbol.name}_{number}", **assumptions),
        name=f"{quantity.name}_{number}",
        text=f"{quantity.text}_{number}",
        latex=f"{stem}_{{{within}}}{caret}{label}",
        meaning=f"{quantity.meaning}, branch {number}",
    )
