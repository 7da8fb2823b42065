"""Sections of the report on the kernel and on scaling, from the raw numbers."""

from __future__ import annotations

import numpy as np

from benchmarks.markdown import bullets, table
from benchmarks.targets import beyond_result
from benchmarks.vector_width import failures


def peak(numbers: dict) -> str:
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


def kernel(numbers: dict) -> str:
    title = "## Rate of the compiled kernel\n\n"
    if "left_out" in numbers:
        return title + numbers["left_out"]
    finished = {name: one for name, one in numbers["cases"].items() if "gigaflops" in one}
    rows = [_rate_row(name, one) for name, one in finished.items()]
    heads = (
        "", "runs", "evaluations", "a trajectory and evaluation [ns]", "operations an evaluation",
        "10^9 operations/s", "of the peak",
    )  # fmt: skip
    return f"{title}{table(heads, rows)}\n\n{_counting(finished, numbers)}"


def _rate_row(name: str, one: dict) -> tuple:
    return (
        name.replace("_", "-"), one["runs"], f"{one['evaluations']:.3g}", f"{one['nanoseconds']:.2f}",
        f"{one['operations']['total']:.0f}", f"{one['gigaflops']:.1f}", f"{one['share_of_peak']:.0%}",
    )  # fmt: skip


def _counting(cases: dict[str, dict], numbers: dict) -> str:
    counts = "; ".join(
        f"{name.replace('_', '-')} {one['operations']['rates_and_sine']:.0f} for the rates and the sine, "
        f"{one['operations']['stage_sums']:.1f} for the sums of the stages, "
        f"{one['operations']['error_estimate']:.1f} for the error estimate"
        for name, one in cases.items()
    )
    return (
        f"The sweep of each case at rtol {numbers['rtol']:g}, one thread; time: the whole of it, extrema and all, over "
        "the evaluations of all trajectories, 12 for each step tried. Operations, as counted for one evaluation, "
        f"those of a step shared out over its 12: {counts}. Sums and products are one operation each, a division "
        "too. Not counted, though done: the drives, the choice of the step, the search for extrema with its "
        f"interpolants. Peak, measured in between: {numbers['peak_gigaflops']:.1f} x 10^9 operations/s."
    )


def vectors(numbers: dict) -> str:
    title = "## Vectors of the compiled kernel\n\n"
    if "left_out" in numbers:
        return title + numbers["left_out"]
    rows = [
        (model, *one["counts"].values(), one["width"], f"{one['share']:.0%}")
        for model, one in numbers["models"].items()
    ]
    counted = next(iter(numbers["models"].values()))["counts"]
    text = table(("", *counted, "packed on", "its share"), rows)
    about = (
        "Instructions of the assembly that add, multiply, divide or fuse doubles, by registers; each is counted once, "
        f"however often it runs. The machine's full width is {numbers['machine_width']}."
    )
    return "\n\n".join([title + text, about, bullets(f"**{line}**" for line in failures(numbers))]).rstrip()


def threads(numbers: dict) -> str:
    title = f"## Threads (engine {numbers['engine']}, rtol {numbers['rtol']:g})\n\n"
    single = float(np.median(numbers["counts"][0]["times"]))
    rows = []
    for one in numbers["counts"]:
        time = float(np.median(one["times"]))
        rows.append((one["threads"], one["runs"], f"{time:.3g}", f"{single / time:.2f}"))
    text = title + table(("threads", "runs", "time [s]", "speed-up"), rows)
    text += (
        f"\n\nThe sweep of the six equal-biaxial curves {numbers['sweeps']} times, counts of threads in turn."
    )
    return text if numbers["engine"] == "compiled" else text + " This engine has no threads."


def ensembles(numbers: dict) -> str:
    title = f"## Large ensembles (engine {numbers['engine']}, rtol {numbers['rtol']:g}, one thread)\n\n"
    rows = [
        (
            f"{one['trajectories']:,}".replace(",", " "), f"{one['time']:.3g}",
            f"{one['time'] / one['trajectories'] * 1e6:.3g}", _mebibyte(one["result"]),
            _mebibyte(beyond_result(one)), _mebibyte(one["peak"]),
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


def compile_time(numbers: dict) -> str:
    imports = float(np.median(numbers["imports"])) if numbers["imports"] else np.nan
    rows = [
        (state, len(times), f"{np.median(times):.3g}", f"{np.median(times) - imports:.3g}")
        for state, times in (("empty", numbers["cold"]), ("full", numbers["cached"]))
        if times
    ]
    heads = ("cache of compiled code", "processes", "first tiny sweep [s]", "less imports [s]")
    return (
        f"## Compile time (engine {numbers['engine']})\n\n{table(heads, rows)}\n\nMedians over fresh processes. "
        "First tiny sweep: from before `import delagrange` to the end of a sweep of one run. Less imports: less the "
        f"time of a process that imports delagrange, numpy and xarray and no more, {imports:.3g} s."
    )


def tangents(numbers: dict) -> str:
    title = "## Tangents by the variational equations\n\n"
    if "left_out" in numbers:
        return title + numbers["left_out"]
    rows = [
        (model.replace("_", "-"), one["label"], _milliseconds(one["time"]), _times(one["ratio"]))
        for model, found in numbers["models"].items()
        for one in found.values()
    ]
    return (
        f"{title}{table(('', 'by', 'time [ms]', 'over ours'), rows)}\n\n"
        f"The derivative of stretches and rates by those {numbers['periods']} forcing periods before (0.067 s "
        "under 0.5 N and 1 MV/m at 300 Hz, dashpots frozen), one core, medians, tolerances interleaved; compiling is "
        f"not counted. At a largest error of {numbers['error']:g} of the largest entry, in units of typical sizes, "
        "against heyoka at a tolerance of 1e-18."
    )


def _milliseconds(time: float | str) -> str:
    return time if isinstance(time, str) else f"{1e3 * time:.3g}"


def _times(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.3g}"


def understanding(numbers: dict) -> str:
    rows = [
        (one["text"], f"{one['first']:.2f}", f"{np.median(one['again']):.2f}", one["size"])
        for one in numbers.values()
        if isinstance(one, dict)
    ]
    heads = ("", "first [s]", "again [s]", "points, seconds of motion, runs, or cases")
    return (
        f"## Questions to a motion\n\n{table(heads, rows)}\n\nEach in a fresh process, beyond the start of Python; "
        "first: with an empty cache of compiled code; again: the median of later ones."
    )
