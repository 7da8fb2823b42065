"""Branches of equilibria over the field, or the charge, and its critical value over the force."""

from __future__ import annotations

from itertools import groupby

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from delagrange.analysis.rest.critical_map import FAST, SLOW, SUDDEN
from delagrange.analysis.rest.pull_in import critical_names
from delagrange.figures.electrical_axis import electrical_axis
from delagrange.figures.style import (
    BLACK,
    BLUE,
    ORANGE,
    PURPLE,
    VERMILION,
    caption,
    new_figure,
    panel_letter,
)
from delagrange.run.run_dataset import forces_text

_LINES = {
    "stable": {"color": BLUE, "linestyle": "-"},
    "saddle": {"color": VERMILION, "linestyle": (0, (6, 1.5, 1, 1.5))},
    "unstable": {"color": VERMILION, "linestyle": (0, (4, 2))},
}
_LIMIT = {
    "marker": "o",
    "markersize": 6,
    "markerfacecolor": "none",
    "markeredgecolor": BLACK,
    "linestyle": "none",
}
_SLACK = {"color": ORANGE, "linewidth": 6.5, "alpha": 0.4, "solid_capstyle": "butt", "zorder": 1}
_BROKEN = {"color": PURPLE, "linewidth": 3.5, "alpha": 0.5, "solid_capstyle": "butt", "zorder": 1.5}
_LARGEST_RATIO = 6.0  # of stretches on a linear scale; beyond it is logarithmic
_LOADS = {
    SLOW: {"color": BLUE, "linestyle": "-"},
    FAST: {"color": BLACK, "linestyle": "-"},
    SUDDEN: {"color": VERMILION, "linestyle": (0, (4, 1.5))},
}


def draw_equilibria(found: xr.Dataset) -> Figure:
    """Every coordinate over the field or charge: stable branches solid, others dashed, with limits marked.

    found: of `delagrange.equilibria`
    """
    names = coordinate_names(found)
    figure = new_figure(height=3.6)
    all_axes = figure.subplots(1, len(names), squeeze=False)[0]
    for axes, name, letter in zip(all_axes, names, "abc"):
        _draw_branches(axes, found, name)
        axes.set_xlabel(electrical_axis(found).label)
        axes.set_ylabel(f"{found[name].attrs['long_name']} ${stretch_symbol(name)}$ [1]")
        if len(names) > 1:
            panel_letter(axes, letter)
    figure.legend(handles=_legend(found), loc="outside upper center", ncols=6, columnspacing=1.2)
    caption(figure, _caption(found))
    return figure


def coordinate_names(found: xr.Dataset) -> list[str]:
    """The coordinates among the state variables, in order."""
    if "coordinates" in found.attrs:
        return found.attrs["coordinates"].split(", ")
    return [name for name in ("stretch_1", "stretch_2") if name in found] or ["stretch"]


def stretch_symbol(name: str) -> str:
    """In TeX, without dollars."""
    if "stretch" not in name:
        return name.removeprefix("coordinate_").replace("_", r"\_")
    index = name.rpartition("_")[2]
    return rf"\lambda_{index}" if index.isdigit() else r"\lambda"


def _draw_branches(axes: Axes, found: xr.Dataset, name: str) -> None:
    along = electrical_axis(found)
    field, stretch = found[f"curve_{along.name}"].values / along.size, found[f"curve_{name}"].values
    numbers, stability = found["curve_branch"].values, found["curve_stability"].values
    for (_, kind), places in _runs(zip(numbers, stability)):
        axes.plot(field[places], stretch[places], **_LINES[kind])
    for flag, style in (("tension_lost", _SLACK), ("breakdown", _BROKEN)):
        for (_, flagged), places in _runs(zip(numbers, found[f"curve_{flag}"].values)):
            if flagged:
                axes.plot(field[places], stretch[places], **style)
    axes.plot(found[f"limit_{along.name}"] / along.size, found[f"limit_{name}"], **_LIMIT)
    axes.set_xlim(left=0.0, right=_right(found))
    _scale(axes, stretch[field <= _right(found)])


