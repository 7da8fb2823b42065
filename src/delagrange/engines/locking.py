"""Runs that a compiled kernel could resolve no more: whether a spring was about to lock."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from delagrange.engines.lanes import Outcome
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem
from delagrange.problem.status import Limits


def name_failures(outcome: Outcome, problem: Problem, limits: Limits) -> Outcome:
    """The outcome of a kernel with the lanes that no step resolved judged as every engine judges them.

    A kernel ends such a lane as diverged, in its last state within the limits; one that has left them lies beyond.
    """
    if not hasattr(problem.model, "validity"):
        return outcome
    with np.errstate(all="ignore"):
        within = problem.margin(outcome.status_time, outcome.state, limits) > 0
        failure = problem.kind_of_failure(outcome.status_time, outcome.state)
    stuck = (outcome.status == loss.DIVERGED) & within
    return replace(outcome, status=np.where(stuck, failure, outcome.status))
