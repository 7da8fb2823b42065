"""Described membranes that differ in what drives their electrodes alone, emitted and imported once a session."""

from __future__ import annotations

from functools import cache
from types import ModuleType

import numpy as np
import sympy as sp
from emitted_once import numpy_module

from delagrange.derive.membrane.description import (
    CHARGE,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    RELATION,
    UNIAXIAL,
    VOLTAGE,
    Description,
    Dielectric,
    Load,
    MaxwellBranch,
    Permittivity,
    Relation,
    constant_permittivity,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS, branch
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, quantity

ELECTROSTRICTION = quantity("b", "electrostriction", "b", "b", "1", "of the permittivity", positive=False)
SOFTENING = Permittivity(
    (s.PERMITTIVITY, ELECTROSTRICTION),
    lambda stretches: (
        s.PERMITTIVITY.symbol * (1 + ELECTROSTRICTION.symbol * (stretches[0] + stretches[1] - 2))
    ),
)
PERMITTIVITIES = {"constant": constant_permittivity(), "softening": SOFTENING}
CURVED = Relation(m.STRETCH, (m.STRETCH.value.symbol, m.STRETCH.value.symbol**2), sp.Rational(6, 5))
KINDS = (EQUAL_BIAXIAL, UNIAXIAL, PURE_SHEAR, RELATION)
LAWS = (  # a load with a permittivity
    (EQUAL_BIAXIAL, "constant"),
    (EQUAL_BIAXIAL, "softening"),
    (UNIAXIAL, "softening"),
    (PURE_SHEAR, "constant"),
    (RELATION, "softening"),
)
DRIVEN = {"voltage": (VOLTAGE, None), "charge": (CHARGE, None), "current": (CHARGE, m.CONDUCTIVITY)}

PERMITTIVITY, CONDUCTIVITY, FALL = 6e-11, 6e-9, -0.08  # a Maxwell time of 10 ms; FALL of `SOFTENING`
VALUES = {
    "half_length": 5e-3, "half_thickness": 1e-3, "density": 1.2e3, "permittivity": PERMITTIVITY,
    "conductivity": CONDUCTIVITY, "electrostriction": FALL, "shear_modulus_alpha": 1.8e4, "locking_alpha": 60.0,
    "shear_modulus_beta": 4.2e4, "viscosity": 420.0, "parallel_viscosity": 2.0, "held_stretch": 1.4,
}  # fmt: skip

LEAKY_FILE = """name = "leaky"
title = "Membrane that leaks"
[body]
half_length = "5 mm"
half_thickness = "1 mm"
density = 1200
[equilibrium_spring]
material = "neo-Hookean"
shear_modulus = "18 kPa"
[[branch]]
material = "neo-Hookean"
shear_modulus = "42 kPa"
relaxation_time = "10 ms"
[dielectric]
permittivity = "60 pF/m"
control = "charge"
conductivity = "6 nS/m"
[load]
kind = "equal_biaxial"
"""


def described(
    driven: str, kind: str = EQUAL_BIAXIAL, permittivity: str = "constant", leakage: Quantity | None = None
) -> Description:
    """A Gent membrane with one Maxwell branch and a parallel dashpot."""
    control, conductivity = DRIVEN[driven]
    return Description(
        "own",
        "A membrane",
        Load(kind, relation=CURVED if kind == RELATION else None),
        MATERIALS["Gent"](ALPHA),
        (MaxwellBranch(MATERIALS["neo-Hookean"](branch(1, of=1)), s.VISCOSITY),),
        dielectric=Dielectric(PERMITTIVITIES[permittivity], control, leakage or conductivity),
        parallel_viscosity=m.PARALLEL_VISCOSITY,
    )


@cache
def emitted(driven: str, kind: str = EQUAL_BIAXIAL, permittivity: str = "constant") -> ModuleType:
    """The NumPy module of a membrane, with `VALUES` as its defaults."""
    module = numpy_module(described(driven, kind, permittivity))
    module.DEFAULTS = dict(zip((entry.name for entry in module.PARAMETERS), parameters_of(module)))
    return module


def parameters_of(module: ModuleType) -> list[float]:
    return [VALUES[entry.name] for entry in module.PARAMETERS]


def moving_state(module: ModuleType, seed: int) -> np.ndarray:
    """A state near that of reference, with nothing in equilibrium and some charge where it is part of it."""
    rng, count = np.random.default_rng(seed), module.COORDINATE_COUNT
    start = np.asarray(module.reference_state(parameters_of(module)), dtype=float)
    state = start * rng.uniform(0.9, 1.2, start.size)
    state[count : 2 * count] = rng.uniform(-30.0, 30.0, count)
    if module.STATE[-1].unit == "C/m^2":
        state[-1] = rng.uniform(-6e-4, 6e-4)
    return state


def along(function, at: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Derivative of an analytic function along a direction, by a complex step."""
    step = 1e-25
    return np.imag(function(np.asarray(at, dtype=complex) + 1j * step * direction)) / step
