"""The tables of the reproduction, as data, Markdown, CSV and on the terminal."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

from rich.table import Table as RichTable
from rich.text import Text

from delagrange.reproduction.claims.numbers import Comparison, Found, agreement
from delagrange.reproduction.claims.statements import Judgement

_STYLES = {
    "agrees": "green", "yes": "green", "equal": "green",
    "frequency agrees": "cyan", "amplitude agrees": "cyan", "equal after scaling": "cyan",
    "differs": "red", "no": "red", "only as printed": "yellow", "only in the consistent form": "yellow",
}  # fmt: skip


@dataclass(frozen=True)
class Table:
    """A titled table of text; `caption` says how the numbers were made."""

    name: str  # of its files
    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""

    def markdown(self) -> str:
        lines = [self.headings, tuple("---" for _ in self.headings), *self.rows]
        table = "\n".join(f"| {' | '.join(cell.replace('|', '&#124;') for cell in line)} |" for line in lines)
        return f"## {self.title}\n\n{self.caption}\n\n{table}\n"

    def csv(self) -> str:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerows((self.headings, *self.rows))
        return text.getvalue()

    def rich(self) -> RichTable:
        table = RichTable(
            *self.headings,
            title=self.title,
            caption=self.caption,
            title_justify="left",
            caption_justify="left",
        )
        for row in self.rows:
            table.add_row(*(Text(cell, style=_STYLES.get(cell, "")) for cell in row))
        return table


def _load_text(comparison: Comparison) -> str:
    load = comparison.peak.load
    held = "" if load.held_stretch is None else f", λ_2p = {load.held_stretch:g}"
    return f"P = {load.force:g} N, E_0 = {load.field_amplitude / 1e6:g} MV/m{held}"


def _model_text(comparison: Comparison) -> str:
    formulation = "" if comparison.formulation is None else f", {comparison.formulation.replace('_', ' ')}"
    return comparison.model.replace("_", " ") + formulation


def _peak_text(frequency: float, amplitude: float | None, lost: int = 0) -> str:
    size = "very large" if amplitude is None else f"{amplitude:.5g}"
    return f"{size} at {frequency:g} Hz" + (f" ({lost} points lost)" if lost else "")


def _deviation(comparison: Comparison, found: Found) -> str:
    peak = comparison.peak
    frequency = f"{found.frequency - peak.frequency:+g} Hz"
    return (
        frequency if peak.amplitude is None else f"{found.amplitude / peak.amplitude - 1:+.2%}, {frequency}"
    )


def numbers_table(comparisons: tuple[Comparison, ...]) -> Table:
    """Each printed peak beside ours, in both numerics."""
    rows = tuple(
        (
            f"{c.peak.figure}{c.peak.panel}",
            _model_text(c),
            _load_text(c),
            _peak_text(c.peak.frequency, c.peak.amplitude),
            _peak_text(c.accurate.frequency, c.accurate.amplitude, c.accurate.lost),
            f"{c.accurate_error:.0e}",
            _deviation(c, c.accurate),
            agreement(c.peak, c.accurate),
            _peak_text(c.paper_numerics.frequency, c.paper_numerics.amplitude, c.paper_numerics.lost),
            _deviation(c, c.paper_numerics),
            agreement(c.peak, c.paper_numerics),
        )
        for c in comparisons
    )
    headings = (
        "Fig.", "model", "load", "printed peak",
        "accurate", "error", "accurate from print", "verdict (accurate)",
        "paper's numerics", "paper's numerics from print", "verdict (paper's numerics)",
    )  # fmt: skip
    caption = (
        "Amplitude: half of peak to peak of the stretch over 0.1 s (pure shear 0.12 s) from rest in the "
        "reference state, transient included. Accurate: DOP853, rtol 1e-9, extrema between the steps; its "
        "error is the difference to SciPy's scalar DOP853 at rtol 1e-12 at the same frequency, and half a "
        "grid step in frequency (grid: 1 Hz; pure shear 5 Hz). Paper's numerics: an embedded Runge-Kutta "
        "5(4) at rtol 1e-3, atol 1e-6, step control and output of MATLAB's ode45, 3.14 for π; which "
        "program the authors used is not stated, this one was chosen because it fits the four peaks of "
        "Fig. 4 best. Verdict: within 1 % in amplitude and one grid step in frequency."
    )
    return Table("numbers", "Printed numbers beside ours", headings, rows, caption)


def statements_table(judgements: tuple[Judgement, ...]) -> Table:
    """Each qualitative statement with its answer and the evidence."""
    rows = tuple(
        (j.statement.figure, j.statement.model.replace("_", " "), j.statement.text, j.answer, j.evidence)
        for j in judgements
    )
    caption = (
        "Statements of Secs. III and IV in our words, judged from accurate runs. Beating: what vibrates near "
        "twice the field's frequency is modulated by more than 50 % and is a quarter of the swing or more. "
        "Closed loop: the base frequencies of the motion, the drive's included, span a torus of dimension 2 at most. "
        "f_n/2: half the natural frequencies about the equilibrium under the force and the mean square of the "
        "field, where the squared field is in resonance with small vibrations. Kinds of motion: dashpots frozen."
    )
    return Table(
        "statements",
        "Statements of the paper",
        ("Fig.", "model", "statement", "holds", "evidence"),
        rows,
        caption,
    )
