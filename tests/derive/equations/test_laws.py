"""The laws that physics asks for, on the emitted modules, for any parameters and states."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from conftest import derived
from hypothesis import given
from hypothesis import strategies as st
from lambdified import lambdified
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from delagrange.generated import equal_biaxial, pure_shear_consistent, pure_shear_consistent_free, uniaxial

CONSISTENT = (equal_biaxial, uniaxial, pure_shear_consistent, pure_shear_consistent_free)

lengths = st.floats(1e-3, 0.1)
aspects = st.floats(2.0, 50.0)  # L / H
densities = st.floats(500.0, 3e3)
permittivities = st.floats(1e-11, 1e-9)
moduli = st.floats(1e3, 1e6)
times = st.floats(1e-3, 1e3)
stretches = st.floats(0.6, 2.5)
rates = st.floats(-300.0, 300.0)
forces = st.floats(-0.5, 1.0)
fields = st.floats(0.0, 5e6)


@st.composite
def membranes(draw):
    """Parameters in the order of the modules, without the held stretch."""
    length, beta = draw(lengths), draw(moduli)
    thickness = length / draw(aspects)
    rest = draw(densities), draw(permittivities), draw(moduli), beta, draw(times) * beta
    return (length, thickness, *rest)


@given(membranes())
def test_small_vibration_of_the_undeformed_membrane(parameters):
    """f_n = sqrt(18 (mu_alpha + mu_beta) / (rho H^2 (2 + L^2/H^2))) / (2 pi), from the emitted Jacobian."""
    L, H, rho, _, alpha, beta, _ = parameters
    jacobian = equal_biaxial.jacobian((1.0, 0.0, 1.0), (0.0, 0.0), parameters)
    found = np.sqrt(-jacobian[1, 0]) / (2 * np.pi)
    expected = np.sqrt(18 * (alpha + beta) / (rho * H**2 * (2 + L**2 / H**2))) / (2 * np.pi)
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("model", CONSISTENT, ids=lambda model: model.MODEL)
@given(data=st.data(), parameters=membranes(), force=forces, field=fields)
def test_energy_falls_at_the_rate_that_the_dashpots_dissipate(model, data, parameters, force, field):
    """d(T + Pi)/dt = -dissipated power under constant loads, along the flow, by a complex step."""
    if len(model.PARAMETERS) > len(parameters):
        parameters = (*parameters, data.draw(stretches))
    state = np.array([data.draw(rates if v.unit == "1/s" else stretches) for v in model.STATE])
    inputs = (force, field)
    flow = model.rhs(state, inputs, parameters)
    moved = state + 1e-200j * flow
    energies = (
        model.kinetic_energy(moved, inputs, parameters),
        model.potential_energy(moved, inputs, parameters),
    )
    lost = model.dashpot_power(state, inputs, parameters)
    L, H, *_, beta, viscosity = parameters[:7]
    terms = (
        8 * L**2 * H * beta**2 / viscosity
    )  # size of what cancels in the dissipated power of a relaxed dashpot
    scale = max(abs(energy.imag) * 1e200 for energy in energies) + abs(lost) + terms
    assert sum(energy.imag for energy in energies) * 1e200 == pytest.approx(-lost, abs=1e-10 * scale)
    assert lost >= -1e-12 * scale


@given(membranes(), stretches, st.floats(0.5, 1.5))
def test_relaxation_at_a_held_stretch(parameters, stretch, start):
    """w = (xi/lambda)^2 obeys dw/dt = (1 - w^3) / (3 tau)."""
    tau = parameters[6] / parameters[5]
    xi = start * stretch
    rate = equal_biaxial.rhs((stretch, 0.0, xi), (0.0, 0.0), parameters)[2]
    w = (xi / stretch) ** 2
    assert 2 * xi * rate / stretch**2 == pytest.approx((1 - w**3) / (3 * tau), rel=1e-10, abs=1e-10 / tau)


def test_relaxation_over_time_follows_the_closed_form():
    """Integrated: dw/(1 - w^3) = dt/(3 tau), from w = 0.25 to near its rest."""
    parameters, stretch, tau = (5e-3, 1e-3, 1.2e3, 6.198e-11, 1.8e4, 4.2e4, 4.2e4 * 2.0), 1.7, 2.0

    def flow(_time, xi):
        return [equal_biaxial.rhs((stretch, 0.0, xi[0]), (0.0, 0.0), parameters)[2]]

    def implicit(w):  # integral of dw / (1 - w^3)
        return (
            -np.log(1 - w) / 3 + np.log(1 + w + w * w) / 6 + np.arctan((2 * w + 1) / np.sqrt(3)) / np.sqrt(3)
        )

    run = solve_ivp(
        flow, (0.0, 9.0), [0.5 * stretch], rtol=1e-11, atol=1e-13, method="DOP853", t_eval=[3.0, 9.0]
    )
    for time, xi in zip(run.t, run.y[0], strict=True):
        target = implicit(0.25) + time / (3 * tau)
        expected = brentq(lambda w, target=target: implicit(w) - target, 0.25, 1 - 1e-12, xtol=1e-14)
        assert (xi / stretch) ** 2 == pytest.approx(expected, rel=1e-9)


@given(moduli, permittivities)
def test_pull_in_of_the_ideal_neo_hookean_dielectric(modulus, permittivity):
    """Without force and spring beta: lambda = 2^(1/3) at a nominal field of 0.68736 sqrt(mu/epsilon)."""
    parameters = (5e-3, 1e-3, 1.2e3, permittivity, modulus, 0.0, 1.0)
    scale = np.sqrt(modulus / permittivity)
    critical = np.sqrt(2 ** (-2 / 3) - 2 ** (-8 / 3)) * scale

    def net(stretch, field):
        return equal_biaxial.rhs((stretch, 0.0, 1.0), (0.0, field), parameters)[1]

    def slope(stretch, field):
        return equal_biaxial.jacobian((stretch, 0.0, 1.0), (0.0, field), parameters)[1, 0]

    assert critical / scale == pytest.approx(0.68736, abs=5e-6)
    tolerance = 1e-9 * abs(slope(1.0, 0.0))
    assert abs(net(2 ** (1 / 3), critical)) < tolerance
    assert abs(slope(2 ** (1 / 3), critical)) < tolerance
    below = np.linspace(1.0, 2.0, 400)
    assert np.min(net(below, 0.999 * critical)) < 0 < np.min(net(below, 1.001 * critical))


@cache
def biaxial():
    return lambdified(derived("biaxial"))


@given(membranes(), stretches, stretches, rates, rates, stretches, stretches, forces, forces, fields)
def test_swapping_the_axes_leaves_the_membrane(parameters, a, b, va, vb, xa, xb, first, second, field):
    there = biaxial().rhs([a, b, va, vb, xa, xb], [first, second, field], parameters)
    back = biaxial().rhs([b, a, vb, va, xb, xa], [second, first, field], parameters)
    np.testing.assert_allclose(
        there, back[[1, 0, 3, 2, 5, 4]], rtol=1e-10, atol=1e-10 * np.max(np.abs(there))
    )


@given(membranes(), stretches, rates, stretches, forces, fields)
def test_equal_forces_on_both_axes_give_the_equal_biaxial_motion(parameters, stretch, rate, xi, force, field):
    both = biaxial().rhs([stretch, stretch, rate, rate, xi, xi], [force, force, field], parameters)
    one = equal_biaxial.rhs((stretch, rate, xi), (force, field), parameters)
    scale = 1e-9 * np.max(np.abs(one))
    np.testing.assert_allclose(both[::2], one, rtol=1e-9, atol=scale)
    np.testing.assert_allclose(both[1::2], one, rtol=1e-9, atol=scale)


@given(membranes(), stretches, stretches, rates, rates, stretches, stretches, forces, fields)
def test_uniaxial_is_the_membrane_with_one_force(parameters, a, b, va, vb, xa, xb, force, field):
    state = [a, b, va, vb, xa, xb]
    full = biaxial().rhs(state, [force, 0.0, field], parameters)
    emitted = uniaxial.rhs(state, (force, field), parameters)
    np.testing.assert_allclose(emitted, full, rtol=1e-10, atol=1e-10 * np.max(np.abs(full)))


@given(membranes(), stretches, rates, stretches, stretches, forces, fields)
def test_the_reaction_holds_the_axis(parameters, stretch, rate, xi, held, force, field):
    """Loaded with the reaction, the free membrane has no acceleration along the held axis."""
    state = (stretch, rate, xi, held)
    model, values = pure_shear_consistent_free, (*parameters, held)
    reaction = model.reaction_forces(state, (force, field), values)[0]
    full = biaxial().rhs([stretch, held, rate, 0.0, xi, held], [force, reaction, field], parameters)
    own = model.rhs(state, (force, field), values)
    scale = np.max(np.abs(full)) + 2 * abs(reaction) / (parameters[2] * parameters[0] ** 2 * parameters[1])
    assert abs(full[3]) <= 1e-9 * scale
    assert full[2] == pytest.approx(own[1], rel=1e-9, abs=1e-9 * scale)
