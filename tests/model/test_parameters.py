"""The membrane as validated, frozen data."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange import SHENG_2015, Parameters
from delagrange.model.parameters import CHANGEABLE_UNITS, MATERIAL_UNITS

positive = st.floats(1e-12, 1e12)


def test_the_papers_set():
    assert (SHENG_2015.half_length, SHENG_2015.half_thickness) == (5e-3, 1e-3)
    assert (SHENG_2015.density, SHENG_2015.permittivity) == (1.2e3, 6.198e-11)
    assert (SHENG_2015.shear_modulus_alpha, SHENG_2015.shear_modulus_beta) == (1.8e4, 4.2e4)
    assert SHENG_2015.relaxation_time == pytest.approx(400.0, rel=1e-15)
    assert "10.1063/1.4913384" in SHENG_2015.source


def test_frozen_and_described():
    with pytest.raises(FrozenInstanceError):
        SHENG_2015.density = 1.0
    for entry in fields(Parameters):
        if entry.name != "source":
            assert entry.metadata["unit"] and entry.metadata["symbol"] and entry.metadata["meaning"]


@pytest.mark.parametrize("name", MATERIAL_UNITS)
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), "1", None, True])
def test_each_value_must_be_positive_and_finite(name, value):
    values = {entry: getattr(SHENG_2015, entry) for entry in MATERIAL_UNITS}
    with pytest.raises(ValueError, match=name) as caught:
        Parameters(**(values | {name: value}))
    assert "\n" not in str(caught.value)


@given(name=st.sampled_from(list(MATERIAL_UNITS)), value=positive)
def test_replace_changes_one_value_and_says_so(name, value):
    changed = SHENG_2015.replace(**{name: value})
    for entry in MATERIAL_UNITS:
        assert getattr(changed, entry) == (value if entry == name else getattr(SHENG_2015, entry))
    assert SHENG_2015.source in changed.source and name in changed.source


@given(modulus=positive, time=st.floats(1e-6, 1e6))
def test_relaxation_time_sets_the_viscosity(modulus, time):
    changed = SHENG_2015.replace(shear_modulus_beta=modulus, relaxation_time=time)
    assert changed.shear_modulus_beta == modulus
    assert changed.relaxation_time == pytest.approx(time, rel=1e-14)


def test_viscosity_and_relaxation_time_exclude_each_other():
    with pytest.raises(ValueError, match=r"viscosity .* relaxation_time"):
        SHENG_2015.replace(viscosity=1.0, relaxation_time=1.0)


def test_an_unknown_name_is_answered_with_the_nearest():
    with pytest.raises(ValueError, match=r"densty.*did you mean 'density'"):
        SHENG_2015.replace(densty=1.0)


def test_arrays_broadcast_over_a_grid():
    values = SHENG_2015.material.changed({"relaxation_time": np.array([1.0, 2.0])})
    np.testing.assert_array_equal(values["viscosity"], 4.2e4 * np.array([1.0, 2.0]))
    with pytest.raises(ValueError, match="density"):
        SHENG_2015.material.changed({"density": np.array([1.0, -2.0])})
    assert CHANGEABLE_UNITS["relaxation_time"] == "s"
