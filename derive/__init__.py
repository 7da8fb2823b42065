"""From energies on paper to checked code: derive, verify, emit.

Each stage is a function from one frozen dataclass to the next; `delagrange.derive.pipeline` walks the whole road, the
same for everybody. The derived side (`membrane`, `equations`) never reads the printed side (`printed`, the equations of
`papers`); the two meet in `check` only.

What a membrane is put together from in Python stands here by short names: `from delagrange.derive import Description`.
Nothing is imported before it is used (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_NAMES = {  # by the file that they stand in
    "check.pasted.check": "check_equations",
    "emit.write_together": "write_together",
    "equations.described": "description_equations",
    "membrane.body": "Body Domain Extent Face",
    "membrane.description": (
        "BIAXIAL EQUAL_BIAXIAL FREE PURE_SHEAR RELATION UNIAXIAL CONSTRAINED_VARIATION REACTION_IN_POTENTIAL VOLTAGE "
        "CHARGE Attachment Description Dielectric Load MaxwellBranch Notation Permittivity Relation "
        "constant_permittivity numbered"
    ),
    "membrane.material_data": "ECOFLEX_00_30_OGDEN ECOFLEX_00_30_YEOH MATERIAL_DATA VHB_4910 material_data",
    "membrane.materials": "ALPHA BETA MATERIALS branch",
    "membrane.own_energy": "own_energy",
    "membrane.rectangle": "rectangle",
    "membrane.strain_energy": "StrainEnergy",
    "model_file.file": "read_model_file",
    "notation.more_symbols": (
        "CONDUCTIVITY EDGE_MASS EDGE_MASSES EDGE_STIFFNESS EDGE_STIFFNESSES HALF_LENGTH_1 HALF_LENGTH_2 "
        "MEDIUM_DAMPING PARALLEL_VISCOSITY"
    ),
    "notation.symbols": "PERMITTIVITY VISCOSITY Quantity TimeDependent moving quantity",
    "papers.paper": "Paper",
    "papers.printed_equation": "PrintedEquation",
    "pipeline": "derive_description",
}
_HOME = {name: home for home, names in _NAMES.items() for name in names.split()}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME])
