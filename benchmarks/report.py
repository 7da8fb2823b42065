"""The report: tables in Markdown from the raw numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from benchmarks.accuracy import EQUAL_ERRORS, Point, ratio, time_at

CASE_TITLES = {
    "equal_biaxial": "Equal-biaxial: six curves of Fig. 4",
    "uniaxial": "Uniaxial: six curves of Fig. 7",
}
_BASES = ("compiled", "numpy")  # the first one that was measured is what ratios are to


def series_points(series: dict) -> list[Point]:
    """The finished points of a contestant."""
    return [
        Point(float(key), *(_known(point[name]) for name in _ERRORS), tuple(point["times"]))
        for key, point in series["points"].items()
        if "rms_error" in point and point["times"]
    ]


_ERRORS = ("rms_error", "maximum_error")


def _known(error: float | None) -> float:
    """JSON has no infinity: an error of lost runs is null there."""
    return math.inf if error is None else error


def report(numbers: dict) -> str:
    """The whole text, of the parts that there are."""
    parts = [_introduction(), _machine(numbers.get("machine"))]
    parts += [_case(title, numbers[name]) for name, title in CASE_TITLES.items() if name in numbers]
    sections = (
        ("peak", _peak),
        ("threads", _threads),
        ("ensembles", _ensembles),
        ("compile_time", _compile_time),
    )
    parts += [section(numbers[name]) for name, section in sections if name in numbers]
    return "\n\n".join(part for part in parts if part) + "\n"


def _introduction() -> str:
    return (
        "# Benchmark of sweeps\n\n"
        "Half of peak to peak of the stretch, from rest, of the membrane of Sheng et al. (2015), under a "
        "step of force and a sinusoidal field. Time: median of repeats on one core, "
        "contestants and tolerances interleaved; compiling is not counted. Error: of the amplitude, against heyoka "
        "at tolerance 1e-16. Made by `python -m benchmarks`."
    )


def _machine(facts: dict | None) -> str:
    if facts is None:
        return ""
    rows = [(name, facts[name]) for name in ("processor", "cores", "vectors", "system", "python")]
    packages = ", ".join(f"{name} {version}" for name, version in facts["packages"].items())
    return "## Machine\n\n" + table(("", ""), [*rows, ("packages", packages)])


# --- work and precision ----------------------------------------------------------------------------


def _case(title: str, numbers: dict) -> str:
    if "left_out" in numbers:
        return f"## {title}\n\n{numbers['left_out']}"
    contestants = numbers["contestants"]
    blocks = [f"## {title}", _runs(numbers), _equal_error_table(contestants), _methods(numbers)]
    if "cross_check" in numbers:
        blocks.append(_cross_check(numbers["cross_check"]))
    blocks.append("All points:")
    blocks.append(_points_table(contestants))
    return "\n\n".join(blocks)


def _runs(numbers: dict) -> str:
    return (
        f"{numbers['runs']} runs of {numbers['duration']:g} s: {numbers['frequencies']} frequencies from "
        f"{numbers['first_frequency']:g} to {numbers['last_frequency']:g} Hz on each curve."
    )


def _equal_error_table(contestants: dict[str, dict]) -> str:
    """Time at equal error, and in brackets how many times that of the base."""
    base = next((name for name in _BASES if name in contestants), None)
    heads = ("", *(f"{error:.0e}".replace("e-0", "e-") for error in EQUAL_ERRORS))
    rows = [
        (series["label"], *_at_equal_errors(series, contestants.get(base))) for series in contestants.values()
    ]
    about = (
        f"in brackets: over that of {contestants[base]['label']}"
        if base
        else "no base for ratios was measured"
    )
    text = (
        "Time [s] of all runs at equal root-mean-square error of the amplitude, interpolated between neighbouring "
        f"tolerances in log-log, nothing extrapolated; {about}:"
    )
    return f"{text}\n\n{table(heads, rows)}"


def _at_equal_errors(series: dict, base: dict | None) -> list[str]:
    return [_with_ratio(time_at(series_points(series), error), base, error) for error in EQUAL_ERRORS]


def _with_ratio(time: float | str, base: dict | None, error: float) -> str:
    if isinstance(time, str):
        return time
    times_base = ratio(time, time_at(series_points(base), error)) if base else "no base"
    return f"{time:.3g} s" if isinstance(times_base, str) else f"{time:.3g} s ({times_base:.3g}x)"


def equal_error_ratios(contestants: dict[str, dict]) -> dict[str, dict[str, float | str]]:
    """For the JSON: times at equal error over that of the base, by contestant and error."""
    base = next((name for name in _BASES if name in contestants), None)
    if base is None:
        return {}
    base_times = {error: time_at(series_points(contestants[base]), error) for error in EQUAL_ERRORS}
    return {
        name: {
            f"{error:g}": ratio(time_at(series_points(series), error), base_times[error])
            for error in EQUAL_ERRORS
        }
        for name, series in contestants.items()
    }


def _methods(numbers: dict) -> str:
    lines = []
    for series in numbers["contestants"].values():
        line = f"- {series['label']}: {series['method']}"
        if series["timed_runs"] < numbers["runs"]:
            line += f"; {series['timed_runs']} runs spread over all were timed, the time scaled to {numbers['runs']}"
        if series["accuracy_of"]:
            lender = numbers["contestants"].get(series["accuracy_of"], {}).get("label", series["accuracy_of"])
            line += f"; as its error stands that of {lender!r} at equal tolerance"
        lines.append(line)
    lines += [f"- {line}" for line in numbers.get("refusals", [])]
    return "\n".join(lines)


def _cross_check(check: dict) -> str:
    return (
        f"The reference against `solve_ivp` (DOP853, rtol {check['rtol']:g}) on {check['runs']} runs: largest "
        f"difference {check['largest_difference']:.1e}."
    )


def _points_table(contestants: dict[str, dict]) -> str:
    heads = (
        "",
        "tolerance",
        "rms error",
        "largest error",
        "time [s]",
        "shortest [s]",
        "longest [s]",
        "repeats",
    )
    rows = [
        (
            series["label"], f"{point.tolerance:g}", _error(point.rms_error), _error(point.maximum_error),
            f"{point.time:.3g}", f"{min(point.times):.3g}", f"{max(point.times):.3g}", len(point.times),
        )
        for series in contestants.values()
        for point in series_points(series)
    ]  # fmt: skip
    return table(heads, rows)


def _error(error: float) -> str:
    return f"{error:.1e}" if math.isfinite(error) else "runs lost"


# --- the other parts -------------------------------------------------------------------------------


def _peak(numbers: dict) -> str:
    title = "## Peak of fused multiply-adds, one core, double precision\n\n"
    if "left_out" in numbers:
        return title + numbers["left_out"]
    rows = [(one["doubles"], one["registers"], f"{one['rate']:.1f}") for one in numbers["widths"]]
    loop = " and ".join(f"{count} on {name}" for name, count in numbers["plain_loop"].items()) or "none"
    text = table(("doubles a vector", "registers", "10^9 operations/s"), rows)
    return (
        f"{title}{text}\n\nA multiply-add counts as two operations. An ordinary loop over arrays, compiled as "
        f"Numba does by itself here, has these packed multiply-adds: {loop}."
    )


def _threads(numbers: dict) -> str:
    title = f"## Threads (engine {numbers['engine']}, rtol {numbers['rtol']:g})\n\n"
    single = float(np.median(numbers["counts"][0]["times"]))
    rows = []
    for one in numbers["counts"]:
        time = float(np.median(one["times"]))
        rows.append((one["threads"], one["runs"], f"{time:.3g}", f"{single / time:.2f}"))
    text = title + table(("threads", "runs", "time [s]", "speed-up"), rows)
    return text if numbers["engine"] == "compiled" else text + "\n\nThis engine has no threads."


def _ensembles(numbers: dict) -> str:
    title = f"## Large ensembles (engine {numbers['engine']}, rtol {numbers['rtol']:g}, one thread)\n\n"
    rows = [
        (
            f"{one['trajectories']:,}".replace(",", " "), f"{one['time']:.3g}",
            f"{one['time'] / one['trajectories'] * 1e6:.3g}", _mebibyte(one["result"]),
            _mebibyte(max(one["peak"] - one["before"] - one["result"], 0)), _mebibyte(one["peak"]),
        )
        for one in numbers["sizes"]
    ]  # fmt: skip
    heads = (
        "trajectories", "time [s]", "a trajectory [µs]", "result [MiB]", "memory beyond it [MiB]",
        "whole process [MiB]",
    )  # fmt: skip
    return (
        f"{title}{table(heads, rows)}\n\nEqual-biaxial, frequencies times field amplitudes, {numbers['duration']:g} s "
        "each, every size in a fresh process. Memory beyond the result: the peak, less what the process had after "
        "a sweep of 16 runs, less the result."
    )


def _mebibyte(size: int) -> str:
    return f"{size / 2**20:.3g}"


def _compile_time(numbers: dict) -> str:
    rows = [
        (f"{state} cache", *(f"{numbers[name][key]:.3g}" for key in ("imports", "first", "second")))
        for name, state in (("cold", "empty"), ("cached", "full"))
        if name in numbers
    ]
    heads = ("", "imports [s]", "first sweep of 16 runs [s]", "second [s]")
    title = f"## Compile time (engine {numbers['engine']})\n\n"
    return f"{title}{table(heads, rows)}\n\nEach row in a fresh process; cache: of compiled code."


def table(heads: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(entry) for entry in line) + " |" for line in lines)
