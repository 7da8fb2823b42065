"""`delagrange derive FILE`: the modules of a membrane that a user describes."""

from __future__ import annotations

from pathlib import Path

import typer

from delagrange.cli import console
from delagrange.cli.interruption import interruptible
from delagrange.common.files import check_folder


def derive_file(model: Path, out: Path | None, check: bool, quiet: bool) -> None:
    """Derive the membrane of a model file and write its modules, or compare them with those in the folder.

    Raises:
        ValueError: no folder is given, the file is refused, or the folder cannot be written.
        typer.Exit: with `check`, a module is stale.
    """
    if out is None:
        raise ValueError(f"the modules of {model} need a folder of their own: give it with --out DIR")
    if check:
        check_folder(out)
    with interruptible("nothing was written"), console.messages(quiet).status(f"deriving {model}"):
        modules = _derived(model)
    if check:
        _compare(modules, out, model)
        return
    from delagrange.derive.emit.write_together import write_together

    with interruptible("nothing was written"):
        write_together(modules, out)
    print(f"written: {', '.join(name for name, _ in modules)} in {out}")


def _derived(path: Path) -> tuple[tuple[str, str], ...]:
    """File name and text of each module of the membrane."""
    from delagrange.derive.model_file.describe import describe
    from delagrange.derive.model_file.file import read_model_file
    from delagrange.derive.pipeline import derive_description

    description = describe(read_model_file(path))
    try:
        return derive_description(description)
    except ValueError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from error


def _compare(modules: tuple[tuple[str, str], ...], folder: Path, model: Path) -> None:
    from delagrange.derive import pipeline

    old = pipeline.stale(modules, folder)
    for name in old:
        console.complain(f"stale: {folder / name} is not what {model} gives; derive it again")
    print(f"{len(modules) - len(old)} of {len(modules)} modules in {folder} are as emitted")
    if old:
        raise typer.Exit(1)
