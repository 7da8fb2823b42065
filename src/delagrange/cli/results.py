"""What becomes of a result: its file, its figure, and what Ctrl-C leaves of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from delagrange.common.files import check_file, check_suffix, write_dataset

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from delagrange.cli.options import Given

_PLOTS = {".png": "PNG", ".pdf": "PDF"}
_RESOLUTION = 200  # [dots per inch] of PNG


class Interrupted(Exception):
    """The user stopped a command; the message says what became of its work."""


@contextmanager
def interruptible(consequence: str) -> Iterator[None]:
    """Turn Ctrl-C inside of the block into `Interrupted` with its consequence."""
    try:
        yield
    except KeyboardInterrupt:
        raise Interrupted(consequence) from None


def check_plot(path: Path) -> Path:
    """The path, if a figure can be written there.

    Raises:
        ValueError: another suffix, a folder in the file's place, or a folder that takes no file.
    """
    check_suffix("plot file", path, _PLOTS)
    return check_file(path)


def check_netcdf(path: Path) -> Path:
    """The path, if NetCDF can be written there: evidence has too many dimensions for a table.

    Raises:
        ValueError: as `check_plot`.
    """
    check_suffix("output file", path, {".nc": "NetCDF"})
    return check_file(path)


def write(result: xr.Dataset, given: Given) -> None:
    """Write the result where a file is wanted."""
    if given.out is not None:
        write_dataset(result, given.out)


def tell_written(given: Given) -> None:
    """Say where the result is, if it is in a file."""
    if given.out is not None:
        print(f"written: {given.out}")


def write_plot(path: Path, draw: Callable[..., Figure], *results: object) -> None:
    """Draw results in the style of all figures, and write one file."""
    from delagrange.figures.style import journal_style

    with journal_style():
        metadata = {"CreationDate": None} if path.suffix == ".pdf" else None
        draw(*results).savefig(path, dpi=_RESOLUTION, metadata=metadata)
    print(f"written: {path}")
