"""Compiled runs on all cores of the machine, part by part, while progress is told and the keyboard heard."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait

import numpy as np

from delagrange.engines.numpy_engine import Report

LOOK = 0.05  # [s], how often progress is reported and the keyboard heard
Run = Callable[[int, int, np.ndarray], None]  # first lane, the one after the last, progress (1,)


def run_on_threads(
    run: Run, lanes: int, width: int, stop: np.ndarray, threads: int | None, report: Report | None
) -> None:
    """Integrate all lanes on as many threads as are wanted, or there are cores.

    width: lanes that compiled code takes side by side
    stop: (1,) of int8, which ends every part once it is not 0
    """
    workers = cores() if threads is None else threads
    whole = list(parts(lanes, workers, width))
    progress = np.zeros((len(whole), 1))
    with ThreadPoolExecutor(workers) as pool:
        waiting = {
            pool.submit(run, part.start, part.stop, progress[number]) for number, part in enumerate(whole)
        }
        try:
            while waiting:
                done, waiting = wait(waiting, timeout=LOOK, return_when=FIRST_EXCEPTION)
                for future in done:
                    future.result()
                if report is not None:
                    report(float(np.sum(progress)))
        except BaseException:
            stop[0] = 1
            pool.shutdown(wait=True, cancel_futures=True)
            raise


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def parts(lanes: int, workers: int, width: int) -> Iterator[slice]:
    """Parts in whole widths: large ones first, small ones last, so that all threads end together."""
    start = 0
    while start < lanes:
        share = lanes - start if workers == 1 else -(-(lanes - start) // (2 * workers))
        stop = min(start + -(-share // width) * width, lanes)
        yield slice(start, stop)
        start = stop


def slices(size: int, length: int) -> Iterator[slice]:
    """Consecutive slices of a length, the last one as long as what is left."""
    return (slice(start, min(start + length, size)) for start in range(0, size, length))


def shifted(report: Report | None, done: int) -> Report | None:
    """A report of what comes behind lanes that are done."""
    return None if report is None else lambda more: report(done + more)
