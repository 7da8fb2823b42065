"""Whether a frequency is a whole-number combination of others, and whether that may be chance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

_LARGEST_ORDER = {1: 60, 2: 40, 3: 18, 4: 9, 5: 6}  # by the number of bases: some thousand combinations each
_DENOMINATORS = (1, 2, 3, 4, 5, 6, 8)
_BY_CHANCE = 0.02  # probability below which a match is believed


@dataclass(frozen=True)
class Bases:
    """Frequencies [Hz] of which others may be made, with their accuracies [Hz]."""

    frequency: np.ndarray  # (n,)
    accuracy: np.ndarray  # (n,)

    def with_one_more(self, frequency: float, accuracy: float) -> Bases:
        """The same with another one at the end."""
        return Bases(np.append(self.frequency, frequency), np.append(self.accuracy, accuracy))


@dataclass(frozen=True)
class Relation:
    """frequency = sum of integers * bases / denominator."""

    integers: tuple[int, ...]
    denominator: int


def relation(frequency: float, accuracy: float, bases: Bases) -> Relation | None:
    """The simplest relation of a frequency [Hz] with the bases that holds within the accuracies.

    None where there is none, or only one so intricate that some such would be found by chance.
    """
    count = len(bases.frequency)
    if count == 0:
        return None
    combinations, orders = _combinations(count)
    sums = combinations @ bases.frequency
    doubts = np.abs(combinations) @ bases.accuracy
    found: list[tuple[float, Relation]] = []
    for denominator in _DENOMINATORS:
        tolerance = denominator * accuracy + doubts
        places = np.flatnonzero(np.abs(sums - denominator * frequency) <= tolerance)
        if len(places):
            place = int(places[np.argmin(orders[places])])
            integers = tuple(int(k) for k in combinations[place])
            chance = _chance(int(orders[place]), denominator, float(tolerance[place]), bases)
            found.append((chance, Relation(integers, denominator)))
    chance, simplest = min(found, key=lambda entry: entry[0], default=(1.0, None))
    return simplest if chance < _BY_CHANCE else None


def _chance(order: int, denominator: int, tolerance: float, bases: Bases) -> float:
    """How many matches as simple as this one a frequency put at random would have."""
    _, orders = _combinations(len(bases.frequency))
    tried = float(np.sum(orders <= order)) * denominator
    width = 2 * order * float(np.max(bases.frequency))  # over which these combinations are spread
    return tried * 2 * tolerance / width


@cache
def _combinations(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Integers (n, count), not all zero, up to the largest order, and their orders (n,), sums of magnitudes."""
    largest = _LARGEST_ORDER[count]
    grid = np.meshgrid(*[np.arange(-largest, largest + 1)] * count, indexing="ij")
    integers = np.stack([axis.ravel() for axis in grid], axis=1)
    orders = np.sum(np.abs(integers), axis=1)
    kept = (orders > 0) & (orders <= largest)
    return integers[kept], orders[kept]
