"""Floquet multipliers and bifurcations where they are known: Mathieu's equation, and matrices made for it."""

from __future__ import annotations

from collections import namedtuple
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

import delagrange as dl
from delagrange.analysis.steady import floquet
from delagrange.analysis.steady.periodic_qr import product_logarithms
from delagrange.analysis.steady.shooting import Orbit, Parts, Shooting
from delagrange.engines.flow import FlowPath
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.equilibrium.continuation import ContinuationSettings, Evaluation, Lost, continue_branch
from delagrange.problem.problem import Problem

STIFFNESS, GAIN = 1.0, 0.4
Entry = namedtuple("Entry", "name symbol unit meaning")


def mathieu() -> ModuleType:
    """x'' = -(STIFFNESS + GAIN E^2) x, whose rest under a sine field is periodic with any period."""
    model = ModuleType("mathieu")
    model.MODEL, model.FORMULATION, model.COORDINATE_COUNT = "mathieu", "", 1
    model.STATE = (Entry("place", "x", "1", "place"), Entry("rate", "v", "1/s", "rate"))
    model.INPUTS = (Entry("nominal_electric_field", "E", "V/m", "field"),)
    model.PARAMETERS = ()
    model.rhs = lambda y, u, p: np.array([y[1], -(STIFFNESS + GAIN * u[0] ** 2) * y[0]])
    model.jacobian = lambda y, u, p: np.array([[0.0, 1.0], [-(STIFFNESS + GAIN * u[0] ** 2), 0.0]])
    model.input_jacobian = lambda y, u, p: np.array([[0.0], [-2 * GAIN * u[0] * y[0]]])
    model.principal_stretches = lambda y, u, p: np.ones(3)
    model.reference_state = lambda p: np.zeros(2)
    return model


def mathieu_numbers(frequency: float) -> tuple[float, float]:
    """a and q of x'' + (a - 2 q cos 2 t) x = 0, E = sin(2 pi f t), time in units of 1/(2 pi f)."""
    omega = 2 * np.pi * frequency
    return (STIFFNESS + GAIN / 2) / omega**2, GAIN / 4 / omega**2


def boundary(characteristic, order: int, low: float, high: float) -> float:
    """Frequency [Hz] at which the motion loses or gains its stability."""

    def off(frequency):
        a, q = mathieu_numbers(frequency)
        return a - characteristic(order, q)

    return brentq(off, low, high, xtol=1e-15)


@pytest.fixture(scope="module")
def rest_of_mathieu():
    """Points and bifurcations of x = 0 along the frequency."""
    problem = Problem(mathieu(), (dl.Constant(0.0),), ())
    path = FlowPath(problem, np.ones(2), 1e-11)
    load = {"force": 0.0, "field_amplitude": 1.0, "field_bias": 0.0, "frequency": 0.14}
    one = Shooting(path, flow_by_scipy, np.zeros(2), np.arange(2), load, "frequency", 0.1, 2)
    outside = lambda x: None if x[-1] < 0.19 else "far enough"  # noqa: E731
    settings = ContinuationSettings(first_step=0.05, largest_step=0.06, tolerance=1e-10)
    branch = continue_branch(one.residual, np.array([0.0, 0.0, 0.145]), 1, one.scale, settings, outside)
    return branch.points, floquet.bifurcations(one.residual, branch.points, True, one.scale, 1e-10)


def test_stability_is_lost_where_mathieu_has_it(rest_of_mathieu):
    points, _ = rest_of_mathieu
    low, high = (boundary(value, 1, 0.14, 0.25) for value in (mathieu_a, mathieu_b))
    low, high = sorted((low, high))
    for point in points:
        expected = "unstable" if low < point.x[-1] < high else "neutral"
        assert floquet.spectrum(point.payload).stability(True) == expected


def test_period_doublings_are_where_mathieu_has_them(rest_of_mathieu):
    _, found = rest_of_mathieu
    expected = sorted(boundary(value, 1, 0.14, 0.25) for value in (mathieu_a, mathieu_b))
    kept = [at for at in found if at.kind == floquet.PERIOD_DOUBLING]
    assert [at.point.x[-1] for at in kept] == pytest.approx(expected, abs=1e-9)
    for at in kept:
        assert np.linalg.eigvals(at.point.payload.monodromy) == pytest.approx([-1, -1], abs=1e-4)


