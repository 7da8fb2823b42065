"""The whole road, walked once: membrane -> load case -> equations -> verdicts -> kernel -> text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from delagrange.derive import symbols as s
from delagrange.derive.derived_equations import check_dimensions, derived_equations
from delagrange.derive.emit import emit
from delagrange.derive.euler_lagrange import EquationsOfMotion, equations_of_motion
from delagrange.derive.kernel import kernel
from delagrange.derive.load_cases import BIAXIAL, EMITTED, LoadCase
from delagrange.derive.membrane import Membrane, membrane
from delagrange.derive.published.sheng_2015 import SHENG_2015
from delagrange.derive.strain_energy import neo_hookean
from delagrange.derive.verdict import Verdict
from delagrange.derive.verify import verify


@dataclass(frozen=True)
class Walked:
    """What one walk of the road gives."""

    models: tuple[EquationsOfMotion, ...]  # the unconstrained membrane first
    verdicts: tuple[Verdict, ...]
    modules: tuple[tuple[str, str], ...]  # file name, text


def paper_membrane() -> Membrane:
    """The membrane of Sheng et al. (2015): both springs neo-Hookean."""
    return membrane(neo_hookean(s.SHEAR_MODULUS_ALPHA), neo_hookean(s.SHEAR_MODULUS_BETA))


def derive(model: Membrane, load_case: LoadCase) -> EquationsOfMotion:
    """Equations of motion whose every term has its unit.

    Raises:
        DimensionError: a derived term breaks the unit of its equation.
    """
    eom = equations_of_motion(model, load_case)
    for equation in derived_equations(eom).values():
        check_dimensions(equation)
    return eom


def walk() -> Walked:
    """Derive all models, check them against the paper, describe and emit those that are emitted."""
    model = paper_membrane()
    models = tuple(derive(model, load_case) for load_case in (BIAXIAL, *EMITTED))
    verdicts = {eom.load_case.name: verify(eom, SHENG_2015) for eom in models}
    modules = tuple(
        (f"{eom.load_case.name}.py", emit(kernel(eom, verdicts[eom.load_case.name])))
        for eom in models
        if eom.load_case in EMITTED
    )
    return Walked(models, tuple(verdict for found in verdicts.values() for verdict in found), modules)


def check() -> tuple[Verdict, ...]:
    """The verdicts alone, without emitting."""
    model = paper_membrane()
    return tuple(v for load_case in (BIAXIAL, *EMITTED) for v in verify(derive(model, load_case), SHENG_2015))


def write(modules: tuple[tuple[str, str], ...], folder: Path) -> None:
    """Write the emitted modules, each as a whole or not at all.

    Raises:
        ValueError: the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in modules:
            unfinished = folder / f"{name}.unfinished"
            unfinished.write_text(text, encoding="utf-8", newline="\n")
            unfinished.replace(folder / name)
    except OSError as error:
        raise ValueError(f"output folder {folder} cannot be written: {error.strerror}") from error


def stale(modules: tuple[tuple[str, str], ...], folder: Path) -> tuple[str, ...]:
    """Names of the modules in `folder` that are not, byte for byte, what the derivation emits."""
    return tuple(
        name
        for name, text in modules
        if not (folder / name).is_file() or (folder / name).read_bytes() != text.encode("utf-8")
    )
