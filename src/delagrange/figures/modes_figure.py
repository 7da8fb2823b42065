"""Natural frequencies over whatever is varied."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from delagrange.figures.electrical_axis import electrical_axis
from delagrange.figures.equilibrium_figure import model_text
from delagrange.figures.quantities import LOADS, shown_as
from delagrange.figures.style import BLACK, BLUE, ORANGE, SKY_BLUE, VERMILION, caption, new_figure

_COLOURS = (BLACK, VERMILION, BLUE, ORANGE, SKY_BLUE)
_STYLES = ("-", (0, (4, 1.5)), (0, (1, 1.5)))


def draw_modes(found: xr.Dataset) -> Figure:
    """Natural frequencies over the longest dimension; the others give curves, one colour for each.

    found: of `delagrange.modes`, with at least one dimension besides the mode

    Raises:
        ValueError: nothing is varied.
    """
    frequency = found["frequency"]
    varied = [name for name in frequency.dims if name != "mode"]
    if not varied:
        raise ValueError(
            "a figure of modes needs something that varies; give force, field or held stretch as a range"
        )
    along = max(varied, key=lambda name: frequency.sizes[name])
    others = [name for name in varied if name != along]
    figure = new_figure(height=3.6)
    axes = figure.subplots()
    _draw_curves(axes, found, along, others)
    axes.set_xlabel(shown_as(found, along).label)
    axes.set_ylabel(r"natural frequency $f_n$ [Hz]")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    halved = axes.secondary_yaxis("right", functions=(lambda value: value / 2, lambda value: 2 * value))
    halved.set_ylabel(rf"resonant {electrical_axis(found).electrical.stem} frequency $f_n / 2$ [Hz]")
    axes.tick_params(right=False)
    axes.legend(loc="best", ncols=1 + (len(axes.get_lines()) > 4))
    caption(figure, _caption(found))
    return figure


def _draw_curves(axes: Axes, found: xr.Dataset, along: str, others: list[str]) -> None:
    x = found[along].values / shown_as(found, along).size
    shape = [found.sizes[name] for name in others]
    for number, place in enumerate(np.ndindex(*shape)):
        here = found.isel(dict(zip(others, place)))
        for mode in range(found.sizes["mode"]):
            name = f"mode {mode + 1}" if found.sizes["mode"] > 1 else ""
            fixed = [shown_as(here, other).value(float(here[other])) for other in others]
            text = ", ".join(filter(None, [name, *fixed]))
            axes.plot(
                x, here["frequency"].isel(mode=mode), color=_COLOURS[number % len(_COLOURS)],
                linestyle=_STYLES[mode % len(_STYLES)], label=text or "$f_n$",
            )  # fmt: skip


def _caption(found: xr.Dataset) -> str:
    ended = ""
    if bool(found["frequency"].isnull().any()):
        ended = "Where a curve ends there is no equilibrium, as beyond pull-in. "
    along = electrical_axis(found)
    loads = ("force", "force_1", "force_2", along.name)
    single = [
        LOADS[name].value(float(found[name]), plain=True)
        for name in loads
        if name in found and found[name].ndim == 0
    ]
    at = "".join(f", {text}" for text in single)
    return (
        f"Natural frequencies of the membrane, {model_text(found)}{at}, about its stable equilibrium, dashpots "
        f"{found.attrs['dashpots']}. {ended}The {along.electrical.stem} enters squared: without bias it excites a "
        "mode at half the natural frequency (right axis); with a bias, as a force does, at that frequency as well."
    )
