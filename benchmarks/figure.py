"""Work over precision: time of all runs against the error of the amplitude, a panel a case."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.series import series_points
from delagrange.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
    journal_style,
    panel_letter,
)

WIDTH = 90 / 25.4  # one column of a journal page [inch]
_RESOLUTION = 300  # [dots per inch]
_CASES = {"equal_biaxial": "equal-biaxial", "uniaxial": "uniaxial"}
_STYLES = {  # colour, marker, line, and a label that is short enough
    "compiled": (BLACK, "o", "-", "Delagrange, compiled"),
    "numpy": (VERMILION, "s", "-", "Delagrange, NumPy"),
    "scipy": (PURPLE, "^", "-", "SciPy solve_ivp, lambdify"),
    "heyoka": (BLUE, "D", "-", "heyoka"),
    "heyoka_output": (SKY_BLUE, "v", "-", "heyoka, continuous output"),
    "heyoka_tuned": (GREEN, "P", "-", "heyoka, tuned by us"),
    "heyoka_alone": (BLUE, "x", "--", "heyoka, no extrema"),
    "heyoka_tuned_alone": (ORANGE, "+", "--", "heyoka, tuned, no extrema"),
}


def draw(numbers: dict) -> Figure | None:
    """The figure of the cases that were measured; None where there is none."""
    names = [name for name in _CASES if "contestants" in numbers.get(name, {})]
    if not names:
        return None
    figure = Figure(figsize=(WIDTH, 0.9 + 2.2 * len(names)), layout="constrained")
    FigureCanvasAgg(figure)
    all_axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for axes, name, letter in zip(all_axes, names, "ab"):
        _draw_case(axes, numbers[name]["contestants"])
        panel_letter(axes, letter)
        axes.set_title(f"{_CASES[name]}, {numbers[name]['runs']} runs", loc="right", fontsize=8.0, pad=3.0)
    all_axes[-1].set_xlabel("rms error of the amplitude [1]")
    handles = {line.get_label(): line for axes in all_axes for line in axes.get_lines()}
    figure.legend(
        handles=list(handles.values()), loc="outside upper center", ncols=2, fontsize=6.5, columnspacing=0.8
    )
    return figure


def _draw_case(axes: Axes, contestants: dict[str, dict]) -> None:
    for name, series in contestants.items():
        points = [point for point in series_points(series) if 0 < point.rms_error < 1]
        colour, marker, line, label = _STYLES[name]
        axes.loglog(
            [point.rms_error for point in points], [point.time for point in points],
            color=colour, marker=marker, linestyle=line, markersize=3.5, linewidth=1.0, label=label,
        )  # fmt: skip
    axes.set_ylabel("time on one core [s]")


def save_figure(numbers: dict, folder: Path) -> Path | None:
    """Write `work_precision.png`; nothing where no case was measured."""
    with journal_style():
        figure = draw(numbers)
        if figure is None:
            return None
        path = folder / "work_precision.png"
        figure.savefig(path, dpi=_RESOLUTION)
    return path
