"""Equilibria against closed forms, against the energies in high precision, and against laws."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from gent_membrane import gent_membrane
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st
from precise_membrane import P, PreciseMembrane

import delagrange as dl
from delagrange.common.files import write_dataset

MU = P.shear_modulus_alpha + P.shear_modulus_beta
FIELD_UNIT = np.sqrt(MU / P.permittivity)  # [V/m], about 31 MV/m


@pytest.fixture(autouse=True)
def precise():
    with mp.workdps(40):
        yield


def neo_hookean_field(stretch: np.ndarray, modulus: float, force: float = 0.0) -> np.ndarray:
    """ε E^2 λ^3 = μ (λ - λ^-5) - P / (4 L H): the field of an equal-biaxial equilibrium."""
    stress = force / (4 * P.half_length * P.half_thickness)
    return np.sqrt((modulus * (stretch - stretch**-5) - stress) / (P.permittivity * stretch**3))


@pytest.mark.parametrize(("dashpots", "modulus"), [("frozen", MU), ("relaxed", P.shear_modulus_alpha)])
def test_the_whole_curve_is_the_closed_form(dashpots, modulus):
    found = dl.equilibria("equal_biaxial", field=np.linspace(0, 3e7, 31), dashpots=dashpots)
    stretch, field = found["curve_stretch"].values, found["curve_field"].values
    assert stretch.max() > 30
    expected = modulus * (stretch**-2 - stretch**-8)  # of ε E^2, whose terms cancel at λ = 1
    size = modulus * np.maximum(stretch**-2, 1e-3)
    np.testing.assert_allclose(P.permittivity * field**2 / size, expected / size, rtol=0, atol=1e-12)
    folds = found["limit_kind"].values.tolist()
    assert folds == ["pull-in"]
    np.testing.assert_allclose(found["limit_stretch"], 2 ** (1 / 3), rtol=1e-12)


def test_every_field_asked_for_has_its_equilibria():
    fields = np.linspace(0, 2.5e7, 26)
    found = dl.equilibria("equal_biaxial", force=0.5, field=fields, dashpots="frozen")
    for branch in found["branch"].values:
        stretch = found["stretch"].isel(branch=branch).values
        there = np.isfinite(stretch)
        assert np.any(there)
        there &= fields > 0
        np.testing.assert_allclose(neo_hookean_field(stretch[there], MU, 0.5), fields[there], rtol=1e-10)
    beyond = fields > float(found["limit_field"][0])
    assert found["count"].values[beyond].tolist() == [0] * beyond.sum()
    assert np.all(found["stability"].values[beyond] == "no equilibrium")
    assert found["count"].values[1:][~beyond[1:]].max() == 2
    assert np.all(found["stable_count"].values[~beyond] == 1)


@pytest.mark.parametrize("field", [0.0, 5e6, 1.5e7])
@pytest.mark.parametrize("dashpots", ["frozen", "relaxed"])
def test_uniaxial_equilibria_are_those_of_the_energies(field, dashpots):
    field = field if dashpots == "frozen" else field / 3
    found = dl.equilibria("uniaxial", force=0.5, field=field, dashpots=dashpots)
    witness = PreciseMembrane(0.5, field, (1.0, 1.0) if dashpots == "frozen" else None)
    for branch in np.flatnonzero(np.isfinite(found["stretch_1"].values)):
        here = found.isel(branch=branch)
        expected = witness.rest(float(here["stretch_1"]), float(here["stretch_2"]))
        np.testing.assert_allclose(
            [float(here["stretch_1"]), float(here["stretch_2"])], [float(v) for v in expected], rtol=1e-12
        )
        if dashpots == "relaxed":
            np.testing.assert_allclose(here["inelastic_stretch_2"], here["stretch_2"], rtol=1e-12)
    assert int(found["count"]) == (2 if field else 1)


@pytest.mark.parametrize("dashpots", ["frozen", "relaxed"])
def test_pure_shear_equilibria_are_those_of_the_energies(dashpots):
    found = dl.equilibria("pure_shear", force=0.3, field=6e6, held_stretch=2.0, dashpots=dashpots)
    witness = PreciseMembrane(0.3, 6e6, (1.0, 2.0) if dashpots == "frozen" else None, held=2.0)
    assert int(found["count"]) == 1
    assert found["stability"].values.tolist() == ["stable"]
    expected = witness.rest(float(found["stretch"][0]))[0]
    assert float(found["stretch"][0]) == pytest.approx(float(expected), rel=1e-12)


def test_edge_forces_are_the_applied_force_and_the_reaction():
    found = dl.equilibria("pure_shear", force=0.3, field=6e6, held_stretch=2.0, dashpots="frozen")
    stretch = float(found["stretch"][0])
    witness = PreciseMembrane(0.0, 6e6, (1.0, 2.0))
    reaction = witness.derivative((mp.mpf(stretch), mp.mpf(2)), 0, 1) / (2 * mp.mpf(P.half_length))
    assert float(found["edge_force_1"][0]) == pytest.approx(0.3, rel=1e-12)
    assert float(found["edge_force_2"][0]) == pytest.approx(float(reaction), rel=1e-12)


def test_a_stiffening_membrane_snaps_through():
    gent = gent_membrane()
    fields = np.linspace(0, 1.2, 25) * np.sqrt(P.shear_modulus_alpha / P.permittivity)
    found = dl.equilibria(gent, field=fields, dashpots="frozen")
    assert sorted(found["limit_kind"].values) == ["snap-back", "snap-through"]
    assert found["count"].values.max() == 3
    assert found["count"].values[-1] == 1
    assert set(found["stable_count"].values) == {1, 2}
    assert found["curve_branch"].values.max() == 2
    stable = found["curve_stability"].values == "stable"
    assert set(found["curve_branch"].values[stable]) == {0, 2}
    pull_in = dl.pull_in(gent)
    assert str(pull_in["found"].values) == "snap-through"
    assert float(pull_in["field"]) == pytest.approx(float(found["limit_field"].max()), rel=1e-12)


def test_stability_and_margins():
    found = dl.equilibria("uniaxial", force=0.5, field=[0.0, 1e7, 1.9e7, 2e7], dashpots="frozen")
    assert found["stability"].values.tolist() == [
        ["stable", "no equilibrium"],
        ["stable", "saddle"],
        ["stable", "saddle"],
        ["no equilibrium"] * 2,
    ]
    limit = float(found["limit_field"][0])
    np.testing.assert_allclose(found["margin"][:3, 0], limit - np.array([0.0, 1e7, 1.9e7]), rtol=1e-12)
    np.testing.assert_allclose(found["relative_margin"][1, 0], 1 - 1e7 / limit, rtol=1e-12)
    assert found["branch_lower_end"].values[1].startswith("limit: ")
    assert found["branch_upper_end"].values.tolist() == ["fold", "fold"]


def test_voltage_is_field_times_thickness():
    by_field = dl.equilibria("equal_biaxial", field=[1e6, 1e7])
    by_voltage = dl.equilibria("equal_biaxial", voltage=[2e3, 2e4])
    np.testing.assert_array_equal(by_voltage["field"], by_field["field"])
    np.testing.assert_array_equal(by_voltage["stretch"], by_field["stretch"])
    np.testing.assert_allclose(by_field["voltage"], [2e3, 2e4])


def test_loss_of_tension_and_breakdown():
    found = dl.equilibria(
        "pure_shear", force=0.1, field=[1e6, 1.4e7], held_stretch=2.0, dashpots="frozen", breakdown_field=2e7
    )
    assert found["tension_lost"].values.ravel().tolist() == [False, True]
    assert found["edge_force_2"].values[1, 0] < 0
    assert found["breakdown"].values.ravel().tolist() == [False, True]
    np.testing.assert_allclose(
        found["true_field"].values.ravel(), [1e6, 1.4e7] * found["stretch"].values.ravel() * 2, rtol=1e-12
    )
    free = dl.equilibria("equal_biaxial", field=[1e6, 1e7])
    assert not np.any(free["tension_lost"])
    stronger = dl.equilibria(
        "pure_shear", force=0.1, field=[1e6, 1.4e7], held_stretch=2.0, dashpots="frozen",
        breakdown_field=2e7, breakdown_exponent=2.0,
    )  # fmt: skip
    assert not np.any(stronger["breakdown"])


def test_at_the_limit_point_itself_two_become_one():
    limit = float(dl.pull_in("equal_biaxial")["field"])
    found = dl.equilibria("equal_biaxial", field=limit, dashpots="frozen")
    assert set(found["stability"].values) == {"limit point"}
    assert int(found["stable_count"]) == 0
    assert float(found["margin"].max()) == 0.0


def test_the_sign_of_the_field_does_not_matter():
    found = dl.equilibria("equal_biaxial", field=[-1e7, 1e7])
    np.testing.assert_array_equal(found["stretch"][0], found["stretch"][1])
    np.testing.assert_allclose(found["voltage"], [-2e4, 2e4])


def test_a_single_field_has_no_dimension():
    found = dl.equilibria("equal_biaxial", field=1e7)
    assert found["stretch"].dims == ("branch",)
    assert int(found["count"]) == 2


def test_a_given_state_freezes_the_dashpots_there():
    found = dl.equilibria(
        "equal_biaxial", field=0.0, dashpots="frozen", initial_state={"inelastic_stretch": 1.5}
    )
    stretch = float(found["stretch"][0])
    balance = P.shear_modulus_alpha * (stretch - stretch**-5) + P.shear_modulus_beta * (
        stretch / 1.5**2 - 1.5**4 / stretch**5
    )
    assert abs(balance) < 1e-9 * MU
    assert found.attrs["initial_inelastic_stretch"] == 1.5


def test_beyond_pull_in_there_is_an_answer():
    found = dl.equilibria("equal_biaxial", field=4e7)
    assert int(found["count"]) == 0
    assert np.all(np.isnan(found["stretch"]))
    nothing = dl.equilibria("equal_biaxial", force=1e4, field=[1e7, 2e7])
    assert nothing["count"].values.tolist() == [0, 0]


def test_results_can_be_written(tmp_path):
    found = dl.equilibria("uniaxial", force=0.5, field=[0.0, 1e7], breakdown_field=3e7)
    write_dataset(found, tmp_path / "found.nc")
    assert (tmp_path / "found.nc").stat().st_size > 0
    for name, values in found.variables.items():
        assert "long_name" in values.attrs, name
        assert values.dtype.kind in "bO" or "units" in values.attrs, name


def test_a_stiff_spring_beside_a_soft_one_loses_no_digits_that_matter():
    found = dl.pull_in("uniaxial", dashpots="relaxed", shear_modulus_beta=1e9)
    expected = np.sqrt(3 / 4 / 2 ** (2 / 3) * P.shear_modulus_alpha / P.permittivity)
    assert float(found["field"]) == pytest.approx(expected, rel=1e-9)


def test_what_is_beyond_double_precision_is_lost_and_says_where():
    found = dl.pull_in("uniaxial", dashpots="relaxed", shear_modulus_alpha=1e-3)
    assert found["found"].item().startswith("lost: ")
    assert "near parameter" in found["found"].item()
    assert np.isfinite(found["highest_field"])


@given(factor=st.floats(0.01, 100), share=st.floats(0.1, 0.9))
@budget(max_examples=4)
def test_stiffness_scales_force_and_field(factor, share):
    """μ -> c μ, P -> c P, E -> c^(1/2) E leaves every stretch as it is."""
    softer = dl.equilibria("uniaxial", force=0.4, field=share * 1.9e7, dashpots="frozen")
    harder = dl.equilibria(
        "uniaxial", force=0.4 * factor, field=share * 1.9e7 * np.sqrt(factor), dashpots="frozen",
        shear_modulus_alpha=factor * P.shear_modulus_alpha, shear_modulus_beta=factor * P.shear_modulus_beta,
    )  # fmt: skip
    np.testing.assert_allclose(harder["stretch_1"], softer["stretch_1"], rtol=1e-10)
    np.testing.assert_allclose(harder["stretch_2"], softer["stretch_2"], rtol=1e-10)


@given(share=st.floats(0.05, 0.95), dashpots=st.sampled_from(["frozen", "relaxed"]))
@budget(max_examples=4)
def test_without_force_both_axes_are_alike(share, dashpots):
    """Uniaxial without force is equal-biaxial without force."""
    modulus = MU if dashpots == "frozen" else P.shear_modulus_alpha
    field = share * 0.687 * np.sqrt(modulus / P.permittivity)
    one = dl.equilibria("equal_biaxial", field=field, dashpots=dashpots)
    two = dl.equilibria("uniaxial", field=field, dashpots=dashpots)
    assert int(one["count"]) == int(two["count"]) == 2
    np.testing.assert_allclose(two["stretch_1"], one["stretch"], rtol=1e-10)
    np.testing.assert_allclose(two["stretch_2"], one["stretch"], rtol=1e-10)


@given(force=st.floats(-0.3, 2.0), share=st.one_of(st.floats(0.1, 0.999), st.floats(1.001, 1.5)))
@budget(max_examples=8)
def test_equilibria_come_in_pairs(force, share):
    """Folds make and end equilibria in pairs of which one is stable, where no branch leaves the limits."""
    limit = float(dl.pull_in("equal_biaxial", force=force)["field"])
    found = dl.equilibria("equal_biaxial", force=force, field=share * limit, dashpots="frozen")
    expected = 2 if share < 1 else 0
    assert int(found["count"]) == expected
    assert int(found["stable_count"]) == expected // 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"field": 1e6, "voltage": 1e3}, r"either field \[V/m\] or voltage \[V\] must be given, got both"),
        ({}, "got neither"),
        ({"field": [2e6, 1e6]}, "field must be strictly increasing"),
        ({"field": np.nan}, "field must be finite"),
        (
            {"field": 1e6, "force": [0.1, 0.2]},
            "force must be a single number for equilibria, got 2 values in N",
        ),
        ({"field": 1e6, "force": np.inf}, "force must be finite"),
        ({"field": 1e6, "dashpots": "evolving"}, "dashpots must be one of frozen, relaxed"),
        ({"field": 1e6, "breakdown_field": -1.0}, "breakdown_field must be positive"),
        ({"field": 1e6, "smallest_tension": np.nan}, "smallest_tension must be finite"),
        ({"field": 1e6, "initial_state": {"stretch_rate": 1.0}}, "stretch_rate must be 0 1/s"),
        ({"field": 1e6, "initial_state": {"strech": 1.0}}, "unknown state variable 'strech'"),
        ({"field": 1e6, "held_stretch": 2.0}, "holds no stretch"),
        ({"field": 1e6, "densty": 1.0}, "unknown parameter 'densty'"),
        ({"field": 1e6, "initial_state": [1.0, 0.0, 1.0]}, "initial_state must map names of state variables"),
        ({"field": 1e6, "limits": 3}, "limits must be a delagrange.Limits"),
    ],
)
def test_bad_input(options, message):
    with pytest.raises(ValueError, match=message) as caught:
        dl.equilibria("equal_biaxial", **options)
    assert "\n" not in str(caught.value)
