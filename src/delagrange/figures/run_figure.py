"""One run: its stretches over time, and below them what drives it."""

from __future__ import annotations

from itertools import takewhile
from textwrap import shorten

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from delagrange.common.roles import Role
from delagrange.figures.notation import TIME_LABEL, integrator_text
from delagrange.figures.quantities import model_title, shown_as, single_loads, symbol_in_tex
from delagrange.figures.style import BLACK, BLUE, ORANGE, VERMILION, caption, new_figure, panel_letter

_COLOURS = (BLUE, ORANGE, BLACK)
_STYLES = ("-", (0, (4, 1.5)), (0, (1, 1.2)))
_KINDS = {
    Role.STRETCH: "stretches",
    Role.INELASTIC_STRETCH: "inelastic stretches",
}  # of which there may be several
_STATE_HEIGHT, _DRIVE_HEIGHT = 1.7, 1.15  # [inch] of a panel
_LARGEST_LINEAR = 8.0  # of the largest to the smallest value of a panel
_LONGEST_DRIVE = 90  # letters of its description
_LETTERS = "abcdefghijklmnopqrstuvwxyz"


def draw_run(run: xr.Dataset) -> Figure:
    """A panel for each kind of state variable but the rates, and one for each input that varies.

    run: of `delagrange.simulate`
    """
    state, driven = _state_panels(run), [[name] for name in _inputs(run) if np.ptp(run[name].values) > 0]
    heights = [_STATE_HEIGHT] * len(state) + [_DRIVE_HEIGHT] * len(driven)
    figure = new_figure(height=sum(heights) + 1.0)
    rows = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    for place, (axes, names) in enumerate(zip(rows, [*state, *driven], strict=True)):
        _draw_panel(axes, run, names, _COLOURS if names in state else (BLACK,))
        if names in state:
            mark_loss(axes, run, names[0], VERMILION, told=place == 0)
            _spread(axes, run, names)
        if len(rows) > 1:
            panel_letter(axes, _LETTERS[place])
    rows[-1].set_xlim(0.0, run.attrs["duration"])
    rows[-1].set_xlabel(TIME_LABEL)
    figure.align_ylabels(rows)
    figure.suptitle(model_title(run, single_loads(run)), fontsize=9.0)
    caption(figure, _caption(run))
    return figure


def _inputs(run: xr.Dataset) -> list[str]:
    """The inputs of the model: a run says how each is driven."""
    return [str(name) for name in run.data_vars if f"{name}_drive" in run.attrs]


def _state_panels(run: xr.Dataset) -> list[list[str]]:
    """The state variables but the rates; stretches share a panel, and so do inelastic ones."""
    panels: dict[str, list[str]] = {}
    inputs = _inputs(run)
    for name in takewhile(lambda name: name not in inputs, map(str, run.data_vars)):
        role = run[name].attrs.get("role", name)
        if role != Role.RATE:
            shared = role in (Role.STRETCH, Role.INELASTIC_STRETCH)
            panels.setdefault(role if shared else name, []).append(name)
    return list(panels.values())


def _draw_panel(axes: Axes, run: xr.Dataset, names: list[str], colours: tuple[str, ...]) -> None:
    for place, name in enumerate(names):
        colour = colours[place % len(colours)]
        shown = shown_as(run, name)
        axes.plot(run["time"], run[name] / shown.size, color=colour, linestyle=_STYLES[place % len(_STYLES)],
                  linewidth=0.9, label=f"${symbol_in_tex(run[name].attrs['symbol'])}$")  # fmt: skip
    axes.set_ylabel(_label(run, names))
    if len(names) > 1:
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(names), borderpad=0.0, borderaxespad=0.3
        )
    if f"{names[0]}_drive" in run.attrs:
        told = shorten(str(run.attrs[f"{names[0]}_drive"]), _LONGEST_DRIVE, placeholder="...")
        axes.set_title(told, loc="right", fontsize=8.0, pad=3.0)


def _label(run: xr.Dataset, names: list[str]) -> str:
    """`stretch λ_EB [1]`; of several `stretches [1]`, whose symbols the legend tells."""
    about = run[names[0]].attrs
    if len(names) > 1:
        return f"{_KINDS[about['role']]} [{about['units']}]"
    shown = shown_as(run, names[0])
    return f"${symbol_in_tex(about['symbol'])}$ [{shown.unit}]"


def _spread(axes: Axes, run: xr.Dataset, names: list[str]) -> None:
    """A logarithmic scale where a loss would press all that was before it to the ground."""
    values = np.concatenate([run[name].values for name in names])
    low, high = np.nanmin(values), np.nanmax(values)
    if low > 0 and high > _LARGEST_LINEAR * low:
        axes.set_yscale("log")


def mark_loss(axes: Axes, run: xr.Dataset, name: str, colour: str, told: bool = True) -> None:
    """A cross at the last value of a run that was lost and, where it is to be `told`, how it was lost."""
    if str(run["status"].values) == "completed":
        return
    last = run.isel(time=int(run[name].notnull().values.nonzero()[0][-1]))
    time, value = float(last["time"]), float(last[name])
    axes.plot(time, value, "x", color=colour, markersize=6, clip_on=False)
    if told:
        early = time < 0.6 * float(run["time"][-1])  # so that there is room behind it, where nothing is drawn
        axes.annotate(
            f"{run['status'].values} at {float(run['status_time']):.4g} s", (time, 0.5 if early else 0.9),
            (7 if early else -7, 0), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="left" if early else "right", va="center", fontsize=8.0, color=colour,
        )  # fmt: skip


def _caption(run: xr.Dataset) -> str:
    about = run.attrs
    start = f" Start: {about['initial_state']}." if "initial_state" in about else ""
    integrator = integrator_text(about["method"], about["rtol"], about["atol"])
    end = "" if about["status"] == "completed" else f" at {about['status_time']:.6g} s"
    return (
        f"Run of {about['duration']:g} s: {about['status']}{end}.{start} A run is lost where a principal stretch falls "
        f"below {about['smallest_stretch']:g} or one in the plane passes {about['largest_stretch']:g}. {integrator}."
    )
