"""Figs. 5, 8 and 11: inelastic stretch and stretch over time at half, one and two times the resonance.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III.
"""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from delagrange.figures.data import by_formulation, of_formulation
from delagrange.figures.notation import NOTATION, TIME_LABEL, integrator_text
from delagrange.figures.run_figure import mark_loss
from delagrange.figures.style import (
    FORMULATION_COLOURS,
    FORMULATION_NAMES,
    caption,
    new_figure,
    panel_letter,
)
from delagrange.reproduction.figures.labels import DRIVE_TEXT, load_label
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import MotionFigures
from delagrange.reproduction.runs.runs import ACCURATE, formulations


def history_data(runs: Runs, case: MotionFigures) -> xr.Dataset:
    """Over ([formulation], frequency, time): the stretch and the inelastic stretch that the figure shows."""
    notation, forms = NOTATION[case.model], formulations(case.model)
    shown = [notation.inelastic_stretch, notation.stretch, "status", "status_time"]
    return by_formulation([runs.motions(case.history_number, form)[shown] for form in forms], forms)


def draw_history(data: xr.Dataset, case: MotionFigures) -> Figure:
    """Three rows of frequencies; inelastic stretch on the left, stretch on the right."""
    notation = NOTATION[case.model]
    figure = new_figure(height=6.6)
    rows = figure.subplots(3, 2, sharex=True)
    letters = iter("abcdef")
    for row, frequency in zip(rows, case.frequencies):
        labels = (notation.inelastic_label, notation.stretch_label)
        for axes, name, label in zip(row, (notation.inelastic_stretch, notation.stretch), labels):
            _draw_panel(axes, data.sel(frequency=frequency), name, case)
            axes.set_ylabel(label)
            panel_letter(axes, next(letters))
            axes.set_title(f"$f$ = {frequency:g} Hz", fontsize=8.0, pad=3.0, loc="right")
    for axes in rows[-1]:
        axes.set_xlabel(TIME_LABEL)
    _legend(figure, case)
    caption(figure, _caption(case))
    return figure


def _draw_panel(axes: Axes, data: xr.Dataset, name: str, case: MotionFigures) -> None:
    for form in formulations(case.model):
        run = of_formulation(data, form)
        axes.plot(run["time"], run[name], color=FORMULATION_COLOURS[form], linewidth=0.6)
        mark_loss(axes, run, name, FORMULATION_COLOURS[form])
    axes.set_xlim(0.0, case.window)


def _legend(figure: Figure, case: MotionFigures) -> None:
    named = [form for form in formulations(case.model) if form is not None]
    entries = [
        Line2D([], [], color=FORMULATION_COLOURS[form], label=FORMULATION_NAMES[form]) for form in named
    ]
    if entries:
        figure.legend(handles=entries, loc="outside upper center", ncols=1)


def _caption(case: MotionFigures) -> str:
    return (
        f"Fig. {case.history_number}. {NOTATION[case.model].title}, {load_label(case.load, plain=True)}: "
        f"{DRIVE_TEXT}. Rows: half the printed resonance, the printed resonance, twice the printed resonance. "
        f"{integrator_text(ACCURATE.method, ACCURATE.rtol, ACCURATE.atol)}."
    )
