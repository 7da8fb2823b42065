"""Results on disk: NetCDF with everything, CSV with names and units; each file whole or not at all."""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

SUFFIXES = {".nc": "NetCDF", ".csv": "CSV"}


def check_writable(path: Path) -> Path:
    """The path, if a result can be written there: a known suffix in a folder that takes files.

    Raises:
        ValueError: another suffix, a folder in the file's place, or a folder that takes no file.
    """
    check_suffix("output file", path, SUFFIXES)
    return check_file(path)


def check_suffix(what: str, path: Path, suffixes: Mapping[str, str]) -> None:
    """Refuse a file that does not end as one of its kind.

    suffixes: that are allowed, with their names

    Raises:
        ValueError: another suffix, or none.
    """
    if path.suffix not in suffixes:
        allowed = " or ".join(f"{suffix} ({name})" for suffix, name in suffixes.items())
        raise ValueError(f"{what} {path} must end in {allowed}, got {path.suffix or 'no suffix'!r}")


def check_file(path: Path) -> Path:
    """The path, if a file of any kind can be written there.

    Raises:
        ValueError: a folder in the file's place, or a folder that takes no file.
    """
    if path.is_dir():
        raise ValueError(f"output file {path} cannot be written: it is a folder")
    _check_takes_files(path.parent, f"output file {path}")
    return path


def prepare_folder(path: Path) -> Path:
    """The folder, made if it was missing, once it is known to take files.

    Raises:
        ValueError: it cannot be made or takes no file.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"output folder {path} cannot be written: {error.strerror}") from error
    _check_takes_files(path, f"output folder {path}")
    return path


def check_folder(path: Path) -> Path:
    """The path, if it is a folder that can be read.

    Raises:
        ValueError: there is none, it is a file, or it may not be read.
    """
    try:
        next(path.iterdir(), None)
    except OSError as error:
        raise ValueError(f"folder {path} cannot be read: {error.strerror}") from error
    return path


def _check_takes_files(folder: Path, what: str) -> None:
    """Ask the file system by making a file: permissions alone do not know of read-only mounts."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ValueError(f"{what} cannot be written: folder {folder}: {error.strerror}") from error


def write_dataset(dataset: xr.Dataset, path: Path) -> Path:
    """Write a Dataset as NetCDF (`.nc`) or CSV (`.csv`).

    CSV has a header of names and units (`time [s]`) and a row for every point of the grid, the last
    dimension varying fastest; what does not vary along a dimension is repeated. Numbers read back equal.
    NetCDF keeps the attributes as well: definitions, numerics, source.

    Raises:
        ValueError: as `check_writable`, or the writing failed.
    """
    check_writable(path)
    unfinished = path.with_name(f"{path.name}.unfinished")
    try:
        if path.suffix == ".nc":
            dataset.to_netcdf(unfinished, engine="netcdf4")
        else:
            _write_csv(dataset, unfinished)
        unfinished.replace(path)
    except OSError as error:
        raise ValueError(f"output file {path} cannot be written: {error.strerror or error}") from error
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def _write_csv(dataset: xr.Dataset, path: Path) -> None:
    columns = dict(_columns(dataset))
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def _columns(dataset: xr.Dataset) -> Iterator[tuple[str, list]]:
    """Heading and values, a row each, of the dimensions, the other coordinates and the data."""
    sizes = {str(name): size for name, size in dataset.sizes.items()}
    counted = dataset.assign_coords(
        {name: np.arange(size) for name, size in sizes.items() if name not in dataset.coords}
    )
    others = [name for name in (*counted.coords, *counted.data_vars) if name not in sizes]
    for name in (*sizes, *others):
        variable = counted[name].variable
        yield _heading(str(name), variable.attrs), variable.set_dims(sizes).values.ravel().tolist()


def _heading(name: str, attributes: dict[str, object]) -> str:
    return f"{name} [{attributes['units']}]" if "units" in attributes else name
