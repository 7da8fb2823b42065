"""Periodic motions by shooting, against SciPy and against harmonic balance that knows nothing of shooting."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

import delagrange as dl
from delagrange.analysis.steady.floquet import spectrum
from delagrange.analysis.steady.shooting import Shooting
from delagrange.engines.flow import FlowPath
from delagrange.engines.flows import resolve_flow
from delagrange.equilibrium.continuation import Lost, solve
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import frozen
from delagrange.problem.problem import make_problem

LOAD = {"force": 0.4, "field_amplitude": 3e6, "field_bias": 1e6, "frequency": 300.0}


def shooting(
    name: str,
    varied: str = "frequency",
    flowing: bool = False,
    load=LOAD,
    limits: dl.Limits | None = None,
    **material,
) -> Shooting:
    model = dl.load_model(name)
    problem = make_problem(model, dl.SHENG_2015, material, 2.0 if "shear" in name else None, 0.0, 0.0)
    problem = problem if flowing else frozen(problem)
    count = model.COORDINATE_COUNT
    unknowns = np.arange(len(model.STATE) if flowing else 2 * count)
    path = FlowPath(problem, typical_sizes(problem), 1e-13, limits or dl.Limits())
    rest = np.asarray(model.reference_state(problem.parameters), dtype=float)
    size, per_sine = 0.1 * load[varied], 1 if load["field_bias"] else 2
    return Shooting(path, resolve_flow(problem), rest, unknowns, load, varied, size, per_sine)


def displaced(one: Shooting) -> np.ndarray:
    """x off equilibrium, so that nothing vanishes by symmetry."""
    x = one.x_of(one.rest, one.load[one.varied])
    count = one.path.problem.model.COORDINATE_COUNT
    x[:count] += 0.05 * np.arange(1, count + 1)
    x[count : 2 * count] += 30.0
    return x


@pytest.mark.parametrize("varied", LOAD)
@pytest.mark.parametrize(
    "name, flowing", [("equal_biaxial", False), ("uniaxial", True), ("pure_shear_as_printed", True)]
)
def test_slopes_are_those_of_central_differences(name, flowing, varied):
    one = shooting(name, varied, flowing, relaxation_time=1e-2)
    x, scale = displaced(one), one.scale
    steps = 1e-4 * scale
    differences = np.empty((len(x) - 1, len(x)))
    for place, step in enumerate(steps):
        two = [one.residual(x + sign * step * np.eye(len(x))[place]).residual for sign in (1, -1)]
        differences[:, place] = (two[0] - two[1]) / (2 * step)
    errors = (differences - one.residual(x).slopes) * scale / scale[:-1, None]
    assert np.max(np.abs(errors)) < 2e-6


def test_the_monodromy_matrix_is_that_of_scipy():
    """Every column from two perturbed runs of solve_ivp."""
    one = shooting("uniaxial")
    x = solve(one.residual, one.x_of(one.rest, 300.0), one.scale, 1e-11).x
    orbit = one.residual(x).payload
    problem = one.problem(one.at(300.0))

    def end(state):
        run = solve_ivp(problem.rhs, (0.0, orbit.period), state, method="DOP853", rtol=1e-13, atol=1e-14)
        return run.y[:4, -1]

    columns = []
    for place in range(4):
        step = 1e-5 * one.path.weights[place]
        shift = step * np.eye(6)[place]
        columns.append((end(orbit.state + shift) - end(orbit.state - shift)) / (2 * step))
    expected = np.linalg.eigvals(np.array(columns).T)
    found = spectrum(orbit).multipliers
    assert all(np.min(np.abs(expected - value)) < 1e-7 for value in found)


def harmonic_balance(problem, frequency: float, harmonics: int, guess: np.ndarray):
    """Fourier coefficients of the one coordinate for which the equation of motion holds at 2 N + 1 phases."""
    count = 2 * harmonics + 1
    phases = 2 * np.pi * np.arange(count) / count
    orders = np.arange(1, harmonics + 1)
    omega = 2 * np.pi * frequency

    def motion(coefficients, phase):
        cosines, sines = np.cos(np.outer(phase, orders)), np.sin(np.outer(phase, orders))
        mean, a, b = coefficients[0], coefficients[1 : harmonics + 1], coefficients[harmonics + 1 :]
        place = mean + cosines @ a + sines @ b
        rate = omega * (sines @ (-a * orders) + cosines @ (b * orders))
        acceleration = -(omega**2) * (cosines @ (a * orders**2) + sines @ (b * orders**2))
        return place, rate, acceleration

    def residual(coefficients):
        place, rate, acceleration = motion(coefficients, phases)
        state = np.array([place, rate, np.ones(count)])
        inputs = problem.inputs(phases / omega)
        inputs = tuple(np.broadcast_to(value, (count,)) for value in inputs)
        return (problem.model.rhs(state, inputs, problem.parameters)[1] - acceleration) / omega**2

    found = root(residual, guess, method="hybr", options={"xtol": 1e-14})
    assert np.max(np.abs(found.fun)) < 1e-11
    return lambda phase: motion(found.x, phase)


@pytest.mark.parametrize("frequency", [250.0, 500.0])
def test_an_orbit_is_that_of_harmonic_balance(frequency):
    load = {**LOAD, "frequency": frequency}
    one = shooting("equal_biaxial", load=load)
    x = solve(one.residual, one.x_of(one.rest, frequency), one.scale, 1e-11).x
    orbit = one.residual(x).payload
    guess = np.zeros(61)
    guess[0] = (orbit.maximum[0] + orbit.minimum[0]) / 2
    motion = harmonic_balance(one.problem(one.at(frequency)), frequency, 30, guess)
    place, rate, _ = motion(np.array([0.0]))
    assert orbit.state[0] == pytest.approx(place[0], abs=1e-10)
    assert orbit.state[1] == pytest.approx(rate[0], abs=1e-10 * one.path.weights[1])
    values = motion(np.linspace(0, 2 * np.pi, 20001))[0]
    assert orbit.maximum[0] == pytest.approx(values.max(), abs=1e-7)
    assert orbit.minimum[0] == pytest.approx(values.min(), abs=1e-7)


def test_without_bias_the_period_is_half_that_of_the_field():
    load = {**LOAD, "field_bias": 0.0}
    one = shooting("equal_biaxial", load=load)
    assert one.period(load) == pytest.approx(1 / 600)
    x = solve(one.residual, one.x_of(one.rest, 300.0), one.scale, 1e-11).x
    run = dl.simulate(
        "equal_biaxial", force=0.4, field=dl.Sine(3e6, 300.0), duration=1 / 300, viscosity=1e30, rtol=1e-12,
        time=np.array([0.0, 1 / 600, 1 / 300]), initial_state=one.state(x),
    )  # fmt: skip
    assert np.ptp(run["stretch"].values) < 1e-10


def test_a_motion_that_is_lost_raises():
    one = shooting("equal_biaxial", limits=dl.Limits(largest_stretch=1.01))
    with pytest.raises(Lost, match="the motion diverged after"):
        one.residual(displaced(one))


@pytest.mark.parametrize("frequency", [0.0, -5.0, np.nan])
def test_there_is_no_motion_of_such_a_frequency(frequency):
    one = shooting("equal_biaxial")
    with pytest.raises(Lost, match="no motion at frequency"):
        one.residual(one.x_of(one.rest, frequency))


@pytest.mark.parametrize("count", [1, 2, 7])
@pytest.mark.parametrize("name, flowing", [("equal_biaxial", False), ("uniaxial", True)])
def test_the_parts_make_up_the_monodromy_matrix(name, flowing, count):
    one = shooting(name, flowing=flowing, relaxation_time=1e-2)
    orbit = one.residual(displaced(one)).payload
    parts = orbit.in_parts(count)
    product = np.eye(len(one.unknowns))
    for matrix in parts.matrices:
        product = matrix @ product
    assert parts.matrices.shape == (count, len(product), len(product))
    assert product == pytest.approx(orbit.monodromy, abs=1e-9)
    assert parts.divergence == pytest.approx(orbit.divergence, abs=1e-10)


def test_parts_of_a_motion_that_is_lost_raise():
    one = shooting("equal_biaxial", limits=dl.Limits(largest_stretch=1.01))
    with pytest.raises(Lost, match="the motion diverged after"):
        one.parts(displaced(one), 3)
