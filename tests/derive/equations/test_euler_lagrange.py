"""The operator against SymPy's own mechanics, load cases as constraints, and the laws that must come out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from delagrange.derive.equations.euler_lagrange import equations_of_motion, euler_lagrange, kinematics
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.time_derivative import time_derivative
from delagrange.derive.papers.sheng_2015 import symbols as paper

CONSISTENT = ("biaxial", "equal_biaxial", "uniaxial", "pure_shear_consistent", "pure_shear_consistent_free")
ALL = (*CONSISTENT, "pure_shear_as_printed")


def _sympy_mechanics(lagrangian, coordinates):
    """Euler-Lagrange expressions from sympy.physics.mechanics, in our symbols."""
    functions = {c: dynamicsymbols(f"q{k}") for k, c in enumerate(coordinates)}
    time = dynamicsymbols._t
    forward = {c.value.symbol: f for c, f in functions.items()} | {
        c.rate.symbol: f.diff(time) for c, f in functions.items()
    }
    method = LagrangesMethod(lagrangian.subs(forward), list(functions.values()))
    back = [(f.diff(time, 2), c.acceleration.symbol) for c, f in functions.items()]
    back += [(f.diff(time), c.rate.symbol) for c, f in functions.items()]
    back += [(f, c.value.symbol) for c, f in functions.items()]
    return [expression.subs(back) for expression in method.form_lagranges_equations()]


@pytest.mark.parametrize("name", ALL)
def test_operator_agrees_with_sympy_mechanics(name, equations):
    eom = equations(name)
    expected = _sympy_mechanics(eom.kinetic_energy - eom.potential_energy, eom.load_case.coordinates)
    for ours, theirs in zip(eom.residuals, expected, strict=True):
        assert sp.simplify(ours - theirs) == 0


def test_operator_takes_any_number_of_coordinates():
    coordinates = (s.STRETCH_1, s.STRETCH_2, paper.STRETCH_PS)
    q = [c.value.symbol for c in coordinates]
    v = [c.rate.symbol for c in coordinates]
    lagrangian = (
        sum(vi**2 * (1 + qi**2) for vi, qi in zip(v, q, strict=True))
        + q[0] * v[1] * v[2]
        - q[0] * q[1] ** 2 * q[2]
    )
    for ours, theirs in zip(
        euler_lagrange(lagrangian, coordinates), _sympy_mechanics(lagrangian, coordinates), strict=True
    ):
        assert sp.expand(ours - theirs) == 0


@pytest.mark.parametrize("name", ALL)
def test_first_order_form_solves_the_residuals(name, equations):
    eom = equations(name)
    solution = dict(
        zip((c.acceleration.symbol for c in eom.load_case.coordinates), eom.acceleration, strict=True)
    )
    assert all(sp.simplify(residual.subs(solution)) == 0 for residual in eom.residuals)


@pytest.mark.parametrize("name", ALL)
def test_mass_matrix_is_the_kinetic_energy(name, equations):
    eom = equations(name)
    v = sp.Matrix([c.rate.symbol for c in eom.load_case.coordinates])
    assert sp.simplify((v.T * eom.mass_matrix * v)[0] / 2 - eom.kinetic_energy) == 0
    assert eom.mass_matrix.is_symmetric()


def _energy_rate(eom):
    """d(T + Pi)/dt along a solution, forces and field constant."""
    load_case = eom.load_case
    rates = {i.rate.symbol: rate for i, rate in zip(load_case.internals, eom.internal_rates, strict=True)}
    accelerations = dict(
        zip((c.acceleration.symbol for c in load_case.coordinates), eom.acceleration, strict=True)
    )
    total = time_derivative(
        eom.kinetic_energy + eom.potential_energy, load_case.coordinates + load_case.internals
    )
    return total.subs(rates).subs(accelerations)


@pytest.mark.parametrize("name", CONSISTENT)
def test_energy_falls_at_the_rate_that_the_dashpots_dissipate(name, equations):
    eom = equations(name)
    assert sp.simplify(_energy_rate(eom) + eom.dashpot_power) == 0


def test_the_printed_pure_shear_breaks_the_energy_balance(equations):
    eom = equations("pure_shear_as_printed")
    assert sp.simplify(_energy_rate(eom) + eom.dashpot_power) != 0


@pytest.mark.parametrize("name", ALL)
def test_dissipation_is_never_negative(name, equations, rng):
    eom = equations(name)
    symbols = sorted(eom.dashpot_power.free_symbols, key=str)
    function = sp.lambdify(symbols, eom.dashpot_power)
    values = rng.uniform(0.4, 2.5, (len(symbols), 2000))
    power = function(*values)
    assert np.min(power) >= -1e-12 * np.max(power)


def test_holding_the_lateral_dashpot_ignores_a_rate(equations):
    """The remark in the module's docstring: Eq. (6) gives xi_2 a rate on the constraint that the model ignores."""
    free = equations("pure_shear_consistent_free").internal_rates[1]
    held = free.subs(paper.INELASTIC_STRETCH_PS2.value.symbol, s.HELD_STRETCH.symbol)
    at = {p.symbol: 1 for p in equations("pure_shear_consistent").parameters}
    at |= {paper.STRETCH_PS.value.symbol: 2, paper.INELASTIC_STRETCH_PS.value.symbol: 1}
    assert held.subs(at) != 0


