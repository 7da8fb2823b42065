"""Samples of the state inside the steps of many lanes, written to the outcome as they come by."""

from __future__ import annotations

import numpy as np

from delagrange.engines.interpolation import evaluate, trial_polynomial
from delagrange.engines.lanes import Outcome, RunSettings, Sampling, Trial
from delagrange.problem.problem import Problem


def keep_start(outcome: Outcome, sampling: Sampling, state: np.ndarray) -> None:
    """Write the samples at t = 0 of the lanes that have one there; `state` is (n_state, n_lanes)."""
    places = np.flatnonzero(sampling.taken(np.zeros(state.shape[1])))
    outcome.samples[0][:, places] = state[:, places]


def keep_step(
    outcome: Outcome, sampling: Sampling, problem: Problem, trial: Trial, settings: RunSettings
) -> None:
    """Write the samples that lie in the accepted steps, as far as these count, after their beginning."""
    before = trial.before
    own = sampling.take(before.index)
    number, due = own.taken(before.time), own.taken(trial.end)
    places = np.flatnonzero(trial.accepted & (number < due))
    if len(places) == 0:
        return
    polynomial = trial_polynomial(problem, trial, settings, places)
    while len(places):
        time = own.first[places] + number[places] * own.spacing[places]
        values = evaluate(polynomial, (time - before.time[places]) / trial.step[places])
        outcome.samples[number[places], :, before.index[places]] = values.T
        number[places] += 1
        more = number[places] < due[places]
        places, polynomial = places[more], polynomial[..., more]
