"""What is known of a motion, in numbers: growth of its tangent, lines of its spectrum, their torus, the 0-1 test."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.analysis.motion.lyapunov import Spectrum, spectrum
from delagrange.analysis.motion.observation import Observation
from delagrange.analysis.motion.spectral_lines import Band, Lines, band, find_lines
from delagrange.analysis.motion.torus import Torus, torus
from delagrange.analysis.motion.zero_one import zero_one
from delagrange.problem.status import COMPLETED

_GOLDEN = (np.sqrt(5) - 1) / 2  # a mixture of coordinates with such weights is blind to no symmetry
_SMOOTHED = 0.1  # of the time, over which the logarithm of the tangent's growth is averaged
_MOST_BASES = 5
_SECTION_POINTS = 500  # for the 0-1 test, at least, where there are so many
_SAME_POINT = 1e-6  # of the extent of the motion: a periodic motion has one point
_STRONG = 1e-4  # share of the power of a line that counts for the slowest


@dataclass(frozen=True)
class Growth:
    """Gain of the logarithm of the longest tangent vector, smoothed, in the second half of the time."""

    first: float  # from about a half to three quarters of the time
    second: float  # from there to the end

    @property
    def gain(self) -> float:
        """Over the second half: about ln 2 for growth in proportion to time, rate times time for exponential."""
        return self.first + self.second

    @property
    def sustained(self) -> bool:
        """Whether it goes on growing as it did: each part has at least a fifth of the whole."""
        return min(self.first, self.second) > 0.2 * self.gain > 0


@dataclass(frozen=True)
class Evidence:
    """All that a verdict stands on."""

    observation: Observation
    extent: float  # [unit of the coordinates], largest peak to peak of a coordinate
    spectrum: Spectrum | None
    growth: Growth
    lines: Lines
    band: Band
    torus: Torus
    zero_one: float

    @property
    def unexplained(self) -> float:
        """Share of the power in no line, or in lines that are no combination of the base frequencies."""
        other = float(np.sum(self.lines.power_share[~self.torus.explained]))
        return self.lines.residue + (1 - self.lines.residue) * other

    @property
    def slowest(self) -> float:
        """Lowest frequency [Hz] among the strong lines; infinite where there is none."""
        strong = self.lines.frequency[self.lines.power_share > _STRONG]
        return float(np.min(strong, initial=np.inf))


def gather(observation: Observation, coordinates: int) -> Evidence | None:
    """The evidence in what was observed of a model with so many coordinates; None where it was lost."""
    if observation.status != COMPLETED:
        return None
    states = observation.states[:, : coordinates or observation.states.shape[1]]
    signal = states[:-1] @ _GOLDEN ** np.arange(states.shape[1])
    forcing = observation.forcing
    lines = find_lines(signal, forcing.interval)
    most = min(_MOST_BASES, states.shape[1] + len(forcing.frequencies))
    return Evidence(
        observation,
        float(np.max(np.ptp(states, axis=0))),
        spectrum(observation),
        tangent_growth(observation.growth),
        lines,
        band(signal, forcing.interval),
        torus(lines, forcing.frequencies, most),
        zero_one(_once_in_a_turn(observation, signal, lines), _SAME_POINT * float(np.ptp(signal))),
    )


def tangent_growth(growth: np.ndarray) -> Growth:
    """From the logarithms of the growth of the columns, (n, n_columns), sample by sample."""
    longest = np.cumsum(growth[:, 0])
    width = max(1, int(_SMOOTHED * len(longest)))
    ends = (len(longest) // 2, 3 * len(longest) // 4, len(longest))
    at_half, at_three_quarters, at_end = (np.mean(longest[end - width : end]) for end in ends)
    return Growth(float(at_three_quarters - at_half), float(at_end - at_three_quarters))


def _once_in_a_turn(observation: Observation, signal: np.ndarray, lines: Lines) -> np.ndarray:
    """The signal at one phase of the forcing, not oftener than the strongest line turns.

    What is sampled too often looks regular to the 0-1 test.
    """
    strongest = lines.frequency[0] if len(lines.frequency) else np.inf
    periods = int(1 / (strongest * observation.forcing.period))
    most = len(signal) // (observation.forcing.samples * _SECTION_POINTS)
    return signal[:: observation.forcing.samples * max(1, min(periods, most))]