def test_swapping_the_axes_leaves_the_membrane(equations):
    eom = equations("biaxial")
    pairs = [(s.STRETCH_1, s.STRETCH_2), (s.INELASTIC_STRETCH_1, s.INELASTIC_STRETCH_2)]
    swap = {}
    for a, b in pairs:
        for left, right in ((a.value, b.value), (a.rate, b.rate), (a.acceleration, b.acceleration)):
            swap |= {left.symbol: right.symbol, right.symbol: left.symbol}
    swap |= {s.FORCE_1.symbol: s.FORCE_2.symbol, s.FORCE_2.symbol: s.FORCE_1.symbol}
    first, second = eom.residuals
    assert sp.expand(first.subs(swap, simultaneous=True) - second) == 0
    assert sp.expand(eom.internal_rates[0].subs(swap, simultaneous=True) - eom.internal_rates[1]) == 0


def test_uniaxial_is_the_membrane_with_one_force(equations):
    full, uniaxial = equations("biaxial"), equations("uniaxial")
    substitution = kinematics(full.membrane, uniaxial.load_case) | {
        s.FORCE_1.symbol: s.FORCE.symbol,
        s.FORCE_2.symbol: 0,
    }
    for ours, theirs in zip(uniaxial.residuals, full.residuals, strict=True):
        assert sp.expand(ours - theirs.subs(substitution, simultaneous=True)) == 0


def test_equal_forces_give_the_equal_biaxial_motion(equations):
    """On the diagonal both residuals of the full membrane are half the equal-biaxial one."""
    full, diagonal = equations("biaxial"), equations("equal_biaxial")
    substitution = kinematics(full.membrane, diagonal.load_case) | {
        f.symbol: s.FORCE.symbol for f in full.membrane.forces
    }
    for residual in full.residuals:
        assert sp.expand(2 * residual.subs(substitution, simultaneous=True) - diagonal.residuals[0]) == 0


@pytest.mark.parametrize("name", ["pure_shear_consistent", "pure_shear_consistent_free"])
def test_the_reaction_holds_the_axis(name, equations):
    """With the reaction as its force, the full membrane started on the constraint stays there: lambda_2'' = 0."""
    full, held = equations("biaxial"), equations(name)
    substitution = kinematics(full.membrane, held.load_case)
    moving = dict(
        zip((c.acceleration.symbol for c in held.load_case.coordinates), held.acceleration, strict=True)
    )
    loads = {s.FORCE_1.symbol: s.FORCE.symbol, s.FORCE_2.symbol: held.reaction_forces[0].subs(moving)}
    first, second = full.acceleration
    assert sp.simplify(second.subs(loads).subs(substitution, simultaneous=True)) == 0
    assert sp.simplify(first.subs(loads).subs(substitution, simultaneous=True) - held.acceleration[0]) == 0


def test_the_reaction_has_a_thickness_inertia_term(equations):
    consistent, printed = equations("pure_shear_consistent"), equations("pure_shear_as_printed")
    difference = sp.expand(consistent.reaction_forces[0] - printed.reaction_forces[0])
    assert difference.has(paper.STRETCH_PS.acceleration.symbol) and difference.has(
        paper.STRETCH_PS.rate.symbol
    )
    at_rest = {paper.STRETCH_PS.acceleration.symbol: 0, paper.STRETCH_PS.rate.symbol: 0}
    assert difference.subs(at_rest) == 0
    assert consistent.static_reaction_forces == printed.static_reaction_forces


