"""What the variables of a model are and which signs they may have: its module says so, and nothing is guessed.

A module that is written by hand, or was emitted before variables said it, may leave out `role` and `sign`. A variable
without a role then has that of the emitted variable whose name it has, up to the numbers of axes and branches:
`viscosity_2` is a viscosity. With another name it is a constant of which nothing is known. A variable without a sign
has the one that is usual for its role.
"""

from __future__ import annotations

from collections.abc import Iterable
from types import ModuleType
from typing import Protocol

from delagrange.common.checks import did_you_mean
from delagrange.common.roles import Role, Sign, usual_sign
from delagrange.common.units import shown


class Variable(Protocol):
    """An entry of STATE, INPUTS, PARAMETERS or REACTIONS of a model; `role` and `sign` may be missing."""

    name: str
    symbol: str
    unit: str
    meaning: str


_EMITTED_NAMES = {  # without numbers
    "stretch": Role.STRETCH,
    "inelastic_stretch": Role.INELASTIC_STRETCH,
    "force": Role.FORCE,
    "nominal_electric_field": Role.ELECTRIC_FIELD,
    "nominal_charge_density": Role.CHARGE_DENSITY,
    "nominal_current_density": Role.CURRENT_DENSITY,
    "half_length": Role.SIZE,
    "half_thickness": Role.SIZE,
    "density": Role.MASS_DENSITY,
    "permittivity": Role.PERMITTIVITY,
    "conductivity": Role.CONDUCTIVITY,
    "locking_alpha": Role.LOCKING_LIMIT,
    "locking_beta": Role.LOCKING_LIMIT,
    "locking_stretch_alpha": Role.LOCKING_LIMIT,
    "locking_stretch_beta": Role.LOCKING_LIMIT,
    "viscosity": Role.VISCOSITY,
    "parallel_viscosity": Role.DAMPING,
    "medium_damping": Role.DAMPING,
    "edge_mass": Role.MASS,
    "edge_stiffness": Role.STIFFNESS,
    "held_stretch": Role.HELD_STRETCH,
}


def role_of(entry: Variable) -> Role:
    """What a variable is in its model.

    Raises:
        ValueError: it says a role that there is not.
    """
    said = getattr(entry, "role", None)
    if said is None:
        return _EMITTED_NAMES.get(entry.name.rstrip("_0123456789"), Role.CONSTANT)
    return _member(entry, "role", said, Role)


def sign_of(entry: Variable) -> Sign:
    """Which finite values a variable may have.

    Raises:
        ValueError: it says a sign, or a role, that there is not.
    """
    said = getattr(entry, "sign", None)
    return usual_sign(role_of(entry)) if said is None else _member(entry, "sign", said, Sign)


def _member(entry: Variable, what: str, said: object, kind: type) -> Role | Sign:
    known = [each.value for each in kind]
    if said not in known:
        near = did_you_mean(said, known)
        raise ValueError(f"{what} of {entry.name} must be one of {', '.join(known)}; got {shown(said)}{near}")
    return kind(said)


def is_stretch(entry: Variable) -> bool:
    """Whether a variable is a stretch, of the membrane or of a dashpot; an angle, a rate or a charge is none."""
    return role_of(entry) in (Role.STRETCH, Role.INELASTIC_STRETCH)


def named(entries: Iterable[Variable], role: Role) -> list[str]:
    """Names of those that have a role, in their order."""
    return [entry.name for entry in entries if role_of(entry) is role]


def material_parameters(model: ModuleType) -> list[Variable]:
    """The parameters of a model but for a held stretch, which every function takes by an argument of its own."""
    return [entry for entry in model.PARAMETERS if role_of(entry) is not Role.HELD_STRETCH]
