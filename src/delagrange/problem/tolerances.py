"""What durations and tolerances make sense in double precision."""

from __future__ import annotations

from delagrange.common import checks
from delagrange.common.units import with_unit

RTOL_RANGE = (1e-13, 1e-2)
ATOL_RANGE = (1e-18, 1e-2)
DURATION_RANGE = (1e-9, 1e6)  # [s], far beyond the fastest and the slowest membrane on both sides


def check_tolerances(rtol: float, atol: float) -> tuple[float, float]:
    """Relative and absolute tolerance, within what double precision can honour.

    Raises:
        ValueError: outside `RTOL_RANGE` or `ATOL_RANGE`.
    """
    return checks.within("rtol", rtol, "1", *RTOL_RANGE), checks.within(
        "atol", atol, "the unit of each state variable", *ATOL_RANGE
    )


def check_duration(duration: float) -> float:
    """Duration [s].

    Raises:
        ValueError: outside `DURATION_RANGE`.
    """
    return checks.within("duration", duration, "s", *DURATION_RANGE)


def check_window(window: tuple[float, float] | None, duration: float) -> tuple[float, float]:
    """Start and end [s] of the window in which extrema are taken; the whole duration if None.

    Raises:
        ValueError: not 0 <= start < end <= duration.
    """
    if window is None:
        return 0.0, duration
    ends = checks.increasing("window", window, "s")
    if len(ends) != 2 or ends[0] < 0 or ends[1] > duration:
        raise ValueError(
            f"window must be (start, end) with 0 s <= start < end <= {duration:g} s, got {with_unit(window, 's')}"
        )
    return float(ends[0]), float(ends[1])