def test_the_printed_road_triples_two_terms_and_turns_the_electric_one(equations):
    terms = {t.name: t.vector[0] for t in equations("pure_shear_consistent").force_terms}
    printed = {t.name: t.vector[0] for t in equations("pure_shear_as_printed").force_terms}
    assert sp.expand(printed["electric_force"] + terms["electric_force"]) == 0
    for name in ("spring_alpha_force", "spring_beta_force"):
        own, theirs = (sp.expand(side[name]).as_ordered_terms() for side in (terms, printed))
        assert sorted(sp.simplify(b / a) for a, b in zip(own, theirs, strict=True)) == [1, 3]


# --- what physics says ------------------------------------------------------------------------------


def _linear_frequency(eom, values):
    """Natural frequency [Hz] of small vibration about the undeformed state, dashpots frozen."""
    coordinate = eom.load_case.coordinates[0].value.symbol
    rest = {q.symbol: 1 for q in eom.state if q.unit == "1"}
    stiffness = eom.potential_energy.diff(coordinate, 2).subs({s.FIELD.symbol: 0}).subs(rest)
    mass = eom.mass_matrix[0].subs(rest)
    return sp.sqrt(stiffness / mass).subs(values) / (2 * sp.pi)


def test_small_vibration_of_the_undeformed_membrane(equations):
    """f_n = sqrt(18 (mu_alpha + mu_beta) / (rho H^2 (2 + L^2/H^2))) / (2 pi) = 918.9 Hz."""
    L, H, rho, ma, mb = (
        q.symbol
        for q in (s.HALF_LENGTH, s.HALF_THICKNESS, s.DENSITY, s.SHEAR_MODULUS_ALPHA, s.SHEAR_MODULUS_BETA)
    )
    values = {L: sp.Rational(5, 1000), H: sp.Rational(1, 1000), rho: 1200, ma: 18000, mb: 42000}
    found = _linear_frequency(equations("equal_biaxial"), values)
    expected = sp.sqrt(18 * (ma + mb) / (rho * H**2 * (2 + L**2 / H**2))).subs(values) / (2 * sp.pi)
    assert float(found) == pytest.approx(float(expected), rel=1e-14)
    assert float(found) == pytest.approx(918.9, abs=0.05)


def test_pull_in_of_the_ideal_neo_hookean_dielectric(equations):
    """No force, spring beta absent: lambda = 2^(1/3) at a nominal field of 0.68736 sqrt(mu/epsilon)."""
    eom = equations("equal_biaxial")
    stretch, field = paper.STRETCH_EB.value.symbol, s.FIELD.symbol
    balance = eom.potential_energy.diff(stretch).subs({s.FORCE.symbol: 0, s.SHEAR_MODULUS_BETA.symbol: 0})
    squared = sp.solve(balance, field**2)[0]
    turning = [root for root in sp.solve(squared.diff(stretch), stretch) if root.is_positive]
    assert turning == [sp.cbrt(2)]
    critical = sp.sqrt(
        squared.subs(stretch, turning[0]) * s.PERMITTIVITY.symbol / s.SHEAR_MODULUS_ALPHA.symbol
    )
    assert float(critical) == pytest.approx(0.68736, abs=5e-6)


def test_relaxation_at_a_held_stretch(equations):
    """w = (xi/lambda)^2 obeys dw/dt = (1 - w^3) / (3 tau), tau = eta / mu_beta."""
    eom = equations("equal_biaxial")
    stretch, xi = paper.STRETCH_EB.value.symbol, paper.INELASTIC_STRETCH_EB.value.symbol
    w = (xi / stretch) ** 2
    tau = s.VISCOSITY.symbol / s.SHEAR_MODULUS_BETA.symbol
    assert sp.simplify(w.diff(xi) * eom.internal_rates[0] - (1 - w**3) / (3 * tau)) == 0


def test_a_constraint_at_odds_with_the_dashpots_is_refused(equations):
    shared = paper.INELASTIC_STRETCH_UA1
    uniaxial = equations("uniaxial")
    case = replace(
        uniaxial.load_case,
        internals=(shared,),
        inelastic_stretches=(shared.value.symbol, shared.value.symbol),
    )
    with pytest.raises(ValueError, match="inelastic_stretch_1 has two different dashpot rates"):
        equations_of_motion(uniaxial.membrane, case)
