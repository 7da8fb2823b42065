"""Values of material and size by name: which there are, in which units, and how they are changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from delagrange.common import checks
from delagrange.common.units import with_unit

RELAXATION_TIME = "relaxation_time"
_VISCOSITY, _MODULUS = "viscosity", "shear_modulus_beta"  # of the one dashpot that such a time belongs to


@dataclass(frozen=True)
class Material:
    """The values of one kind of membrane."""

    values: Mapping[str, float]
    units: Mapping[
        str, str
    ]  # of every name that may be given, `relaxation_time` [s] where there is one dashpot
    positive: frozenset[str]  # names whose values must be so; the others are finite
    source: str
    not_negative: frozenset[str] = frozenset()  # names whose values may be zero, and not below

    def checked(self, name: str, value: object) -> float | np.ndarray:
        """The value given for a known name; an array stays one.

        Raises:
            ValueError: it is not finite, or not positive (or zero) as it must be.
        """
        if name in self.positive:
            return checks.positive(name, value, self.units[name])
        checked = checks.finite(name, value, self.units[name])
        if name in self.not_negative and np.any(np.less(checked, 0)):
            raise ValueError(
                f"{name} must be zero or positive and finite, got {with_unit(value, self.units[name])}"
            )
        return checked

    def check_names(self, names: Mapping[str, object]) -> None:
        """Refuse a name that the membrane does not have, and a viscosity that is given twice.

        Raises:
            ValueError: naming the nearest known name.
        """
        for name in names:
            if name not in self.units:
                known = ", ".join(self.units)
                near = checks.did_you_mean(name, self.units)
                raise ValueError(f"unknown parameter {name!r}{near}; known are {known}")
        if _VISCOSITY in names and RELAXATION_TIME in names:
            raise ValueError(
                "viscosity [Pa s] and relaxation_time [s] both given; give one, since relaxation_time = "
                "viscosity / shear_modulus_beta"
            )

    def changed(self, changes: Mapping[str, object]) -> dict[str, float | np.ndarray]:
        """All values by name with `changes` applied; arrays stay arrays and broadcast together.

        Raises:
            ValueError: an unknown name, a bad value, or both `viscosity` and `relaxation_time` given.
        """
        self.check_names(changes)
        changed = {name: self.checked(name, value) for name, value in changes.items()}
        relaxation_time = changed.pop(RELAXATION_TIME, None)
        values = dict(self.values) | changed
        if relaxation_time is not None:
            values[_VISCOSITY] = relaxation_time * values[_MODULUS]
        return values

    def replace(self, **changes: float) -> Material:
        """The same with some single values changed, as its source then says.

        Raises:
            ValueError: as `changed`.
        """
        return replace(self, values=self.changed(changes), source=self.changed_source(changes))

    def changed_source(self, changes: Mapping[str, object]) -> str:
        """The source, and what was changed of it."""
        known = {name: value for name, value in changes.items() if name in self.units}
        if not known:
            return self.source
        text = ", ".join(f"{name} = {with_unit(value, self.units[name])}" for name, value in known.items())
        return f"{self.source}; changed: {text}"
