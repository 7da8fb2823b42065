"""Values of material and size by name: which there are, in which units, and how they are changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.roles import Role, Sign
from delagrange.common.units import with_unit
from delagrange.model.springs import branch_modulus, check_grid, check_springs, single_dashpot
from delagrange.model.variables import material_parameters, named, sign_of

RELAXATION_TIME = "relaxation_time"


@dataclass(frozen=True)
class Material:
    """The values of the parameters of a model, but for a held stretch; one that has no value must be given."""

    model: ModuleType
    values: Mapping[str, float]
    source: str

    @property
    def units(self) -> dict[str, str]:
        """Unit of every name that may be given, `relaxation_time` [s] where there is one dashpot."""
        units = {entry.name: entry.unit for entry in material_parameters(self.model)}
        return units | ({RELAXATION_TIME: "s"} if single_dashpot(self.model) else {})

    def checked(self, name: str, value: object) -> float | np.ndarray:
        """The value given for a known name; an array stays one.

        Raises:
            ValueError: it is not finite, or not positive (or zero) as it must be.
        """
        signs = {entry.name: sign_of(entry) for entry in self.model.PARAMETERS}
        return checks.signed(name, value, self.units[name], signs.get(name, Sign.POSITIVE))

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
        viscosity = single_dashpot(self.model)
        if viscosity in names and RELAXATION_TIME in names:
            raise ValueError(
                f"{viscosity} [Pa s] and relaxation_time [s] both given; give one, since relaxation_time = "
                f"{viscosity} / shear modulus of the spring in series at rest"
            )

    def check_grid(self, given: Mapping[str, object]) -> None:
        """Refuse checked numbers and axes, (n,), of which every value meets every other one, if a spring is none.

        Raises:
            ValueError: a shear modulus at rest is not positive.
        """
        check_grid(self.model, {**self.values, **given})

    def changed(self, changes: Mapping[str, object]) -> dict[str, float | np.ndarray]:
        """All values by name with `changes` applied; arrays stay arrays and broadcast together.

        Raises:
            ValueError: an unknown name, a bad value, both `viscosity` and `relaxation_time` given, or a spring whose
                shear modulus at rest is not positive.
        """
        self.check_names(changes)
        changed = {name: self.checked(name, value) for name, value in changes.items()}
        relaxation_time = changed.pop(RELAXATION_TIME, None)
        values = dict(self.values) | changed
        check_springs(self.model, values)
        if relaxation_time is not None:
            values[single_dashpot(self.model)] = relaxation_time * branch_modulus(self.model, values)
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


def defaults_of(model: ModuleType) -> dict[str, float]:
    """The `DEFAULTS` of a model, checked; none where it has none.

    Raises:
        ValueError: they name something that is no parameter of the model, or have a value that it cannot take.
    """
    entries = {entry.name: entry for entry in model.PARAMETERS}
    given = dict(getattr(model, "DEFAULTS", {}))
    for name, value in given.items():
        if name not in entries:
            near = checks.did_you_mean(name, entries)
            raise ValueError(
                f"DEFAULTS of the model {model.MODEL} name {name!r}, which is not among its PARAMETERS{near}"
            )
        unit = entries[name].unit
        try:
            given[name] = checks.scalar(name, checks.signed(name, value, unit, sign_of(entries[name])), unit)
        except ValueError as error:
            raise ValueError(f"DEFAULTS of the model {model.MODEL}: {error}") from None
    return given


def held_stretch_name(model: ModuleType) -> str | None:
    """Name of the parameter that is the stretch at which an axis is held, where the model has one."""
    return next(iter(named(model.PARAMETERS, Role.HELD_STRETCH)), None)


def value_of(model: ModuleType, name: str, values: Mapping[str, object]) -> object:
    """The value of a parameter of the model among those of its material.

    Raises:
        ValueError: it has none.
    """
    if name not in values:
        unit = next(entry.unit for entry in model.PARAMETERS if entry.name == name)
        raise ValueError(
            f"{name} [{unit}] is missing: the model {model.MODEL} has no default for it; give it"
        )
    return values[name]
