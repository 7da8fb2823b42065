"""Figs. 6, 9 and 12: phase paths and Poincaré maps at half, one and two times the resonance.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from delagrange.figures.data import by_formulation, joined, of_formulation
from delagrange.figures.notation import NOTATION, Notation, integrator_text
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

PATH, MAP = "phase path", "Poincaré map"


def phase_data(runs: Runs, case: MotionFigures) -> xr.Dataset:
    """Over ([formulation], frequency, row): stretch and its rate; the rows of the phase path come first, then
    those of the Poincaré map, as `shown` says. `time` [s] is a coordinate.
    """
    forms = formulations(case.model)
    return by_formulation([_rows(runs, case, form) for form in forms], forms)


def _rows(runs: Runs, case: MotionFigures, form: str | None) -> xr.Dataset:
    notation = NOTATION[case.model]
    names = [notation.stretch, notation.stretch_rate]
    history, section = runs.motions(case.history_number, form), runs.sections(case.phase_number, form)
    times = history["time"].expand_dims(frequency=history["frequency"]).rename(time="row").variable
    path = history[names].rename_dims(time="row").drop_vars("time").assign_coords(time=times)
    points = section[names].rename_dims(point="row").drop_vars("period_number")
    rows = joined([part.assign_coords(shown=("row", [what] * part.sizes["row"]))
                   for part, what in ((path, PATH), (points, MAP))], "row")  # fmt: skip
    return rows.assign(status=section["status"], status_time=section["status_time"])


def part_of(data: xr.Dataset, what: str) -> xr.Dataset:
    """The rows of the phase path or of the Poincaré map."""
    return data.isel(row=np.flatnonzero(data["shown"].values == what))


def draw_phase(data: xr.Dataset, case: MotionFigures) -> Figure:
    """Phase paths above, Poincaré maps below; one such block a formulation."""
    forms = formulations(case.model)
    figure = new_figure(height=0.8 + 4.4 * len(forms))
    for form, block in zip(forms, np.atleast_1d(figure.subfigures(len(forms), 1))):
        if form is not None:
            block.suptitle(FORMULATION_NAMES[form], fontsize=9.0)
        _draw_block(block, of_formulation(data, form), case, FORMULATION_COLOURS[form])
    caption(figure, _caption(data, case))
    return figure


def _draw_block(block: SubFigure, data: xr.Dataset, case: MotionFigures, colour: str) -> None:
    notation = NOTATION[case.model]
    styles = {
        PATH: {"color": colour, "linewidth": 0.35},
        MAP: {"color": colour, "marker": ".", "markersize": 2.5, "linestyle": "none"},
    }
    letters = iter("abcdef")
    for row, (what, style) in zip(block.subplots(2, 3), styles.items()):
        row[0].set_ylabel(notation.rate_label)
        for axes, frequency in zip(row, case.frequencies):
            shown = part_of(data.sel(frequency=frequency), what)
            axes.plot(shown[notation.stretch], shown[notation.stretch_rate], **style)
            _label(axes, next(letters), frequency, str(shown["status"].values), notation)


def _label(axes: Axes, letter: str, frequency: float, status: str, notation: Notation) -> None:
    """A run that was lost says so above its panel."""
    panel_letter(axes, letter)
    ended = "" if status == "completed" else f", {status}"
    axes.set_title(f"$f$ = {frequency:g} Hz{ended}", fontsize=8.0, pad=3.0, loc="right")
    axes.set_xlabel(notation.stretch_label)
    axes.margins(0.06)


def _caption(data: xr.Dataset, case: MotionFigures) -> str:
    count = part_of(data, MAP).sizes["row"]
    spans = ", ".join(f"{(count - 1) / frequency:.2f} s" for frequency in case.frequencies)
    return (
        f"Fig. {case.phase_number}. {NOTATION[case.model].title}, {load_label(case.load, plain=True)}: "
        f"{DRIVE_TEXT}. (a)-(c) Phase paths over 0 to {case.window:g} s. (d)-(f) Poincaré maps, {count} points at "
        f"t = k/f, k = 0 ... {count - 1} (over {spans}). "
        f"{integrator_text(ACCURATE.method, ACCURATE.rtol, ACCURATE.atol)}."
    )
