"""What durations and tolerances make sense in double precision."""

from __future__ import annotations

from delagrange import checks

RTOL_RANGE = (1e-13, 1e-2)
ATOL_RANGE = (1e-18, 1e-2)


def check_tolerances(rtol: float, atol: float) -> tuple[float, float]:
    """Relative and absolute tolerance, within what double precision can honour.

    Raises:
        ValueError: outside `RTOL_RANGE` or `ATOL_RANGE`.
    """
    return checks.within("rtol", rtol, "1", *RTOL_RANGE), checks.within(
        "atol", atol, "the unit of each state variable", *ATOL_RANGE
    )


def check_duration(duration: float) -> float:
    """Duration [s], positive and finite.

    Raises:
        ValueError: it is not.
    """
    return checks.scalar("duration", checks.positive("duration", duration, "s"), "s")


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
            f"window must be (start, end) with 0 s <= start < end <= {duration:g} s, got {window!r} s"
        )
    return float(ends[0]), float(ends[1])
