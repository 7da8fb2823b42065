"""A user's own strain energy: equal to a built-in one that it repeats, or refused in one line."""

from __future__ import annotations

import pytest
import sympy as sp

from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.membrane.own_energy import own_energy
from delagrange.derive.notation import symbols as s

A, B, C = STRETCHES = sp.symbols("lambda_1 lambda_2 lambda_3", positive=True)
LOCKING = MATERIALS["Gent"](ALPHA).parameters[1]
MU, LIMIT = s.SHEAR_MODULUS_ALPHA.symbol, LOCKING.symbol
EXCESS = A**2 + B**2 + C**2 - 3
MODULUS = (s.SHEAR_MODULUS_ALPHA,)


def test_gent_written_down_is_gent():
    ours = own_energy(
        "mine",
        -MU * LIMIT / 2 * sp.log(1 - EXCESS / LIMIT),
        STRETCHES,
        (s.SHEAR_MODULUS_ALPHA, LOCKING),
        validity=LIMIT - EXCESS,
    )
    gent = MATERIALS["Gent"](ALPHA)
    at = sp.symbols("a b c", positive=True)
    assert ours.parameters == gent.parameters
    assert sp.simplify(ours.density(at) - gent.density(at)) == 0
    assert sp.expand(ours.validity(at) - gent.validity(at)) == 0
    assert ours.shear_modulus == gent.shear_modulus


def test_stretches_may_change_places():
    """The stretches are put in at once: none is taken for another that is put in before it."""
    ours = own_energy("mine", MU * (EXCESS + (A - 1) ** 2), STRETCHES, MODULUS)
    assert sp.expand(ours.density((B, A, C)) - MU * (EXCESS + (B - 1) ** 2)) == 0


def test_exponential_energy_of_fung_is_taken():
    b = LOCKING.symbol
    fung = own_energy(
        "Fung", MU / (2 * b) * (sp.exp(b * EXCESS) - 1), STRETCHES, (s.SHEAR_MODULUS_ALPHA, LOCKING)
    )
    assert fung.shear_modulus == MU
    assert fung.validity is None


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        (MU / 2 * (sp.Symbol("lambda_4") ** 2 - 1), r"unknown symbol lambda_4 \(did you mean 'lambda_\d'"),
        (MU**2 * EXCESS, "allowed is that of Pa"),
        (MU * EXCESS + EXCESS, "breaks its unit"),
        (MU * sp.exp(MU * EXCESS), "breaks its unit"),
        (MU * (A + 2 * B + C), "not stress-free at rest"),
        (MU * sp.log(A * B * C - 1), "not stress-free at rest"),
    ],
)
def test_what_is_no_strain_energy_is_refused_in_one_line(expression, reason):
    with pytest.raises(ValueError, match=reason) as refused:
        own_energy("mine", expression, STRETCHES, MODULUS)
    assert "\n" not in str(refused.value)
    assert "'mine'" in str(refused.value)


def test_a_limit_with_an_unknown_symbol_is_refused():
    with pytest.raises(ValueError, match=r"limit of mine.*unknown symbol J_alpha"):
        own_energy("mine", MU * EXCESS, STRETCHES, MODULUS, validity=LIMIT - EXCESS)


def test_a_limit_with_a_unit_is_refused():
    with pytest.raises(ValueError, match=r"limit of mine.*allowed is that of 1"):
        own_energy("mine", MU * EXCESS, STRETCHES, MODULUS, validity=MU * (LIMIT - EXCESS).subs(LIMIT, 3))
