"""The whole road, walked once: membrane -> load case -> equations -> verdicts -> kernel -> text."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from itertools import chain
from pathlib import Path

from delagrange.derive.check.verdict import Verdict
from delagrange.derive.check.verify import verify
from delagrange.derive.emit.targets import emitted
from delagrange.derive.equations.derived_equations import (
    check_dimensions,
    check_model_dimensions,
    derived_equations,
)
from delagrange.derive.equations.described import description_equations
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion, equations_of_motion
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.kernel.spec import KernelSpec, Origin
from delagrange.derive.membrane.checks import check_texts
from delagrange.derive.membrane.description import Description
from delagrange.derive.membrane.load_cases import BIAXIAL, EMITTED, LoadCase
from delagrange.derive.membrane.membrane import Membrane, membrane
from delagrange.derive.membrane.strain_energy import StrainEnergy, neo_hookean
from delagrange.derive.notation import symbols as s
from delagrange.derive.papers.sheng_2015.equations import SHENG_2015

_COMMAND = "delagrange derive"
_LEAKAGE = "Foo et al. (2012), J. Appl. Phys. 111, 034102"
_PACKAGE_MARKER = "__init__.py"  # makes the folder a package; it is empty


@dataclass(frozen=True)
class Derivation:
    """What one walk of the road gives."""

    models: tuple[EquationsOfMotion, ...]  # the unconstrained membrane first
    verdicts: tuple[Verdict, ...]
    modules: tuple[tuple[str, str], ...]  # file name, text


def paper_membrane() -> Membrane:
    """The membrane of Sheng et al. (2015): both springs neo-Hookean."""
    return membrane(neo_hookean(s.SHEAR_MODULUS_ALPHA), neo_hookean(s.SHEAR_MODULUS_BETA))


def derive(model: Membrane, load_case: LoadCase) -> EquationsOfMotion:
    """Equations of motion whose every term, and every part that is emitted, has its unit.

    Raises:
        DimensionError: a derived term breaks the unit of its equation, or a part has another unit.
    """
    eom = equations_of_motion(model, load_case)
    for equation in derived_equations(eom).values():
        check_dimensions(equation)
    check_model_dimensions(eom)
    return eom


def derive_all() -> tuple[EquationsOfMotion, ...]:
    """Every model of the paper's membrane, the unconstrained one first."""
    model = paper_membrane()
    return tuple(derive(model, load_case) for load_case in (BIAXIAL, *EMITTED))


def walk() -> Derivation:
    """Derive all models, check them against the paper, describe and emit those that are emitted."""
    models = derive_all()
    verdicts = tuple(verify(eom, SHENG_2015) for eom in models)
    described = (
        kernel(eom, found) for eom, found in zip(models, verdicts, strict=True) if eom.load_case in EMITTED
    )
    modules = tuple(module for spec in described for module in emitted(spec))
    return Derivation(models, tuple(chain.from_iterable(verdicts)), modules)


def check() -> tuple[Verdict, ...]:
    """The verdicts alone, without emitting."""
    return tuple(verdict for eom in derive_all() for verdict in verify(eom, SHENG_2015))


def derive_description(description: Description) -> tuple[tuple[str, str], ...]:
    """File name and text of the modules of a described membrane: NumPy, lanes, variational kernel.

    Raises:
        ValueError: the description is not whole, or at odds with itself or with what emitted code is written with.
        DimensionError: a term of what is derived has another unit than the others.
    """
    return emitted(description_spec(description))


def description_spec(description: Description) -> KernelSpec:
    """The description of the modules of a membrane."""
    eom = description_equations(description)
    _check_defaults(description, eom)
    sources = _sources(description)
    check_texts(description, sources, eom.quantities)
    origin = Origin(_COMMAND, _body_text(description), "", sources, _start_text(eom.load_case))
    return kernel(eom, (), origin, description.defaults)


def _check_defaults(description: Description, eom: EquationsOfMotion) -> None:
    names = [parameter.name for parameter in eom.parameters]
    for name in description.defaults:
        if name not in names:
            near = get_close_matches(name, names, n=1, cutoff=0.0)
            raise ValueError(
                f"model {description.name}: default of {name}, which is no parameter of it; nearest is {near[0]}"
            )


def _body_text(description: Description) -> str:
    sides = "A square membrane of sides 2 L" if description.body.is_square else (
        "A rectangular membrane of sides 2 L_1 and 2 L_2"
    )  # fmt: skip
    return f"{sides} and thickness 2 H in the reference state"


def _start_text(load_case: LoadCase) -> str:
    if load_case.start is None:
        return ""
    return "State at rest where the relation between the stretches begins; dashpots have relaxed to the stretches."


def _sources(description: Description) -> tuple[str, ...]:
    energies: list[StrainEnergy] = [description.equilibrium_spring]
    energies += [branch.energy for branch in description.branches]
    own = [f"{energy.name}: {energy.source}" for energy in energies if energy.source]
    leakage = [] if description.dielectric.leakage is None else [f"leakage: {_LEAKAGE}"]
    return tuple(dict.fromkeys([*own, *leakage, *description.sources]))


def stale(modules: tuple[tuple[str, str], ...], folder: Path) -> tuple[str, ...]:
    """Names of the modules in `folder` that are not, byte for byte, what the derivation emits."""
    return tuple(name for name, text in modules if not _holds(folder / name, text))


def surplus(modules: tuple[tuple[str, str], ...], folder: Path) -> tuple[str, ...]:
    """Names of what stands in `folder` and nothing emits, an `__init__.py` that is not empty among them."""
    emitted = {name for name, _ in modules}
    found = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    marker = folder / _PACKAGE_MARKER
    allowed = {_PACKAGE_MARKER, "__pycache__"} if _holds(marker, "") else {"__pycache__"}
    return tuple(name for name in found if name not in emitted | allowed)


def _holds(path: Path, text: str) -> bool:
    return path.is_file() and path.read_bytes() == text.encode("utf-8")
