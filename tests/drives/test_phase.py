"""The phase of a sine against rational arithmetic, after 10^9 turns, in every engine."""

from __future__ import annotations

from fractions import Fraction
from importlib import import_module

import mpmath
import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import delagrange as dl
from delagrange.engines.flow import PHASE, drive_slope
from delagrange.engines.kernel_drives import piece_rows
from delagrange.problem.problem import make_problem

KINDS = ("lanes", "variational")
LONG = [(371.0, 2.7e6 + 1 / 3), (1e3 / 3, 3e6 + 1e-4), (98765.4321, 12345.6789)]  # [Hz], [s]: 10^9 turns
MICROTURN = 1e-6
EXACT = 1e-12  # turns, of the compiled kernels; a rounded product is off by 1e-7


def kernel_of(kind):
    return import_module(f"delagrange.generated.equal_biaxial_{kind}")


def turns(frequency, time, phase=0.0):
    return Fraction(frequency) * Fraction(time) + Fraction(phase)


def off(found, exact):
    """How far `found` turns are from the exact ones, whole turns left out."""
    difference = Fraction(float(found)) - exact
    return float(abs(difference - round(difference)))


def sine_of(exact):
    with mpmath.workdps(40):
        part = exact - round(exact)
        return float(mpmath.sin(2 * mpmath.pi * mpmath.mpf(part.numerator) / part.denominator))


def test_the_cases_have_turned_a_thousand_million_times():
    assert all(9e8 < turns(*case) < 1.3e9 for case in LONG)
    assert max(off(frequency * time, turns(frequency, time)) for frequency, time in LONG) > 1e4 * EXACT


@given(frequency=st.floats(1e-3, 1e5), time=st.floats(-1e7, 1e7))
def test_turns_are_exact(frequency, time):
    """frequency * time modulo 1 is right to the last digits, however many whole turns there are."""
    exact = turns(frequency, time)
    ours = [kernel_of(kind)._fraction_of_turns.py_func(frequency, time) for kind in KINDS]
    assert all(off(found, exact) < 1e-15 and abs(found) < 1 for found in ours)
    assert len(set(ours)) == 1  # one way, to the last digit


def lanes_drives(frequency, time, start=0.0):
    """Argument [turns] and value of a sine of amplitude 1 and phase 0.25 turns in a compiled lane, at the start of
    a step at `time` in a piece that began at `start`."""
    kernel = kernel_of("lanes")
    begin, inputs, lanes = kernel._begin_inputs, kernel._inputs, kernel.LANES
    drives = piece_rows(driven(frequency), [(start, np.inf)], kernel)[0]
    work, vibrates = np.zeros(kernel.SIZE), np.array([False, True])
    work[kernel.TIME : kernel.TIME + lanes], work[kernel.START : kernel.START + lanes] = time, start
    work[kernel.DRIVE : kernel.DRIVE + drives.size * lanes] = np.repeat(drives.ravel(), lanes)

    @numba.njit
    def at_the_start(work, vibrates):
        begin(work, vibrates)
        inputs(work, 0.0, vibrates)

    at_the_start(work, vibrates)
    return work[kernel.TURNS + lanes], work[kernel.INPUT + lanes]


def variational_drives(frequency, time, start=0.0):
    """The same in the variational kernel, `start` the last of the times that was reached."""
    kernel = kernel_of("variational")
    begin, drive = kernel._begin_drives, kernel._drive
    frame, sources = np.zeros(kernel.COLUMN), np.zeros((0, 2), dtype=np.int64)
    numbers = frame[kernel.DRIVE :].reshape(-1)
    for row, value in ((kernel.AMPLITUDE, 1.0), (kernel.FREQUENCY, frequency), (kernel.PHASE, 0.25)):
        numbers[row + 1] = value

    @numba.njit
    def at_the_start(frame, sources, start, since):
        begin(frame, start, since)
        drive(frame, sources, 0, 0.0)

    at_the_start(frame, sources, start, time - start)
    return frame[kernel.TURNS + 1], frame[kernel.INPUT + 1]


def driven(frequency):
    model = dl.load_model("equal_biaxial")
    return make_problem(model, dl.SHENG_2015, {}, None, 0.0, dl.Sine(1.0, frequency, phase=np.pi / 2))


@pytest.mark.parametrize("drives", [lanes_drives, variational_drives])
@pytest.mark.parametrize(("frequency", "time"), LONG)
@pytest.mark.parametrize("start", [0.0, 1024.0])
def test_a_compiled_drive_keeps_its_phase(drives, frequency, time, start):
    """Compiled, where products may be fused with sums, and wherever its piece of time began."""
    argument, value = drives(frequency, start + (time - start), start)
    exact = turns(frequency, start + (time - start), 0.25)
    assert off(argument, exact) < EXACT < MICROTURN
    assert value == pytest.approx(sine_of(exact), abs=1e-11)


@pytest.mark.parametrize(("frequency", "time"), LONG)
def test_a_drive_of_the_other_engines_keeps_its_phase(frequency, time):
    """To a microturn: that of the NumPy and the SciPy engine, at one time and at many, and its slope by its phase."""
    off_by = 2 * np.pi * MICROTURN
    exact = turns(frequency, time)
    sine = dl.Sine(1.0, frequency)
    assert sine.at(time) == pytest.approx(sine_of(exact), abs=off_by)
    assert sine.at(np.array([0.0, time])) == pytest.approx([0.0, sine_of(exact)], abs=off_by)
    slope = drive_slope(np.array([0.0, 1.0, frequency, 0.0]), PHASE, time)
    assert slope == pytest.approx(sine_of(exact + Fraction(1, 4)), abs=off_by)
