"""Continuation of branches whose course is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange.equilibrium.continuation import (
    ContinuationSettings,
    Evaluation,
    Lost,
    Point,
    continue_branch,
    locate,
    solve,
    turning,
)

ONES = np.ones(2)


def everywhere(x: np.ndarray) -> None:
    return None


def circle(x: np.ndarray) -> Evaluation:
    """x^2 + y^2 = 1, y the parameter."""
    return Evaluation(np.array([x @ x - 1.0]), 2 * x[None, :], payload=float(np.arctan2(x[1], x[0])))


def cubic(x: np.ndarray) -> Evaluation:
    """p = u^3 - 3 u: folds at u = 1, p = -2 and at u = -1, p = 2."""
    u, p = x
    return Evaluation(np.array([p - u**3 + 3 * u]), np.array([[3 - 3 * u**2, 1.0]]))


def near_cusp(width: float):
    """p = (u^2 + width^2)^(1/2): a corner that becomes sharp as the width goes to zero."""

    def residual(x: np.ndarray) -> Evaluation:
        u, p = x
        root = np.hypot(u, width)
        return Evaluation(np.array([p - root]), np.array([[-u / root, 1.0]]))

    return residual


def root(x: np.ndarray) -> Evaluation:
    """u = p^(1/2), which ends where the parameter would be negative."""
    u, p = x
    if p < 0:
        raise Lost("no square root of a negative number")
    return Evaluation(np.array([u - np.sqrt(p)]), np.array([[1.0, -0.5 / np.sqrt(p) if p > 0 else -np.inf]]))


def test_a_circle_closes_on_itself():
    settings = ContinuationSettings(largest_step=0.05)
    branch = continue_branch(circle, np.array([1.0, 0.1]), +1, ONES, settings, everywhere)
    points = np.array([point.x for point in branch.points])
    assert branch.ending == "closed on itself"
    assert np.array_equal(points[0], points[-1])
    np.testing.assert_allclose(np.hypot(*points.T), 1.0, atol=1e-14)
    angles = np.unwrap([point.payload for point in branch.points])
    assert np.all(np.diff(angles) > 0)
    assert angles[-1] - angles[0] == pytest.approx(2 * np.pi, abs=1e-6)


def test_the_direction_is_the_sign_of_the_change_of_the_parameter():
    for direction in (+1, -1):
        branch = continue_branch(
            circle, np.array([1.0, 0.1]), direction, ONES, ContinuationSettings(most_points=3), everywhere
        )
        assert np.sign(branch.points[1].x[1] - branch.points[0].x[1]) == direction
        assert branch.ending == "3 points"


def test_tangents_are_unit_vectors_along_the_branch():
    scale = np.array([2.0, 0.5])
    branch = continue_branch(circle, np.array([1.0, 0.1]), +1, scale, ContinuationSettings(most_points=40), everywhere)
    for point in branch.points:
        assert np.linalg.norm(point.tangent) == pytest.approx(1.0, abs=1e-14)
        assert point.x @ (scale * point.tangent) == pytest.approx(0.0, abs=4e-12)  # of the last correction


def folds(branch) -> list[tuple[Point, Point]]:
    return [
        (before, after)
        for before, after in zip(branch.points, branch.points[1:])
        if turning(before) * turning(after) < 0
    ]


def test_both_folds_of_a_cubic_are_located_to_round_off():
    settings = ContinuationSettings()
    branch = continue_branch(
        cubic, np.array([-2.5, -8.125]), +1, ONES, settings, lambda x: "far enough" if x[0] > 2.5 else None
    )
    assert branch.ending == "far enough"
    assert branch.points[-1].x[0] < 2.5 < branch.beyond.x[0]
    found = [locate(cubic, *pair, turning, ONES, 1e-13) for pair in folds(branch)]
    np.testing.assert_allclose([point.x for point in found], [[-1.0, 2.0], [1.0, -2.0]], atol=1e-12)


def test_locate_finds_where_any_test_vanishes():
    branch = continue_branch(cubic, np.array([2.0, 2.0]), +1, ONES, ContinuationSettings(most_points=30), everywhere)
    point = locate(cubic, branch.points[0], branch.points[-1], lambda point: point.x[1] - 2.25, ONES, 1e-13)
    assert point.x[1] == pytest.approx(2.25, abs=1e-13)
    assert point.x[0] ** 3 - 3 * point.x[0] == pytest.approx(2.25, abs=1e-12)


def test_locate_refuses_a_test_of_one_sign():
    branch = continue_branch(cubic, np.array([2.0, 2.0]), +1, ONES, ContinuationSettings(most_points=3), everywhere)
    with pytest.raises(ValueError, match=r"two signs.*parameter 2 and"):
        locate(cubic, branch.points[0], branch.points[-1], lambda point: 1.0, ONES, 1e-13)


def test_a_lost_branch_says_where_and_keeps_what_it_has():
    branch = continue_branch(root, np.array([1.0, 1.0]), -1, ONES, ContinuationSettings(smallest_step=1e-5), everywhere)
    assert branch.ending.startswith("lost: ")
    assert "near parameter" in branch.ending
    assert len(branch.points) > 10
    assert 0 <= branch.points[-1].x[1] < 1e-3
    assert branch.ending.endswith(f"near parameter {branch.points[-1].x[1]:.10g}")


def test_a_start_that_is_no_solution_is_a_branch_without_points():
    branch = continue_branch(root, np.array([1.0, -1.0]), +1, ONES, ContinuationSettings(), everywhere)
    assert branch.points == ()
    assert branch.ending == "lost: no square root of a negative number near parameter -1"


def test_a_start_outside_is_a_branch_without_points():
    branch = continue_branch(circle, np.array([1.0, 0.1]), +1, ONES, ContinuationSettings(), lambda x: "left the range")
    assert (branch.points, branch.ending) == ((), "left the range")
    assert branch.beyond.x[1] == 0.1


def test_a_sharp_corner_is_passed_with_small_steps():
    width = 1e-4
    settings = ContinuationSettings(first_step=0.05)
    branch = continue_branch(
        near_cusp(width), np.array([-1.0, 1.0]), -1, ONES, settings, lambda x: "far" if x[0] > 1 else None
    )
    points = np.array([point.x for point in branch.points])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert branch.ending == "far"
    assert points[:, 1].min() == pytest.approx(width, rel=0.05)
    assert steps.min() < 10 * width < 0.01 < steps.max()
    assert np.all(np.diff(points[:, 0]) > 0)


def test_a_corner_sharper_than_the_smallest_step_ends_the_branch():
    settings = ContinuationSettings(smallest_step=1e-3)
    branch = continue_branch(near_cusp(1e-7), np.array([-1.0, 1.0]), -1, ONES, settings, everywhere)
    assert branch.ending.startswith("lost: ")
    assert -0.01 < branch.points[-1].x[0] < 0


def test_solve_keeps_the_parameter_and_says_what_does_not_converge():
    found = solve(cubic, np.array([2.2, 2.0]), ONES, 1e-12)
    np.testing.assert_allclose(found.x, [2.0, 2.0], atol=1e-15)
    with pytest.raises(Lost, match="singular"):
        solve(cubic, np.array([1.0, 0.0]), ONES, 1e-12)
    with pytest.raises(Lost, match=r"diverges|still corrects"):
        solve(lambda x: Evaluation(np.array([x[0] ** 2 + 1]), np.array([[2 * x[0], 0.0]])), np.array([0.3, 0]),
              ONES, 1e-12)  # fmt: skip


def test_what_is_not_finite_is_lost():
    with pytest.raises(Lost, match="not finite"):
        solve(lambda x: Evaluation(np.array([np.nan]), np.ones((1, 2))), ONES, ONES, 1e-12)


@given(stretch=st.floats(1e-3, 1e3), size=st.floats(1e-6, 1e9))
def test_units_do_not_matter(stretch, size):
    """With the scale in the same units, the branch of an ellipse is that of the circle."""
    scale = np.array([stretch, size])

    def ellipse(x: np.ndarray) -> Evaluation:
        z = x / scale
        return Evaluation(np.array([z @ z - 1.0]), 2 * (z / scale)[None, :])

    settings = ContinuationSettings(most_points=20)
    plain = continue_branch(circle, np.array([1.0, 0.1]), +1, ONES, settings, everywhere)
    scaled = continue_branch(ellipse, scale * [1.0, 0.1], +1, scale, settings, everywhere)
    np.testing.assert_allclose(
        [point.x / scale for point in scaled.points], [point.x for point in plain.points], atol=1e-9
    )
