"""Published parameter sets: complete, with units and sources, sane at all stretches, and near what was measured."""

from __future__ import annotations

import re

import numpy as np
import pytest
import sympy as sp
from conftest import paper_membrane
from hypothesis import assume, given
from hypothesis import strategies as st

from delagrange.common.dimension import Dimension
from delagrange.derive.membrane.material_data import (
    ECOFLEX_00_30_OGDEN,
    ECOFLEX_00_30_YEOH,
    MATERIAL_DATA,
    VHB_4910,
    BranchData,
    MaterialSet,
    material_data,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation import symbols as s

SETS = list(MATERIAL_DATA.values())
STRETCHES = sp.symbols("l_1 l_2 l_3", positive=True)


def springs(data):
    return (data.equilibrium_spring, *(branch.spring for branch in data.branches))


def cited(data):
    yield from (value for spring in springs(data) for value in spring.values.values())
    yield from (branch.relaxation_time for branch in data.branches)
    yield from (value for value in (data.permittivity, data.density) if value is not None)


def cauchy_stresses(spring):
    """Principal Cauchy stresses [Pa] of a spring up to a pressure, as a function of three stretches."""
    energy, values = spring.energy(ALPHA), spring.defaults(ALPHA)
    numbers = {parameter.symbol: values[parameter.name] for parameter in energy.parameters}
    return sp.lambdify(STRETCHES, [stress.subs(numbers) for stress in energy.cauchy_stresses(STRETCHES)])


STRESSES = {
    f"{data.name} {number}": cauchy_stresses(spring)
    for data in SETS
    for number, spring in enumerate(springs(data))
}


def nominal_stress(data, stretch):
    """Nominal stress [Pa] of the equilibrium spring along one axis."""
    first, _, third = STRESSES[f"{data.name} 0"](stretch, stretch**-0.5, stretch**-0.5)
    return (first - third) / stretch


@pytest.mark.parametrize("data", SETS, ids=lambda data: data.name)
def test_every_value_says_where_it_is_from(data):
    values = list(cited(data))
    assert values
    for value in values:
        assert re.search(r"\b(19|20)\d\d\b", value.source), value
        assert value.read_in
        assert np.isfinite(value.value)
    assert data.left_out


@pytest.mark.parametrize("data", SETS, ids=lambda data: data.name)
def test_every_parameter_has_a_value_of_its_unit_and_sign(data):
    for spring in springs(data):
        kinds = MATERIALS[spring.material].kinds(spring.terms)
        assert set(spring.values) == {kind.name for kind in kinds}
        for kind in kinds:
            assert Dimension.of_unit(spring.values[kind.name].unit) == Dimension.of_unit(kind.unit)
            assert spring.values[kind.name].value > 0 or not kind.positive


@pytest.mark.parametrize("data", SETS, ids=lambda data: data.name)
def test_defaults_name_every_parameter_of_springs_and_dashpots(data):
    names = [parameter.name for parameter in data.energy().parameters]
    for branch in data.maxwell_branches():
        names += [parameter.name for parameter in branch.energy.parameters] + [branch.viscosity.name]
    names += [s.PERMITTIVITY.name] * (data.permittivity is not None)
    names += [s.DENSITY.name] * (data.density is not None)
    assert len(set(names)) == len(names)
    assert set(data.defaults()) == set(names)


@pytest.mark.parametrize("name", STRESSES)
@given(one=st.floats(0.4, 4.0), two=st.floats(0.4, 4.0))
def test_the_greater_stretch_has_the_greater_stress(name, one, two):
    """Baker & Ericksen (1954): (sigma_i - sigma_j)(lambda_i - lambda_j) is positive."""
    assume(abs(one - two) > 1e-3)
    stretches = np.array([one, two, 1 / (one * two)])
    stresses = np.array(STRESSES[name](*stretches))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if abs(stretches[i] - stretches[j]) > 1e-6:
            assert (stresses[i] - stresses[j]) * (stretches[i] - stretches[j]) > 0


@given(stretch=st.floats(1 / 3, 8.0), other=st.floats(1 / 3, 8.0))
@pytest.mark.parametrize("data", SETS, ids=lambda data: data.name)
def test_pulling_harder_stretches_further(data, stretch, other):
    assume(stretch - other > 1e-3)
    assert nominal_stress(data, stretch) > nominal_stress(data, other)


def test_viscosity_is_modulus_times_relaxation_time():
    values = VHB_4910.defaults()
    for number, time in ((1, 0.6074), (2, 6.56), (3, 61.25)):
        assert values[f"viscosity_{number}"] == pytest.approx(values[f"shear_modulus_beta_{number}"] * time)
    alone = BranchData(VHB_4910.equilibrium_spring, VHB_4910.branches[0].relaxation_time)
    assert alone.viscosity() == pytest.approx(float(VHB_4910.equilibrium_spring.shear_modulus()) * 0.6074)


def test_a_branch_alone_carries_no_number():
    data = MaterialSet("one", "", "", VHB_4910.equilibrium_spring, VHB_4910.branches[:1])
    assert {"viscosity", "shear_modulus_beta"} < set(data.defaults())


@pytest.mark.parametrize("stretch", [0.5, 1.5, 3.0, 4.7])
def test_vhb_in_equilibrium_is_what_the_text_computes(stretch):
    """Stewart & Anand's uniaxial stress, with Cohen's (1991) Pade approximant of L^-1; ours is the series."""
    x = np.sqrt((stretch**2 + 2 / stretch) / 3) / 5.99
    factor = (3 - x**2) / (1 - x**2) / 3
    expected = 15.36e3 * factor * (stretch - stretch**-2)
    assert nominal_stress(VHB_4910, stretch) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize(("stretch", "measured"), [(2.327, 37.28e3), (3.577, 60.28e3), (4.688, 84.67e3)])
def test_vhb_in_equilibrium_is_near_what_was_measured(stretch, measured):
    """Nominal stress of Wang et al. (2016) as digitised by Stewart & Anand (2024), less its first point.

    The fit itself misses the first of these by 8 %, the others by 2 % and 1 %.
    """
    assert nominal_stress(VHB_4910, stretch) == pytest.approx(measured, rel=0.09)


def test_a_newtonian_dashpot_flows_as_the_later_codes_have_it():
    """dC_v/dt = (C - C_v tr(C C_v^-1)/3) / tau, the flow (Stewart & Anand 2024) that keeps det C_v = 1."""
    model = paper_membrane()
    xi = [internal.value.symbol for internal in model.internals]
    ratio = model.principal_stretches[2] * xi[0] * xi[1]
    trace = sum((model.principal_stretches[i] / xi[i]) ** 2 for i in (0, 1)) + ratio**2
    time = s.VISCOSITY.symbol / s.SHEAR_MODULUS_BETA.symbol
    for i in (0, 1):
        flow = (model.principal_stretches[i] ** 2 - xi[i] ** 2 * trace / 3) / time
        assert sp.simplify(2 * xi[i] * model.dashpot_rates[i] - flow) == 0


@pytest.mark.parametrize(
    ("data", "standard_error"), [(ECOFLEX_00_30_YEOH, 1.259e3), (ECOFLEX_00_30_OGDEN, 1.519e3)]
)
def test_ecoflex_in_compression_is_what_was_measured(data, standard_error):
    """Mean nominal stress of the ten tests of EF30_0T in the database; its standard error of the fit."""
    measured = {0.8: -24.02e3, 0.6: -63.69e3, 0.5: -108.13e3, 0.4: -214.73e3}
    for stretch, stress in measured.items():
        assert abs(nominal_stress(data, stretch) - stress) < 2 * standard_error


def test_an_unknown_set_is_refused_with_the_nearest_name():
    assert material_data("vhb_4910") is VHB_4910
    with pytest.raises(ValueError, match="did you mean 'vhb_4910'"):
        material_data("vhb_4905")
