"""The springs of a model at rest: none may be without stiffness there.

Single coefficients of a strain energy may have either sign; what mechanics needs is that all of them together make a
positive shear modulus at rest. An emitted module says what that is.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from delagrange.common.roles import Role
from delagrange.common.units import with_unit
from delagrange.model.variables import named

_BRANCH_MODULUS = "shear_modulus_beta"  # of a module that does not say what its springs are


def moduli_at_rest(model: ModuleType, values: Mapping[str, object]) -> np.ndarray | None:
    """Shear modulus at rest [Pa] of every spring, (n_springs, ...); None where a constant has no value, or the module
    does not say it."""
    springs = getattr(model, "SPRINGS", {})
    if not springs or any(name not in values for constants in springs.values() for name in constants):
        return None
    numbers = tuple(np.asarray(values.get(entry.name, 1.0), dtype=float)[()] for entry in model.PARAMETERS)
    with np.errstate(all="ignore"):
        return np.asarray(model.shear_moduli_at_rest(numbers), dtype=float)


def check_springs(model: ModuleType, values: Mapping[str, object]) -> None:
    """Refuse values of parameters, numbers or arrays that broadcast, of which a spring is none.

    Raises:
        ValueError: a shear modulus at rest is not positive and finite; it names the spring and its constants.
    """
    moduli = moduli_at_rest(model, values)
    for (spring, constants), modulus in zip(
        getattr(model, "SPRINGS", {}).items(), () if moduli is None else moduli
    ):
        unfit = ~(np.isfinite(modulus) & (modulus > 0))
        if np.any(unfit):
            place = np.unravel_index(np.argmax(unfit), unfit.shape)
            units = {entry.name: entry.unit for entry in model.PARAMETERS}
            numbers = {name: np.broadcast_to(values[name], unfit.shape)[place] for name in constants}
            made = ", ".join(
                f"{name} = {with_unit(float(number), units[name])}" for name, number in numbers.items()
            )
            raise ValueError(
                f"shear modulus of {spring} at rest must be positive and finite, got "
                f"{with_unit(float(modulus[place]), 'Pa')} with {made}"
            )


def check_grid(model: ModuleType, values: Mapping[str, object]) -> None:
    """As `check_springs` for numbers and axes, (n,), of which every value meets every other one.

    Raises:
        ValueError: as `check_springs`.
    """
    constants = {name for names in getattr(model, "SPRINGS", {}).values() for name in names}
    axes = {name: value for name, value in values.items() if name in constants and np.ndim(value) == 1}
    check_springs(model, {**values, **dict(zip(axes, np.ix_(*axes.values())))})


def single_dashpot(model: ModuleType) -> str | None:
    """Name of the viscosity of the only dashpot in series with a spring, whose relaxation time says all; else None."""
    found = named(model.PARAMETERS, Role.VISCOSITY)
    names = [entry.name for entry in model.PARAMETERS]
    known = len(getattr(model, "SPRINGS", ())) == 2 or _BRANCH_MODULUS in names
    return found[0] if len(found) == 1 and known else None


def branch_modulus(model: ModuleType, values: Mapping[str, object]) -> float | np.ndarray:
    """Shear modulus at rest [Pa] of the spring that is in series with the only dashpot.

    Raises:
        KeyError: a constant of it has no value.
    """
    moduli = moduli_at_rest(model, values)
    modulus = values[_BRANCH_MODULUS] if moduli is None else moduli[1]
    return float(modulus) if np.ndim(modulus) == 0 else modulus
