"""Eigenvalues of long products, with mpmath as a witness that multiplies them out in many digits."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delagrange.analysis.steady.periodic_qr import product_logarithms

DIGITS = 120


def rotation(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def block_diagonal(moduli, angles) -> np.ndarray:
    """Real eigenvalues, and conjugate pairs where an angle is given."""
    parts = [np.array([[modulus]]) for modulus in moduli]
    parts += [modulus * rotation(angle) for modulus, angle in angles]
    whole, place = np.zeros((sum(map(len, parts)),) * 2), 0
    for part in parts:
        whole[place : place + len(part), place : place + len(part)] = part
        place += len(part)
    return whole


def frame(random: np.random.Generator, size: int) -> np.ndarray:
    """Random, with a condition number of 3 at most."""
    left, right = (np.linalg.qr(random.standard_normal((size, size)))[0] for _ in range(2))
    return left @ np.diag(random.uniform(1.0, 3.0, size)) @ right


def factors_with(logarithms, pairs, count: int, seed: int) -> np.ndarray:
    """`count` matrices whose product has real eigenvalues exp(logarithm), and pairs exp(logarithm +- i angle)."""
    random = np.random.default_rng(seed)
    size = len(logarithms) + 2 * len(pairs)
    frames = [frame(random, size) for _ in range(count)]
    frames.append(frames[0])
    part = block_diagonal(
        np.exp(np.array(logarithms) / count), [(np.exp(log / count), angle / count) for log, angle in pairs]
    )
    return np.array([after @ part @ np.linalg.inv(before) for before, after in pairwise(frames)])


def witness(factors: np.ndarray) -> np.ndarray:
    """Logarithms of the eigenvalues of what the factors, as they are, multiply to."""
    with mpmath.workdps(DIGITS):
        product = mpmath.eye(factors.shape[1])
        for factor in factors:
            product = mpmath.matrix(factor.tolist()) * product
        values = mpmath.eig(product, left=False, right=False)
        return np.array([complex(mpmath.log(value)) for value in values])


def furthest(found: np.ndarray, expected: np.ndarray) -> float:
    """Largest relative error of an eigenvalue, each matched with the nearest that is left."""
    left, errors = list(expected), []
    for value in found:
        with np.errstate(over="ignore"):
            gaps = np.abs(np.exp(value - np.array(left)) - 1)
        errors.append(float(np.min(gaps)))
        left.pop(int(np.argmin(gaps)))
    return max(errors)


@settings(deadline=None, max_examples=40)
@given(
    st.lists(st.floats(-46.0, 23.0), min_size=2, max_size=3),  # 1e-20 to 1e10
    st.lists(st.tuples(st.floats(-46.0, 23.0), st.floats(0.3, 2.8)), max_size=2),
    st.integers(0, 1000),
)
def test_every_eigenvalue_is_as_accurate_as_the_largest(logarithms, pairs, seed):
    near = sorted([*logarithms, *(log for log, _ in pairs)])
    if np.min(np.diff(near), initial=1.0) < 0.1:  # nearly double: ill-conditioned, whoever computes it
        return
    factors = factors_with(logarithms, pairs, 16, seed)
    assert furthest(product_logarithms(factors), witness(factors)) < 1e-9


@pytest.mark.parametrize(
    "logarithms, pairs",
    [
        ([-46.0, 23.0], []),
        ([-46.0, 23.0], [(0.0, 1.0)]),
        ([], [(-40.0, 2.0), (20.0, 0.5)]),
        ([5.0, 4.5, -30.0], []),
        ([-700.0, -690.0, -3000.0], [(0.0, 0.4)]),
    ],
)
def test_the_spectrum_is_what_the_factors_were_made_of(logarithms, pairs):
    count = 16 if min(logarithms, default=0) > -100 else 400
    found = product_logarithms(factors_with(logarithms, pairs, count, 7))
    conjugates = [log + 1j * sign * angle for log, angle in pairs for sign in (1, -1)]
    expected = np.array([*logarithms, *conjugates], dtype=complex)
    assert furthest(found, expected) < 1e-9
    assert np.all(np.diff(found.real) <= 1e-8)


def test_signs_are_kept():
    factors = np.array([np.diag([3.0, -1e-3, -0.5]), np.diag([-2.0, -1e-4, 0.5])])
    found = np.exp(product_logarithms(factors))
    assert found == pytest.approx(np.array([-6.0, -0.25, 1e-7]), rel=1e-14)


def test_conjugates_come_with_the_positive_angle_first():
    found = product_logarithms(np.array([rotation(0.4)] * 3))
    assert found == pytest.approx(np.array([1.2j, -1.2j]), abs=1e-14)


def test_a_double_eigenvalue_among_far_ones():
    """A Jordan block, whose eigenvalues are known to the root of the rounding."""
    factors = np.array([np.array([[1e3, 5.0, 1.0, 2.0], [0, 1, 1, 1], [0, 0, 1, 1], [0, 0, 0, 1e-3]])] * 5)
    found = product_logarithms(factors)
    assert found[[0, 3]].real == pytest.approx(5 * np.log([1e3, 1e-3]), rel=1e-12)
    assert np.sum(found[1:3]) == pytest.approx(0.0, abs=1e-11)
    assert np.abs(found[1:3]) == pytest.approx([0, 0], abs=1e-5)


def test_a_singular_factor_has_an_eigenvalue_zero():
    factors = np.array([np.diag([2.0, 1.0]), np.diag([2.0, 0.0])])
    found = product_logarithms(factors)
    assert found[0] == pytest.approx(np.log(4.0))
    assert found[1].real == -np.inf


@given(st.integers(1, 30), st.integers(1, 4), st.integers(0, 1000))
def test_the_sum_is_the_logarithm_of_the_determinants(count, size, seed):
    factors = np.random.default_rng(seed).standard_normal((count, size, size)) + 2 * np.eye(size)
    total = np.linalg.slogdet(factors)[1].sum()
    assert np.sum(product_logarithms(factors)).real == pytest.approx(total, abs=1e-9)
