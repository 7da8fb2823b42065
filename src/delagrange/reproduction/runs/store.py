"""Finished runs on disk: kept as NetCDF under their name, and used again only for the very same job."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path

import xarray as xr

_ROOMS = (".", "analysis", "analysis/motion", "analysis/rest", "analysis/steady", "generated", "reproduction")
_COMPUTING = (
    "cases.py",
    "kinds.py",
    "motions.py",
    "numerics.py",
    "responses.py",
)  # of the modules beside this one


def digest(*described: object) -> str:
    """SHA-256 over the `repr` of what is run and the sources of the modules that run it."""
    state = hashlib.sha256(repr(described).encode())
    for name, text in _sources():
        state.update(name.encode() + b"\0" + text + b"\0")
    return state.hexdigest()


def _sources() -> Iterable[tuple[str, bytes]]:
    for room in _ROOMS:
        folder = files("delagrange").joinpath(room)
        for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
            counts = entry.name.endswith(".py") if room != "reproduction" else entry.name in _COMPUTING
            if counts:
                yield f"{room}/{entry.name}", entry.read_bytes()


def kept(path: Path, key: str) -> xr.Dataset | None:
    """The Dataset at `path` if it was saved for this `key`; None if there is none or it is another's."""
    if not path.exists():
        return None
    try:
        dataset = xr.load_dataset(path)
    except (OSError, ValueError):
        return None  # not a whole NetCDF file: computed anew
    return dataset if dataset.attrs.get("digest") == key else None


def keep(dataset: xr.Dataset, path: Path, key: str) -> None:
    """Save for `key`; the file appears whole or not at all, whatever interrupts."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    dataset.assign_attrs(digest=key).to_netcdf(part, engine="netcdf4")
    os.replace(part, path)
