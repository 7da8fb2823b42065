"""Branches of periodic motions with their stability, beside the transient amplitude and what sweeps up and down see."""

from __future__ import annotations

import re
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
from delagrange.figures.notation import FREQUENCY_LABEL, NOTATION
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

X_LABELS = {
    "frequency": FREQUENCY_LABEL,
    "force": r"force $P$ [N]",
    "field_amplitude": r"amplitude of the field $E_0$ [MV/m]",
    "field_bias": r"bias of the field $E_\mathrm{b}$ [MV/m]",
    "charge_amplitude": r"amplitude of the charge $D_0$ [mC/m$^2$]",
    "charge_bias": r"bias of the charge $D_\mathrm{b}$ [mC/m$^2$]",
}
_SHOWN = {
    "force": ("P", "N", 1.0),
    "field_amplitude": ("E₀", "MV/m", 1e6),
    "charge_amplitude": ("D₀", "mC/m²", 1e-3),
    "field_bias": ("E_b", "MV/m", 1e6),
    "charge_bias": ("D_b", "mC/m²", 1e-3),
    "frequency": ("f", "Hz", 1.0),
}  # symbol, unit that is shown, and its size in SI units
_X_SIZES = {name: size for name, (_, _, size) in _SHOWN.items()}
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
        axes.set_ylabel(_amplitude_label(steady))
        axes.margins(x=0.0)
    if not steady.sizes["point"]:
        _say_empty(all_axes[0])
    largest = _largest(steady, transient, sweeps)
    all_axes[0].set_ylim(0.0, largest)
    all_axes[0].set_title(_load_text(steady), loc="right", fontsize=8.0, pad=3.0)
    all_axes[1].set_yscale("log")
    all_axes[1].set_ylim(_smallest(steady, transient), _shown_top(steady))
    all_axes[1].set_xlabel(X_LABELS[varied])
    entries = _entries(steady, transient, sweeps)
    figure.legend(handles=entries, loc="outside upper center", ncols=min(len(entries), 4), columnspacing=1.2)
    caption(figure, _caption(steady, transient, sweeps))
    return figure


def _say_empty(axes: Axes, why: str = "no periodic motion found") -> None:
    axes.text(0.5, 0.5, why, transform=axes.transAxes, ha="center", va="center")


def draw_transient(transient: xr.Dataset, varied: str) -> Figure:
    """The transient amplitude alone."""
    figure = new_figure(height=3.4)
    axes = figure.subplots()
    x = transient[varied].values / _X_SIZES[varied]
    axes.plot(x, transient["amplitude"], color=BLACK)
    axes.set_xlabel(X_LABELS[varied])
    axes.set_ylabel(_amplitude_label(transient))
    axes.margins(x=0.0)
    if not transient["amplitude"].notnull().any():
        axes.set_xlim(x.min(), x.max())
        _say_empty(axes, "every run was lost")
    axes.set_ylim(bottom=0.0)
    axes.set_title(_transient_load(transient, varied), loc="right", fontsize=8.0)
    caption(figure, _transient_text(transient))
    return figure


def _amplitude_label(data: xr.Dataset) -> str:
    """As the paper writes the stretch of its load cases; of any other, the symbol of the first coordinate."""
    load_case = str(data.attrs["load_case"])
    for name, notation in NOTATION.items():
        if load_case.startswith(name):
            return notation.amplitude_label
    symbol, unit = data["amplitude"].attrs["symbol"], data["amplitude"].attrs["units"]
    return f"amplitude of ${symbol.replace('λ', chr(92) + 'lambda')}$ [{unit}]"


def _draw_branches(axes: Axes, steady: xr.Dataset, varied: str) -> None:
    for number in range(steady.sizes["branch"]):
        one = steady.isel(point=np.flatnonzero(steady["branch_number"].values == number))
        x, y = one[varied].values / _X_SIZES[varied], one["amplitude"].values
        for name, piece in pieces(one["stability"].values):
            axes.plot(x[piece], y[piece], **{**_LINES[name], "label": None})


def pieces(names: np.ndarray) -> Iterator[tuple[str, slice]]:
    """The runs of one stability along a branch, each up to the first point of the next, so that no gap is left."""
    starts = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1), len(names)]
    for start, stop in pairwise(starts):
        yield str(names[start]), slice(start, stop + 1)


def _draw_transient(axes: Axes, transient: xr.Dataset | None, varied: str) -> None:
    if transient is not None:
        axes.plot(transient[varied] / _X_SIZES[varied], transient["amplitude"], **_TRANSIENT)


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
    x = steady[f"bifurcation_{varied}"].values / _X_SIZES[varied]
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


def _load_text(steady: xr.Dataset) -> str:
    """`P = 0.5 N, E₀ = 1 MV/m`, of what does not vary."""
    parts = _other_forces(steady)
    for name, (symbol, unit, size) in _SHOWN.items():
        if name != steady.attrs["varied"] and name in steady and steady.sizes["point"]:
            value = float(steady[name][0]) / size
            if value != 0 or (name == "force" and not parts):
                parts.append(f"{symbol} = {value:g} {unit}")
    if "held_stretch" in steady.attrs:
        parts.append(f"λ₂ held at {steady.attrs['held_stretch']:g}")
    return f"{steady.attrs['model'].replace('_', ' ')}: {', '.join(parts)}"


def _other_forces(data: xr.Dataset) -> list[str]:
    """`P₁ = 0.1 N` of a membrane that has a force along each axis, instead of the one force of the others."""
    numbers = {"force_1": "P₁", "force_2": "P₂"}
    values = {name: _constant(data, name) for name in numbers}
    return [f"{numbers[name]} = {value:g} N" for name, value in values.items() if value is not None]


def _constant(data: xr.Dataset, name: str) -> float | None:
    """The value of an input that is constant, from the coordinates or from what is said of its drive."""
    if name in data.coords:
        return float(data.coords[name])
    found = re.fullmatch(r"Constant\(value=(.*)\)", str(data.attrs.get(f"{name}_drive", "")))
    return float(found[1]) if found else None


def _transient_load(transient: xr.Dataset, varied: str) -> str:
    parts = _other_forces(transient) + [
        f"{symbol} = {float(transient[name]) / size:g} {unit}"
        for name, (symbol, unit, size) in _SHOWN.items()
        if name != varied and name in transient.coords and (float(transient[name]) != 0 or name == "force")
    ]
    return f"{transient.attrs['model'].replace('_', ' ')}: {', '.join(parts)}"


def _transient_text(transient: xr.Dataset) -> str:
    start, stop = transient.attrs["window_start"], transient.attrs["window_stop"]
    return (
        f"Transient amplitude: {transient.attrs['definition']}, {start:g} to {stop:g} s from rest in the reference "
        f"state, force a step at t = 0, dashpots flowing."
    )


def _caption(steady: xr.Dataset, transient: xr.Dataset | None, sweeps: Sequence[xr.Dataset]) -> str:
    texts = [
        f"Periodic motions of period {_period_text(steady)}: {steady.attrs['definition']}; dashpots "
        f"{steady.attrs['dashpots']}. {steady.attrs['explanation']}"
    ]
    if transient is not None:
        texts.append(_transient_text(transient))
    if sweeps:
        texts.append(f"Stepped: {sweeps[0].attrs['definition']}.")
    return " ".join(texts)


def _period_text(steady: xr.Dataset) -> str:
    multiple = int(steady.attrs["period_multiple"])
    period = steady.attrs["forcing_period"].split(":")[0]
    return period if multiple == 1 else f"{multiple} times {period}"
