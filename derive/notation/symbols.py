"""Each symbol once: its meaning, SI unit, assumptions and notation.

The notation is that of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384. Every other
module takes its symbols from here, so that two symbols are the same if and only if they are meant
to be the same. There is no table of all of them: a model carries its own quantities.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from delagrange.common.roles import Role, Sign, usual_sign


@dataclass(frozen=True)
class Quantity:
    """A physical quantity and how it is written."""

    symbol: sp.Symbol  # what the algebra uses; its name is unique
    name: str  # what emitted code calls it, the field's term in full
    text: str  # notation in plain text, e.g. "λ_EB"
    latex: str  # notation in LaTeX, e.g. r"\lambda_{EB}"
    unit: str  # SI, e.g. "kg/m^3"; "1" for a pure number
    meaning: str  # one line for a person
    role: Role = Role.CONSTANT  # what it is in a model
    sign: Sign = Sign.ANY  # which values it may have; the symbol may assume more, to keep formulas short


@dataclass(frozen=True)
class TimeDependent:
    """A quantity that moves, with its first and second rate of change as symbols of their own."""

    value: Quantity
    rate: Quantity
    acceleration: Quantity

    @property
    def parts(self) -> tuple[Quantity, Quantity, Quantity]:
        """By order of the time derivative."""
        return self.value, self.rate, self.acceleration


def quantity(
    key: str,
    name: str,
    text: str,
    latex: str,
    unit: str,
    meaning: str,
    role: Role = Role.CONSTANT,
    *,
    positive: bool = True,
) -> Quantity:
    """A quantity with a symbol of its own, called `key` in the algebra, and the sign that its role allows."""
    assumptions = {"positive": True} if positive else {"real": True}
    symbol = sp.Symbol(key, **assumptions)
    return Quantity(symbol, name, text, latex, unit, meaning, role, usual_sign(role))


def _rate_name(name: str, suffix: str) -> str:
    """`stretch_1` -> `stretch_rate_1`: the indices of branch and axis stay last."""
    stem = name.rstrip("_0123456789")
    return f"{stem}_{suffix}{name[len(stem) :]}"


def _dotted(text: str, mark: str) -> str:
    """Put a combining dot (or two) over the letter: `λ_EB` -> `λ̇_EB`."""
    return text[0] + mark + text[1:]


def moving(
    key: str, name: str, text: str, latex: str, meaning: str, role: Role = Role.COORDINATE
) -> TimeDependent:
    """A positive quantity [1] with its rates [1/s], [1/s^2]."""
    head, _, subscript = latex.partition("_")
    tail = f"_{subscript}" if subscript else ""
    return TimeDependent(
        replace(quantity(key, name, text, latex, "1", meaning, role), sign=Sign.POSITIVE),
        quantity(
            f"{key}_dot",
            _rate_name(name, "rate"),
            _dotted(text, "\u0307"),
            rf"\dot{{{head}}}{tail}",
            "1/s",
            f"rate of change of the {meaning}",
            Role.RATE,
            positive=False,
        ),
        quantity(
            f"{key}_ddot",
            _rate_name(name, "acceleration"),
            _dotted(text, "\u0308"),
            rf"\ddot{{{head}}}{tail}",
            "1/s^2",
            f"second rate of change of the {meaning}",
            Role.ACCELERATION,
            positive=False,
        ),
    )


# The membrane
HALF_LENGTH = quantity(
    "L",
    "half_length",
    "L",
    "L",
    "m",
    "half the side of the square membrane in the reference state",
    Role.SIZE,
)
HALF_THICKNESS = quantity(
    "H", "half_thickness", "H", "H", "m", "half the thickness in the reference state", Role.SIZE
)
DENSITY = quantity("rho", "density", "ρ", r"\rho", "kg/m^3", "mass density", Role.MASS_DENSITY)
PERMITTIVITY = quantity(
    "epsilon", "permittivity", "ε", r"\varepsilon", "F/m", "permittivity", Role.PERMITTIVITY
)
SHEAR_MODULUS_ALPHA = quantity(
    "mu_alpha",
    "shear_modulus_alpha",
    "μ^α",
    r"\mu^{\alpha}",
    "Pa",
    "shear modulus of spring α, the equilibrium spring",
    Role.MODULUS,
)
SHEAR_MODULUS_BETA = quantity(
    "mu_beta",
    "shear_modulus_beta",
    "μ^β",
    r"\mu^{\beta}",
    "Pa",
    "shear modulus of spring β, in series with the dashpot",
    Role.MODULUS,
)
VISCOSITY = quantity(
    "eta", "viscosity", "η", r"\eta", "Pa s", "viscosity of the dashpot, τ_v μ^β", Role.VISCOSITY
)

# What drives it
FORCE_1 = quantity(
    "P_1", "force_1", "P_1", "P_1", "N", "force on each edge normal to axis 1", Role.FORCE, positive=False
)
FORCE_2 = quantity(
    "P_2", "force_2", "P_2", "P_2", "N", "force on each edge normal to axis 2", Role.FORCE, positive=False
)
FORCE = quantity("P", "force", "P", "P", "N", "force on each loaded edge", Role.FORCE, positive=False)
FIELD = quantity(
    "E",
    "nominal_electric_field",
    "E",
    "E",
    "V/m",
    "nominal electric field, voltage over reference thickness",
    Role.ELECTRIC_FIELD,
    positive=False,
)
REACTION_2 = quantity(
    "P_2p",
    "reaction_force_2",
    "P_2p",
    "P_{2p}",
    "N",
    "force on each edge normal to axis 2 that holds its stretch",
    Role.REACTION,
    positive=False,
)

# The full membrane: two in-plane stretches, two inelastic stretches of the dashpot
STRETCH_1 = moving("lambda_1", "stretch_1", "λ_1", r"\lambda_1", "stretch along axis 1", Role.STRETCH)
STRETCH_2 = moving("lambda_2", "stretch_2", "λ_2", r"\lambda_2", "stretch along axis 2", Role.STRETCH)
INELASTIC_STRETCH_1 = moving(
    "xi_1",
    "inelastic_stretch_1",
    "ξ_1",
    r"\xi_1",
    "inelastic stretch of the dashpot along axis 1",
    Role.INELASTIC_STRETCH,
)
INELASTIC_STRETCH_2 = moving(
    "xi_2",
    "inelastic_stretch_2",
    "ξ_2",
    r"\xi_2",
    "inelastic stretch of the dashpot along axis 2",
    Role.INELASTIC_STRETCH,
)

# What a frame holds
HELD_STRETCH = quantity(
    "lambda_2p",
    "held_stretch",
    "λ_2p",
    r"\lambda_{2p}",
    "1",
    "stretch at which axis 2 is held",
    Role.HELD_STRETCH,
)

# What equations are equal to
KINETIC_ENERGY = quantity(
    "T", "kinetic_energy", "T", "T", "J", "kinetic energy of the membrane", Role.ENERGY, positive=False
)
POTENTIAL_ENERGY = quantity(
    "Pi",
    "potential_energy",
    "Π",
    r"\Pi",
    "J",
    "potential of springs, forces and field",
    Role.ENERGY,
    positive=False,
)
