"""Phase portrait: a coordinate against its rate."""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange import checks


def phase_portrait(run: xr.Dataset, coordinate: str | None = None, start: float = 0.0) -> xr.Dataset:
    """A coordinate of a run and its rate, from the time `start` [s] on, without what follows a loss.

    Args:
        run: as `simulate` returns it.
        coordinate: its name, "stretch" or "stretch_1", "stretch_2"; the first of the run if left out.

    Raises:
        ValueError: the run has no such coordinate, or nothing at or after `start`.
    """
    names = [name for name in run.data_vars if _rate_name(str(name)) in run.data_vars]
    coordinate = checks.choice("coordinate", names[0] if coordinate is None else coordinate, map(str, names))
    portrait = run[[coordinate, _rate_name(coordinate)]]
    shown = (portrait["time"] >= checks.finite("start", start, "s")) & np.isfinite(portrait[coordinate])
    if not bool(shown.any()):
        end = float(run["status_time"])
        raise ValueError(f"start = {start:g} s leaves nothing of the run, which ended at {end:g} s")
    return portrait.isel(time=np.flatnonzero(shown.values))


def _rate_name(coordinate: str) -> str:
    """`stretch` -> `stretch_rate`, `stretch_1` -> `stretch_rate_1`."""
    stem, _, index = coordinate.rpartition("_")
    return f"{stem}_rate_{index}" if index.isdigit() else f"{coordinate}_rate"
