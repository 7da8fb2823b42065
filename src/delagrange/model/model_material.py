"""The material of a model: the paper's membrane, or a user's model with parameters and defaults of its own."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

from delagrange.common import checks
from delagrange.model.material import RELAXATION_TIME, Material
from delagrange.model.parameters import MATERIAL_UNITS, SHENG_2015, Parameters

HELD_STRETCH = "held_stretch"  # a parameter that every function takes by an argument of its own
_POSITIVE_UNITS = ("m", "kg/m^3")  # of sizes and of the density
_PERMITTIVITY = "permittivity"  # coefficients of a law for it have its unit, and any sign
_POSITIVE_NAMES = ("viscosity", "locking")  # of dashpots in series, and how far a spring can be stretched
_NOT_NEGATIVE_UNITS = ("Pa s", "Pa s/m", "kg", "S/m")  # dampers, masses and leakage, which may be absent


def material_of(model: ModuleType, parameters: Parameters) -> Material:
    """What the parameters of `model` are before a run changes them.

    A model without `DEFAULTS` whose parameters are those of `Parameters` takes them from `parameters`. For any other
    the module's `DEFAULTS` hold; a `parameters` that is not the default SHENG_2015 replaces those whose names
    fit. What then has no value must be given by name.

    Raises:
        ValueError: `parameters` is no `Parameters`, or `DEFAULTS` name something that is no parameter of the model, or
            have a value that it cannot take.
    """
    checks.instance("parameters", parameters, Parameters)
    units = {entry.name: entry.unit for entry in model.PARAMETERS if entry.name != HELD_STRETCH}
    if not hasattr(model, "DEFAULTS") and set(units) <= set(MATERIAL_UNITS):
        return parameters.material
    defaults = _defaults(model)
    fitting = {name: getattr(parameters, name) for name in units if name in MATERIAL_UNITS}
    replaced = fitting if parameters is not SHENG_2015 or not defaults else {}
    values = {name: value for name, value in (defaults | replaced).items() if name in units}
    known = units | ({RELAXATION_TIME: "s"} if _has_one_dashpot(units) else {})
    source = f"defaults of the model {model.MODEL}" if defaults else f"given for the model {model.MODEL}"
    source += f"; replaced by those of: {parameters.source}" if replaced else ""
    return _limited(values, known, source)


def default_held_stretch(model: ModuleType) -> float | None:
    """The held stretch [1] that a model has by default, if it has one."""
    return _defaults(model).get(HELD_STRETCH)


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


def _defaults(model: ModuleType) -> dict[str, float]:
    given = dict(getattr(model, "DEFAULTS", {}))
    units = {entry.name: entry.unit for entry in model.PARAMETERS}
    material = _limited({}, units, "")
    for name, value in given.items():
        if name not in units:
            near = checks.did_you_mean(name, units)
            raise ValueError(
                f"DEFAULTS of the model {model.MODEL} name {name!r}, which is not among its PARAMETERS{near}"
            )
        try:
            given[name] = checks.scalar(name, material.checked(name, value), units[name])
        except ValueError as error:
            raise ValueError(f"DEFAULTS of the model {model.MODEL}: {error}") from None
    return given


def _limited(values: Mapping[str, float], units: Mapping[str, str], source: str) -> Material:
    """The material with the names whose values may not be negative."""
    positive = frozenset(name for name, unit in units.items() if _is_positive(name, unit))
    others = frozenset(name for name, unit in units.items() if unit in _NOT_NEGATIVE_UNITS) - positive
    return Material(values, units, positive, source, others)


def _has_one_dashpot(units: Mapping[str, str]) -> bool:
    """Whether one relaxation time says all about the dashpots."""
    return "shear_modulus_beta" in units and [n for n in units if n.startswith("viscosity")] == ["viscosity"]


def _is_positive(name: str, unit: str) -> bool:
    """Sizes, density, permittivity, limits of springs and what divides.

    A modulus may be negative, since in a sum of several each may be; so may a stiffness: there are springs that push.
    """
    named = name in (_PERMITTIVITY, RELAXATION_TIME, HELD_STRETCH) or name.startswith(_POSITIVE_NAMES)
    return unit in _POSITIVE_UNITS or named
