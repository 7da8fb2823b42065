"""What an emitted module says of its variables and of its springs at rest."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from described import CURVED, described, emitted, parameters_of, plain

from delagrange.common.roles import Role, Sign
from delagrange.derive.membrane.description import Attachment, Description, Dielectric, Load
from delagrange.derive.membrane.own_energy import own_energy
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import moving

ATTACHED = tuple(Attachment(axis, m.EDGE_MASS, m.EDGE_STIFFNESS) for axis in (1, 2))


def facts(module):
    tables = (*module.STATE, *module.INPUTS, *module.PARAMETERS, *module.REACTIONS)
    return {entry.name: (Role(entry.role), Sign(entry.sign)) for entry in tables}


def test_every_variable_says_its_role_and_its_sign():
    leaking = replace(Dielectric(), control="charge", leakage=m.CONDUCTIVITY)
    module = emitted(described("equal_biaxial", "Gent", "Ogden", dielectric=leaking, attachments=ATTACHED))
    assert facts(module) == {
        "stretch": (Role.STRETCH, Sign.POSITIVE), "stretch_rate": (Role.RATE, Sign.ANY),
        "inelastic_stretch": (Role.INELASTIC_STRETCH, Sign.POSITIVE),
        "nominal_charge_density": (Role.CHARGE_DENSITY, Sign.ANY),
        "force": (Role.FORCE, Sign.ANY), "nominal_current_density": (Role.CURRENT_DENSITY, Sign.ANY),
        "half_length": (Role.SIZE, Sign.POSITIVE), "half_thickness": (Role.SIZE, Sign.POSITIVE),
        "density": (Role.MASS_DENSITY, Sign.POSITIVE), "permittivity": (Role.PERMITTIVITY, Sign.POSITIVE),
        "conductivity": (Role.CONDUCTIVITY, Sign.NOT_NEGATIVE),
        "shear_modulus_alpha": (Role.MODULUS, Sign.ANY), "locking_alpha": (Role.LOCKING_LIMIT, Sign.POSITIVE),
        "ogden_modulus_1_beta": (Role.MODULUS, Sign.ANY), "ogden_exponent_1_beta": (Role.EXPONENT, Sign.ANY),
        "viscosity": (Role.VISCOSITY, Sign.POSITIVE), "parallel_viscosity": (Role.DAMPING, Sign.NOT_NEGATIVE),
        "medium_damping": (Role.DAMPING, Sign.NOT_NEGATIVE), "edge_mass": (Role.MASS, Sign.NOT_NEGATIVE),
        "edge_stiffness": (Role.STIFFNESS, Sign.ANY),
    }  # fmt: skip


def test_a_coordinate_of_a_relation_is_no_stretch():
    own = moving("angle", "angle", "φ", r"\phi", "angle")
    curved = replace(CURVED, coordinate=own, stretches=(own.value.symbol, 1 / own.value.symbol))
    told = facts(emitted(plain("relation", load=Load("relation", relation=curved))))
    assert told["angle"] == (Role.COORDINATE, Sign.POSITIVE)
    assert told["reaction_force_1"] == (Role.REACTION, Sign.ANY)


def _chains(modulus, locking):
    """Arruda & Boyce (1993), five terms: mu (1 + 3/(5 N) + 99/(175 N^2) + 513/(875 N^3) + 42039/(67375 N^4))."""
    links = locking**2
    terms = zip((1, 3 / 5, 99 / 175, 513 / 875, 42039 / 67375), range(5), strict=True)
    return modulus * sum(coefficient / links**power for coefficient, power in terms)


@pytest.mark.parametrize(("material", "modulus"), [
    ("neo-Hookean", lambda mu: mu),
    ("Mooney-Rivlin", lambda mu, second: mu + second),
    ("Yeoh", lambda first, *_: 2 * first),
    ("Ogden", lambda mu, exponent: mu * exponent / 2),
    ("Gent", lambda mu, _: mu),
    ("Arruda-Boyce", _chains),
])  # fmt: skip
def test_the_springs_know_their_shear_modulus_at_rest(material, modulus):
    module = emitted(plain("uniaxial", material, "neo-Hookean", alpha="Gent"))
    names = [entry.name for entry in module.PARAMETERS]
    values = dict(zip(names, parameters_of(module), strict=True))
    values[module.SPRINGS["spring β of branch 1"][0]] = np.array([-5.0, 3e4])  # of several membranes at once
    found = module.shear_moduli_at_rest(tuple(values.values()))
    assert list(module.SPRINGS) == ["spring α", "spring β of branch 1", "spring β of branch 2"]
    assert found.shape == (3, 2)
    expected = modulus(*(values[name] for name in module.SPRINGS["spring β of branch 1"]))
    np.testing.assert_allclose(found[1], expected, rtol=1e-14)
    assert np.all(found[0] == values["shear_modulus_alpha"]) and np.all(
        found[2] == values["shear_modulus_beta_2"]
    )


def test_an_own_energy_knows_its_shear_modulus_at_rest():
    stretches = sp.symbols("a b c", positive=True)
    energy = own_energy(
        "own",
        s.SHEAR_MODULUS_ALPHA.symbol / 2 * (sp.exp(sum(each**2 for each in stretches) - 3) - 1),
        stretches,
        (s.SHEAR_MODULUS_ALPHA,),
    )
    module = emitted(Description("own", "A membrane", Load("equal_biaxial"), energy))
    assert math.isclose(module.shear_moduli_at_rest(parameters_of(module))[0], 1.8e4, rel_tol=1e-14)
    assert module.SPRINGS == {"spring α": ("shear_modulus_alpha",)}
