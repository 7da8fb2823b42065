"""The full membrane: integrals against quadrature, energies against first principles, the dashpot law."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from conftest import paper_membrane
from hypothesis import given
from hypothesis import strategies as st

from delagrange.derive.membrane.body import check_body
from delagrange.derive.membrane.dissipation import dashpot_strain_rates, elastic_stretches
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.membrane.strain_energy import gent, mooney_rivlin, neo_hookean
from delagrange.derive.notation import symbols as s

stretch = st.floats(0.5, 3.0)
rate = st.floats(-500.0, 500.0)
LOCKING = s.Quantity(sp.Symbol("J_m", positive=True), "locking", "J_m", "J_m", "1", "locking limit")
SECOND = s.Quantity(
    sp.Symbol("mu_2", positive=True), "second_modulus", "μ_2", r"\mu_2", "Pa", "second modulus"
)


@pytest.fixture(scope="module")
def paper():
    return paper_membrane()


def _gauss_kinetic_energy(l1, l2, v1, v2, L, H, rho):
    """Kinetic energy by Gauss-Legendre quadrature over the body, velocities by the chain rule in numbers."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    total = 0.0
    for (a, wa), (b, wb), (c, wc) in itertools.product(zip(nodes, weights, strict=True), repeat=3):
        x, y, z = a * L, b * L, c * H
        v3 = -(v1 / l1 + v2 / l2) / (l1 * l2)
        total += wa * wb * wc * L * L * H * rho / 2 * ((v1 * x) ** 2 + (v2 * y) ** 2 + (v3 * z) ** 2)
    return total


@given(l1=stretch, l2=stretch, v1=rate, v2=rate)
def test_kinetic_energy_is_the_integral_over_the_body(l1, l2, v1, v2):
    model = paper_membrane()
    values = {
        s.STRETCH_1.value.symbol: l1, s.STRETCH_2.value.symbol: l2, s.STRETCH_1.rate.symbol: v1,
        s.STRETCH_2.rate.symbol: v2, s.HALF_LENGTH.symbol: 5e-3, s.HALF_THICKNESS.symbol: 1e-3, s.DENSITY.symbol: 1.2e3,
    }  # fmt: skip
    expected = _gauss_kinetic_energy(l1, l2, v1, v2, 5e-3, 1e-3, 1.2e3)
    assert float(model.kinetic_energy.subs(values)) == pytest.approx(expected, rel=1e-12, abs=1e-30)


def test_the_motion_keeps_the_volume(paper):
    L, H = s.HALF_LENGTH.symbol, s.HALF_THICKNESS.symbol
    assert sp.Mul(*paper.principal_stretches) == 1
    assert paper.volume == (2 * L) ** 2 * (2 * H)


def test_a_compressible_motion_would_change_the_volume():
    body = rectangle()
    with pytest.raises(
        ValueError, match=r"volume changes by lambda_1\*lambda_2; allowed is an incompressible"
    ):
        check_body(replace(body, principal_stretches=(*body.principal_stretches[:2], sp.Integer(1))))


def test_energies_vanish_without_strain_and_load(paper):
    rest = {m.value.symbol: 1 for m in (*paper.coordinates, *paper.internals)}
    unloaded = {force.symbol: 0 for force in paper.forces} | {paper.field.symbol: 0}
    assert paper.energies.total.subs(rest).subs(unloaded) == 0
    for coordinate in paper.coordinates:
        assert paper.energies.total.diff(coordinate.value.symbol).subs(rest).subs(unloaded) == 0


def test_electrostatic_energy_is_that_of_a_capacitor(paper):
    """-1/2 C phi^2 with C = epsilon area / gap and phi = 2 H E, under voltage control."""
    l1, l2, l3 = paper.principal_stretches
    L, H, eps, E = s.HALF_LENGTH.symbol, s.HALF_THICKNESS.symbol, s.PERMITTIVITY.symbol, s.FIELD.symbol
    capacitance = eps * (2 * L * l1) * (2 * L * l2) / (2 * H * l3)
    assert sp.simplify(paper.energies["electrostatic"] + capacitance * (2 * H * E) ** 2 / 2) == 0


def test_forces_do_work_on_the_length_of_the_membrane(paper):
    for force, coordinate in zip(paper.forces, paper.coordinates, strict=True):
        work_rate = -paper.energies["forces"].diff(coordinate.value.symbol)
        assert sp.simplify(work_rate - force.symbol * 2 * s.HALF_LENGTH.symbol) == 0


@pytest.mark.parametrize(
    "spring",
    [
        neo_hookean(s.SHEAR_MODULUS_BETA),
        mooney_rivlin(s.SHEAR_MODULUS_BETA, SECOND),
        gent(s.SHEAR_MODULUS_BETA, LOCKING),
    ],
    ids=lambda spring: spring.name,
)
def test_the_dashpot_law_holds_for_any_strain_energy(spring, rng):
    """Deviatoric, volume-keeping, dissipative, and driving the spring's stress to a pressure."""
    stresses = spring.cauchy_stresses(
        elastic_stretches(rectangle(), (s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2))
    )
    rates = dashpot_strain_rates(stresses)
    assert sp.simplify(sum(rates)) == 0
    symbols = sorted(set().union(*(r.free_symbols for r in rates)), key=str)
    function = sp.lambdify(symbols, (rates, stresses))
    for _ in range(50):
        values = {symbol: rng.uniform(0.8, 1.3) for symbol in symbols} | {LOCKING.symbol: 80.0}
        found, sigma = function(*(values[symbol] for symbol in symbols))
        assert np.dot(found, sigma) >= 0
        deviator = np.array(sigma) - np.mean(sigma)
        assert np.allclose(np.array(found) * 2 * values[s.VISCOSITY.symbol], deviator, rtol=1e-12, atol=1e-12)


def test_a_relaxed_dashpot_is_at_rest(paper):
    relaxed = {
        internal.value.symbol: coordinate.value.symbol
        for internal, coordinate in zip(paper.internals, paper.coordinates, strict=True)
    }
    assert all(sp.simplify(rate.subs(relaxed)) == 0 for rate in paper.dashpot_rates)


def test_dissipation_is_what_the_springs_energy_loses(paper):
    """-dPi/dxi . xi' is the power into the dashpots, deviatoric stress squared over 2 eta, identically."""
    assert sp.simplify(_loss(paper) - _stress_power(paper)) == 0


def _loss(model):
    """What the potential loses when the dashpots flow by their law [W]."""
    flow = zip(model.internals, model.dashpot_rates, strict=True)
    return -sum(model.energies.total.diff(internal.value.symbol) * rate for internal, rate in flow)


def _stress_power(model):
    squares = sum(deviator**2 for deviator in model.dashpots[0].deviators)
    return model.volume * squares / (2 * s.VISCOSITY.symbol)


@pytest.mark.parametrize(
    "spring", [mooney_rivlin(s.SHEAR_MODULUS_BETA, SECOND), gent(s.SHEAR_MODULUS_BETA, LOCKING)]
)
def test_dissipation_identity_for_other_springs(spring):
    model = paper_membrane(beta=spring)
    assert sp.simplify(_loss(model) - _stress_power(model)) == 0


def test_gent_tends_to_neo_hookean():
    stretches = sp.symbols("a b c", positive=True)
    limit = sp.limit(gent(s.SHEAR_MODULUS_BETA, LOCKING).density(stretches), LOCKING.symbol, sp.oo)
    assert sp.simplify(limit - neo_hookean(s.SHEAR_MODULUS_BETA).density(stretches)) == 0
