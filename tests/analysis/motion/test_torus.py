"""Spectral lines far sharper than a bin, and the base frequencies that they are made of."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delagrange.analysis.motion import lattice
from delagrange.analysis.motion.frequency_relations import Bases, relation
from delagrange.analysis.motion.spectral_lines import band, find_lines
from delagrange.analysis.motion.torus import torus

INTERVAL = 1 / 5000.0  # [s]
DRIVE, FREE, OTHER = 742.0, 517.2126549813, 834.9412476646  # [Hz]


def signal_of(lines, count=20001, mean=0.0):
    """lines: (frequency [Hz], amplitude, phase [rad]) of each."""
    time = INTERVAL * np.arange(count)
    return mean + sum(a * np.cos(2 * np.pi * f * time + phase) for f, a, phase in lines)


def combined(terms, bases):
    """Lines from (integers, amplitude) and base frequencies."""
    return [(abs(np.dot(k, bases)), a, 0.3 + place) for place, (k, a) in enumerate(terms)]


# --- lines -------------------------------------------------------------------------------------------


@settings(max_examples=25)
@given(data=st.data(), count=st.sampled_from([5000, 5001, 9973]), mean=st.floats(-5, 5))
def test_lines_come_back_to_rounding(data, count, mean):
    width = 1 / (count * INTERVAL)
    places = data.draw(st.lists(st.integers(1, 60), min_size=1, max_size=12, unique=True))
    shifts = data.draw(st.lists(st.floats(-0.4, 0.4), min_size=len(places), max_size=len(places)))
    powers = data.draw(st.lists(st.floats(-4, 0), min_size=len(places), max_size=len(places)))
    lines = [(width * (35 * p + 10 * s), 10**e, 3 * s) for p, s, e in zip(places, shifts, powers)]
    found = find_lines(signal_of(lines, count, mean), INTERVAL, residue=1e-20)
    order = np.argsort([-a for _, a, _ in lines], kind="stable")
    expected = np.array(lines)[order]
    np.testing.assert_allclose(np.sort(found.frequency), np.sort(expected[:, 0]), atol=1e-6 * width)
    np.testing.assert_allclose(found.amplitude, expected[:, 1], rtol=1e-7)
    assert found.residue < 1e-18


def test_neighbours_a_few_bins_apart_are_told_apart():
    width = 1 / (5001 * INTERVAL)
    lines = [(700.0, 1.0, 0.2), (700.0 + 5 * width, 0.01, 1.0), (700.0 - 9 * width, 1e-4, 2.0)]
    found = find_lines(signal_of(lines, 5001), INTERVAL, residue=1e-20)
    np.testing.assert_allclose(found.frequency, [f for f, _, _ in lines], atol=1e-6 * width)


def test_the_accuracy_bounds_the_error():
    noise = 1e-4 * np.random.default_rng(3).standard_normal(20001)
    lines = [(DRIVE, 1.0, 0.0), (FREE, 0.1, 1.0), (OTHER, 0.01, 2.0)]
    found = find_lines(signal_of(lines) + noise, INTERVAL, most=3)
    error = np.abs(found.frequency - [f for f, _, _ in lines])
    assert np.all(error < found.accuracy)
    assert np.all(found.accuracy < 0.1 * found.resolution)


def test_noise_and_nothing():
    noise = np.random.default_rng(4).standard_normal(5000)
    assert find_lines(noise, INTERVAL).residue > 0.5
    nothing = find_lines(np.full(500, 2.0), INTERVAL)
    assert len(nothing.frequency) == 0 and nothing.residue == 0.0


def test_the_band_shows_the_lines_and_their_heights():
    lines = [(DRIVE, 1.0, 0.0), (FREE, 0.1, 1.0)]
    shown = band(signal_of(lines, mean=7.0), INTERVAL, parts=400)
    assert shown.frequency[np.argmax(shown.amplitude)] == pytest.approx(DRIVE, abs=10.0)
    assert 0.8 < np.max(shown.amplitude) <= 1.0 + 1e-9
    assert np.all(np.diff(shown.frequency) > 0)


# --- relations and lattices --------------------------------------------------------------------------


@settings(max_examples=40)
@given(k=st.integers(-9, 9), m=st.integers(-6, 6), denominator=st.sampled_from([1, 2, 3]))
def test_a_combination_is_recognised(k, m, denominator):
    frequency = (k * DRIVE + m * FREE) / denominator
    if frequency < 1.0:
        return
    found = relation(frequency, 1e-6, Bases(np.array([DRIVE, FREE]), np.array([0.0, 1e-7])))
    made = np.array(found.integers) / found.denominator
    np.testing.assert_allclose(made, [k / denominator, m / denominator], atol=1e-12)


def test_an_intricate_match_within_a_poor_accuracy_is_chance():
    bases = Bases(np.array([DRIVE, FREE]), np.array([0.0, 0.1]))
    assert relation(OTHER, 2.0, bases) is None
    assert relation(OTHER, 1e-7, bases) is None


@given(
    rows=st.lists(st.tuples(*[st.fractions(-4, 4, max_denominator=4)] * 3), min_size=1, max_size=5).filter(
        lambda rows: any(any(row) for row in rows)
    )
)
def test_a_basis_makes_every_row_by_whole_numbers_and_no_smaller_set_does(rows):
    basis = lattice.basis(rows)
    for row in rows:
        integers = lattice.coordinates(row, basis)
        made = [sum(k * each[place] for k, each in zip(integers, basis)) for place in range(3)]
        assert made == list(row)
    matrix = np.array([[float(entry) for entry in row] for row in rows])
    assert len(basis) == np.linalg.matrix_rank(matrix)


def test_what_is_no_combination_is_refused():
    with pytest.raises(ValueError, match="no whole-number combination"):
        lattice.coordinates((Fraction(1, 2),), [(Fraction(1),)])


@given(
    rows=st.lists(st.tuples(*[st.integers(-9, 9)] * 4), min_size=1, max_size=3).filter(
        lambda rows: lattice.extends(rows)
    )
)
def test_rows_without_a_common_divisor_are_completed_to_a_basis(rows):
    whole = lattice.completed(rows, 4)
    assert whole[: len(rows)] == rows
    assert abs(np.linalg.det(np.array(whole, dtype=float))) == pytest.approx(1.0, abs=1e-6)


# --- tori --------------------------------------------------------------------------------------------


def torus_of(terms, bases, drives=(DRIVE,), most=4, count=20001):
    found = find_lines(signal_of(combined(terms, bases), count), INTERVAL, residue=1e-18)
    return torus(found, drives, most), found


def test_three_base_frequencies():
    terms = [((0, 1, 0), 1.0), ((0, 0, 1), 0.5), ((1, 0, 0), 0.2), ((1, -1, 0), 0.1), ((2, 0, -1), 0.05),
             ((0, 1, 1), 0.02), ((1, 1, -1), 0.01), ((3, 0, 0), 1e-3)]  # fmt: skip
    found, lines = torus_of(terms, (DRIVE, OTHER, FREE))
    np.testing.assert_allclose(found.base_frequencies, [DRIVE, OTHER, FREE], atol=1e-7)
    assert (found.dimension, found.period_multiple) == (3, 1)
    assert np.all(found.explained)
    np.testing.assert_allclose(np.abs(found.integers @ found.base_frequencies), lines.frequency, atol=1e-6)


def test_the_smallest_set_is_found_where_the_strongest_line_is_a_multiple():
    """Twice a frequency strongest, three times it next, itself nowhere: its sum with the drive is a base."""
    found, lines = torus_of([((2, 0), 1.0), ((3, 0), 0.5), ((0, 1), 0.3), ((1, 1), 0.1)], (FREE, DRIVE))
    np.testing.assert_allclose(found.base_frequencies, [DRIVE, DRIVE + FREE], atol=1e-6)
    np.testing.assert_allclose(np.abs(found.integers @ found.base_frequencies), lines.frequency, atol=1e-6)


@pytest.mark.parametrize("multiple", [1, 2, 3, 4])
def test_a_motion_of_several_periods_of_the_drive_is_periodic(multiple):
    terms = [((multiple,), 1.0), ((1,), 0.1), ((multiple + 1,), 0.05), ((2 * multiple,), 0.01)]
    found, _ = torus_of(terms, (DRIVE / multiple,))
    assert (found.dimension, found.period_multiple) == (1, multiple)
    assert found.base_frequencies[0] == pytest.approx(DRIVE / multiple, rel=1e-14)
    assert np.all(found.explained)


def test_a_free_motion_has_its_own_base_and_two_drives_both():
    found, _ = torus_of([((1,), 1.0), ((2,), 0.1)], (FREE,), drives=())
    assert found.dimension == 1 and found.base_frequencies[0] == pytest.approx(FREE, abs=1e-7)
    both, _ = torus_of([((1, 0), 1.0), ((0, 1), 0.1)], (DRIVE, 200.0), drives=(200.0, DRIVE))
    assert both.dimension == 2 and both.drives == 2
    np.testing.assert_array_equal(both.base_frequencies, [200.0, DRIVE])


def test_the_drive_counts_though_no_line_shows_it():
    found, _ = torus_of([((1,), 1.0)], (FREE,))
    np.testing.assert_allclose(found.base_frequencies, [DRIVE, FREE], atol=1e-7)


def test_too_many_independent_lines_stay_unexplained():
    frequencies = DRIVE / np.sqrt([2, 3, 5, 7, 11])
    terms = [(tuple(np.eye(5, dtype=int)[place]), 1.0 / (place + 1)) for place in range(5)]
    found, _ = torus_of(terms, frequencies, most=3)
    assert found.dimension == 3
    assert np.sum(~found.explained) == 3


@settings(max_examples=15, deadline=None)
@given(
    first=st.floats(300.0, 500.0), second=st.floats(550.0, 900.0), phase=st.floats(0, 6.28),
    integers=st.lists(st.tuples(st.integers(-2, 2), st.integers(-2, 2), st.integers(-2, 2)), max_size=6),
)  # fmt: skip
def test_any_signal_on_a_torus_is_explained(first, second, phase, integers):
    bases = np.array([DRIVE, first, second])
    terms = [((0, 1, 0), 1.0), ((0, 0, 1), 0.6), ((1, 0, 0), 0.3)]
    terms += [(k, 0.01) for k in set(integers) if 5 < abs(np.dot(k, bases)) < 2400]
    found, lines = torus_of(terms, bases)
    if np.min(np.diff(np.sort(np.abs([np.dot(k, bases) for k, _ in terms])))) < 1.5:
        return  # lines that this record cannot tell apart
    assert np.all(found.explained[lines.power_share > 1e-8])
    assert found.dimension <= 3
