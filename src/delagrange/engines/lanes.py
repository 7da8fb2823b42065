"""What an ensemble keeps of its lanes: before a step, during it, and at the end."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from delagrange.engines.step_control import StepControl
from delagrange.engines.tableau import Tableau
from delagrange.problem.status import Limits


@dataclass(frozen=True)
class RunSettings:
    """How to integrate and what to measure."""

    tableau: Tableau | None  # None for an engine that carries its own
    control: StepControl
    duration: float  # [s]
    window: tuple[float, float]  # [s], where extrema and averages are taken
    limits: Limits
    extrema: str  # one of delagrange.engines.extrema.EXTREMA, or "none"
    averages: bool = False  # mean and mean square of the coordinates over the window
    threads: int | None = None  # for engines that use threads; None: as many as they like

    def measures(self, start: float, stop: float) -> bool:
        """Whether the time from `start` to `stop` [s] lies in the window; segments lie inside it or outside."""
        return self.window[0] <= start and stop <= self.window[1]


@dataclass(frozen=True)
class Sampling:
    """When the state of each lane is kept: sample j at first + j * spacing.

    Those that lie beyond the duration are not taken.
    """

    first: np.ndarray  # (n_lanes,) [s], not negative
    spacing: np.ndarray  # (n_lanes,) [s], positive
    count: int  # samples a lane

    def times(self) -> np.ndarray:
        """Time of every sample [s], (count, n_lanes)."""
        return self.first + np.arange(self.count)[:, None] * self.spacing

    def taken(self, time: np.ndarray) -> np.ndarray:
        """How many samples of each lane lie at or before `time` [s], (n_lanes,) -> (n_lanes,) of int."""
        near = np.floor((time - self.first) / self.spacing)
        last = near + (self.first + (near + 1) * self.spacing <= time)  # where the division rounded
        last -= self.first + last * self.spacing > time
        return np.clip(last + 1, 0, self.count).astype(int)

    def take(self, lanes: np.ndarray | slice) -> Sampling:
        """The sampling of some of the lanes."""
        return Sampling(self.first[lanes], self.spacing[lanes], self.count)


@dataclass(frozen=True)
class Lanes:
    """The lanes that are running; the last axis of every array counts them."""

    index: np.ndarray  # (n_lanes,), place in the outcome
    time: np.ndarray  # (n_lanes,) [s]
    step: np.ndarray  # (n_lanes,) [s], to try next
    retried: np.ndarray  # (n_lanes,) of bool: the last try was rejected
    state: np.ndarray  # (n_state, n_lanes)
    rate: np.ndarray  # (n_state, n_lanes), of the state
    maximum: np.ndarray  # (n_coordinates, n_lanes) [1]
    minimum: np.ndarray  # (n_coordinates, n_lanes) [1]
    integrals: (
        np.ndarray
    )  # (1 + 2 n_coordinates, n_lanes) [s], over the window so far; see delagrange.engines.averages
    steps: np.ndarray  # (n_lanes,), accepted so far
    rejections: np.ndarray  # (n_lanes,)

    def take(self, places: np.ndarray) -> Lanes:
        """Some of the lanes."""
        return Lanes(**{entry.name: getattr(self, entry.name)[..., places] for entry in fields(self)})


def first_lanes(state: np.ndarray, coordinates: int, averages: bool = False) -> Lanes:
    """Lanes at t = 0 in `state`, (n_state, n_lanes), with nothing measured yet.

    Without averages the integrals have no rows, so that nobody carries them along.
    """
    lanes = state.shape[-1]
    return Lanes(
        index=np.arange(lanes),
        time=np.zeros(lanes),
        step=np.zeros(lanes),
        retried=np.zeros(lanes, dtype=bool),
        state=state,
        rate=np.zeros_like(state),
        maximum=np.full((coordinates, lanes), -np.inf),
        minimum=np.full((coordinates, lanes), np.inf),
        integrals=np.zeros((1 + 2 * coordinates if averages else 0, lanes)),
        steps=np.zeros(lanes, dtype=int),
        rejections=np.zeros(lanes, dtype=int),
    )


def joined(groups: list[Lanes]) -> Lanes:
    """Groups of lanes as one, in the order of their places in the outcome."""
    together = Lanes(
        **{
            entry.name: np.concatenate([getattr(group, entry.name) for group in groups], axis=-1)
            for entry in fields(Lanes)
        }
    )
    return together.take(np.argsort(together.index))


@dataclass(frozen=True)
class Trial:
    """One step that every lane tried."""

    before: Lanes
    step: np.ndarray  # (n_lanes,) [s]
    stages: np.ndarray  # (stage_count + 1, n_state, n_lanes), rates during the step and at its end
    accepted: np.ndarray  # (n_lanes,) of bool
    next_step: np.ndarray  # (n_lanes,) [s]
    fraction: np.ndarray  # (n_lanes,), part of the step that counts: less than 1 where the lane is lost in it
    end: np.ndarray  # (n_lanes,) [s], after that part
    state: np.ndarray  # (n_state, n_lanes), after that part

    def take(self, places: np.ndarray) -> Trial:
        """Some of the lanes."""
        arrays = (entry.name for entry in fields(self) if entry.name != "before")
        return Trial(self.before.take(places), **{name: getattr(self, name)[..., places] for name in arrays})


@dataclass(frozen=True)
class Outcome:
    """What is left of each lane; filled lane by lane as they end."""

    maximum: np.ndarray  # (n_coordinates, n_lanes) [1], in the window as far as the lane came into it
    minimum: np.ndarray  # (n_coordinates, n_lanes) [1]
    mean: np.ndarray  # (n_coordinates, n_lanes) [1], over the part of the window that the lane came through
    mean_square: np.ndarray  # (n_coordinates, n_lanes) [1], of the coordinate itself, over the same part
    state: np.ndarray  # (n_state, n_lanes), at the end or at the loss
    status: np.ndarray  # (n_lanes,), place in delagrange.problem.status.STATUS
    status_time: np.ndarray  # (n_lanes,) [s], when the lane ended
    steps: np.ndarray  # (n_lanes,), accepted
    rejections: np.ndarray  # (n_lanes,)
    samples: np.ndarray  # (count, n_state, n_lanes), NaN after the loss; none (count 0) where not asked for

    def record_into(self, lanes: Lanes, status: int | np.ndarray) -> None:
        """Write the lanes' present values to their places; samples are written as they are taken."""
        for name in ("maximum", "minimum", "state", "steps", "rejections"):
            getattr(self, name)[..., lanes.index] = getattr(lanes, name)
        self.status[lanes.index] = status
        self.status_time[lanes.index] = lanes.time
        if len(lanes.integrals):
            covered, sums, squares = np.split(lanes.integrals, [1, 1 + len(self.mean)])
            self.mean[:, lanes.index] = sums / covered  # 0 / 0 for a lane that never came into the window
            self.mean_square[:, lanes.index] = squares / covered

    def place_into(self, places: slice, part: Outcome) -> None:
        """Write the outcome of some of the lanes to their places."""
        for entry in fields(self):
            getattr(self, entry.name)[..., places] = getattr(part, entry.name)


class Interrupted(KeyboardInterrupt):
    """An interruption from the keyboard, with what was finished before it."""

    def __init__(self, outcome: Outcome) -> None:
        super().__init__()
        self.outcome = outcome


def empty_outcome(state: np.ndarray, coordinates: int, status: int, samples: int = 0) -> Outcome:
    """An outcome of lanes that have not run, all with `status`, with room for `samples` of each."""
    lanes = state.shape[-1]
    return Outcome(
        maximum=np.full((coordinates, lanes), np.nan),
        minimum=np.full((coordinates, lanes), np.nan),
        mean=np.full((coordinates, lanes), np.nan),
        mean_square=np.full((coordinates, lanes), np.nan),
        state=np.full(state.shape, np.nan),
        status=np.full(lanes, status),
        status_time=np.zeros(lanes),
        steps=np.zeros(lanes, dtype=int),
        rejections=np.zeros(lanes, dtype=int),
        samples=np.full((samples, *state.shape), np.nan),
    )
