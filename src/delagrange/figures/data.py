"""The data a figure is drawn from: one Dataset a figure, as NetCDF and as a table for any program."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from delagrange.common.files import write_dataset


def joined(parts: Sequence[xr.Dataset], dimension: str) -> xr.Dataset:
    """Datasets of the same variables one after the other along `dimension`; attributes that differ are dropped."""
    return xr.concat(
        list(parts), dim=dimension, data_vars="all", coords="different", compat="equals",
        combine_attrs="drop_conflicts",
    )  # fmt: skip


def side_by_side(parts: Sequence[xr.Dataset], dimension: str, names: Sequence[str]) -> xr.Dataset:
    """Datasets of the same variables along a new `dimension` whose coordinate holds their names."""
    return joined(parts, dimension).assign_coords({dimension: (dimension, np.array(names, dtype=object))})


def by_formulation(parts: Sequence[xr.Dataset], forms: Sequence[str | None]) -> xr.Dataset:
    """One Dataset for each formulation, side by side; where there is but one, that."""
    return parts[0] if len(parts) == 1 else side_by_side(parts, "formulation", forms)


def of_formulation(data: xr.Dataset, form: str | None) -> xr.Dataset:
    """The part of one formulation of what `by_formulation` gave."""
    return data if form is None else data.sel(formulation=form)


def save_data(data: xr.Dataset, stem: Path) -> tuple[Path, Path]:
    """Write `stem`.nc and `stem`.csv.

    Raises:
        ValueError: the folder cannot be written.
    """
    netcdf = write_dataset(data, stem.with_name(f"{stem.name}.nc"))
    return netcdf, write_dataset(data, stem.with_name(f"{stem.name}.csv"))
