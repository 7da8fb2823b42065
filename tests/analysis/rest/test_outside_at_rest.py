"""A membrane that is held beyond what its energy allows: nothing rests, and every answer says why."""

from __future__ import annotations

import numpy as np
import pytest
from charge_membranes import VOLTAGE, derived

import delagrange as dl

LOCKING = 6.0
GENT = f'material = "Gent"\nshear_modulus = "20 kPa"\nlocking = {LOCKING}'
PURE_SHEAR = 'kind = "pure_shear"\nheld_stretch = 1.5'
REASON = "the strain energy ceases to hold, in the unloaded state"


@pytest.fixture(scope="module")
def strip(tmp_path_factory):
    """In pure shear, where a stretch of 3 alone makes the first invariant too large."""
    assert 3.0**2 + 2 / 3.0 - 3 > LOCKING > 1.5**2 + 2 / 1.5 - 3
    folder = tmp_path_factory.mktemp("outside")
    return derived(folder, "gent_strip", control=VOLTAGE, spring=GENT, load=PURE_SHEAR)


def test_there_is_no_equilibrium_and_the_reason_is_said(strip):
    found = dl.equilibria(strip, held_stretch=3.0, field=[0.0, 1e6])
    assert found.sizes["branch"] == 0 and REASON in found.attrs["unloaded_lost"]
    assert "unloaded_lost" not in dl.equilibria(strip, held_stretch=1.5, field=[0.0, 1e6]).attrs


def test_modes_say_why_there_are_none_and_give_the_others(strip):
    found = dl.modes(strip, held_stretch=[1.5, 3.0])
    held, lost = found["status"].values
    assert held == "stable" and REASON in lost
    assert list(np.isfinite(found["frequency"].values[:, 0])) == [True, False]


def test_no_state_of_rest(strip):
    with pytest.raises(ValueError, match=REASON):
        dl.rest_state(strip, held_stretch=3.0)


def test_a_branch_that_the_unloaded_membrane_does_not_reach_is_not_said_to_begin_there(strip):
    """The stretch of the reference state is locked at a held stretch of 2.6; one of 1/sqrt(2.6) is not."""
    found = dl.equilibria(strip, held_stretch=2.6, locking_alpha=4.7, field=0.0)
    assert found["stretch"].values == pytest.approx([2.6**-0.5], rel=1e-10)
    assert "none begins" in found["branch"].attrs["long_name"] and REASON in found.attrs["unloaded_lost"]


def test_limits_without_room_for_the_unloaded_membrane_are_a_reason_too(strip):
    narrow = dl.Limits(smallest_stretch=0.9, largest_stretch=100.0)
    found = dl.modes(strip, held_stretch=1.5, limits=narrow)
    assert "a principal stretch below 0.9, in the unloaded state" in found["status"].item()
