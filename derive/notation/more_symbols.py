"""Quantities of what a membrane may have beyond those of `symbols`: sides of two lengths, dampers, edges, charges."""

from __future__ import annotations

from delagrange.common.roles import Role
from delagrange.derive.notation.symbols import TimeDependent, moving, quantity

# The membrane
HALF_LENGTH_1 = quantity(
    "L_1",
    "half_length_1",
    "L_1",
    "L_{1}",
    "m",
    "half the side along axis 1 in the reference state",
    Role.SIZE,
)
HALF_LENGTH_2 = quantity(
    "L_2",
    "half_length_2",
    "L_2",
    "L_{2}",
    "m",
    "half the side along axis 2 in the reference state",
    Role.SIZE,
)
PARALLEL_VISCOSITY = quantity(
    "eta_KV",
    "parallel_viscosity",
    "η_KV",
    r"\eta_{KV}",
    "Pa s",
    "viscosity of the dashpot beside all springs",
    Role.DAMPING,
)
MEDIUM_DAMPING = quantity(
    "c",
    "medium_damping",
    "c",
    "c",
    "Pa s/m",
    "traction of the medium on each face over its velocity",
    Role.DAMPING,
)
EDGE_MASSES = tuple(
    quantity(f"m_{axis}", f"edge_mass_{axis}", f"m_{axis}", f"m_{{{axis}}}", "kg",
             f"mass on each edge normal to axis {axis}", Role.MASS)
    for axis in (1, 2)
)  # fmt: skip
EDGE_STIFFNESSES = tuple(
    quantity(f"k_{axis}", f"edge_stiffness_{axis}", f"k_{axis}", f"k_{{{axis}}}", "N/m",
             f"stiffness of the spring on each edge normal to axis {axis}", Role.STIFFNESS)
    for axis in (1, 2)
)  # fmt: skip
EDGE_MASS = quantity("m", "edge_mass", "m", "m", "kg", "mass on each of the four edges", Role.MASS)
EDGE_STIFFNESS = quantity(
    "k",
    "edge_stiffness",
    "k",
    "k",
    "N/m",
    "stiffness of the spring on each of the four edges",
    Role.STIFFNESS,
)

# What drives it
CHARGE_DENSITY = quantity(
    "D",
    "nominal_charge_density",
    "D",
    "D",
    "C/m^2",
    "nominal charge density, charge over the area of an electrode in the reference state",
    Role.CHARGE_DENSITY,
    positive=False,
)
CHARGE_RATE = quantity(
    "D_dot",
    "nominal_charge_density_rate",
    "D\u0307",
    r"\dot{D}",
    "A/m^2",
    "rate of change of the nominal charge density",
    Role.RATE,
    positive=False,
)
CURRENT_DENSITY = quantity(
    "j",
    "nominal_current_density",
    "j",
    "j",
    "A/m^2",
    "nominal current density, current to an electrode over its area in the reference state",
    Role.CURRENT_DENSITY,
    positive=False,
)
CONDUCTIVITY = quantity(
    "sigma",
    "conductivity",
    "σ",
    r"\sigma",
    "S/m",
    "electrical conductivity of the elastomer",
    Role.CONDUCTIVITY,
)

# What holds it
REACTIONS = tuple(
    quantity(f"R_{axis}", f"reaction_force_{axis}", f"R_{axis}", f"R_{{{axis}}}", "N",
             f"force of the frame on each edge normal to axis {axis}, beside any applied force", Role.REACTION,
             positive=False)
    for axis in (1, 2)
)  # fmt: skip

# What moves
STRETCH = moving("lambda", "stretch", "λ", r"\lambda", "in-plane stretch", Role.STRETCH)


def inelastic_stretch(branch: int | None, axis: int | None) -> TimeDependent:
    """Inelastic stretch of a branch along an axis [1].

    `branch` None: there is one branch only. `axis` None: the dashpot has one, along the free axis or along both.
    """
    places = [str(place) for place in (branch, axis) if place is not None]
    subscript = ",".join(places)
    return moving(
        "_".join(["xi", *places]),
        "_".join(["inelastic_stretch", *places]),
        f"ξ_{subscript}" if subscript else "ξ",
        rf"\xi_{{{subscript}}}" if subscript else r"\xi",
        "inelastic stretch of the dashpot"
        + (f" of branch {branch}" if branch is not None else "")
        + (f" along axis {axis}" if axis is not None else ""),
        Role.INELASTIC_STRETCH,
    )
