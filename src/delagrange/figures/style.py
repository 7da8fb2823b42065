"""What all figures share: colours, sizes, symbols, captions, and how a figure is saved."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure

# Okabe & Ito (2008), Color Universal Design: told apart with any colour vision, and in grey by their lightness.
BLACK, ORANGE, SKY_BLUE, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
CURVE_COLOURS = (BLACK, VERMILION, BLUE)
FORMULATION_COLOURS = {"as_printed": VERMILION, "consistent": BLUE, None: BLACK}
FORMULATION_NAMES = {
    "as_printed": "as printed: reaction put into the potential, Eqs. (18)-(20)",
    "consistent": "consistent: constrained variation, reaction an output",
}

PAGE_WIDTH = 7.0  # [inch], both columns of a journal page
_CAPTION_LETTERS = 116  # in a line of that width
_RESOLUTION = 200  # [dots per inch] of PNG

_RC = {
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "lines.linewidth": 1.2,
    "axes.linewidth": 0.7,
    "axes.formatter.useoffset": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "pdf.fonttype": 42,
    "agg.path.chunksize": 10000,
}


@contextmanager
def journal_style() -> Iterator[None]:
    """Matplotlib's settings for a journal page while the block runs, whatever the user's own are."""
    with mpl.rc_context():
        mpl.rcParams.update(mpl.rcParamsDefault | _RC | {"backend": mpl.rcParams["backend"]})
        yield


def new_figure(height: float) -> Figure:
    """An empty figure as wide as a page and `height` [inch] high, drawn by Agg, laid out without overlaps."""
    figure = Figure(figsize=(PAGE_WIDTH, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def panel_letter(axes: Axes, letter: str, above: float = 0.0) -> None:
    """`(a)` above the upper left corner, where no data are; `above` [point] leaves room for a legend."""
    axes.set_title(f"({letter})", loc="left", pad=3.0 + above)


def caption(figure: Figure | SubFigure, text: str) -> None:
    """What was computed and how, below the panels."""
    lines = "\n".join(textwrap.wrap(text, _CAPTION_LETTERS, break_on_hyphens=False))
    figure.supxlabel(lines, x=0.01, ha="left", fontsize=8.0, linespacing=1.3)


def save(figure: Figure, stem: Path) -> tuple[Path, Path]:
    """Write `stem`.png and `stem`.pdf; the same figure gives the same bytes every time.

    Raises:
        OSError: the folder cannot be written.
    """
    png, pdf = stem.with_name(f"{stem.name}.png"), stem.with_name(f"{stem.name}.pdf")
    figure.savefig(png, dpi=_RESOLUTION)
    figure.set_layout_engine("none")  # the layout is found by now; once more would take as long
    figure.savefig(pdf, metadata={"CreationDate": None})
    return png, pdf
