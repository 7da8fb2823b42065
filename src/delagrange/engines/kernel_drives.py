"""Drives as the rows of numbers that a compiled kernel reads."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from delagrange.drives.drive import Constant, Drive, Line, Ramp, Sine, Step, Tabulated, Values
from delagrange.drives.phase import fraction_of_period
from delagrange.problem.problem import Problem

Row = tuple[Values, Values, Values, Values, Values]  # level, slope, amplitude, frequency, phase in turns
_KNOWN = (Constant, Line, Ramp, Sine, Step, Tabulated)


def is_known(drive: Drive) -> bool:
    """Whether a compiled kernel can follow a drive: one whose pieces are lines and sines.

    A subclass of such a drive may say anything about its values, and is not known.
    """
    return type(drive) in _KNOWN


def piece_rows(problem: Problem, spans: list[tuple[float, float]], kernel: ModuleType) -> np.ndarray:
    """The drives in each span of time, (n_spans, 5 * n_inputs, n_lanes), or 1 where all lanes have them in common."""
    pieces = [problem.piece(*span).drives for span in spans]
    rows = [[_row(drive, start) for drive in drives] for drives, (start, _) in zip(pieces, spans)]
    shape = np.broadcast_shapes((1,), *(np.shape(value) for piece in rows for row in piece for value in row))
    table = np.empty((len(spans), 5 * len(problem.drives), *shape))
    for number, piece in enumerate(rows):
        for place, row in enumerate(piece):
            for start, value in zip(_starts(kernel), row, strict=True):
                table[number, start + place] = value
    return table


def _starts(kernel: ModuleType) -> tuple[int, ...]:
    return kernel.LEVEL, kernel.SLOPE, kernel.AMPLITUDE, kernel.FREQUENCY, kernel.PHASE


def _row(drive: Drive, start: float) -> Row:
    """The smooth drive as a line in the time since `start` [s] and a sine of the time."""
    match drive:
        case Constant():
            return drive.value, 0.0, 0.0, 1.0, 0.0
        case Line():
            return drive.at(start), drive.slope, 0.0, 1.0, 0.0
        case Sine():
            return drive.bias, 0.0, drive.amplitude, drive.frequency, fraction_of_period(drive.phase)
    raise TypeError(f"no compiled kernel follows {drive}")
