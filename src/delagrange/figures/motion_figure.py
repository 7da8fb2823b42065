"""The kind of a motion and its evidence: section, Lyapunov exponents over time, lines of the spectrum."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from delagrange.figures.quantities import symbol_in_tex
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
    panel_letter,
)

_COLOURS = (VERMILION, BLUE, GREEN, ORANGE, SKY_BLUE, PURPLE)
_LABELLED = 9  # strongest lines that get their integers
_CLEAR = 0.035  # of the width of the panel between two labels
_SETTLED = 0.12  # of the time, before which the running exponents do not set the axis
_ZOOM = 0.1  # of the largest exponent, the least that the axis of exponents spans
_FAINTEST = 1e-6  # of the highest amplitude, below which nothing is drawn
_FAINTEST_BAND = 1e-4  # the same of a broad band
_STILL = 1e-8  # amplitude [1] below which nothing moves
_GREY = "#999999"
_REGULAR = ("periodic", "quasi-periodic")


def draw_motion(motion: xr.Dataset) -> Figure:
    """Section, exponents and spectrum of a motion as `delagrange.classify` returns it."""
    figure = new_figure(height=5.6)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.15, 1.0))
    section, exponents = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])
    spectrum = figure.add_subplot(grid[1, :])
    _draw_section(section, motion)
    _draw_exponents(exponents, motion)
    _draw_spectrum(spectrum, motion)
    for axes, letter in zip((section, exponents, spectrum), "abc"):
        panel_letter(axes, letter)
    figure.suptitle(f"{motion.attrs['model'].replace('_', ' ')}: {motion['verdict'].item()}", fontsize=10.0)
    caption(figure, _caption(motion))
    return figure


def _draw_section(axes: Axes, motion: xr.Dataset) -> None:
    """The first coordinate and its rate, once in a period."""
    names = [str(name) for name in motion.data_vars if str(name).startswith("section_")]
    coordinate, rate = names[0], next((name for name in names if "rate" in name), names[1])
    x, y = motion[coordinate].values, motion[rate].values
    axes.plot(x, y, linestyle="none", marker=".", markersize=2.0, color=BLUE, markeredgewidth=0)
    if len(x) and np.ptp(x) < 1e-5 * max(1.0, abs(x[0])):
        axes.plot(x[-1:], y[-1:], linestyle="none", marker="o", markersize=5.0, color=BLUE)
        _widen(axes, x[-1], y[-1])
    axes.set_xlabel(_quantity(motion[coordinate]))
    axes.set_ylabel(_quantity(motion[rate]))
    axes.margins(0.06)
    forced = bool(motion.sizes["base"]) and "forcing" in motion["section_time"].attrs["long_name"]
    axes.set_title("once in a period of the forcing" if forced else "once in a period of small vibration",
                   fontsize=8.0, loc="right", pad=3.0)  # fmt: skip


def _widen(axes: Axes, x: float, y: float) -> None:
    """A motion that shows one point needs axes that show how little it moves."""
    axes.set_xlim(x - 0.05, x + 0.05)
    axes.set_ylim(y - 0.05 * max(1.0, abs(y)), y + 0.05 * max(1.0, abs(y)))


def _quantity(data: xr.DataArray) -> str:
    return f"${symbol_in_tex(data.attrs.get('symbol', ''))}$ [{data.attrs['units']}]"


def _draw_exponents(axes: Axes, motion: xr.Dataset) -> None:
    time = motion["time"].values
    axes.set_xlabel(r"time followed $t$ [s]")
    axes.set_ylabel(r"Lyapunov exponents $\lambda_i$ [1/s]")
    if len(time) == 0:
        axes.text(0.5, 0.5, "lost too early", transform=axes.transAxes, ha="center", va="center")
        return
    running = motion["running_exponents"].values
    for values, colour in zip(running, _COLOURS):
        axes.plot(time, values, color=colour)
    ends = motion["lyapunov_exponents"].values
    bars = motion["lyapunov_uncertainty"].values
    axes.errorbar(
        np.full(len(ends), time[-1]), ends, bars, linestyle="none", color=BLACK, capsize=2.5, linewidth=0.9
    )
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    settled = running[:, time > _SETTLED * time[-1]]
    low, high = np.min(settled), np.max(settled)
    if motion["verdict"].item() != "chaotic" and high > 0 and low > -4 * high:
        _draw_proportional(axes, time)
    least = _ZOOM * max(abs(low), abs(high))  # exponents that agree are not to look as if they did not
    room = max(0.08 * (high - low), (least - (high - low)) / 2) or 1.0
    axes.set_ylim(low - room, high + room)
    axes.set_xlim(0.0, 1.02 * time[-1])


def _draw_proportional(axes: Axes, time: np.ndarray) -> None:
    """What the running exponent of a tangent that grows in proportion to time is."""
    phases = (np.arange(500) + 0.5) / 500
    mean = np.mean(2 * np.sin(np.pi * phases) ** 2 / (0.25 + 0.75 * phases))
    label = "growth in proportion to time"
    axes.plot(time, mean / time, color=BLACK, linestyle=(0, (4, 2)), linewidth=0.9, label=label)
    axes.legend(loc="lower right", bbox_to_anchor=(0.97, 0.0))  # beside the bars of the uncertainty


def _draw_spectrum(axes: Axes, motion: xr.Dataset) -> None:
    """The band behind, the lines before it where base frequencies explain them."""
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("amplitude [1]")
    band = motion["band_amplitude"].values
    if not np.max(band, initial=0.0) > _STILL:
        axes.text(0.5, 0.5, "nothing moves" if band.size else "lost too early", transform=axes.transAxes,
                  ha="center", va="center")  # fmt: skip
        return
    axes.plot(motion["band_frequency"].values, band, color=_GREY, linewidth=0.7)
    axes.set_yscale("log")
    regular = motion["verdict"].item() in _REGULAR
    floor = (_FAINTEST if regular else _FAINTEST_BAND) * np.max(band)
    seen = motion["band_frequency"].values[band > floor]
    axes.set_xlim(-0.02 * np.max(seen), 1.06 * np.max(seen))
    axes.set_ylim(floor, (100 if regular else 5) * np.max(band))
    if regular:
        _draw_lines(axes, motion, floor)


def _draw_lines(axes: Axes, motion: xr.Dataset, floor: float) -> None:
    frequency, amplitude = motion["line_frequency"].values, motion["line_amplitude"].values
    explained = motion["line_explained"].values.astype(bool)
    for chosen, colour in ((explained, BLUE), (~explained, ORANGE)):
        axes.vlines(frequency[chosen], floor, amplitude[chosen], color=colour, linewidth=0.9)
        axes.plot(
            frequency[chosen], amplitude[chosen], linestyle="none", marker="o", markersize=2.5, color=colour
        )
    _label_lines(axes, frequency, amplitude, motion["line_integers"].values)


def _label_lines(axes: Axes, frequency: np.ndarray, amplitude: np.ndarray, integers: np.ndarray) -> None:
    """The combination that makes a line, above it, where there is room; the strongest first."""
    taken: list[float] = []
    width = axes.get_xlim()[1]
    for f, a, row in zip(frequency, amplitude, integers):
        if len(taken) < _LABELLED and all(abs(f - other) > _CLEAR * width for other in taken):
            axes.annotate(
                combination(row), (f, a), (0, 4), textcoords="offset points", ha="center", va="bottom",
                fontsize=7.5, rotation=90 if np.count_nonzero(row) > 1 else 0,
            )  # fmt: skip
            taken.append(float(f))


def combination(integers: np.ndarray) -> str:
    """`[2, -1]` -> `2 f_1 - f_2`, in TeX."""
    text = ""
    for place, k in enumerate(integers, start=1):
        if k:
            sign = "-" if k < 0 else "+" if text else ""
            text += f"{sign}{abs(k) if abs(k) != 1 else ''}f_{{{place}}}"
    return f"${text}$" if text else "?"


def _caption(motion: xr.Dataset) -> str:
    bases = motion["base_frequencies"].values
    load = motion.attrs["load"].replace("_", " ") or "no load"
    if motion["verdict"].item() in _REGULAR:
        named = ", ".join(f"f{place} = {value:.7g} Hz" for place, value in enumerate(bases, start=1))
        lines = f", grey; its lines, blue, are made of {named}"
    else:
        lines = ""
    return (
        f"{load[0].upper()}{load[1:]}; dashpots {motion.attrs['dashpots']}. (a) Stroboscopic section. "
        "(b) Lyapunov exponents had the motion been followed so long, at the end with their uncertainty. "
        f"(c) Spectrum of the coordinates{lines}. Evidence: {motion['evidence'].item()}."
    )
