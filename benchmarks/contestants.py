"""All contestants, in the order of the tables."""

from __future__ import annotations

from benchmarks.contestant import Contestant
from benchmarks.peer_delagrange import COMPILED, NUMPY
from benchmarks.peer_heyoka import (
    HEYOKA,
    HEYOKA_ALONE,
    HEYOKA_OUTPUT,
    HEYOKA_TUNED,
    HEYOKA_TUNED_ALONE,
)
from benchmarks.peer_scipy import SCIPY

CONTESTANTS: tuple[Contestant, ...] = (
    COMPILED, NUMPY, SCIPY, HEYOKA, HEYOKA_OUTPUT, HEYOKA_TUNED, HEYOKA_ALONE, HEYOKA_TUNED_ALONE,
)  # fmt: skip


def available() -> tuple[Contestant, ...]:
    """Those whose modules are installed."""
    return tuple(contestant for contestant in CONTESTANTS if not contestant.missing())
