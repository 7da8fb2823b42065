"""Files that belong together, all of them or none: a module must not stand beside the kernels of another."""

from __future__ import annotations

import tempfile
from pathlib import Path


def write_together(files: tuple[tuple[str, str], ...], folder: Path) -> None:
    """Write files, given as name and text, into a folder, which is made if it is missing.

    If one cannot be written, or the writing is interrupted, what stood there before stands there again.

    Raises:
        ValueError: the folder cannot be made or takes no file.
    """
    missing = [place for place in (folder, *folder.parents) if not place.exists()]  # the innermost first
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _write(files, folder)
    except BaseException as error:
        _remove_empty(missing)
        if isinstance(error, OSError):
            raise ValueError(
                f"output folder {folder} cannot be written: {error.strerror or error}"
            ) from error
        raise


def _write(files: tuple[tuple[str, str], ...], folder: Path) -> None:
    with tempfile.TemporaryDirectory(dir=folder, prefix=".unfinished-") as aside:
        for name, text in files:
            (Path(aside) / name).write_text(text, encoding="utf-8", newline="\n")
        before = {name: _content(folder / name) for name, _ in files}
        try:
            for name, _ in files:
                (Path(aside) / name).replace(folder / name)
        except BaseException:
            for name, content in before.items():
                _restore(folder / name, content)
            raise


def _content(path: Path) -> bytes | None:
    return path.read_bytes() if path.exists() else None


def _restore(path: Path, content: bytes | None) -> None:
    if content is None:
        path.unlink(missing_ok=True)
    else:
        path.write_bytes(content)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