def orbit_of(monodromy: np.ndarray) -> Orbit:
    size = len(monodromy)
    slopes = np.column_stack([monodromy - np.eye(size), np.ones(size)])
    determinant = abs(np.linalg.det(monodromy))
    return Orbit(
        np.ones(size), {}, 1.0, monodromy, slopes, float(np.log(determinant)), np.ones(1), np.ones(1), 0.0
    )  # fmt: skip


def along(family, start: float, stop: float):
    """A straight branch u = 0 of a parameter p whose monodromy is family(p), and its bifurcations."""

    def residual(x):
        size = len(x) - 1
        slopes = np.column_stack([np.eye(size), np.zeros(size)])
        return Evaluation(np.array(x[:-1]), slopes, orbit_of(family(x[-1])))

    size = len(family(start))
    outside = lambda x: None if x[-1] <= stop else "far enough"  # noqa: E731
    x = np.append(np.zeros(size), start)
    scale = np.ones(size + 1)
    settings = ContinuationSettings(first_step=0.07, largest_step=0.07)
    branch = continue_branch(residual, x, 1, scale, settings, outside)
    return residual, branch.points, scale


def rotation(angle: float, radius: float = 1.0) -> np.ndarray:
    return radius * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def blocks(*parts: np.ndarray) -> np.ndarray:
    size = sum(len(part) for part in parts)
    whole, place = np.zeros((size, size)), 0
    for part in parts:
        whole[place : place + len(part), place : place + len(part)] = part
        place += len(part)
    return whole


def test_a_torus_bifurcation_with_damping():
    residual, points, scale = along(lambda p: blocks(rotation(1.0, np.exp(p)), np.diag([0.3])), -1.0, 1.0)
    found = floquet.bifurcations(residual, points, False, scale, 1e-12)
    assert [at.kind for at in found] == [floquet.TORUS]
    assert found[0].point.x[-1] == pytest.approx(0.0, abs=1e-9)


def test_real_multipliers_whose_product_is_one_are_no_torus():
    residual, points, scale = along(lambda p: np.diag([2.0, 0.5 * np.exp(p), 0.1]), -1.0, 0.5)
    assert not [at for at in floquet.bifurcations(residual, points, False, scale, 1e-12)]


def symplectic(coupling: float) -> np.ndarray:
    """Two pairs of multipliers of opposite signature that meet at coupling = 0 and leave the circle (Krein)."""
    generator = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, -1.0], [0, 0, 1, 0]])
    pull = np.array([[0, 0, 1, 0], [0, 0, 0, 1], [0.0, 0, 0, 0], [0, 0, 0, 0]])
    back = np.array([[0, 0, 0, 0], [0, 0, 0, 0], [1.0, 0, 0, 0], [0, 1, 0, 0]])
    exponent = generator + pull + coupling * back  # eigenvalues i (+-1) +- sqrt(coupling)
    values, vectors = np.linalg.eig(exponent.astype(complex))
    return (vectors @ np.diag(np.exp(values)) @ np.linalg.inv(vectors)).real


def test_a_krein_collision_without_damping():
    residual, points, scale = along(symplectic, -0.33, 0.4)
    found = floquet.bifurcations(residual, points, True, scale, 1e-12)
    assert [at.kind for at in found] == [floquet.TORUS]
    assert found[0].point.x[-1] == pytest.approx(0.0, abs=1e-7)
    stable = [floquet.spectrum(point.payload).stability(True) == floquet.NEUTRAL for point in points]
    assert stable == [point.x[-1] < 0 for point in points]


@given(st.floats(0.05, 3.1), st.floats(0.05, 3.1))
def test_rotations_are_neutral(first, second):
    assert (
        floquet.spectrum(orbit_of(blocks(rotation(first), rotation(second)))).stability(True)
        == floquet.NEUTRAL
    )


@given(st.floats(0.1, 0.999), st.floats(0.1, 3.0))
def test_what_contracts_is_stable_and_what_grows_is_not(radius, angle):
    assert (
        floquet.spectrum(orbit_of(blocks(rotation(angle, radius), np.eye(1) * radius))).stability(False)
        == "stable"
    )
    assert (
        floquet.spectrum(orbit_of(blocks(rotation(angle, 1 / radius), np.eye(1) * radius))).stability(False)
        == "unstable"
    )
    assert floquet.spectrum(orbit_of(np.diag([radius, 1 / radius]))).stability(True) == "unstable"


def test_what_cannot_be_told_is_marginal():
    assert floquet.spectrum(orbit_of(np.diag([1 - 1e-13, 0.5]))).stability(False) == floquet.MARGINAL


