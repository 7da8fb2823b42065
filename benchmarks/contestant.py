"""What all contestants have in common."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np

from benchmarks.cases import Case
from delagrange.engines.engines import ENGINES

Run = Callable[[], np.ndarray]  # the timed part; amplitudes [1], (n_places,)
Prepare = Callable[[Case, np.ndarray, float], Run]  # (case, places of the runs, tolerance), not timed


@dataclass(frozen=True)
class Contestant:
    """A way to compute the amplitudes of a case."""

    name: str
    label: str  # in tables and figures
    method: str  # one line for the report
    needs: tuple[str, ...]  # importable modules beyond those of delagrange
    tolerances: tuple[float, ...]  # from loose to tight
    prepare: Prepare
    subset: int | None = None  # runs that are timed, the time scaled to all; None for all
    group: int = 1  # neighbours that stay together in the subset
    repeats: int | None = None  # at most so many, and one less than the others; None for as many
    accuracy_of: str | None = None  # measures no amplitude: its error is that of another at equal tolerance
    engine: str | None = None  # of this package
    notes: tuple[str, ...] = ()  # what was done to it, for the report

    def missing(self) -> tuple[str, ...]:
        """What it needs and is not there."""
        modules = tuple(name for name in self.needs if find_spec(name) is None)
        return modules if self.engine in (None, *ENGINES) else (*modules, f"engine {self.engine!r}")


def refusal(contestant: Contestant) -> str:
    """The line that stands in the report for a contestant that lacks something."""
    return f"{contestant.label}: left out, not installed here: {', '.join(contestant.missing())}"
