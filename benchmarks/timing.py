"""Times of many contestants, interleaved so that noise of the machine hits all alike."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter

import numpy as np


@dataclass(frozen=True)
class Timed:
    """Something to be timed, and how often at most."""

    run: Callable[[], np.ndarray]
    repeats: int


def interleaved(tasks: Sequence[Timed]) -> Iterator[tuple[int, float, np.ndarray]]:
    """(place of the task, time [s], result), repeat after repeat, and all tasks within a repeat."""
    for repeat in range(max((task.repeats for task in tasks), default=0)):
        for place, task in enumerate(tasks):
            if repeat < task.repeats:
                yield place, *timed(task.run)


def timed(run: Callable[[], np.ndarray]) -> tuple[float, np.ndarray]:
    """Time [s] and result of one call."""
    begin = perf_counter()
    result = run()
    return perf_counter() - begin, result


def core_count() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if _CAN_CHOOSE else os.cpu_count() or 1


@contextmanager
def one_core() -> Iterator[None]:
    """Keep this process, and threads that it starts, on one core while the block runs, where the system can."""
    allowed = os.sched_getaffinity(0) if _CAN_CHOOSE else set()
    if _CAN_CHOOSE:
        os.sched_setaffinity(0, {max(allowed)})  # the first core serves most interrupts
    try:
        yield
    finally:
        if _CAN_CHOOSE:
            os.sched_setaffinity(0, allowed)


_CAN_CHOOSE = hasattr(os, "sched_setaffinity")
