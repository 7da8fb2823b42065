"""Figs. 4, 7 and 10: amplitude over frequency, the printed peaks beside the computed curves.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from delagrange.figures.amplitude_axis import lost_places, mark_lost, set_scale
from delagrange.figures.data import by_formulation, of_formulation, side_by_side
from delagrange.figures.notation import FREQUENCY_LABEL, NOTATION
from delagrange.figures.style import (
    BLACK,
    CURVE_COLOURS,
    FORMULATION_NAMES,
    caption,
    new_figure,
    panel_letter,
)
from delagrange.reproduction.figures.labels import DRIVE_TEXT, load_label, quantity_label, value_label
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import CurveLoad, Panel, ResponseFigure
from delagrange.reproduction.runs.published_numbers import PEAKS, Peak
from delagrange.reproduction.runs.runs import ACCURATE, NUMERICS, PAPER_LIKE, curve, formulations
from delagrange.run.run_dataset import PAPER as SOURCE

_LEGEND_HEIGHT = 12.0  # [point]


def response_data(runs: Runs, case: ResponseFigure) -> xr.Dataset:
    """Over ([formulation], numerics, load, frequency): the amplitudes that the figure shows."""
    names = [numerics.name for numerics in NUMERICS]
    parts = [
        side_by_side([runs.response(case.number, form, name) for name in names], "numerics", names)
        for form in formulations(case.model)
    ]
    return by_formulation(parts, formulations(case.model))


def draw_response(data: xr.Dataset, case: ResponseFigure) -> Figure:
    """One column a panel, one row a formulation."""
    forms = formulations(case.model)
    figure = new_figure(height=1.2 + 2.6 * len(forms))
    blocks = np.atleast_1d(figure.subfigures(len(forms), 1))
    for form, block in zip(forms, blocks):
        if form is not None:
            block.suptitle(FORMULATION_NAMES[form], fontsize=9.0)
        _draw_block(block, of_formulation(data, form), case)
    _legend(figure, data, case)
    caption(figure, _caption(data, case))
    return figure


def _draw_block(block: SubFigure, data: xr.Dataset, case: ResponseFigure) -> None:
    notation = NOTATION[case.model]
    all_axes = block.subplots(1, len(case.panels), sharex=True, squeeze=False)[0]
    for axes, panel in zip(all_axes, case.panels):
        _draw_panel(axes, data, case, panel)
        panel_letter(axes, panel.letter, above=_LEGEND_HEIGHT)
        fixed = load_label(panel.loads[0], without=panel.varied)
        axes.set_title(fixed, fontsize=8.0, pad=3.0 + _LEGEND_HEIGHT, loc="right")
        axes.set_xlabel(FREQUENCY_LABEL)
        axes.margins(x=0.0)
        set_scale(axes, _shown_amplitudes(data, case, panel))
    all_axes[0].set_ylabel(notation.amplitude_label)


def _draw_panel(axes: Axes, data: xr.Dataset, case: ResponseFigure, panel: Panel) -> None:
    for load, colour in zip(panel.loads, CURVE_COLOURS):
        accurate, rough = (
            curve(data.sel(numerics=numerics.name), load) for numerics in (ACCURATE, PAPER_LIKE)
        )
        axes.plot(
            rough["frequency"], rough["amplitude"], color=colour, linewidth=0.7, linestyle=(0, (3, 1.5))
        )
        axes.plot(
            accurate["frequency"], accurate["amplitude"], color=colour, label=value_label(load, panel.varied)
        )
        for shown in (accurate, rough):
            mark_lost(axes, lost_places(shown), colour)
        for peak in peaks_of(case, load):
            _mark_peak(axes, peak, colour)
    _panel_legend(axes, panel)


def _panel_legend(axes: Axes, panel: Panel) -> None:
    """One line above the panel, where no data are: `E_0 [MV/m]: - 3 - 4 - 5`."""
    heading = Line2D([], [], linestyle="none", label=f"{quantity_label(panel.varied)}:")
    curves = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
    axes.legend(
        handles=[heading, *curves], loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=1 + len(curves),
        handlelength=1.0, handletextpad=0.4, columnspacing=0.8, borderpad=0.0, borderaxespad=0.3,
    )  # fmt: skip


def peaks_of(case: ResponseFigure, load: CurveLoad) -> tuple[Peak, ...]:
    """What the paper prints of the curve of a load in a figure."""
    return tuple(peak for peak in PEAKS if peak.figure == case.number and peak.load == load)


def _mark_peak(axes: Axes, peak: Peak, colour: str) -> None:
    if peak.amplitude is None:
        axes.axvline(peak.frequency, color=colour, linewidth=0.7, linestyle=":")
        return
    axes.plot(peak.frequency, peak.amplitude, **_PEAK, markeredgecolor=colour)


_PEAK = {
    "marker": "o",
    "markersize": 5.5,
    "markerfacecolor": "none",
    "markeredgewidth": 1.1,
    "linestyle": "none",
}


def _shown_amplitudes(data: xr.Dataset, case: ResponseFigure, panel: Panel) -> np.ndarray:
    """All amplitudes [1] that a panel has to hold, computed and printed."""
    computed = [curve(data, load)["amplitude"].values.ravel() for load in panel.loads]
    printed = [peak.amplitude for load in panel.loads for peak in peaks_of(case, load) if peak.amplitude]
    return np.concatenate([*computed, printed])


def _legend(figure: Figure, data: xr.Dataset, case: ResponseFigure) -> None:
    printed = [peak for load in case.loads for peak in peaks_of(case, load)]
    entries = [
        Line2D([], [], color=BLACK, label="accurate"),
        Line2D(
            [], [], color=BLACK, linewidth=0.7, linestyle=(0, (3, 1.5)), label="numerics like the paper's"
        ),
        Line2D([], [], **_PEAK, markeredgecolor=BLACK, label="printed peak"),
    ]
    if any(peak.amplitude is None for peak in printed):
        entries.append(
            Line2D([], [], color=BLACK, linewidth=0.7, linestyle=":", label="printed frequency alone")
        )
    if bool((data["status"] != "completed").any()):
        entries.append(
            Line2D([], [], color=BLACK, marker="x", markersize=4, linestyle="none", label="solution lost")
        )
    figure.legend(handles=entries, loc="outside upper center", ncols=len(entries), columnspacing=1.2)


def _losses(data: xr.Dataset) -> str:
    """At how many points the solution was lost, in which numerics; nothing where it never was."""
    lost = {
        name: int((data["status"].sel(numerics=name) != "completed").sum())
        for name in (ACCURATE.name, PAPER_LIKE.name)
    }
    if not any(lost.values()):
        return ""
    accurate, rough = lost[ACCURATE.name], lost[PAPER_LIKE.name]
    return f"Solution lost at {accurate} points accurate, at {rough} in numerics like the paper's. "


def _caption(data: xr.Dataset, case: ResponseFigure) -> str:
    notation = NOTATION[case.model]
    return (
        f"Fig. {case.number}. {notation.title}: {DRIVE_TEXT}. Amplitude: {data.attrs['definition']}, "
        f"0 to {case.window:g} s; grid of {case.frequency_step:g} Hz. Accurate: {ACCURATE.description}. "
        f"Numerics like the paper's: {PAPER_LIKE.description}. {_losses(data)}Printed values: {SOURCE}, Sec. III."
    )
