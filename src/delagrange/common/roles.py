"""What a quantity is in a model, and which signs it may have: said by the derivation, asked by the run time."""

from __future__ import annotations

from enum import StrEnum
from typing import Any


class Role(StrEnum):
    """What a quantity is in a model."""

    # What moves
    STRETCH = "stretch"  # a coordinate that is a principal stretch
    COORDINATE = "coordinate"  # any other generalised coordinate, e.g. an angle
    INELASTIC_STRETCH = "inelastic_stretch"  # of a dashpot in series with a spring
    RATE = "rate"  # first derivative by time of what moves
    ACCELERATION = "acceleration"  # second one

    # What drives, as an input; a charge may move instead
    FORCE = "force"
    ELECTRIC_FIELD = "electric_field"
    CHARGE_DENSITY = "charge_density"
    CURRENT_DENSITY = "current_density"

    # Size and material
    SIZE = "size"
    MASS_DENSITY = "mass_density"
    PERMITTIVITY = "permittivity"
    CONDUCTIVITY = "conductivity"
    MODULUS = "modulus"  # a coefficient of a strain energy; only what all of them make at rest has a sign
    EXPONENT = "exponent"  # of a strain energy
    LOCKING_LIMIT = "locking_limit"  # how far a spring can be stretched
    VISCOSITY = "viscosity"  # of a dashpot in series with a spring: what is infinite freezes it
    DAMPING = "damping"  # of what acts beside all springs: a parallel dashpot, the medium
    CONSTANT = "constant"  # of a formula of the user's own

    # What holds it, or is attached to it
    HELD_STRETCH = "held_stretch"
    MASS = "mass"
    STIFFNESS = "stiffness"
    REACTION = "reaction"

    # What is no variable of a model
    ENERGY = "energy"


class Sign(StrEnum):
    """Which finite values a quantity may have."""

    POSITIVE = "positive"
    NOT_NEGATIVE = "not_negative"  # positive or zero: what may be absent
    ANY = "any"

    @property
    def words(self) -> str:
        """What must be so of a number, in a sentence."""
        return {Sign.POSITIVE: "positive", Sign.NOT_NEGATIVE: "zero or positive"}.get(self, "a number")

    def allows(self, numbers: Any) -> Any:
        """Whether a number may be so, or which of an array may; what is not a number may not."""
        match self:
            case Sign.POSITIVE:
                return numbers > 0
            case Sign.NOT_NEGATIVE:
                return numbers >= 0
        return numbers == numbers


_POSITIVE = (
    Role.STRETCH, Role.INELASTIC_STRETCH, Role.HELD_STRETCH, Role.SIZE, Role.MASS_DENSITY, Role.PERMITTIVITY,
    Role.LOCKING_LIMIT, Role.VISCOSITY,
)  # fmt: skip
_MAY_BE_ABSENT = (Role.MASS, Role.DAMPING, Role.CONDUCTIVITY)


def usual_sign(role: Role) -> Sign:
    """Which values mechanics allows what has this role.

    Stiffnesses and moduli may have either: there are springs that push, and terms of an energy that soften it.
    """
    if role in _POSITIVE:
        return Sign.POSITIVE
    return Sign.NOT_NEGATIVE if role in _MAY_BE_ABSENT else Sign.ANY
