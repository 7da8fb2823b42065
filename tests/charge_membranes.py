"""Membranes from model files for the tests of charge control and of relations: derived, emitted, loaded, and kept."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

from emitted_once import described_in, loaded

from delagrange.derive.membrane.description import RELATION, Load, Relation
from delagrange.derive.notation.symbols import TimeDependent, moving, quantity

MU, EPSILON, DENSITY = 6.0e4, 6.198e-11, 1.2e3  # [Pa], [F/m], [kg/m^3]
LENGTH, THICKNESS = 5e-3, 1e-3  # half of both [m]
NEO_HOOKEAN = f'material = "neo-Hookean"\nshear_modulus = {MU}'
GENT = f'material = "Gent"\nshear_modulus = {MU}\nlocking = 60.0'
EQUAL_BIAXIAL = 'kind = "equal_biaxial"'
TWO_BRANCHES = """
[[branch]]
material = "neo-Hookean"
shear_modulus = 2e4
viscosity = 40.0
[[branch]]
material = "neo-Hookean"
shear_modulus = 3e4
viscosity = 150.0
"""
ONE_BRANCH = '[[branch]]\nmaterial = "neo-Hookean"\nshear_modulus = 4.2e4\nviscosity = 100.0\n'
MEDIUM, PARALLEL = "[damping]\nmedium = 60.0\n", "[damping]\nparallel_viscosity = 20.0\n"
CHARGE, VOLTAGE = 'control = "charge"', 'control = "voltage"'
PERMITTIVITY = f"permittivity = {EPSILON}"

Q = TimeDependent(
    quantity("q", "q", "q", "q", "1", "coordinate of the relation", positive=False),
    *(
        getattr(moving("q", "q", "q", "q", "coordinate of the relation"), each)
        for each in ("rate", "acceleration")
    ),
)  # a coordinate of any sign


def model_text(
    name: str,
    control: str = CHARGE,
    spring: str = NEO_HOOKEAN,
    load: str = EQUAL_BIAXIAL,
    more: str = "",
    permittivity: str = PERMITTIVITY,
) -> str:
    """A model file."""
    return f"""name = "{name}"
title = "a membrane of the tests"
[body]
half_length = {LENGTH}
half_thickness = {THICKNESS}
density = {DENSITY}
[equilibrium_spring]
{spring}
{more}
[dielectric]
{permittivity}
{control}
[load]
{load}
"""


def derived(
    folder: Path, name: str, kernels: bool = False, relation: Relation | None = None, **parts: str
) -> ModuleType:
    """The model of such a file, which is written to a folder that is made; with its compiled kernels, or without.

    relation: takes the place of the load of the file
    """
    folder.mkdir(parents=True, exist_ok=True)
    described = described_in(folder, name, model_text(name, **parts))
    if relation is not None:
        described = replace(described, load=Load(RELATION, relation=relation))
    return loaded(described, kernels)
