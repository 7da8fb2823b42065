"""General forms in the limits in which they are special ones."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from described import VALUES, branches, emitted, inputs_of, parameters_of, state_of

from delagrange.derive.membrane.description import (
    BIAXIAL,
    CHARGE,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    RELATION,
    UNIAXIAL,
    Description,
    Dielectric,
    Load,
    Relation,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation import more_symbols as m

KINDS = (EQUAL_BIAXIAL, UNIAXIAL, PURE_SHEAR)
MODULUS = 1.8e4  # [Pa], of the neo-Hookean spring
FAR = 1e9


def membrane(alpha="neo-Hookean", *beta, kind=EQUAL_BIAXIAL, load=None, **parts):
    load = load or Load(kind)
    return emitted(Description("own", "A membrane", load, MATERIALS[alpha](ALPHA), branches(*beta), **parts))


def values_of(module, **changed):
    return dict(
        zip((entry.name for entry in module.PARAMETERS), parameters_of(module, **changed), strict=True)
    )


def rates(module, state, inputs, **changed):
    return module.rhs(state, inputs, parameters_of(module, **changed))


def spring(letter, **values):
    return {f"{name}_{letter}": value for name, value in values.items()}


# Parameters with which an energy is neo-Hookean of the modulus given, or nearly so
LIKE_NEO_HOOKEAN = {
    "Mooney-Rivlin": lambda modulus: {"shear_modulus": modulus, "second_modulus": 0.0},
    "Yeoh": lambda modulus: {
        "yeoh_coefficient_1": modulus / 2, "yeoh_coefficient_2": 0.0, "yeoh_coefficient_3": 0.0,
    },
    "Ogden": lambda modulus: {"ogden_modulus_1": modulus, "ogden_exponent_1": 2.0},
    "Gent": lambda modulus: {"shear_modulus": modulus, "locking": FAR},
    "Arruda-Boyce": lambda modulus: {"chain_modulus": modulus, "locking_stretch": FAR},
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", LIKE_NEO_HOOKEAN)
def test_every_material_can_be_neo_hookean(name, kind, rng):
    special, general = membrane("neo-Hookean", kind=kind), membrane(name, kind=kind)
    state, inputs = state_of(special, rng, parameters_of(special)), inputs_of(special)
    expected = rates(special, state, inputs)
    found = rates(general, state, inputs, **spring("alpha", **LIKE_NEO_HOOKEAN[name](MODULUS)))
    assert np.allclose(found, expected, rtol=1e-6)


@pytest.mark.parametrize("name", ["Gent", "Arruda-Boyce"])
def test_a_limit_is_approached_as_the_first_term_left_out_says(name, rng):
    """The stiffening falls as the inverse of the locking limit (Gent), and as the square of that (Arruda-Boyce)."""
    special, general = membrane("neo-Hookean"), membrane(name)
    state, inputs = state_of(special, rng, parameters_of(special)), inputs_of(special)
    expected = rates(special, state, inputs)[1]
    key, order = {"Gent": ("locking_alpha", 1), "Arruda-Boyce": ("locking_stretch_alpha", 2)}[name]
    own = spring("alpha", **LIKE_NEO_HOOKEAN[name](MODULUS))
    errors = [abs(rates(general, state, inputs, **(own | {key: far}))[1] - expected) for far in (1e2, 1e3)]
    assert errors[0] / errors[1] == pytest.approx(10**order, rel=0.05)


def test_ogden_terms_with_exponents_2_and_minus_2_are_mooney_rivlin(rng):
    special = membrane("Mooney-Rivlin")
    general = emitted(
        Description("own", "A membrane", Load(EQUAL_BIAXIAL), MATERIALS["Ogden"](ALPHA, terms=2))
    )
    moduli = values_of(special)
    own = {
        "ogden_modulus_1_alpha": moduli["shear_modulus_alpha"], "ogden_exponent_1_alpha": 2.0,
        "ogden_modulus_2_alpha": -moduli["second_modulus_alpha"], "ogden_exponent_2_alpha": -2.0,
    }  # fmt: skip
    state, inputs = state_of(special, rng, parameters_of(special)), inputs_of(special)
    assert np.allclose(rates(general, state, inputs, **own), rates(special, state, inputs), rtol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["neo-Hookean", "Gent"])
def test_branches_with_equal_times_are_one(name, kind, rng):
    one, two = membrane(name, name, kind=kind), membrane(name, name, name, kind=kind)
    single = values_of(one)
    count = 2 * one.COORDINATE_COUNT
    shared = {
        f"{key}_{number}": single[key] / 2 for key in ("shear_modulus_beta", "viscosity") for number in (1, 2)
    }
    shared |= {f"locking_beta_{number}": single["locking_beta"] for number in (1, 2) if name == "Gent"}
    state, inputs = state_of(one, rng, list(single.values())), inputs_of(one)
    motion, inner = state[:count], state[count:]
    found = rates(two, [*motion, *inner, *inner], inputs, **shared)
    expected = rates(one, state, inputs)
    assert np.allclose(found, [*expected, *expected[count:]], rtol=1e-10)


@pytest.mark.parametrize("control", [Dielectric(), Dielectric(control=CHARGE)], ids=["voltage", "charge"])
@pytest.mark.parametrize("name", ["neo-Hookean", "Ogden", "Gent"])
def test_equal_forces_along_both_axes_give_the_equal_biaxial_motion(name, control, rng):
    both = membrane(name, kind=BIAXIAL, dielectric=control)
    equal = membrane(name, kind=EQUAL_BIAXIAL, dielectric=control)
    stretch, rate = state_of(equal, rng, parameters_of(equal))
    force, electric = inputs_of(equal)
    found = rates(both, [stretch, stretch, rate, rate], [force, force, electric])
    assert np.allclose(found, np.repeat(rates(equal, [stretch, rate], [force, electric]), 2), rtol=1e-11)


def test_uniaxial_is_biaxial_without_the_second_force(rng):
    both, one = membrane("Gent", "neo-Hookean", kind=BIAXIAL), membrane("Gent", "neo-Hookean", kind=UNIAXIAL)
    state = state_of(one, rng, parameters_of(one))
    force, field = inputs_of(one)
    assert np.allclose(rates(both, state, [force, 0.0, field]), rates(one, state, [force, field]), rtol=1e-12)


_Q = m.STRETCH.value.symbol


@pytest.mark.parametrize(
    ("kind", "stretches", "levers"),
    [(EQUAL_BIAXIAL, (_Q, _Q), (True, True)), (PURE_SHEAR, (_Q, sp.Rational(17, 10)), (True, False))],
)
def test_a_relation_can_be_a_load_that_has_a_name(kind, stretches, levers, rng):
    relation = Relation(m.STRETCH, stretches, sp.S(1), levers)
    own = membrane("Gent", load=Load(RELATION, relation=relation))
    named = membrane("Gent", kind=kind)
    state = state_of(named, rng, parameters_of(named))
    *forces, field = inputs_of(named)
    found = rates(own, state, [*forces * sum(levers), field])
    assert np.allclose(found, rates(named, state, [*forces, field]), rtol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_a_field_and_the_charge_that_it_brings_pull_alike(kind, rng):
    """Charge density D = epsilon E lambda_1^2 lambda_2^2, by hand from a plate capacitor in the deformed membrane."""
    voltage, charge = (
        membrane("Gent", "neo-Hookean", kind=kind, dielectric=Dielectric(control=control))
        for control in ("voltage", "charge")
    )
    parameters = parameters_of(voltage)
    state = state_of(voltage, rng, parameters)
    force, field = inputs_of(voltage)
    first, second, _ = voltage.principal_stretches(state, [force, field], parameters)
    density = VALUES["permittivity"] * field * (first * second) ** 2
    found, expected = rates(charge, state, [force, density]), rates(voltage, state, [force, field])
    assert np.allclose(found, expected, rtol=1e-11)
