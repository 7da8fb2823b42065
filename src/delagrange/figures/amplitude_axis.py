"""An axis of amplitudes: its label, its scale, and marks where a run was lost so that it has none."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from delagrange.figures.notation import NOTATION
from delagrange.figures.quantities import symbol_in_tex

_LARGEST_LINEAR = 2.5  # amplitude [1]
_MARGIN = 0.95  # height of the axes at which what has no amplitude is marked


def amplitude_label(data: xr.Dataset) -> str:
    """As the paper writes the stretch of its load cases; of any other, the symbol of the first coordinate."""
    load_case = str(data.attrs["load_case"])
    for name, notation in NOTATION.items():
        if load_case.startswith(name):
            return notation.amplitude_label
    about = data["amplitude"].attrs
    return f"amplitude of ${symbol_in_tex(about['symbol'])}$ [{about['units']}]"


def set_scale(axes: Axes, amplitudes: np.ndarray) -> None:
    """Logarithmic where a peak would press all the rest to the ground. Room above for the marks of loss."""
    shown = amplitudes[np.isfinite(amplitudes)]
    largest = shown.max(initial=0.0)
    if largest > _LARGEST_LINEAR:
        axes.set_yscale("log")
        axes.set_ylim(shown[shown > 0].min() / 1.5, largest * 3.0)
    else:
        axes.set_ylim(0.0, 1.1 * largest or 1.0)


def lost_places(one: xr.Dataset, along: str = "frequency") -> np.ndarray:
    """Where along a curve the solution was lost, so that there is no amplitude to draw."""
    return one[along].values[one["status"].values != "completed"]


def mark_lost(axes: Axes, lost: np.ndarray, colour: str, below: float = 0.0) -> None:
    """Crosses near the top, `below` it by a part of the axes' height."""
    if len(lost):
        heights = np.full(len(lost), _MARGIN - below)
        above = axes.get_xaxis_transform()
        axes.plot(lost, heights, "x", color=colour, markersize=4, transform=above, clip_on=False)


def say_empty(axes: Axes, why: str) -> None:
    """In the middle of axes without a curve."""
    axes.text(0.5, 0.5, why, transform=axes.transAxes, ha="center", va="center")
