"""When the state of every run of a sweep is kept: at one phase of the field, or evenly spaced."""

from __future__ import annotations

import numpy as np

from delagrange.drives.phase import fraction_of_period
from delagrange.engines.lanes import Sampling
from delagrange.run.measures import Measures, whole_periods


def make_sampling(
    measures: Measures, duration: float, frequency: np.ndarray, field_phase: float | np.ndarray
) -> Sampling | None:
    """The sampling of lanes with the given fields, `frequency` (n_lanes,) [Hz], `field_phase` [rad].

    Raises:
        ValueError: the duration [s] holds fewer section points than wanted for some frequency, or the
            sample interval is not one of the duration.
    """
    count = measures.sample_count(duration)
    if measures.section_points is not None:
        return _section_sampling(measures, duration, *np.broadcast_arrays(frequency, field_phase))
    if measures.sample_interval is None:
        return None
    spacing = np.full(frequency.shape, float(measures.sample_interval))
    return _within_duration(Sampling(np.zeros(frequency.shape), spacing, count), duration)


def _section_sampling(
    measures: Measures, duration: float, frequency: np.ndarray, field_phase: np.ndarray
) -> Sampling:
    """The last times (k + fraction) / frequency at which 2 pi f t + field_phase is the section's phase.

    The fraction of a period, 0 <= fraction < 1, is that of `analysis.sections`.
    """
    fraction = fraction_of_period(measures.section_phase - field_phase)
    held = whole_periods(frequency * duration - fraction) + 1
    _check_enough(measures, duration, frequency, np.maximum(held, 0))
    first = (held - measures.section_points + fraction) / frequency
    return _within_duration(Sampling(first, 1 / frequency, measures.section_points), duration)


def _check_enough(measures: Measures, duration: float, frequency: np.ndarray, held: np.ndarray) -> None:
    if np.all(held >= measures.section_points):
        return
    worst = np.unravel_index(np.argmin(held), held.shape)
    raise ValueError(
        f"section_points must be at most {held[worst]}, got {measures.section_points}: so often a run of "
        f"{duration:g} s at frequency {frequency[worst]:.12g} Hz passes the phase {measures.section_phase:g} rad"
    )


def _within_duration(sampling: Sampling, duration: float) -> Sampling:
    """The sampling without the rounding that puts the last sample of a lane behind the duration."""
    first, spacing = np.minimum(sampling.first, duration), sampling.spacing
    intervals = sampling.count - 1
    if intervals == 0:
        return Sampling(first, spacing, sampling.count)
    late = first + intervals * spacing > duration
    spacing = np.where(late, (duration - first) / intervals, spacing)
    while np.any(late := first + intervals * spacing > duration):
        spacing = np.where(late, np.nextafter(spacing, 0.0), spacing)
    return Sampling(first, spacing, sampling.count)