def _scale(axes: Axes, shown: np.ndarray) -> None:
    """Room for the coordinates in the range that is shown, logarithmic where positive ones differ much."""
    if not len(shown):
        return
    low, high = shown.min(), shown.max()
    if low > 0 and high / low > _LARGEST_RATIO:
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_ylim(low / 1.15, high * 1.15)
    else:
        room = 0.05 * max(high - low, 0.01)
        axes.set_ylim(low - room, high + room)


def _right(found: xr.Dataset) -> float:
    """The largest field or charge to show, in the unit that is shown: those asked for, limit points with some room."""
    along = electrical_axis(found)
    limits = 1.08 * found[f"limit_{along.name}"].values
    asked = np.abs(np.atleast_1d(found[along.name].values))
    return float(max([*limits, *asked, 1e-6 * along.size])) / along.size


def _runs(keys) -> list[tuple[object, slice]]:
    """Slices of neighbouring points with the same key; each begins with the last point of the one before."""
    runs, start = [], 0
    for key, group in groupby(keys):
        stop = start + len(list(group))
        joined = runs and runs[-1][0][0] == key[0]
        runs.append((key, slice(start - 1 if joined else start, stop)))
        start = stop
    return runs


def _legend(found: xr.Dataset) -> list[Line2D]:
    there = set(found["curve_stability"].values)
    entries = [Line2D([], [], **style, label=kind) for kind, style in _LINES.items() if kind in there]
    kinds = ", ".join(dict.fromkeys(found["limit_kind"].values))
    if kinds:
        entries.append(Line2D([], [], **_LIMIT, label=kinds))
    if bool(found["curve_tension_lost"].any()):
        entries.append(Line2D([], [], **_SLACK, label="tension lost"))
    if bool(found["curve_breakdown"].any()):
        entries.append(Line2D([], [], **_BROKEN, label="electrical breakdown"))
    return entries


def _force(found: xr.Dataset) -> str:
    return ("force P = " if "force" in found.coords else "") + forces_text(found)


def _caption(found: xr.Dataset) -> str:
    along = electrical_axis(found)
    limits = ", ".join(
        f"{kind} at {value / along.size:.4g} {along.unit}"
        for kind, value in zip(found["limit_kind"].values, found[f"limit_{along.name}"].values)
    )
    return (
        f"Equilibria of the membrane, {model_text(found)}, {_force(found)}, dashpots "
        f"{found.attrs['dashpots']}. {limits[:1].upper()}{limits[1:]}{'. ' if limits else ''}"
        "Branches by continuation of the derived equations at rest, stability from the linearised motion."
    )


def model_text(data: xr.Dataset) -> str:
    """`pure shear, consistent, held at 2`."""
    name = data.attrs["load_case"].replace("_", " ")
    held = data.coords["held_stretch"] if "held_stretch" in data.coords else data.attrs.get("held_stretch")
    if held is None:
        return name
    at = [f"held at {float(held):g}"] if np.ndim(held) == 0 else []
    return ", ".join([name, data.attrs["formulation"].replace("_", " "), *at])


def draw_critical_map(critical: xr.Dataset) -> Figure:
    """The critical field, or charge, over the force, and the stretch there.

    critical: of `delagrange.analysis.rest.critical_map.critical_map`
    """
    figure = new_figure(height=3.6)
    stretched = bool(critical[_first(critical)].notnull().any())
    left, *others = figure.subplots(1, 1 + stretched, squeeze=False)[0]
    _draw_fields(left, critical)
    for right in others:
        _draw_stretches(right, critical)
    for axes, letter in zip((left, *others), "ab"):
        axes.set_xlabel(r"force $P$ [N]")
        axes.margins(x=0.0)
        if others:
            panel_letter(axes, letter)
    entries = _map_legend(critical)
    figure.legend(
        handles=entries, loc="outside upper center", ncols=2 + (len(entries) != 4), columnspacing=1.2
    )
    caption(figure, _map_caption(critical))
    return figure


