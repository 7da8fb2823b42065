"""The report: tables in Markdown from the raw numbers."""

from __future__ import annotations

import math

from benchmarks import report_parts as sections
from benchmarks.accuracy import EQUAL_ERRORS, ratio, time_at
from benchmarks.heyoka_system import TRIED
from benchmarks.markdown import bullets, table
from benchmarks.series import base_of, series_points
from benchmarks.targets import targets_section

CASE_TITLES = {
    "equal_biaxial": "Equal-biaxial: six curves of Fig. 4",
    "uniaxial": "Uniaxial: six curves of Fig. 7",
}
_PARTS = {
    "kernel": sections.kernel,
    "vectors": sections.vectors,
    "peak": sections.peak,
    "threads": sections.threads,
    "ensembles": sections.ensembles,
    "compile_time": sections.compile_time,
    "tangents": sections.tangents,
    "understanding": sections.understanding,
}


def report(numbers: dict) -> str:
    """The whole text, of the parts that there are."""
    parts = [_introduction(numbers), targets_section(numbers), _machine(numbers.get("machine"))]
    parts += [_case(title, numbers[name]) for name, title in CASE_TITLES.items() if name in numbers]
    parts.append(_notes(numbers))
    parts += [section(numbers[name]) for name, section in _PARTS.items() if name in numbers]
    return "\n\n".join(part for part in parts if part) + "\n"


def _introduction(numbers: dict) -> str:
    quick = [name for name, part in numbers.items() if part.get("quick")]
    warning = (
        f"\n\n**Quick, few runs and repeats, only to see that it works: {', '.join(quick)}.**"
        if quick
        else ""
    )
    return (
        "# Benchmark of sweeps\n\n"
        "Half of peak to peak of the stretch, from rest, of the membrane of Sheng et al. (2015), under a "
        "step of force and a sinusoidal field. Time: median of repeats on one core, "
        "contestants and tolerances interleaved; compiling is not counted. Error: of the amplitude, against heyoka "
        f"at tolerance 1e-16. Made by `python -m benchmarks`.{warning}"
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
    base = base_of(contestants)
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


def _methods(numbers: dict) -> str:
    lines = [_method(series, numbers) for series in numbers["contestants"].values()]
    return bullets([*lines, *numbers.get("refusals", [])])


def _notes(numbers: dict) -> str:
    """What was done to contestants, once for all cases."""
    noted = {
        series["label"]: series["notes"]
        for name in CASE_TITLES
        for series in numbers.get(name, {}).get("contestants", {}).values()
        if series.get("notes")
    }
    blocks = [f"## What was done to {label}\n\n{bullets(notes)}" for label, notes in noted.items()]
    return "\n\n".join([*blocks, f"Tried besides: {TRIED}."]) if noted else ""


def _method(series: dict, numbers: dict) -> str:
    line = f"{series['label']}: {series['method']}"
    if series["timed_runs"] < numbers["runs"]:
        line += (
            f"; {series['timed_runs']} runs spread over all were timed, the time scaled to {numbers['runs']}"
        )
    if series["accuracy_of"]:
        lender = numbers["contestants"].get(series["accuracy_of"], {}).get("label", series["accuracy_of"])
        line += f"; as its error stands that of {lender!r} at equal tolerance"
    return line


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
