"""All runs of the reproduction, on two cores, each kept on disk as soon as it is done."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import xarray as xr

from delagrange.common.files import prepare_folder
from delagrange.common.progress import progress_bar
from delagrange.reproduction.runs.numerics import ACCURATE
from delagrange.reproduction.runs.processes import side_by_side
from delagrange.reproduction.runs.runs import KINDS, Job, jobs, kind_jobs
from delagrange.reproduction.runs.store import keep, kept


@dataclass(frozen=True)
class Runs:
    """Everything computed, by figure, formulation (None where a model has but one) and what was found.

    That is the name of the numerics, or "kinds" for the kinds of motion.
    """

    datasets: Mapping[tuple[int, str | None, str], xr.Dataset]

    def response(
        self, figure: int, formulation: str | None = None, numerics: str = ACCURATE.name
    ) -> xr.Dataset:
        """Amplitudes of Fig. 4, 7 or 10 over (load, frequency), see `responses.response`."""
        return self._of(figure, formulation, numerics)

    def motions(self, figure: int, formulation: str | None = None) -> xr.Dataset:
        """Time histories of Fig. 5, 8 or 11 over (frequency, time), see `motions.motion`."""
        return self._of(figure, formulation, ACCURATE.name)

    def sections(self, figure: int, formulation: str | None = None) -> xr.Dataset:
        """Stroboscopic points of Fig. 6, 9 or 12 over (frequency, point), see `motions.section`."""
        return self._of(figure, formulation, ACCURATE.name)

    def kinds(self, figure: int, formulation: str | None = None) -> xr.Dataset:
        """Kinds of the motions of Fig. 6, 9 or 12 over frequency, with evidence, see `kinds.kinds`."""
        return self._of(figure, formulation, KINDS)

    def _of(self, figure: int, formulation: str | None, found: str) -> xr.Dataset:
        key = (figure, formulation, found)
        if key not in self.datasets:
            known = "; ".join(" ".join(str(part) for part in known if part) for known in self.datasets)
            raise ValueError(f"no runs of figure {figure}, {formulation}, {found}; there are {known}")
        return self.datasets[key]


def all_runs(
    folder: Path,
    only: tuple[int, ...] | None = None,
    progress: bool = False,
    processes: int = 2,
    kinds: bool = False,
) -> Runs:
    """Compute what Figs. 4-12 (or `only` some) need, each job saved in `folder` as it is done.

    With `kinds`, the kinds of the motions as well.

    A job that lies there already, of the same parameters and computed by the same sources, is read and
    not computed again: after an interruption nothing finished is lost.

    Raises:
        ValueError: `only` names a figure that is not among Figs. 4-12, or `folder` cannot be written.
    """
    wanted = (*kind_jobs(), *jobs(only)) if kinds else jobs(only)
    return run_all(wanted, folder, progress, processes)


def run_all(wanted: tuple[Job, ...], folder: Path, progress: bool = False, processes: int = 2) -> Runs:
    """As `all_runs`, for these jobs."""
    prepare_folder(folder)
    done = {}
    with progress_bar(progress, "runs", len(wanted), "jobs") as bar:
        for job, dataset in _run_all(wanted, folder, processes):
            done[job] = dataset
            bar.advance_to(len(done))
    ordered = sorted(done, key=lambda job: job.name)
    return Runs({(job.figure, job.formulation, job.finds): done[job] for job in ordered})


def _run_all(wanted: tuple[Job, ...], folder: Path, processes: int) -> Iterator[tuple[Job, xr.Dataset]]:
    """Every job with its Dataset, as they come."""
    left = []
    for job in wanted:
        dataset = kept(_path(job, folder), job.digest())
        if dataset is None:
            left.append(job)
        else:
            yield job, dataset
    for job, _ in side_by_side(partial(_run_and_keep, folder), left, processes):
        yield job, run(job, folder)


def _run_and_keep(folder: Path, job: Job) -> None:
    """The result stays on disk, where the first process reads it."""
    run(job, folder)


def run(job: Job, folder: Path) -> xr.Dataset:
    """The Dataset of a job, from `folder` if it lies there, else computed and saved."""
    path, key = _path(job, folder), job.digest()
    if kept(path, key) is None:
        keep(job.compute(), path, key)
    return kept(path, key)


def _path(job: Job, folder: Path) -> Path:
    return folder / f"{job.name}.nc"
