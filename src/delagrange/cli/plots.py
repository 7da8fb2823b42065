"""One figure of a result, in the file that a person named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from delagrange.common.files import check_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SUFFIXES = {".png": "PNG", ".pdf": "PDF"}
_RESOLUTION = 200  # [dots per inch] of PNG


def check_plot(path: Path | None) -> None:
    """Refuse a path at which no figure can be written; None is fine.

    Raises:
        ValueError: another suffix, a folder in the file's place, or a folder that takes no file.
    """
    if path is None:
        return
    if path.suffix not in _SUFFIXES:
        allowed = " or ".join(f"{suffix} ({name})" for suffix, name in _SUFFIXES.items())
        raise ValueError(f"plot file {path} must end in {allowed}, got {path.suffix or 'no suffix'!r}")
    check_file(path)


def write_plot(draw: Callable[[], Figure], path: Path) -> None:
    """Draw in the style of all figures, and write one file."""
    from delagrange.figures.style import journal_style

    with journal_style():
        metadata = {"CreationDate": None} if path.suffix == ".pdf" else None
        draw().savefig(path, dpi=_RESOLUTION, metadata=metadata)
    print(f"written: {path}")
