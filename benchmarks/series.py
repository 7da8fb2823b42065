"""The contestants' series in the raw numbers of a case, and what they take at equal error."""

from __future__ import annotations

import math

from benchmarks.accuracy import EQUAL_ERRORS, Point, ratio, time_at

BASES = ("compiled", "numpy")  # the first one that was measured is what ratios are to
_ERRORS = ("rms_error", "maximum_error")


def series_points(series: dict) -> list[Point]:
    """The finished points of a contestant."""
    return [
        Point(float(key), *(_known(point[name]) for name in _ERRORS), tuple(point["times"]))
        for key, point in series["points"].items()
        if "rms_error" in point and point["times"]
    ]


def _known(error: float | None) -> float:
    """JSON has no infinity: an error of lost runs is null there."""
    return math.inf if error is None else error


def base_of(contestants: dict[str, dict]) -> str | None:
    """Name of the contestant that ratios are to."""
    return next((name for name in BASES if name in contestants), None)


def ratio_at(contestants: dict[str, dict], name: str, base: str, error: float) -> float | str:
    """Time of a contestant over that of the base at a root-mean-square error, or why there is none."""
    times = (time_at(series_points(contestants[one]), error) for one in (name, base))
    return ratio(*times)


def equal_error_ratios(contestants: dict[str, dict]) -> dict[str, dict[str, float | str]]:
    """For the JSON: times at equal error over that of the base, by contestant and error."""
    base = base_of(contestants)
    if base is None:
        return {}
    return {
        name: {f"{error:g}": ratio_at(contestants, name, base, error) for error in EQUAL_ERRORS}
        for name in contestants
    }
