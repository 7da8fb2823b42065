"""The torus on which a regular motion moves: base frequencies of which every line is a combination."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import gcd

import numpy as np

from delagrange.analysis.motion import lattice
from delagrange.analysis.motion.frequency_relations import Bases, relation
from delagrange.analysis.motion.spectral_lines import Lines

_INDEPENDENT = 1e-6  # share of the power that a line must have to be taken for a frequency of its own
_SHARP = 0.05  # [bins], how accurately it must be known
_SAFETY = 2.0  # times the accuracy of a line, within which a combination must meet it
_ROUNDING = 1e-9  # relative accuracy of any frequency of a motion that was integrated
_FLOOR = 1e-5  # [bins], accuracy that is believed at best


@dataclass(frozen=True)
class Torus:
    """Base frequencies, and how the lines are made of them."""

    base_frequencies: np.ndarray  # (n_bases,) [Hz], the drive's first, positive
    accuracy: np.ndarray  # (n_bases,) [Hz]
    integers: np.ndarray  # (n_lines, n_bases), zero where a line is not explained
    explained: np.ndarray  # (n_lines,) of bool
    period_multiple: int  # the first base is the drive's first frequency over this
    drives: int  # how many of the bases are the drives'

    @property
    def dimension(self) -> int:
        """Of the torus that the base frequencies span, the drives' included."""
        return len(self.base_frequencies)


def torus(lines: Lines, drives: tuple[float, ...], most: int) -> Torus:
    """The smallest set of base frequencies for the lines, found strongest first.

    Args:
        drives: forcing frequencies [Hz], exact, with no common measure.
        most: how many base frequencies there may be at most.
    """
    accuracy = _believed(lines)
    bases = Bases(np.array(drives, dtype=float), np.zeros(len(drives)))
    rows: list[tuple[Fraction, ...] | None] = []
    for place, frequency in enumerate(lines.frequency):
        found = relation(frequency, accuracy[place], bases)
        if found is not None:
            rows.append(tuple(Fraction(k, found.denominator) for k in found.integers))
        elif _may_be_base(lines, place, accuracy) and len(bases.frequency) < most:
            bases = bases.with_one_more(float(frequency), float(accuracy[place]))
            rows.append(_unit(len(bases.frequency) - 1))
        else:
            rows.append(None)
    return _of_rows([_padded(row, len(bases.frequency)) for row in rows], bases, len(drives))


def _believed(lines: Lines) -> np.ndarray:
    floor = _FLOOR * lines.resolution + _ROUNDING * lines.frequency
    return np.maximum(_SAFETY * lines.accuracy, floor)


def _may_be_base(lines: Lines, place: int, accuracy: np.ndarray) -> bool:
    return bool(lines.power_share[place] > _INDEPENDENT and accuracy[place] < _SHARP * lines.resolution)


def _unit(place: int) -> tuple[Fraction, ...]:
    return (*(Fraction(0) for _ in range(place)), Fraction(1))


def _padded(row: tuple[Fraction, ...] | None, length: int) -> tuple[Fraction, ...] | None:
    return None if row is None else (*row, *(Fraction(0) for _ in range(length - len(row))))


def _of_rows(rows: list[tuple[Fraction, ...] | None], bases: Bases, drives: int) -> Torus:
    """Rows say how each line is made of `bases` by fractions; the torus is made of whole numbers."""
    size = len(bases.frequency)
    own = [_padded(_unit(place), size) for place in range(drives)]
    spanning = lattice.basis([*own, *(row for row in rows if row is not None)])
    within = [None if row is None else lattice.coordinates(row, spanning) for row in rows]
    chosen, multiple = _chosen([lattice.coordinates(row, spanning) for row in own], within, len(spanning))
    fractions = _matrix(chosen) @ _matrix(spanning) if spanning else np.zeros((0, 0))
    frequency = fractions @ bases.frequency
    signs = np.where(frequency < 0, -1, 1)
    inverse = np.linalg.inv(_matrix(chosen)) if spanning else np.zeros((0, 0))
    integers = np.zeros((len(rows), len(chosen)), dtype=int)
    for place, row in enumerate(within):
        if row is not None:
            integers[place] = np.rint(np.array(row, dtype=float) @ inverse) * signs
    return Torus(
        frequency * signs,
        np.abs(fractions) @ bases.accuracy,
        integers,
        np.array([row is not None for row in rows], dtype=bool),
        multiple,
        drives,
    )


def _matrix(rows: list[tuple]) -> np.ndarray:
    return np.array([[float(entry) for entry in row] for row in rows])


def _chosen(
    drives: list[tuple[int, ...]], lines: list[tuple[int, ...] | None], size: int
) -> tuple[list[tuple[int, ...]], int]:
    """A basis of all integer rows of length `size`: what the drives divide, then the strongest lines that fit."""
    multiple = gcd(*drives[0]) if drives else 1
    chosen: list[tuple[int, ...]] = []
    primitive = [tuple(k // gcd(*row) for k in row) for row in drives]
    for row in (*primitive, *lines):
        if row is not None and len(chosen) < size and lattice.extends([*chosen, row]):
            chosen.append(row)
    return lattice.completed(chosen, size), multiple
