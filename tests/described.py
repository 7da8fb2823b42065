"""Described membranes of many kinds, emitted and imported once a session, with states, loads and numbers for them."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import sympy as sp
from emitted_once import numpy_module
from kept import digest

from delagrange.derive.membrane.description import (
    Description,
    Load,
    MaxwellBranch,
    Permittivity,
    Relation,
    numbered,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS, branch
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, quantity

VALUES = {
    "half_length": 0.1, "half_length_1": 0.1, "half_length_2": 0.06, "half_thickness": 5e-4, "density": 1.2e3,
    "permittivity": 4.11e-11, "parallel_viscosity": 3e2, "medium_damping": 40.0, "held_stretch": 1.7,
    "edge_mass": 2e-3, "edge_mass_1": 5e-3, "edge_stiffness": 30.0, "edge_stiffness_1": 80.0, "slope": 0.4,
    "electrostriction": -0.05, "conductivity": 4e-9,
}  # fmt: skip
KINDS = {
    "shear_modulus": 1.8e4, "second_modulus": 2.3e3, "locking": 60.0, "locking_stretch": 4.0,
    "viscosity": 900.0,
}  # fmt: skip
INPUTS = {"N": 0.4, "V/m": 4e6, "C/m^2": 1.3e-4, "A/m^2": 2e-2}  # by unit
SLOPE = quantity("s", "slope", "s", "s", "1", "slope of the relation")
ELECTROSTRICTION = quantity("b", "electrostriction", "b", "b", "1", "of the permittivity", positive=False)


def value_of(name: str, unit: str) -> float:
    """Of a parameter by name; those of branches differ."""
    if name in VALUES:
        return VALUES[name]
    number = int(name[-1]) if name[-1].isdigit() else 0
    kind = next((kind for kind in sorted(KINDS, key=len, reverse=True) if name.startswith(kind)), None)
    if kind is None:  # an Ogden or Yeoh coefficient
        return {"Pa": 6.3e3, "1": 1.7}[unit] / (1 + number)
    return KINDS[kind] * (1 + 0.3 * number)


def branches(*materials: str) -> tuple[MaxwellBranch, ...]:
    """A Maxwell branch of each material."""
    springs = [branch(number, of=len(materials)) for number in range(1, len(materials) + 1)]
    return tuple(
        MaxwellBranch(MATERIALS[name](spring), _viscosity(spring.number))
        for name, spring in zip(materials, springs, strict=True)
    )


def _viscosity(number: int | None) -> Quantity:
    return s.VISCOSITY if number is None else numbered(s.VISCOSITY, number)


def described(kind: str, alpha: str = "neo-Hookean", *beta: str, **parts) -> Description:
    """A membrane with every dissipation there is."""
    usual = {"parallel_viscosity": m.PARALLEL_VISCOSITY, "medium_damping": m.MEDIUM_DAMPING}
    load = parts.pop("load", Load(kind))
    return Description("own", "A membrane", load, MATERIALS[alpha](ALPHA), branches(*beta), **(usual | parts))


RECTANGLE = rectangle(m.HALF_LENGTH_1, m.HALF_LENGTH_2)
CURVED = Relation(
    m.STRETCH, (m.STRETCH.value.symbol, 1 + SLOPE.symbol * (m.STRETCH.value.symbol**2 - 1)), sp.Rational(6, 5),
    (True, True), (SLOPE,),
)  # fmt: skip
SOFTENING = Permittivity(
    (s.PERMITTIVITY, ELECTROSTRICTION),
    lambda stretches: (
        s.PERMITTIVITY.symbol * (1 + ELECTROSTRICTION.symbol * (stretches[0] + stretches[1] - 2))
    ),
)
_MODULES: dict[str, ModuleType] = {}  # by the digest of the description


def emitted(description: Description) -> ModuleType:
    """The emitted NumPy module of a description."""
    key = digest(description)
    if key not in _MODULES:
        _MODULES[key] = numpy_module(description)
    return _MODULES[key]


def parameters_of(module: ModuleType, **changed: float) -> list[float]:
    return [changed.get(entry.name, value_of(entry.name, entry.unit)) for entry in module.PARAMETERS]


def state_of(module: ModuleType, rng, parameters) -> np.ndarray:
    """A moving state near that of reference, with nothing in equilibrium."""
    start = np.asarray(module.reference_state(parameters), dtype=float)
    count = module.COORDINATE_COUNT
    state = start * rng.uniform(0.95, 1.15, start.size)
    state[count : 2 * count] = rng.uniform(-30.0, 30.0, count)
    for place, entry in enumerate(module.STATE):
        state[place] += INPUTS["C/m^2"] if entry.unit == "C/m^2" else 0.0
    return state


def inputs_of(module: ModuleType) -> list[float]:
    return [INPUTS[entry.unit] * (1 + 0.5 * place) for place, entry in enumerate(module.INPUTS)]


def slope(function, state, direction):
    """Derivative of a function of the state along a direction, by a complex step."""
    step = 1e-25
    return np.imag(function(np.asarray(state, dtype=complex) + 1j * step * direction)) / step


def plain(kind: str, *beta: str, alpha: str = "neo-Hookean", **parts) -> Description:
    return described(kind, alpha, *beta, **({"parallel_viscosity": None, "medium_damping": None} | parts))
