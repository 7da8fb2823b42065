"""Drives: values, breakpoints, smooth pieces, lanes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange import Constant, Ramp, Sine, Step, Tabulated
from delagrange.drives.drive import as_drive

finite = st.floats(-1e6, 1e6)
times = st.floats(0.0, 10.0)
tables = st.lists(st.tuples(st.floats(0.1, 2.0), finite), min_size=3, max_size=6).map(
    lambda rows: Tabulated(np.cumsum([row[0] for row in rows]) - rows[0][0], [row[1] for row in rows])
)


@given(amplitude=finite, frequency=st.floats(1e-3, 1e3), bias=finite, phase=finite, time=times)
def test_sine(amplitude, frequency, bias, phase, time):
    drive = Sine(amplitude, frequency, bias, phase)
    assert drive.at(time) == pytest.approx(
        bias + amplitude * np.sin(2 * np.pi * frequency * time + phase), rel=1e-12, abs=1e-6
    )
    assert drive.breakpoints(0.0, 10.0) == ()


def test_step_is_right_continuous_and_its_pieces_are_not_mixed():
    drive = Step(2.0, time=1.0, before=-1.0)
    np.testing.assert_array_equal(drive.at(np.array([0.0, 1.0, 3.0])), [-1.0, 2.0, 2.0])
    assert drive.breakpoints(0.0, 3.0) == (1.0,)
    assert drive.breakpoints(1.0, 3.0) == ()
    assert drive.piece(0.0, 1.0).at(1.0) == -1.0  # the limit from inside
    assert drive.piece(1.0, 3.0).at(1.0) == 2.0


def test_ramp():
    drive = Ramp(1.0, 3.0, duration=2.0, begin=0.5)
    np.testing.assert_allclose(drive.at(np.array([0.0, 0.5, 1.5, 2.5, 9.0])), [1, 1, 2, 3, 3])
    assert drive.breakpoints(0.0, 9.0) == (0.5, 2.5)


@given(table=tables)
def test_tabulated_passes_through_its_values(table):
    np.testing.assert_allclose(table.at(table.times), table.values)
    middle = (table.times[:-1] + table.times[1:]) / 2
    np.testing.assert_allclose(table.at(middle), (table.values[:-1] + table.values[1:]) / 2, atol=1e-6)


@given(
    drive=st.one_of(
        tables,
        st.builds(Step, finite, times, finite),
        st.builds(Ramp, finite, finite, st.floats(0.1, 3.0), times),
        st.builds(Constant, finite),
    ),
    fraction=st.floats(0.0, 1.0, exclude_min=True, exclude_max=True),
)
def test_pieces_between_breakpoints_equal_the_drive(drive, fraction):
    stop = float(drive.times[-1]) if isinstance(drive, Tabulated) else 12.0
    bounds = (0.0, *drive.breakpoints(0.0, stop), stop)
    assert list(bounds) == sorted(set(bounds))
    for start, end in pairwise(bounds):
        time = start + fraction * (end - start)
        if start < time < end:
            assert drive.piece(start, end).at(time) == pytest.approx(drive.at(time), rel=1e-6, abs=1e-6 * 1e6)


def test_lanes_are_taken_from_arrays_only():
    drive = Sine(np.array([1.0, 2.0, 3.0]), 5.0, phase=np.array([0.0, 0.1, 0.2]))
    some = drive.take(np.array([2, 0]))
    np.testing.assert_array_equal(some.amplitude, [3.0, 1.0])
    np.testing.assert_array_equal(some.phase, [0.2, 0.0])
    assert some.frequency == 5.0
    np.testing.assert_array_equal(drive.at(0.3)[[2, 0]], some.at(0.3))


def test_a_number_means_a_constant():
    assert as_drive("force", 0.5, "N") == Constant(0.5)
    assert str(Sine(5e6, 371.0)) == "Sine(amplitude=5000000, frequency=371, bias=0, phase=0)"


@pytest.mark.parametrize(
    ("build", "named"),
    [
        (lambda: Sine(1.0, 0.0), "Sine frequency .* 0 Hz"),
        (lambda: Sine(1.0, -3.0), "Sine frequency"),
        (
            lambda: Sine(float("nan"), 1.0),
            "Sine amplitude must be finite, got nan in the unit of the driven input",
        ),
        (lambda: Sine(1j, 1.0), "Sine amplitude must be a number"),
        (lambda: Tabulated([0.0, 1.0], np.ones((2, 2))), "one length .* 2 times"),
        (lambda: Constant("a"), "Constant value"),
        (lambda: Step(1.0, time=float("inf")), "Step time .* s"),
        (lambda: Ramp(0.0, 1.0, duration=0.0), "Ramp duration .* 0 s"),
        (lambda: Tabulated([0.0, 0.0], [1.0, 2.0]), "Tabulated times must be strictly increasing"),
        (lambda: Tabulated([0.0, 1.0], [1.0]), "one length"),
        (lambda: Tabulated([0.0], [1.0]), "at least 2"),
        (lambda: Tabulated([0.0, 1.0], [1.0, float("nan")]), "Tabulated values"),
        (lambda: as_drive("force", None, "N"), "force must be a number in N"),
    ],
)
def test_senseless_drives_are_refused(build, named):
    with pytest.raises(ValueError, match=named) as caught:
        build()
    assert "\n" not in str(caught.value)
