"""What each quantity says of its role and its sign."""

from __future__ import annotations

import pytest

from delagrange.common.roles import Role, Sign
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation import more_symbols
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity, TimeDependent, moving
from delagrange.derive.papers.sheng_2015 import symbols as paper

MODULES = (s, more_symbols, paper)
KNOWN = tuple(each for module in MODULES for each in vars(module).values())
_, SECOND_MODULUS = MATERIALS["Mooney-Rivlin"](ALPHA).parameters
_, LOCKING = MATERIALS["Gent"](ALPHA).parameters
QUANTITIES = tuple(each for each in KNOWN if isinstance(each, Quantity))


@pytest.mark.parametrize("quantity", QUANTITIES, ids=lambda each: each.symbol.name)
def test_every_quantity_of_the_tables_says_what_it_is(quantity):
    assert quantity.role is not Role.CONSTANT


@pytest.mark.parametrize("each", [each for each in KNOWN if isinstance(each, TimeDependent)])
def test_what_moves_in_the_paper_is_a_stretch_and_positive(each):
    inelastic = each.value.symbol.name.startswith("xi")
    assert each.value.role is (Role.INELASTIC_STRETCH if inelastic else Role.STRETCH)
    assert (each.value.sign, each.rate.sign, each.acceleration.sign) == (Sign.POSITIVE, Sign.ANY, Sign.ANY)


def test_a_coordinate_is_a_stretch_only_where_it_is_said_to_be():
    angle = moving("angle", "angle", "φ", r"\phi", "angle")
    assert angle.value.role is Role.COORDINATE and angle.rate.role is Role.RATE


@pytest.mark.parametrize(("quantity", "sign"), [
    (s.HALF_LENGTH, Sign.POSITIVE), (s.VISCOSITY, Sign.POSITIVE), (LOCKING, Sign.POSITIVE),
    (more_symbols.EDGE_MASS, Sign.NOT_NEGATIVE), (more_symbols.PARALLEL_VISCOSITY, Sign.NOT_NEGATIVE),
    (more_symbols.CONDUCTIVITY, Sign.NOT_NEGATIVE), (more_symbols.EDGE_STIFFNESS, Sign.ANY),
    (SECOND_MODULUS, Sign.ANY), (s.FORCE, Sign.ANY),
])  # fmt: skip
def test_the_sign_is_what_mechanics_needs(quantity, sign):
    assert quantity.sign is sign


@pytest.mark.parametrize("name", MATERIALS)
def test_the_constants_of_every_strain_energy_have_a_role(name):
    roles = {parameter.role for parameter in MATERIALS[name](ALPHA).parameters}
    assert Role.MODULUS in roles and roles <= {Role.MODULUS, Role.EXPONENT, Role.LOCKING_LIMIT}
