"""`delagrange derive`: from the energies to the emitted modules."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from delagrange.cli import console
from delagrange.cli import options as o
from delagrange.cli.derive_file import derive_file
from delagrange.cli.interruption import interruptible
from delagrange.cli.verdicts import show
from delagrange.cli.verify import Details, as_recorded
from delagrange.common.files import check_folder, prepare_folder

if TYPE_CHECKING:
    from delagrange.derive.pipeline import Derivation

ModuleFolder = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder of the modules.", show_default="delagrange.generated"),
]
Check = Annotated[
    bool,
    typer.Option("--check", help="Write nothing: compare the folder, byte for byte, with what is emitted."),
]


ModelFile = Annotated[
    Path | None,
    typer.Argument(
        metavar="[FILE]", help="A membrane of your own, described in TOML.", show_default="the paper's models"
    ),
]


def derive(
    model: ModelFile = None,
    out: ModuleFolder = None,
    check: Check = False,
    details: Details = False,
    quiet: o.Quiet = False,
) -> None:
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
    if model is not None:
        derive_file(model, out, check, quiet)
        return
    folder = out if out is not None else Path(str(resources.files("delagrange.generated")))
    check_folder(folder) if check else prepare_folder(folder)
    with (
        interruptible("nothing was written"),
        console.messages(quiet).status("deriving, checking and emitting"),
    ):
        from delagrange.derive import pipeline

        walked = pipeline.walk()
    show(walked.verdicts, details)
    departed = not as_recorded(walked.verdicts)
    if check:
        failed = _stale(walked, folder) or departed
    else:
        failed = departed
        _write(walked, folder, departed)
    if failed:
        raise typer.Exit(1)


def _stale(walked: Derivation, folder: Path) -> bool:
    """Whether a module in the folder is not what the derivation emits; it is named on standard error."""
    from delagrange.derive import pipeline

    old = pipeline.stale(walked.modules, folder)
    for name in old:
        console.complain(f"stale: {folder / name} is not what the derivation emits; run `delagrange derive`")
    extra = pipeline.surplus(walked.modules, folder)
    for name in extra:
        console.complain(f"surplus: {folder / name} is not emitted by the derivation; remove it")
    print(f"{len(walked.modules) - len(old)} of {len(walked.modules)} modules in {folder} are as emitted")
    return bool(old or extra)


def _write(walked: Derivation, folder: Path, departed: bool) -> None:
    """Write the modules, unless their equations are not those that were last looked at."""
    from delagrange.derive import pipeline

    if departed:
        console.complain("no module written, since a verdict is not the recorded one")
        return
    pipeline.write(walked.modules, folder)
    print(f"written: {len(walked.modules)} modules in {folder}")
