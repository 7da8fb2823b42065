"""Many independent runs at once: an adaptive embedded Runge-Kutta method over lanes of trajectories.

Every lane has its own time, step and error control, and leaves when it is done or lost. All work is
element by element over the lanes, so that a lane's result is the same, bit for bit, whatever lanes are
integrated beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from delagrange.engines.averages import widen_integrals
from delagrange.engines.extrema import widen
from delagrange.engines.interpolation import evaluate, first_crossing, trial_polynomial
from delagrange.engines.lanes import (
    Interrupted,
    Lanes,
    Outcome,
    RunSettings,
    Sampling,
    Trial,
    empty_outcome,
    first_lanes,
    joined,
)
from delagrange.engines.recorder import keep_start, keep_step
from delagrange.engines.step_control import combine
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem

Report = Callable[[float], None]  # told how many runs' worth of time has been integrated


def integrate_lanes(
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None = None,
    report: Report | None = None,
) -> Outcome:
    """Integrate every lane from `initial_state`, (n_state, n_lanes), at t = 0 over the duration.

    Raises:
        Interrupted: from the keyboard; it carries the outcome of the lanes that had ended.
    """
    samples = 0 if sampling is None else sampling.count
    outcome = empty_outcome(initial_state, problem.model.COORDINATE_COUNT, loss.INTERRUPTED, samples)
    try:
        with np.errstate(all="ignore"):
            _integrate_into(outcome, problem, initial_state, settings, sampling, report)
    except KeyboardInterrupt as interruption:
        raise Interrupted(outcome) from interruption
    return outcome


def _integrate_into(
    outcome: Outcome,
    problem: Problem,
    initial_state: np.ndarray,
    settings: RunSettings,
    sampling: Sampling | None,
    report: Report | None,
) -> None:
    if sampling is not None:
        keep_start(outcome, sampling, initial_state)
    lanes = first_lanes(initial_state, problem.model.COORDINATE_COUNT, settings.averages)
    lanes = _without_lost_at_start(problem, lanes, settings, outcome)
    for span in segments(problem, settings):
        inside = settings.measures(*span)
        measured = settings if inside else replace(settings, extrema="none", averages=False)
        lanes = _run_segment(problem, lanes, measured, span, outcome, sampling, report)


def _without_lost_at_start(problem: Problem, lanes: Lanes, settings: RunSettings, outcome: Outcome) -> Lanes:
    """A lane is lost before it moves where its initial or held stretch is beyond the limits."""
    lost = ~(problem.margin(lanes.time, lanes.state, settings.limits) > 0)
    lost = np.broadcast_to(lost, lanes.index.shape)
    kind = np.broadcast_to(problem.kind_of_loss(lanes.time, lanes.state, settings.limits), lost.shape)
    outcome.record_into(lanes.take(np.flatnonzero(lost)), kind[lost])
    return lanes.take(np.flatnonzero(~lost))


def segments(problem: Problem, settings: RunSettings) -> Iterator[tuple[float, float]]:
    """Spans [s] in which the drives are smooth and which lie inside the window or outside of it."""
    times = {0.0, settings.duration, *settings.window, *problem.breakpoints(0.0, settings.duration)}
    bounds = sorted(times)
    return pairwise(bounds)


def _run_segment(
    problem: Problem,
    lanes: Lanes,
    settings: RunSettings,
    span: tuple[float, float],
    outcome: Outcome,
    sampling: Sampling | None,
    report: Report | None,
) -> Lanes:
    """Take the lanes to the end of the span; those that are lost on the way or done go to `outcome`."""
    every_lane = problem.piece(*span)
    running = every_lane.take(lanes.index)
    lanes = _at_start(running, lanes, settings, span[1])
    buffer = np.empty((settings.tableau.stage_count + 1) * lanes.state.size)
    arrived = [lanes.take(np.arange(0))]
    while len(lanes.index):
        trial = _try_step(running, lanes, settings, span[1], buffer)
        lanes, lost = _judge(running, trial, span[1], settings, outcome, sampling)
        leaving = lost | (lanes.time >= span[1])
        if np.any(leaving):
            there = lanes.take(np.flatnonzero(leaving & ~lost))
            arrived.append(there)
            if span[1] >= settings.duration:
                outcome.record_into(there, loss.COMPLETED)
            lanes = lanes.take(np.flatnonzero(~leaving))
            running = every_lane.take(lanes.index)
        if report is not None:
            report(_runs_done(outcome, (lanes, *arrived), settings.duration))
    return joined(arrived)


def _runs_done(outcome: Outcome, groups: tuple[Lanes, ...], duration: float) -> float:
    """Lanes that have ended, and the share of the duration behind those that have not."""
    ended = np.count_nonzero(outcome.status != loss.INTERRUPTED)
    going = [group.time for group in groups if not np.any(outcome.status[group.index] != loss.INTERRUPTED)]
    return ended + sum(float(np.sum(time)) for time in going) / duration


def _at_start(problem: Problem, lanes: Lanes, settings: RunSettings, stop: float) -> Lanes:
    """The lanes with the rate and first step of a new segment, and its first values measured."""
    rate = np.array(problem.rhs(lanes.time, lanes.state))
    step = settings.control.first_step(problem, settings.tableau, lanes.time, lanes.state, rate, stop)
    lanes = replace(lanes, rate=rate, step=step, retried=np.zeros(len(lanes.index), dtype=bool))
    if settings.extrema == "none":
        return lanes
    values = lanes.state[: len(lanes.maximum)]
    return replace(
        lanes, maximum=np.maximum(lanes.maximum, values), minimum=np.minimum(lanes.minimum, values)
    )


def _try_step(problem: Problem, lanes: Lanes, settings: RunSettings, stop: float, buffer: np.ndarray) -> Trial:
    tableau, control = settings.tableau, settings.control
    step, end = control.bounded(lanes.step, lanes.time, stop)
    shape = (tableau.stage_count + 1, *lanes.state.shape)
    stages = buffer[: np.prod(shape)].reshape(shape)
    stages[0] = lanes.rate
    for stage in range(1, tableau.stage_count):
        increment = step * combine(tableau.coupling[stage], stages)
        stages[stage] = problem.rhs(lanes.time + tableau.nodes[stage] * step, lanes.state + increment)
    state = lanes.state + step * combine(tableau.weights, stages)
    stages[-1] = problem.rhs(end, state)
    error = control.error(tableau, stages, step, lanes.state, state)
    accepted = error <= 1
    next_step = control.next_step(tableau, step, error, accepted, lanes.retried)
    return Trial(lanes, step, stages, accepted, next_step, np.ones(len(step)), end, state)


def _judge(
    problem: Problem,
    trial: Trial,
    stop: float,
    settings: RunSettings,
    outcome: Outcome,
    sampling: Sampling | None,
) -> tuple[Lanes, np.ndarray]:
    """The lanes after the step, and which of them are lost (and written to `outcome`, as samples are).

    A short step that reaches `stop`, the end of the segment [s], is no sign of a hopeless run.
    """
    beyond = trial.accepted & ~(problem.margin(trial.end, trial.state, settings.limits) > 0)
    smallest = np.maximum(
        settings.control.smallest_step(trial.before.time), loss.SMALLEST_STEP * settings.duration
    )
    resolved = trial.next_step >= smallest  # not so for NaN
    cut = trial.accepted & ((trial.before.step >= smallest) | (trial.end >= stop))
    stuck = ~resolved & ~cut
    if np.any(beyond):
        trial = _cut_at_loss(problem, trial, settings, np.flatnonzero(beyond))
    if sampling is not None:
        keep_step(outcome, sampling, problem, trial, settings)
    integrals = widen_integrals(problem, trial, settings)
    lanes = _after(trial, *widen(problem, trial, settings), integrals)
    if np.any(beyond | stuck):
        lost_how = problem.kind_of_loss(trial.end, trial.state, settings.limits)
        kind = np.where(stuck, problem.kind_of_failure(trial.before.time, trial.before.state), lost_how)
        lost = np.flatnonzero(beyond | stuck)
        outcome.record_into(lanes.take(lost), kind[lost])
    return lanes, beyond | stuck


def _cut_at_loss(problem: Problem, trial: Trial, settings: RunSettings, places: np.ndarray) -> Trial:
    """The trial with the steps of the lost lanes, at `places`, ending where the limit is passed."""
    lost, some = trial.take(places), problem.take(places)
    before = lost.before
    polynomial = trial_polynomial(problem, trial, settings, places)

    def distance(fraction: np.ndarray) -> np.ndarray:
        state = evaluate(polynomial, fraction)
        return some.margin(before.time + fraction * lost.step, state, settings.limits)

    crossing = first_crossing(distance, places.shape)
    fraction, end, state = trial.fraction.copy(), trial.end.copy(), trial.state.copy()
    fraction[places] = crossing
    end[places] = before.time + crossing * lost.step
    state[:, places] = evaluate(polynomial, crossing)
    return replace(trial, fraction=fraction, end=end, state=state)


def _after(trial: Trial, maximum: np.ndarray, minimum: np.ndarray, integrals: np.ndarray) -> Lanes:
    before, accepted = trial.before, trial.accepted
    return Lanes(
        index=before.index,
        time=np.where(accepted, trial.end, before.time),
        step=trial.next_step,
        retried=~accepted,
        state=np.where(accepted, trial.state, before.state),
        rate=np.where(accepted, trial.stages[-1], before.rate),
        maximum=maximum,
        minimum=minimum,
        integrals=integrals,
        steps=before.steps + accepted,
        rejections=before.rejections + ~accepted,
    )
