"""What a sweep measures besides the extrema: averages, the final state, sections, trajectories."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.common import checks
from delagrange.common.units import shown, with_unit

_MOST_SAMPLES = 10**9  # of a run; memory ends long before
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Measures:
    """What to keep of every run of a sweep; sections and trajectories exclude each other.

    Raises:
        ValueError: a value out of range, a section's phase without a section, or both kinds of samples.
    """

    averages: bool = False
    final_state: bool = False
    section_points: int | None = None
    section_phase: float = 0.0  # [rad]
    sample_interval: float | None = None  # [s]

    def __post_init__(self) -> None:
        _check_flag("averages", self.averages)
        _check_flag("final_state", self.final_state)
        if self.section_points is not None:
            checks.count("section_points", self.section_points, 1, _MOST_SAMPLES)
        phase = checks.finite("section_phase", self.section_phase, "rad")
        object.__setattr__(self, "section_phase", checks.scalar("section_phase", phase, "rad"))
        if self.section_phase != 0.0 and self.section_points is None:
            raise ValueError(
                f"section_phase {with_unit(self.section_phase, 'rad')} given without section_points; "
                "give how many points to keep"
            )
        if self.sample_interval is not None and self.section_points is not None:
            raise ValueError(
                f"section_points {shown(self.section_points)} and sample_interval "
                f"{with_unit(self.sample_interval, 's')} both given; a sweep keeps one kind of samples, give one"
            )

    def sample_count(self, duration: float) -> int:
        """How many samples of the state are kept of every run of `duration` [s].

        Raises:
            ValueError: a sample interval that is not positive, or longer than the duration.
        """
        if self.section_points is not None:
            return int(self.section_points)
        if self.sample_interval is None:
            return 0
        return whole_periods(duration / self._interval(duration)) + 1

    def _interval(self, duration: float) -> float:
        shortest = duration / _MOST_SAMPLES
        return checks.within("sample_interval", self.sample_interval, "s", shortest, duration)


def whole_periods(periods: float | np.ndarray) -> int | np.ndarray:
    """How many whole ones there are in `periods`, not less by rounding."""
    whole = np.floor(np.minimum(periods, 2.0**53) * (1 + _ROUNDING) + _ROUNDING).astype(int)
    return whole if np.ndim(whole) else int(whole)


def _check_flag(name: str, value: object) -> None:
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"{name} must be True or False, got {shown(value)}")