def _draw_fields(axes: Axes, critical: xr.Dataset) -> None:
    force, along = critical["force"].values, electrical_axis(critical)
    names = critical_names(along.electrical)
    for load, style in _LOADS.items():
        here = critical[[along.name, *names.values()]].sel(load=load) / along.size
        colour = {"color": style["color"], "clip_on": False}
        axes.plot(force, here[along.name], **style)
        _plot_known(axes, force, here[names["tension"]].values, **colour, **_TENSION)
        _plot_known(axes, force, here[names["breakdown"]].values, **colour, **_BREAKDOWN)
        without = here[names["highest"]].where(here[along.name].isnull())
        _plot_known(axes, force, without.values, **colour, **_REACHED)
    axes.set_ylabel(rf"critical {along.long_name.removeprefix('nominal ')} ${along.symbol}$ [{along.unit}]")
    axes.set_ylim(bottom=0.0)


def _first(critical: xr.Dataset) -> str:
    """The variable of the first coordinate."""
    return "stretch" if "stretch" in critical else coordinate_names(critical)[0]


def _plot_known(axes: Axes, force: np.ndarray, values: np.ndarray, **style: object) -> None:
    """Without what is NaN: a line of nothing that is not clipped would ask for room at the edge of the figure."""
    if np.any(known := np.isfinite(values)):
        axes.plot(force[known], values[known], **style)


def _draw_stretches(axes: Axes, critical: xr.Dataset) -> None:
    name = _first(critical)
    for load, style in _LOADS.items():
        axes.plot(critical["force"], critical[name].sel(load=load), **style)
    axes.set_ylabel(rf"critical {name.replace('_', ' ')} ${stretch_symbol(name)}$ [1]")


_TENSION = {"linestyle": (0, (1, 1.5)), "linewidth": 1.6}
_BREAKDOWN = {"linestyle": (0, (6, 1.5, 1, 1.5)), "linewidth": 0.9}
_REACHED = {"linestyle": "none", "marker": "^", "markersize": 3.5, "markerfacecolor": "none"}


def _map_legend(critical: xr.Dataset) -> list[Line2D]:
    name, names = electrical_axis(critical).name, critical_names(electrical_axis(critical).electrical)
    there = critical[[name, names["highest"]]].notnull().any("force")
    shown = [
        load for load in _LOADS if bool(there[name].sel(load=load) | there[names["highest"]].sel(load=load))
    ]
    entries = [Line2D([], [], label=load, **_LOADS[load]) for load in shown]
    if bool(critical[names["tension"]].notnull().any()):
        entries.append(Line2D([], [], color=BLACK, label="tension lost before", **_TENSION))
    if bool(critical[names["breakdown"]].notnull().any()):
        entries.append(Line2D([], [], color=BLACK, label="breakdown before", **_BREAKDOWN))
    if bool((critical[name].isnull() & critical[names["highest"]].notnull()).any()):
        last = electrical_axis(critical).electrical.stem
        label = f"no limit point: last {last} within the limits"
        entries.append(Line2D([], [], color=BLACK, label=label, **_REACHED))
    return entries


def _map_caption(critical: xr.Dataset) -> str:
    stretch = (
        " Critical stretch: at the limit point, or at the unstable equilibrium that the motion has to pass."
    )
    stem = electrical_axis(critical).electrical.stem
    return (
        f"Critical {stem} of the membrane, {model_text(critical)}, over the force. Static: limit point of the "
        f"equilibrium under a slowly growing {stem}; with relaxed dashpots slowly against relaxation as well. "
        f"Dynamic: {stem} and force applied at once to the membrane at rest in the reference state."
        + (stretch if bool(critical[_first(critical)].notnull().any()) else "")
    )
