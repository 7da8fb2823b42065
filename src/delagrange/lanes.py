"""What an ensemble keeps of its lanes: before a step, during it, and at the end."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from delagrange.loss import Limits
from delagrange.step_control import StepControl
from delagrange.tableau import Tableau


@dataclass(frozen=True)
class Settings:
    """How to integrate and what to measure."""

    tableau: Tableau
    control: StepControl
    duration: float  # [s]
    window: tuple[float, float]  # [s], where extrema are taken
    limits: Limits
    extrema: str  # one of delagrange.extrema.EXTREMA, or "none"


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
    steps: np.ndarray  # (n_lanes,), accepted so far
    rejections: np.ndarray  # (n_lanes,)

    def take(self, places: np.ndarray) -> Lanes:
        """Some of the lanes."""
        return Lanes(**{entry.name: getattr(self, entry.name)[..., places] for entry in fields(self)})


def first_lanes(state: np.ndarray, coordinates: int) -> Lanes:
    """Lanes at t = 0 in `state`, (n_state, n_lanes), with nothing measured yet."""
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
    state: np.ndarray  # (n_state, n_lanes), at the end or at the loss
    status: np.ndarray  # (n_lanes,), place in delagrange.loss.STATUS
    status_time: np.ndarray  # (n_lanes,) [s], when the lane ended
    steps: np.ndarray  # (n_lanes,), accepted
    rejections: np.ndarray  # (n_lanes,)

    def record_into(self, lanes: Lanes, status: int | np.ndarray) -> None:
        """Write the lanes' present values to their places."""
        for name in ("maximum", "minimum", "state", "steps", "rejections"):
            getattr(self, name)[..., lanes.index] = getattr(lanes, name)
        self.status[lanes.index] = status
        self.status_time[lanes.index] = lanes.time

    def place_into(self, places: slice, part: Outcome) -> None:
        """Write the outcome of some of the lanes to their places."""
        for entry in fields(self):
            getattr(self, entry.name)[..., places] = getattr(part, entry.name)


class Interrupted(KeyboardInterrupt):
    """An interruption from the keyboard, with what was finished before it."""

    def __init__(self, outcome: Outcome) -> None:
        super().__init__()
        self.outcome = outcome


def empty_outcome(state: np.ndarray, coordinates: int, status: int) -> Outcome:
    """An outcome of lanes that have not run, all with `status`."""
    lanes = state.shape[-1]
    return Outcome(
        maximum=np.full((coordinates, lanes), np.nan),
        minimum=np.full((coordinates, lanes), np.nan),
        state=np.full(state.shape, np.nan),
        status=np.full(lanes, status),
        status_time=np.zeros(lanes),
        steps=np.zeros(lanes, dtype=int),
        rejections=np.zeros(lanes, dtype=int),
    )
