"""Phase portrait: a coordinate against its rate."""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange.common import checks, units

_OVER = (("time",), ("point",))


def phase_portrait(run: xr.Dataset, coordinate: str | None = None, start: float = 0.0) -> xr.Dataset:
    """A coordinate of a run and its rate, from the time `start` [s] on, without what follows a loss.

    Args:
        run: as `simulate` returns it, over `time`, or `stroboscopic_section`, over `point`.
        coordinate: its name, "stretch" or "stretch_1", "stretch_2"; the first of the run if left out.

    Raises:
        ValueError: not a run or a section, or it has no such coordinate, or nothing at or after `start`.
    """
    names = _coordinates(run)
    coordinate = checks.choice("coordinate", names[0] if coordinate is None else coordinate, names)
    start = checks.scalar("start", checks.finite("start", start, "s"), "s")
    portrait = run[[coordinate, _rate_name(coordinate)]]
    kept = (portrait["time"] >= start) & np.isfinite(portrait[coordinate])
    if not bool(kept.any()):
        end = float(run["status_time"])
        raise ValueError(f"start = {start:g} s leaves nothing of the run, which ended at {end:g} s")
    return portrait.isel({kept.dims[0]: np.flatnonzero(kept.values)})


def _coordinates(run: object) -> list[str]:
    """The names of the run's coordinates, of which there is at least one."""
    variables = [str(name) for name in run.variables] if isinstance(run, xr.Dataset) else []
    names = [name for name in variables if _rate_name(name) in variables]
    if not names or not {"time", "status_time"} <= set(variables) or run["time"].dims not in _OVER:
        given = f"a Dataset of {', '.join(variables)}" if variables else units.shown(run)
        raise ValueError(
            "run must be a Dataset over time as simulate returns it, or over point as stroboscopic_section "
            f"does, got {given}"
        )
    return names


def _rate_name(coordinate: str) -> str:
    """`stretch` -> `stretch_rate`, `stretch_1` -> `stretch_rate_1`."""
    stem, _, index = coordinate.rpartition("_")
    return f"{stem}_rate_{index}" if index.isdigit() else f"{coordinate}_rate"
