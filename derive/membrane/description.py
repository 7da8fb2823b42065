"""What a membrane is, as a person describes it: the pieces that the derivation starts from.

A description holds no equation of motion. Energies and quantities are given whole;
`delagrange.derive.pipeline.derive_description` walks the road from here to emitted modules, for everybody.

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

from delagrange.derive.membrane.body import Body
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.membrane.strain_energy import StrainEnergy, Stretches
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent

VOLTAGE, CHARGE = "voltage", "charge"  # what the electrodes are driven by
# Of loads on two axes, but the last, which leaves every coordinate of any body free
EQUAL_BIAXIAL, UNIAXIAL, BIAXIAL, PURE_SHEAR, RELATION, FREE = (
    "equal_biaxial", "uniaxial", "biaxial", "pure_shear", "relation", "free",
)  # fmt: skip
# Of the equations where a frame holds an axis: its force does no work, or is put into the potential first
CONSTRAINED_VARIATION, REACTION_IN_POTENTIAL = "consistent", "as_printed"


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
    formulation: str = CONSTRAINED_VARIATION


@dataclass(frozen=True)
class Notation:
    """How what moves is written, where it is not as usual: as many as the load leaves free, in its order."""

    coordinates: tuple[TimeDependent, ...] = ()
    internals: tuple[TimeDependent, ...] = ()  # inelastic stretches that flow, branch by branch
    source: str = ""  # whose notation it is


@dataclass(frozen=True)
class Attachment:
    """What sits on the edges of a body along an axis: a mass and a spring on each, or one of them.

    The springs are relaxed in the reference state of the membrane and act along the axis.
    """

    axis: int  # from 1; of a body that has edges there
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
    body: Body = field(default_factory=rectangle)
    dielectric: Dielectric = field(default_factory=Dielectric)
    parallel_viscosity: Quantity | None = None  # of a Kelvin-Voigt dashpot beside all springs [Pa s]
    medium_damping: Quantity | None = None  # traction on the two faces over their velocity [Pa s/m]
    attachments: tuple[Attachment, ...] = ()
    defaults: Mapping[str, float] | None = field(
        default_factory=lambda: MappingProxyType({})
    )  # values of parameters by name [their SI units]; None: the module has no table of them
    sources: tuple[str, ...] = ()  # where energies and values come from
    notation: Notation = field(default_factory=Notation)
    remark: str = ""  # what a user of the emitted module must know; "": what the load says of itself


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
