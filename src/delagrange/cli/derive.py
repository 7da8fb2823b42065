"""`delagrange derive`: from the energies to the emitted modules, the paper's or those of a user's model file."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from delagrange.cli import console
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible
from delagrange.cli.verdicts import as_recorded, show
from delagrange.common.files import check_folder, prepare_folder

if TYPE_CHECKING:
    from delagrange.derive.pipeline import Derivation


def derive(given: Given) -> None:
    """Derive, check against the paper and write one NumPy module a model.

    From the motion, the kinetic energy T and the potential Π of Eqs. (1)-(6) to
    the Euler-Lagrange equations of each load case (equal-biaxial, uniaxial, pure
    shear in its formulations), the verdicts on the printed equations, and the
    modules that 'delagrange simulate' integrates. A module needs NumPy only.

    With a FILE, the membrane that it describes instead: its module and its two
    compiled kernels, all of them or none, in the folder of --out. No code of the
    file is run; whatever does not make a membrane is refused with its line.

    Exit code 1 where a verdict is not the recorded one or, with --check, a
    module is stale.

    [bold]Examples[/]

      delagrange derive --out modules
      delagrange derive --check
      delagrange derive my_membrane.toml --out my_models
    """
    if given.model is not None:
        _derive_file(given.model, given)
        return
    folder = given.out if given.out is not None else Path(str(resources.files("delagrange.generated")))
    check_folder(folder) if given.check else prepare_folder(folder)
    with (
        interruptible("nothing was written"),
        console.messages(given.quiet).status("deriving, checking and emitting"),
    ):
        from delagrange.derive import pipeline

        walked = pipeline.walk()
    show(walked.verdicts, given.details)
    departed = not as_recorded(walked)
    if given.check:
        failed = _stale(walked, folder) or departed
    else:
        failed = departed
        _write(walked, folder, departed)
    if failed:
        raise typer.Exit(1)


def _stale(walked: Derivation, folder: Path) -> bool:
    """Whether a module in the folder is not what the derivation emits; it is named on standard error."""
    from delagrange.derive.emit.folder import stale, surplus

    old = stale(walked.modules, folder)
    for name in old:
        console.complain(f"stale: {folder / name} is not what the derivation emits; run `delagrange derive`")
    extra = surplus(walked.modules, folder)
    for name in extra:
        console.complain(f"surplus: {folder / name} is not emitted by the derivation; remove it")
    print(f"{len(walked.modules) - len(old)} of {len(walked.modules)} modules in {folder} are as emitted")
    return bool(old or extra)


def _write(walked: Derivation, folder: Path, departed: bool) -> None:
    """Write the modules, unless their equations are not those that were last looked at."""
    from delagrange.derive.emit.write_together import write_together

    if departed:
        console.complain("no module written, since a verdict is not the recorded one")
        return
    write_together(walked.modules, folder)
    print(f"written: {len(walked.modules)} modules in {folder}")


def _derive_file(model: Path, given: Given) -> None:
    """Derive the membrane of a model file and write its modules, or compare them with those in the folder.

    Raises:
        ValueError: no folder is given, the file is refused, or the folder cannot be written.
        typer.Exit: with --check, a module is stale.
    """
    out = given.out
    if out is None:
        raise ValueError(f"the modules of {model} need a folder of their own: give it with --out DIR")
    if given.check:
        check_folder(out)
    with interruptible("nothing was written"), console.messages(given.quiet).status(f"deriving {model}"):
        modules = _derived(model)
    if given.check:
        _compare(modules, out, model)
        return
    from delagrange.derive.emit.write_together import write_together

    with interruptible("nothing was written"):
        write_together(modules, out)
    print(f"written: {', '.join(name for name, _ in modules)} in {out}")


def _derived(path: Path) -> tuple[tuple[str, str], ...]:
    """File name and text of each module of the membrane."""
    from delagrange.derive.model_file.file import read_model_file
    from delagrange.derive.pipeline import derive_description

    description = read_model_file(path)
    try:
        return derive_description(description)
    except ValueError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from error


def _compare(modules: tuple[tuple[str, str], ...], folder: Path, model: Path) -> None:
    from delagrange.derive.emit.folder import stale

    old = stale(modules, folder)
    for name in old:
        console.complain(f"stale: {folder / name} is not what {model} gives; derive it again")
    print(f"{len(modules) - len(old)} of {len(modules)} modules in {folder} are as emitted")
    if old:
        raise typer.Exit(1)
