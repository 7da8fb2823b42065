"""All figures of the paper, each with the data it was drawn from."""

from __future__ import annotations

from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from delagrange.common.files import prepare_folder
from delagrange.common.progress import progress_bar
from delagrange.figures.data import save_data
from delagrange.figures.style import journal_style, save
from delagrange.reproduction.figures.history_figure import draw_history, history_data
from delagrange.reproduction.figures.phase_figure import draw_phase, phase_data
from delagrange.reproduction.figures.response_figure import draw_response, response_data
from delagrange.reproduction.runs.all_runs import Runs, all_runs
from delagrange.reproduction.runs.cases import MOTIONS, RESPONSES

NUMBERS = tuple(range(4, 13))


def draw_all(
    out: Path, only: tuple[int, ...] | None = None, progress: bool = False, data: Path | None = None
) -> tuple[Path, ...]:
    """Figs. 4-12, or `only` some, as `out`/figure_04.png, .pdf, .nc and .csv and so on.

    The runs behind them are kept in `data` (`out`/data if left out) and used again while they fit.

    Returns:
        The files written.

    Raises:
        ValueError: `only` names a figure that is not among Figs. 4-12, or a folder cannot be written.
    """
    runs = all_runs(out / "data" if data is None else data, only, progress)
    return draw_figures(runs, out, only, progress)


def draw_figures(
    runs: Runs, out: Path, only: tuple[int, ...] | None = None, progress: bool = False
) -> tuple[Path, ...]:
    """As `draw_all`, from runs that are already there."""
    prepare_folder(out)
    written: tuple[Path, ...] = ()
    numbers = NUMBERS if only is None else tuple(sorted(set(only)))
    with progress_bar(progress, "figures", len(numbers), "figures") as bar, journal_style():
        for done, number in enumerate(numbers, 1):
            written += _draw(runs, number, out / f"figure_{number:02d}")
            bar.advance_to(done)
    return written


def _draw(runs: Runs, number: int, stem: Path) -> tuple[Path, ...]:
    data, figure = _drawn(runs, number)
    return (*save(figure, stem), *save_data(data, stem))


def _drawn(runs: Runs, number: int) -> tuple[xr.Dataset, Figure]:
    for response in RESPONSES:
        if number == response.number:
            data = response_data(runs, response)
            return data, draw_response(data, response)
    for motion in MOTIONS:
        if number == motion.history_number:
            data = history_data(runs, motion)
            return data, draw_history(data, motion)
        if number == motion.phase_number:
            data = phase_data(runs, motion)
            return data, draw_phase(data, motion)
    raise ValueError(f"figure must be one of {', '.join(map(str, NUMBERS))}; got {number!r}")
