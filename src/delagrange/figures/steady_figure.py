"""Branches of periodic motions with their stability, beside the transient amplitude and what sweeps up and down see."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from delagrange.analysis.steady.floquet import (
    BRANCH_POINT,
    FOLD,
    NEUTRAL,
    PERIOD_DOUBLING,
    STABLE,
    TORUS,
    UNSTABLE,
)
from delagrange.figures.amplitude_axis import amplitude_label, say_empty
from delagrange.figures.quantities import LOADS, model_title, single_loads
from delagrange.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    VERMILION,
    caption,
    new_figure,
    panel_letter,
)
from delagrange.figures.sweep_figure import amplitude_text

_LINES = {
    NEUTRAL: {"color": BLUE, "linestyle": "-", "label": "periodic, neutral"},
    STABLE: {"color": BLUE, "linestyle": "-", "label": "periodic, stable"},
    UNSTABLE: {"color": VERMILION, "linestyle": (0, (3, 1.5)), "label": "periodic, unstable"},
    "marginal": {"color": PURPLE, "linestyle": "-", "label": "periodic, marginal"},
}
_MARKERS = {
    FOLD: {"marker": "o", "color": BLACK},
    BRANCH_POINT: {"marker": "X", "color": PURPLE},
    PERIOD_DOUBLING: {"marker": "s", "color": GREEN},
    TORUS: {"marker": "D", "color": ORANGE},
}
_TRANSIENT = {"color": "0.55", "linewidth": 0.8}
_SWEEPS = ({"marker": ">", "color": GREEN}, {"marker": "<", "color": ORANGE})
_ROOM = 1.6  # of the largest transient or stable amplitude, which the linear panel shows
_DECADES = 5  # at most, below the largest amplitude, in the logarithmic panel


def draw_steady(
    steady: xr.Dataset, transient: xr.Dataset | None = None, sweeps: Sequence[xr.Dataset] = ()
) -> Figure:
    """Amplitude over what was varied: on a linear scale above, on a logarithmic one below.

    Args:
        steady: of `steady_response`.
        transient: of `frequency_response`, over the same quantity alone.
        sweeps: of `stepped_sweep`, over the same frequencies, up or down.
    """
    figure = new_figure(height=6.2)
    all_axes = figure.subplots(2, 1, sharex=True)
    varied = steady.attrs["varied"]
    for axes, letter in zip(all_axes, "ab"):
        _draw_transient(axes, transient, varied)
        _draw_branches(axes, steady, varied)
        for sweep in sweeps:
            _draw_sweep(axes, sweep)
        _draw_bifurcations(axes, steady, varied)
        panel_letter(axes, letter)
        axes.set_ylabel(amplitude_label(steady))
        axes.margins(x=0.0)
    if not steady.sizes["point"]:
        say_empty(all_axes[0], "no periodic motion found")
    largest = _largest(steady, transient, sweeps)
    all_axes[0].set_ylim(0.0, largest)
    all_axes[0].set_title(model_title(steady, _loads(steady)), loc="right", fontsize=8.0, pad=3.0)
    all_axes[1].set_yscale("log")
    all_axes[1].set_ylim(_smallest(steady, transient), _shown_top(steady))
    all_axes[1].set_xlabel(LOADS[varied].label)
    entries = _entries(steady, transient, sweeps)
    figure.legend(handles=entries, loc="outside upper center", ncols=min(len(entries), 4), columnspacing=1.2)
    caption(figure, _caption(steady, transient, sweeps))
    return figure


def _draw_branches(axes: Axes, steady: xr.Dataset, varied: str) -> None:
    for number in range(steady.sizes["branch"]):
        one = steady.isel(point=np.flatnonzero(steady["branch_number"].values == number))
        x, y = one[varied].values / LOADS[varied].size, one["amplitude"].values
        for name, piece in pieces(one["stability"].values):
            axes.plot(x[piece], y[piece], **{**_LINES[name], "label": None})


def pieces(names: np.ndarray) -> Iterator[tuple[str, slice]]:
    """The runs of one stability along a branch, each up to the first point of the next, so that no gap is left."""
    starts = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1), len(names)]
    for start, stop in pairwise(starts):
        yield str(names[start]), slice(start, stop + 1)


def _draw_transient(axes: Axes, transient: xr.Dataset | None, varied: str) -> None:
    if transient is not None:
        axes.plot(transient[varied] / LOADS[varied].size, transient["amplitude"], **_TRANSIENT)


def _draw_sweep(axes: Axes, sweep: xr.Dataset) -> None:
    style = _SWEEPS[0 if _is_up(sweep) else 1]
    axes.plot(
        sweep["frequency"], sweep["amplitude"], linestyle="none", markersize=3.5, markerfacecolor="none", **style
    )  # fmt: skip


def _is_up(sweep: xr.Dataset) -> bool:
    values = sweep["frequency"].values
    return bool(values[-1] >= values[0])


def _draw_bifurcations(axes: Axes, steady: xr.Dataset, varied: str) -> None:
    kinds = steady["bifurcation_kind"].values.astype(str)
    x = steady[f"bifurcation_{varied}"].values / LOADS[varied].size
    y = steady["bifurcation_amplitude"].values
    for kind, style in _MARKERS.items():
        at = kinds == kind
        axes.plot(x[at], y[at], linestyle="none", markersize=4.5, zorder=4, **style)


def _largest(steady: xr.Dataset, transient: xr.Dataset | None, sweeps: Sequence[xr.Dataset]) -> float:
    """Top of the linear panel [1]: what was measured, where anything was, else the branches."""
    measured = [_peak(data) for data in (transient, *sweeps) if data is not None]
    everything = 1.05 * max(_peak(steady), *measured, 0.0) or 1.0
    if not any(measured):
        return everything
    at_folds = np.nanmax(steady["bifurcation_amplitude"].values, initial=0.0)
    return min(max(_ROOM * max(measured), 1.1 * at_folds), everything)


def _peak(data: xr.Dataset) -> float:
    """The largest amplitude [1]; zero where there is none, as where every motion is lost."""
    return float(np.nanmax(data["amplitude"].values, initial=0.0))


def _smallest(steady: xr.Dataset, transient: xr.Dataset | None) -> float:
    """Bottom of the logarithmic panel [1]."""
    values = steady["amplitude"].values
    values = values[values > 0]
    if not len(values):
        return 1e-6
    return max(float(np.min(values)), float(np.max(values)) * 10.0**-_DECADES) / 1.5


def _shown_top(steady: xr.Dataset) -> float:
    return 2.0 * _peak(steady) or 1.0


def _entries(steady: xr.Dataset, transient: xr.Dataset | None, sweeps: Sequence[xr.Dataset]) -> list[Line2D]:
    present = set(steady["stability"].values.astype(str))
    entries = [Line2D([], [], **style) for name, style in _LINES.items() if name in present]
    kinds = set(steady["bifurcation_kind"].values.astype(str))
    entries += [
        Line2D([], [], linestyle="none", markersize=4.5, label=kind, **style)
        for kind, style in _MARKERS.items()
        if kind in kinds
    ]
    if transient is not None:
        entries.append(Line2D([], [], label="transient amplitude", **_TRANSIENT))
    for sweep in sweeps:
        up = _is_up(sweep)
        style = {"linestyle": "none", "markersize": 3.5, "markerfacecolor": "none", **_SWEEPS[0 if up else 1]}
        entries.append(Line2D([], [], label=f"stepped {'up' if up else 'down'}", **style))
    return entries


def _loads(steady: xr.Dataset) -> dict[str, float | None]:
    """What does not vary, from the first point where there is one."""
    fixed = [name for name in LOADS if name in steady and name != steady.attrs["varied"]]
    at_points = {name: float(steady[name][0]) for name in fixed} if steady.sizes["point"] else {}
    return single_loads(steady) | at_points


def _caption(steady: xr.Dataset, transient: xr.Dataset | None, sweeps: Sequence[xr.Dataset]) -> str:
    texts = [
        f"Periodic motions of period {_period_text(steady)}: {steady.attrs['definition']}; dashpots "
        f"{steady.attrs['dashpots']}. {steady.attrs['explanation']}"
    ]
    if transient is not None:
        texts.append(amplitude_text(transient))
    if sweeps:
        texts.append(f"Stepped: {sweeps[0].attrs['definition']}.")
    return " ".join(texts)


def _period_text(steady: xr.Dataset) -> str:
    multiple = int(steady.attrs["period_multiple"])
    period = steady.attrs["forcing_period"].split(":")[0]
    return period if multiple == 1 else f"{multiple} times {period}"
