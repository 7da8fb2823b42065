"""Amplitude over frequency, or over another load, a curve for each combination of what else varies."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from delagrange.figures.amplitude_axis import (
    amplitude_label,
    lost_places,
    mark_lost,
    say_empty,
    set_scale,
)
from delagrange.figures.notation import integrator_text
from delagrange.figures.quantities import model_title, shown_as, single_loads
from delagrange.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
    caption,
    new_figure,
)

_COLOURS = (BLACK, VERMILION, BLUE, GREEN, ORANGE, SKY_BLUE, PURPLE)
_STYLES = ("-", (0, (4, 1.5)), (0, (1, 1.2)), (0, (4, 1.2, 1, 1.2)))
# Nunez et al. (2018), PLoS ONE 13, e0199239: read the same with any colour vision; without its end, faint on white.
_MAP = mpl.colors.ListedColormap(mpl.colormaps["cividis"](np.linspace(0.0, 0.85, 256)))
_MOST_MARKED = 60  # points of a curve up to which each has a dot
_STEP_BELOW = 0.025  # of the height of the axes, from the crosses of one curve to those of the next


def draw_sweep(response: xr.Dataset, varied: str = "frequency") -> Figure:
    """The amplitude over what varies; a curve for each combination of the other dimensions.

    Up to seven curves have each its colour. Of more, the longest dimension is told by a scale of colours and the
    others by the kind of line.

    Args:
        response: of `frequency_response`.
        varied: the dimension along which curves are drawn.
    """
    figure = new_figure(height=3.8)
    axes = figure.subplots()
    shown = shown_as(response, varied)
    amplitudes = response["amplitude"]
    others = [str(name) for name in amplitudes.dims if name != varied]
    _draw_curves(figure, axes, response, varied, others)
    axes.set_xlabel(shown.label)
    axes.set_ylabel(amplitude_label(response))
    set_scale(axes, amplitudes.values)
    _set_ends(axes, response[varied].values / shown.size)
    if not amplitudes.notnull().any():
        say_empty(axes, "every run was lost")
    fixed = {name: value for name, value in single_loads(response).items() if name != varied}
    axes.set_title(model_title(response, fixed), loc="right", fontsize=8.0, pad=3.0)
    caption(figure, _caption(response))
    return figure


def _draw_curves(figure: Figure, axes: Axes, response: xr.Dataset, varied: str, others: list[str]) -> None:
    curves = list(_curves(response, others))
    if len(curves) <= len(_COLOURS):
        entries = _draw_few(axes, curves, varied, others)
    else:
        entries = _draw_many(figure, axes, response, varied, others)
    if any(len(lost_places(curve, varied)) for curve in curves):
        entries.append(
            Line2D([], [], color="0.4", marker="x", markersize=4, linestyle="none", label="run lost")
        )
    if entries:
        figure.legend(
            handles=entries, loc="outside upper center", ncols=min(len(entries), 4), columnspacing=1.2
        )


def _curves(response: xr.Dataset, others: list[str]) -> Iterator[xr.Dataset]:
    """The part of each combination of the other dimensions, in the order of the file."""
    for place in np.ndindex(*(response.sizes[name] for name in others)):
        yield response.isel(dict(zip(others, place, strict=True)))


def _draw_few(axes: Axes, curves: list[xr.Dataset], varied: str, others: list[str]) -> list[Line2D]:
    """Each curve in a colour of its own; returns what the legend is to tell."""
    entries = []
    for place, (curve, colour) in enumerate(zip(curves, _COLOURS)):
        (line,) = _draw_curve(axes, curve, varied, color=colour, linestyle=_STYLES[place % len(_STYLES)])
        mark_lost(
            axes, lost_places(curve, varied) / shown_as(curve, varied).size, colour, place * _STEP_BELOW
        )
        if others:
            line.set_label(", ".join(shown_as(curve, name).value(float(curve[name])) for name in others))
            entries.append(line)
    return entries


def _draw_many(
    figure: Figure, axes: Axes, response: xr.Dataset, varied: str, others: list[str]
) -> list[Line2D]:
    """The longest of the other dimensions by a scale of colours, the rest by kinds of line."""
    longest = max(others, key=lambda name: response.sizes[name])
    rest, shown = [name for name in others if name != longest], shown_as(response, longest)
    values = response[longest].values / shown.size
    scale = mpl.cm.ScalarMappable(mpl.colors.Normalize(values.min(), values.max()), _MAP)
    entries, crowded = [], _is_crowded(response, rest)
    for number, part in enumerate(_curves(response, rest)):
        style = _STYLES[0] if crowded else _STYLES[number]
        for place, value in enumerate(values):
            _draw_curve(
                axes, part.isel({longest: place}), varied, color=scale.to_rgba(value), linestyle=style
            )
        if rest and not crowded:
            told = ", ".join(shown_as(part, name).value(float(part[name])) for name in rest)
            entries.append(Line2D([], [], color="0.4", linestyle=style, label=told))
    if crowded:
        names = " and ".join(shown_as(response, name).long_name for name in rest)
        entries.append(Line2D([], [], color="0.4", label=f"curves of one colour: over {names}"))
    lost = np.unique(np.concatenate([lost_places(curve, varied) for curve in _curves(response, others)]))
    mark_lost(axes, lost / shown_as(response, varied).size, "0.4")
    figure.colorbar(scale, ax=axes, label=shown.label)
    return entries


def _is_crowded(response: xr.Dataset, names: list[str]) -> bool:
    """Whether there are more combinations of some dimensions than kinds of line."""
    return int(np.prod([response.sizes[name] for name in names], dtype=int)) > len(_STYLES)


def _draw_curve(axes: Axes, curve: xr.Dataset, varied: str, **style: object) -> list[Line2D]:
    marker = "." if curve.sizes[varied] <= _MOST_MARKED else None
    x = curve[varied].values / shown_as(curve, varied).size
    return axes.plot(x, curve["amplitude"].values, marker=marker, markersize=3.5, **style)


def _set_ends(axes: Axes, x: np.ndarray) -> None:
    """From the first value to the last, with some room about a single one."""
    if len(x) > 1:
        axes.set_xlim(x.min(), x.max())


def _caption(response: xr.Dataset) -> str:
    about = response.attrs
    lost = int((response["status"] != "completed").sum())
    losses = f" Lost: {lost} of {response['status'].size} runs." if lost else ""
    integrator = integrator_text(about["method"], about["rtol"], about["atol"])
    return f"{amplitude_text(response)} {integrator}.{losses}"


def amplitude_text(response: xr.Dataset) -> str:
    """What the transient amplitude is, for a caption."""
    about = response.attrs
    window = f"{about['window_start']:g} to {about['window_stop']:g} s"
    return (
        f"Transient amplitude: {about['definition']}, {window} {_start(response)}, force a step at t = 0, "
        "dashpots flowing."
    )


def _start(response: xr.Dataset) -> str:
    """Where the runs start."""
    if "initial_state" in response.attrs:
        return "from rest in the loaded equilibrium"
    if any(str(name).startswith("initial_") for name in response.coords):
        return "from the given state"
    return "from rest in the reference state"
