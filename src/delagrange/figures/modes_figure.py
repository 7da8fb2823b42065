"""Natural frequencies over whatever is varied."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from delagrange.figures.electrical_axis import AXES, electrical_axis
from delagrange.figures.equilibrium_figure import model_text
from delagrange.figures.style import BLACK, BLUE, ORANGE, SKY_BLUE, VERMILION, caption, new_figure

_LABELS = {
    **{along.name: (along.label, along.size) for along in AXES.values()},
    "force": (r"force $P$ [N]", 1.0),
    "held_stretch": (r"held stretch $\lambda_\mathrm{2p}$ [1]", 1.0),
}
_COLOURS = (BLACK, VERMILION, BLUE, ORANGE, SKY_BLUE)
_STYLES = ("-", (0, (4, 1.5)), (0, (1, 1.5)))
_SHORT = {
    **{along.name: (f"${along.symbol}$", along.unit, along.size) for along in AXES.values()},
    "force": ("$P$", "N", 1.0),
    "held_stretch": (r"$\lambda_\mathrm{2p}$", "", 1.0),
}


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
    axes.set_xlabel(_label(found, along)[0])
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
    _, size = _label(found, along)
    x = found[along].values / size
    shape = [found.sizes[name] for name in others]
    for number, place in enumerate(np.ndindex(*shape)):
        here = found.isel(dict(zip(others, place)))
        for mode in range(found.sizes["mode"]):
            name = f"mode {mode + 1}" if found.sizes["mode"] > 1 else ""
            text = ", ".join(filter(None, [name, *(_value(here, other) for other in others)]))
            axes.plot(
                x, here["frequency"].isel(mode=mode), color=_COLOURS[number % len(_COLOURS)],
                linestyle=_STYLES[mode % len(_STYLES)], label=text or "$f_n$",
            )  # fmt: skip


def _label(found: xr.Dataset, name: str) -> tuple[str, float]:
    unit = found[name].attrs["units"]
    return _LABELS.get(name, (f"{found[name].attrs['long_name']} [{unit}]", 1.0))


def _value(here: xr.Dataset, name: str) -> str:
    symbol, unit, size = _SHORT.get(name, (name.replace("_", " "), here[name].attrs["units"], 1.0))
    return f"{symbol} = {float(here[name]) / size:g} {unit}".strip()


def _caption(found: xr.Dataset) -> str:
    ended = ""
    if bool(found["frequency"].isnull().any()):
        ended = "Where a curve ends there is no equilibrium, as beyond pull-in. "
    along = electrical_axis(found)
    single = [
        f"{symbol} = {float(found[name]) / size:g} {unit}"
        for name, (symbol, unit, size) in {
            "force": ("P", "N", 1.0),
            "force_1": ("P₁", "N", 1.0),
            "force_2": ("P₂", "N", 1.0),
            along.name: (along.symbol, along.unit, along.size),
        }.items()
        if name in found and found[name].ndim == 0
    ]
    at = "".join(f", {text}" for text in single)
    return (
        f"Natural frequencies of the membrane, {model_text(found)}{at}, about its stable equilibrium, dashpots "
        f"{found.attrs['dashpots']}. {ended}The {along.electrical.stem} enters squared: without bias it excites a "
        "mode at half the natural frequency (right axis); with a bias, as a force does, at that frequency as well."
    )
