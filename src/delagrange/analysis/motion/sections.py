"""Stroboscopic (Poincaré) sections: the state at one phase of the drive, period after period."""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange.common import checks
from delagrange.drives.drive import Drive, Sine
from delagrange.drives.phase import fraction_of_period
from delagrange.run.run_dataset import variable
from delagrange.run.simulation import simulate


def stroboscopic_section(
    model: object,
    *,
    count: int,
    field: Drive | float = 0.0,
    force: Drive | float = 0.0,
    period: float | None = None,
    phase: float = 0.0,
    transient: int = 0,
    **options: object,
) -> xr.Dataset:
    """The run at one phase of the drive in each period, for `count` periods after `transient` ones.

    The times are t_k = (k + fraction) period, with the fraction in [0, 1) at which the argument of the
    sine, 2 pi t / period plus the drive's own phase, is `phase` (modulo 2 pi). Exact phases: the values
    are those of the integrator's own polynomial at t_k, not picked from an output grid.

    Args:
        model, field, force, options: as for `simulate` (without `duration`, `time` and `samples`).
        count: how many points.
        period: [s]; left out, that of the sinusoidal field or force, whose own phase is then counted.
        phase: [rad], of the argument of the sine.
        transient: how many periods to leave out at the beginning.

    Returns:
        Dataset over `point` with the variables of `simulate` and the coordinates `time` [s] and
        `period_number`. Points after the loss of the solution are NaN.

    Raises:
        ValueError: no period given and none to be had from the drives, or as `simulate`.
    """
    for name in ("duration", "time", "samples"):
        if name in options:
            raise ValueError(f"{name} follows from count, transient and period here; leave it out")
    count = checks.count("count", count, 1)
    numbers = np.arange(count) + checks.count("transient", transient, 0)
    period, start = _period(period, field, force)
    phase = checks.scalar("phase", checks.finite("phase", phase, "rad"), "rad")
    times = (numbers + fraction_of_period(phase - start)) * period
    duration = max(float(times[-1]), period)
    run = simulate(model, field=field, force=force, duration=duration, time=times, **options)
    return _over_points(run, numbers, {"period": period, "phase": phase})


def _period(given: float | None, *drives: Drive | float) -> tuple[float, float]:
    """Period [s] of the section, and the phase [rad] of its drive at t = 0."""
    if given is not None:
        return checks.scalar("period", checks.positive("period", given, "s"), "s"), 0.0
    found = {
        (1 / float(drive.frequency), float(drive.phase))
        for drive in drives
        if isinstance(drive, Sine) and np.ndim(drive.frequency) == 0
    }
    if len(found) != 1:
        periods = sorted(period for period, _ in found)
        raise ValueError(
            f"period [s] must be given where the drives do not have just one; they have {periods}"
        )
    return found.pop()


def _over_points(run: xr.Dataset, numbers: np.ndarray, attributes: dict[str, float]) -> xr.Dataset:
    section = run.rename_dims(time="point").reset_index("time")
    section = section.assign_coords(period_number=variable("point", numbers, "1", "period of the drive"))
    return section.assign_attrs(section_period=attributes["period"], section_phase=attributes["phase"])
