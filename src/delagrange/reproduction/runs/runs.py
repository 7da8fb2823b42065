"""The runs from which the figures of the paper are drawn and its numbers are read, as jobs.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III; what is run stands in `cases`.
"""

from __future__ import annotations

from dataclasses import dataclass

import xarray as xr

from delagrange.model.parameters import SHENG_2015
from delagrange.reproduction.runs.cases import MOTIONS, RESPONSES, MotionFigures, ResponseFigure
from delagrange.reproduction.runs.kinds import kinds
from delagrange.reproduction.runs.motions import SECTION_POINTS, motion, motions, section, sections
from delagrange.reproduction.runs.numerics import ACCURATE, NUMERICS, PAPER_LIKE, NumericsVariant
from delagrange.reproduction.runs.responses import curve, response
from delagrange.reproduction.runs.store import digest

__all__ = [
    "ACCURATE", "KINDS", "NUMERICS", "PAPER_LIKE", "SECTION_POINTS", "Job", "NumericsVariant", "curve", "formulations",
    "jobs", "kind_jobs", "kinds", "motion", "motions", "response", "section", "sections",
]  # fmt: skip


KINDS = "kinds"  # what a job finds that asks for the kinds of the motions of a figure


@dataclass(frozen=True)
class Job:
    """What one process computes in one go: a figure in one formulation and one numerics, or its kinds of motion."""

    figure: int
    case: ResponseFigure | MotionFigures
    formulation: str | None
    numerics: NumericsVariant
    asks_kinds: bool = False

    @property
    def finds(self) -> str:
        """What its result is called among those of a figure."""
        return KINDS if self.asks_kinds else self.numerics.name

    @property
    def name(self) -> str:
        """For people and files: `figure_10_as_printed_paper`."""
        parts = (f"figure_{self.figure:02d}", self.formulation, self.finds)
        return "_".join(part for part in parts if part)

    def digest(self) -> str:
        """What the result depends on, as one number."""
        return digest(self.name, self.case, self.numerics, SHENG_2015, SECTION_POINTS)

    def compute(self) -> xr.Dataset:
        """Over (load, frequency) for a response, (frequency, time) for motions, (frequency, point) for sections."""
        if self.asks_kinds:
            return kinds(self.case, self.formulation)
        if isinstance(self.case, ResponseFigure):
            return response(self.case, self.numerics, self.formulation)
        if self.figure == self.case.history_number:
            return motions(self.case, self.formulation)
        return sections(self.case, self.formulation)


def formulations(model: str) -> tuple[str | None, ...]:
    """The formulations in which a model of the paper is shown; None where there is but one."""
    return ("as_printed", "consistent") if model == "pure_shear" else (None,)


def jobs(only: tuple[int, ...] | None = None) -> tuple[Job, ...]:
    """The jobs for all of Figs. 4-12, or for `only` some of them, the longest first.

    Raises:
        ValueError: `only` names a figure that is not among Figs. 4-12.
    """
    responses = [(figure.number, figure) for figure in RESPONSES]
    phases = [(figures.phase_number, figures) for figures in MOTIONS]
    histories = [(figures.history_number, figures) for figures in MOTIONS]
    order = [(responses, ACCURATE), (phases, ACCURATE), (responses, PAPER_LIKE), (histories, ACCURATE)]
    every = [
        Job(number, case, formulation, numerics)
        for cases, numerics in order
        for number, case in cases
        for formulation in formulations(case.model)
    ]
    _check_figures(only, sorted({job.figure for job in every}))
    return tuple(job for job in every if only is None or _needed(job, only))


def kind_jobs() -> tuple[Job, ...]:
    """The jobs that ask for the kinds of the motions of Figs. 6, 9 and 12."""
    return tuple(
        Job(figures.phase_number, figures, formulation, ACCURATE, asks_kinds=True)
        for figures in MOTIONS
        for formulation in formulations(figures.model)
    )


def _needed(job: Job, only: tuple[int, ...]) -> bool:
    """The phase paths of a figure are those of the time histories."""
    return job.figure in only or (isinstance(job.case, MotionFigures) and job.case.phase_number in only)


def _check_figures(only: tuple[int, ...] | None, known: list[int]) -> None:
    for number in only or ():
        if number not in known:
            raise ValueError(f"figure must be one of {', '.join(map(str, known))}; got {number!r}")
