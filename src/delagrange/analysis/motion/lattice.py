"""Integer lattices: the smallest set of rows of which all given rows are whole-number combinations."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from math import gcd, lcm

import numpy as np

Row = tuple[Fraction, ...]


def basis(rows: list[Row]) -> list[Row]:
    """Rows in echelon form that span, by whole numbers, the same lattice as `rows` (Hermite's form)."""
    denominator = lcm(1, *(entry.denominator for row in rows for entry in row))
    whole = [[int(entry * denominator) for entry in row] for row in rows]
    reduced = _echelon(whole)
    return [tuple(Fraction(entry, denominator) for entry in row) for row in reduced]


def _echelon(rows: list[list[int]]) -> list[list[int]]:
    """Euclid's algorithm on rows of integers, column by column; rows of zeros go."""
    rows = [list(row) for row in rows]
    done: list[list[int]] = []
    for column in range(len(rows[0]) if rows else 0):
        while True:
            active = [row for row in rows if row[column] != 0]
            if len(active) <= 1:
                break
            pivot = min(active, key=lambda row: abs(row[column]))
            for row in active:
                if row is not pivot:
                    _subtract(row, pivot, row[column] // pivot[column])
        if active:
            done.append(active[0])
            rows = [row for row in rows if row is not active[0]]
    return done


def _subtract(row: list[int], pivot: list[int], times: int) -> None:
    for place, entry in enumerate(pivot):
        row[place] -= times * entry


def coordinates(row: Row, of: list[Row]) -> tuple[int, ...]:
    """The integers by which the rows `of`, a basis, make `row`.

    Raises:
        ValueError: no integers do.
    """
    matrix = np.array([[float(entry) for entry in each] for each in of]).T
    solution, *_ = np.linalg.lstsq(matrix, np.array([float(entry) for entry in row]), rcond=None)
    integers = tuple(round(float(value)) for value in solution)
    made = [sum(k * each[place] for k, each in zip(integers, of)) for place in range(len(row))]
    if made != list(row):
        raise ValueError(f"row {row} is no whole-number combination of {of}")
    return integers


def extends(chosen: list[tuple[int, ...]]) -> bool:
    """Whether rows of integers can be completed to a basis of all integer rows of their length.

    They can where the largest common divisor of their largest minors is 1.
    """
    size = len(chosen)
    matrix = np.array(chosen, dtype=float)
    minors = (np.linalg.det(matrix[:, places]) for places in combinations(range(matrix.shape[1]), size))
    return gcd(*(round(float(minor)) for minor in minors)) == 1


def completed(chosen: list[tuple[int, ...]], length: int) -> list[tuple[int, ...]]:
    """`chosen`, which `extends`, and rows that complete it to a basis of all integer rows of `length`."""
    rows = [list(row) for row in chosen]
    inverse = [[int(row == column) for column in range(length)] for row in range(length)]
    for place in range(len(rows)):
        _clear_behind(rows, inverse, place)
    return [*chosen, *(tuple(row) for row in inverse[len(chosen) :])]


def _clear_behind(rows: list[list[int]], inverse: list[list[int]], place: int) -> None:
    """Euclid's algorithm on columns, until row `place` has nothing behind its own column.

    Each operation on the columns of `rows` is undone on the rows of `inverse`: their product stays.
    """
    row = rows[place]
    while any(row[place + 1 :]):
        places = [column for column in range(place, len(row)) if row[column] != 0]
        pivot = min(places, key=lambda column: abs(row[column]))
        for column in places:
            if column != pivot:
                times = row[column] // row[pivot]
                for each in rows:
                    each[column] -= times * each[pivot]
                _subtract(inverse[pivot], inverse[column], -times)
        if not any(row[column] for column in range(place, len(row)) if column != pivot) and pivot != place:
            for each in rows:
                each[place], each[pivot] = each[pivot], each[place]
            inverse[place], inverse[pivot] = inverse[pivot], inverse[place]
