"""All runs of the reproduction, on two cores, each kept on disk as soon as it is done."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import xarray as xr

from delagrange.files import prepare_folder
from delagrange.progress import progress_bar
from delagrange.reproduction.numerics import ACCURATE
from delagrange.reproduction.runs import Job, jobs
from delagrange.reproduction.store import keep, kept


@dataclass(frozen=True)
class Runs:
    """Everything computed, by figure, formulation (None where a model has but one) and name of the numerics."""

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

    def _of(self, figure: int, formulation: str | None, numerics: str) -> xr.Dataset:
        key = (figure, formulation, numerics)
        if key not in self.datasets:
            known = "; ".join(" ".join(str(part) for part in known if part) for known in self.datasets)
            raise ValueError(f"no runs of figure {figure}, {formulation}, {numerics}; there are {known}")
        return self.datasets[key]


def all_runs(
    folder: Path, only: tuple[int, ...] | None = None, progress: bool = False, processes: int = 2
) -> Runs:
    """Compute what Figs. 4-12 (or `only` some) need, each job saved in `folder` as it is done.

    A job that lies there already, of the same parameters and computed by the same sources, is read and
    not computed again: after an interruption nothing finished is lost.

    Raises:
        ValueError: `only` names a figure that is not among Figs. 4-12, or `folder` cannot be written.
    """
    return run_all(jobs(only), folder, progress, processes)


def run_all(wanted: tuple[Job, ...], folder: Path, progress: bool = False, processes: int = 2) -> Runs:
    """As `all_runs`, for these jobs."""
    prepare_folder(folder)
    done = {}
    with progress_bar(progress, "runs", len(wanted), "jobs") as bar:
        for job, dataset in _run_all(wanted, folder, processes):
            done[job] = dataset
            bar.advance_to(len(done))
    ordered = sorted(done, key=lambda job: job.name)
    return Runs({(job.figure, job.formulation, job.numerics.name): done[job] for job in ordered})


def _run_all(wanted: tuple[Job, ...], folder: Path, processes: int) -> Iterator[tuple[Job, xr.Dataset]]:
    """Every job with its Dataset, as they come."""
    left = []
    for job in wanted:
        dataset = kept(_path(job, folder), job.digest())
        if dataset is None:
            left.append(job)
        else:
            yield job, dataset
    if processes > 1 and len(left) > 1:
        for job in _run_aside(tuple(left), folder, processes):
            left.remove(job)
            yield job, run(job, folder)
    for job in left:  # what no other process could do
        yield job, run(job, folder)


def _run_aside(wanted: tuple[Job, ...], folder: Path, processes: int) -> Iterator[Job]:
    """Run jobs in other processes and name each as it is done; ends early where processes cannot be had."""
    context = get_context("spawn")
    try:
        pool = ProcessPoolExecutor(min(processes, len(wanted)), context, initializer=_die_quietly)
    except (OSError, NotImplementedError, ImportError):
        return
    try:
        futures = {pool.submit(_run_and_keep, job, folder): job for job in wanted}
        for future in as_completed(futures):
            future.result()
            yield futures[future]
    except BrokenProcessPool:
        return
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _die_quietly() -> None:
    """An interruption from the keyboard reaches every process; only the first one has to say so."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _run_and_keep(job: Job, folder: Path) -> None:
    run(job, folder)


def run(job: Job, folder: Path) -> xr.Dataset:
    """The Dataset of a job, from `folder` if it lies there, else computed and saved."""
    path, key = _path(job, folder), job.digest()
    if kept(path, key) is None:
        keep(job.compute(), path, key)
    return kept(path, key)


def _path(job: Job, folder: Path) -> Path:
    return folder / f"{job.name}.nc"
