"""What a model file says, read and checked: plain values in SI units, formulas still as text.

`derive.model_file.read_model_file` makes them; `derive.model_description.describe` takes them on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Constant:
    """A user's own constant."""

    name: str
    value: float  # [unit]
    unit: str  # SI


@dataclass(frozen=True)
class MaterialSpring:
    """A spring of a material that has a name."""

    material: str  # key of `derive.materials.MATERIALS`
    values: Mapping[str, float]  # by the parameter's name without its spring [SI]
    terms: int = 1  # of a material with a choice of terms


@dataclass(frozen=True)
class OwnSpring:
    """A spring with the user's own strain-energy density."""

    energy: str  # [J/m^3], in lambda_1, lambda_2, lambda_3, the invariants I_1, I_2 and the constants
    constants: tuple[Constant, ...]
    validity: str | None = None  # positive where the energy holds
    source: str = "given by the user"


SpringEntry = MaterialSpring | OwnSpring


@dataclass(frozen=True)
class BranchEntry:
    """A Maxwell branch."""

    spring: SpringEntry
    viscosity: float  # [Pa s]


@dataclass(frozen=True)
class BodyEntry:
    """Half lengths, half thickness [m] and density [kg/m^3]; a square one has no second half length."""

    half_length_1: float
    half_length_2: float | None
    half_thickness: float
    density: float


@dataclass(frozen=True)
class DielectricEntry:
    """A permittivity [F/m], a value or a formula in the stretches, what drives the electrodes, and leakage."""

    permittivity: float | str
    constants: tuple[Constant, ...]
    control: str
    conductivity: float | None = None  # of an elastomer that leaks [S/m]


@dataclass(frozen=True)
class RelationEntry:
    """Both stretches as formulas in one coordinate."""

    coordinate: str
    lambda_1: str
    lambda_2: str
    start: float  # value of the coordinate in the reference state [1]
    forces: tuple[int, ...]  # axes along which forces are applied
    constants: tuple[Constant, ...]


@dataclass(frozen=True)
class LoadEntry:
    """What a frame does."""

    kind: str
    held_stretch: float | None = None  # in pure shear [1]
    lateral_dashpots_free: bool = True  # in pure shear
    relation: RelationEntry | None = None


@dataclass(frozen=True)
class AttachmentEntry:
    """A mass [kg] and a spring [N/m] on each edge normal to an axis; without an axis, on all four."""

    axis: int | None
    mass: float | None
    stiffness: float | None


@dataclass(frozen=True)
class ModelFile:
    """All that a model file says."""

    name: str
    title: str
    sources: tuple[str, ...]
    body: BodyEntry
    equilibrium_spring: SpringEntry
    branches: tuple[BranchEntry, ...]
    dielectric: DielectricEntry
    parallel_viscosity: float | None  # [Pa s]
    medium_damping: float | None  # [Pa s/m]
    load: LoadEntry
    attachments: tuple[AttachmentEntry, ...]
