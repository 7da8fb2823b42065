"""The 0-1 test on sequences whose kind is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delagrange.analysis.motion.zero_one import MOST, zero_one


def logistic(parameter, count=1500, start=0.3, transient=500):
    values = [start]
    for _ in range(transient + count):
        values.append(parameter * values[-1] * (1 - values[-1]))
    return np.array(values[-count:])


@pytest.mark.parametrize("parameter", [3.9, 3.97, 4.0])
def test_chaotic_logistic_maps_walk(parameter):
    assert zero_one(logistic(parameter)) > 0.95


@pytest.mark.parametrize("parameter", [3.2, 3.5, 3.55, 3.83])
def test_periodic_logistic_maps_stay(parameter):
    assert abs(zero_one(logistic(parameter))) < 0.1


@settings(max_examples=15)
@given(
    first=st.floats(0.05, 0.45),
    second=st.floats(0.05, 0.45),
    offset=st.floats(-10, 10),
    phase=st.floats(0, 6.28),
)
def test_sums_of_sines_stay(first, second, offset, phase):
    number = np.arange(2000)
    signal = offset + np.cos(2 * np.pi * first * number) + 0.5 * np.cos(2 * np.pi * second * number + phase)
    assert abs(zero_one(signal)) < 0.3


@settings(max_examples=10)
@given(scale=st.floats(1e-6, 1e6), seed=st.integers(0, 99))
def test_noise_walks_at_any_scale(scale, seed):
    signal = np.random.default_rng(seed).standard_normal(1000)
    assert zero_one(signal) > 0.9
    assert zero_one(scale * signal) == pytest.approx(zero_one(signal), abs=1e-9)


def test_a_point_that_stays_is_regular_and_too_few_points_say_nothing():
    assert zero_one(np.full(500, 1.3)) == 0.0
    assert zero_one(1.3 + 1e-12 * np.random.default_rng(0).standard_normal(500), smallest=1e-9) == 0.0
    assert np.isnan(zero_one(logistic(4.0, count=150)))


def test_more_points_than_needed_change_nothing():
    points = logistic(3.9, count=MOST + 500)
    assert zero_one(points) == zero_one(points[:MOST])