@given(st.lists(st.floats(-2.0, 2.0).filter(lambda value: abs(value) > 0.1), min_size=2, max_size=5))
def test_multipliers_come_by_size_and_their_product_is_the_determinant(values):
    orbit = orbit_of(np.diag(values))
    sizes = np.abs(floquet.spectrum(orbit).multipliers)
    assert np.all(np.diff(sizes) <= 1e-8)
    expected = abs(np.prod(values) / abs(np.prod(values)) - 1)
    assert floquet.spectrum(orbit).product_error == pytest.approx(expected, abs=1e-12)


SOFT = {"force": 0.5, "field_amplitude": 5e6}
STIFF = {"force": 0.1, "field_amplitude": 4e6, "relaxation_time": 1e-5, "dashpots": "relaxed"}
FEW = {"seeds": 2, "most_branches": 1, "resolution": 20}
FALLING = {
    **SOFT,
    "frequency": (100.0, 372.0),
    "seeds": np.array([360.0]),
    "most_branches": 1,
    "resolution": 10,
}


@pytest.mark.parametrize(
    "model, load",
    [
        ("equal_biaxial", FALLING),
        ("uniaxial", {**SOFT, "frequency": (330.0, 420.0), **FEW}),
        ("equal_biaxial", {**STIFF, "frequency": (390.0, 430.0), **FEW}),
        ("uniaxial", {**STIFF, "frequency": (330.0, 350.0), **FEW}),
    ],
)
def test_the_product_is_that_of_liouville_all_along_a_response(model, load):
    data = dl.steady_response(model, **load)
    assert data.sizes["point"] > 20
    assert float(data["product_error"].max()) < 1e-9
    total = data["multiplier_logarithm"].sum("multiplier")
    assert total.values == pytest.approx(data["divergence"].values, abs=1e-8)


def extreme_orbit(load) -> Orbit:
    """Of a response the motion with the most ill-conditioned monodromy matrix."""
    spectrum, orbits = floquet.spectrum, []

    def kept(orbit):
        orbits.append(orbit)
        return spectrum(orbit)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(floquet, "spectrum", kept)
        dl.steady_response("equal_biaxial", **load)
    return max(orbits, key=lambda orbit: np.linalg.cond(orbit.monodromy))


@pytest.mark.parametrize(
    "load, condition", [(FALLING, 1e6), ({**STIFF, "frequency": (400.0, 401.0), **FEW}, 1e14)]
)
def test_the_multipliers_do_not_depend_on_the_parts(load, condition):
    orbit = extreme_orbit(load)
    assert np.linalg.cond(orbit.monodromy) > condition
    found = floquet.spectrum(orbit)
    assert found.in_parts
    for count in (60, 90):
        other = product_logarithms(orbit.in_parts(count).matrices)
        assert np.exp(other - found.logarithms) == pytest.approx(np.ones(len(other)), abs=1e-8)


def test_a_well_conditioned_matrix_is_not_cut_into_parts():
    def never(count):
        raise AssertionError("not wanted")

    monodromy = np.array([[1.0, 3.0, 0.2], [0.1, 0.5, -2.0], [0.0, 1.0, 0.3]])
    found = floquet.spectrum(replace(orbit_of(monodromy), in_parts=never))
    assert sorted(found.multipliers, key=abs) == sorted(np.linalg.eigvals(monodromy), key=abs)
    assert not found.in_parts


def test_where_the_parts_are_lost_the_whole_is_taken():
    def lost(count):
        raise Lost("the motion diverged")

    found = floquet.spectrum(replace(orbit_of(np.diag([1e5, 1e-5])), in_parts=lost))
    assert found.multipliers == pytest.approx([1e5, 1e-5])
    assert not found.in_parts


def test_parts_that_are_not_well_conditioned_are_cut_again():
    asked = []

    def in_parts(count):
        """All of the growth in one half of the period."""
        asked.append(count)
        half = count // 2
        matrices = [np.diag([10 ** (6 / half), 10 ** (-8 / half)])] * half + [np.eye(2)] * (count - half)
        return Parts(np.array(matrices), float(-2 * np.log(10)))

    found = floquet.spectrum(replace(orbit_of(np.diag([1e6, 1e-8])), in_parts=in_parts))
    assert len(asked) > 1 and asked[-1] == 2 * asked[-2]
    assert found.logarithms == pytest.approx(np.log([1e6, 1e-8]), rel=1e-13)
    assert found.product_error < 1e-12
    assert found.stability(conservative=False) == found.stability(conservative=True) == floquet.UNSTABLE
