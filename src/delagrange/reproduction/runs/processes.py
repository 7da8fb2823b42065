"""Independent tasks side by side in other processes, or one after another where none can be had."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


def side_by_side(
    function: Callable[[Task], Result], tasks: Sequence[Task], processes: int
) -> Iterator[tuple[Task, Result]]:
    """Every task with its result, as they come; `function` and tasks must be fit for pickling."""
    left = list(tasks)
    if processes > 1 and len(left) > 1:
        for task, result in _aside(function, tuple(left), processes):
            left.remove(task)
            yield task, result
    for task in left:  # what no other process could do
        yield task, function(task)


def _aside(
    function: Callable[[Task], Result], tasks: tuple[Task, ...], processes: int
) -> Iterator[tuple[Task, Result]]:
    """In other processes; ends early where they cannot be had."""
    pool = ProcessPoolExecutor(min(processes, len(tasks)), get_context("spawn"), initializer=_die_quietly)
    try:
        futures = {pool.submit(function, task): task for task in tasks}
    except (OSError, BrokenProcessPool):
        pool.shutdown(wait=False, cancel_futures=True)
        return
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    except BrokenProcessPool:
        return
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _die_quietly() -> None:
    """An interruption from the keyboard reaches every process; only the first one has to say so."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
