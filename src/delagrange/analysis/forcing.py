"""At which frequencies a motion is forced, and at which times it is looked at."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import gcd, lcm

import numpy as np

from delagrange.engines.flow import AMPLITUDE, BIAS, FREQUENCY, drive_numbers
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.problem import Problem

_SAMPLES = 8  # in a forcing period, and in a period of the fastest small vibration
_FREE_SAMPLES = 16  # in that period where nothing is forced: no folded line then counts as one of its own
_LARGEST_RATIO = 50  # of two drive frequencies that count as commensurate
_SAME = 1e-12  # relative


@dataclass(frozen=True)
class Forcing:
    """What the drives ask for; a field without bias enters squared and forces at twice its frequency."""

    frequencies: tuple[float, ...]  # [Hz], with no common measure; empty where all drives are constant
    period: float  # [s] of the stroboscopic section: of the first frequency, or of the fastest vibration
    samples: int  # in a period
    fastest: float  # [Hz], of the fastest small vibration about the reference state, loaded as at t = 0

    @property
    def interval(self) -> float:
        """Time between two samples [s]."""
        return self.period / self.samples


def forcing(problem: Problem, start: np.ndarray) -> Forcing:
    """How `problem` is forced, and how densely a motion from the state `start`, (n_state,), is to be sampled.

    Raises:
        ValueError: a drive that is neither constant nor a sine.
    """
    frequencies = _independent(_forcing_frequencies(problem, start))
    fastest = fastest_vibration(problem, start)
    if not frequencies:
        return Forcing((), 1 / fastest, _FREE_SAMPLES, fastest)
    samples = _SAMPLES * max(1.0, fastest / frequencies[0])
    odd = 2 * int(np.ceil(samples / 2)) + 1  # no harmonic of the forcing at half the sampling frequency
    return Forcing(frequencies, 1 / frequencies[0], odd, fastest)


def fastest_vibration(problem: Problem, start: np.ndarray) -> float:
    """Frequency [Hz] of the fastest small vibration; without coordinates, of the fastest rate at `start`."""
    count = problem.model.COORDINATE_COUNT
    if count:
        return float(typical_sizes(problem)[count]) / (2 * np.pi)
    rates = np.abs(np.linalg.eigvals(problem.jacobian(0.0, start)))
    return float(np.max(rates)) / (2 * np.pi) or 1.0


def enters_squared(problem: Problem, place: int, state: np.ndarray) -> bool:
    """Whether the rates at `state` do not know the sign of the input at `place` of model.INPUTS."""
    inputs = [1.0] * len(problem.model.INPUTS)
    mirrored = list(inputs)
    mirrored[place] = -1.0
    rates = (problem.model.rhs(state, values, problem.parameters) for values in (inputs, mirrored))
    return bool(np.array_equal(*rates))


def _forcing_frequencies(problem: Problem, state: np.ndarray) -> list[float]:
    found = []
    for place, numbers in enumerate(drive_numbers(problem)):
        if numbers[AMPLITUDE] != 0.0:
            doubled = numbers[BIAS] == 0.0 and enters_squared(problem, place, state)
            found.append(float(numbers[FREQUENCY]) * (2 if doubled else 1))
    return found


def _independent(frequencies: list[float]) -> tuple[float, ...]:
    """The largest common measure of all where they have one, else each by itself, the lowest first."""
    if not frequencies:
        return ()
    first = frequencies[0]
    ratios = [Fraction(value / first).limit_denominator(_LARGEST_RATIO) for value in frequencies]
    if all(abs(float(ratio) * first - value) <= _SAME * value for ratio, value in zip(ratios, frequencies)):
        denominator = lcm(*(ratio.denominator for ratio in ratios))
        numerator = gcd(*(int(ratio * denominator) for ratio in ratios))
        return (first * numerator / denominator,)
    return tuple(sorted(set(frequencies)))
