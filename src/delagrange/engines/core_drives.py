"""Drives as the rows of numbers that the core reads: one encoding for runs side by side, single runs and tangents."""

from __future__ import annotations

import numpy as np

from delagrange.core.structures import AMPLITUDE, DRIVE_ROWS, FREQUENCY, LEVEL, PHASE, SLOPE
from delagrange.drives.drive import Constant, Drive, Line, Sine, Values
from delagrange.drives.phase import fraction_of_period
from delagrange.problem.problem import Problem

Row = dict[int, Values]


def piece_rows(problem: Problem, spans: list[tuple[float, float]]) -> np.ndarray:
    """The drives in each span of time, (n_spans, DRIVE_ROWS, n_inputs, n_lanes), or 1 where all have them in common.

    Raises:
        TypeError: a drive that is not made of lines and sines.
    """
    rows = [[drive_row(drive, start) for drive in problem.piece(start, stop).drives] for start, stop in spans]
    values = [value for piece in rows for row in piece for value in row.values()]
    shape = np.broadcast_shapes((1,), *(np.shape(value) for value in values))
    table = np.zeros((len(spans), DRIVE_ROWS, len(problem.drives), *shape))
    for number, piece in enumerate(rows):
        for place, row in enumerate(piece):
            for kind, value in row.items():
                table[number, kind, place] = value
    return table


def drive_row(drive: Drive, start: float) -> Row:
    """A smooth drive as a line from `start` [s] on and a sine of the time."""
    match drive:
        case Constant():
            return {LEVEL: drive.value}
        case Line():
            return {LEVEL: drive.at(start), SLOPE: drive.slope}
        case Sine():
            turns = fraction_of_period(drive.phase)
            return {LEVEL: drive.bias, AMPLITUDE: drive.amplitude, FREQUENCY: drive.frequency, PHASE: turns}
    raise TypeError(f"no compiled code follows {drive}")
