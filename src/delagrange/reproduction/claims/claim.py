"""A claim of the paper as a test on the computed runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from delagrange.reproduction.runs.all_runs import Runs

# (runs, formulation or None) -> whether the claim holds, and the numbers that say so
Claim: TypeAlias = Callable[[Runs, str | None], tuple[bool, str]]
