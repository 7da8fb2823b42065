"""Static and dynamic pull-in against closed forms, energies in high precision, integration, and laws."""

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

MU = P.shear_modulus_alpha + P.shear_modulus_beta
NO_FORCE_FIELD = np.sqrt(
    3 / 4 / 2 ** (2 / 3)
)  # in (μ/ε)^(1/2): (λ^-2 - λ^-8)^(1/2) at λ^6 = 4 / 1, λ = 2^(1/3)


@pytest.fixture(autouse=True)
def precise():
    with mp.workdps(40):
        yield


@pytest.mark.parametrize("model", ["equal_biaxial", "uniaxial"])
@pytest.mark.parametrize(("dashpots", "modulus"), [("frozen", MU), ("relaxed", P.shear_modulus_alpha)])
def test_pull_in_without_force_is_the_closed_form(model, dashpots, modulus):
    found = dl.pull_in(model, force=0.0, dashpots=dashpots)
    assert pytest.approx(0.68736, abs=1e-5) == NO_FORCE_FIELD
    assert float(found["field"]) == pytest.approx(
        NO_FORCE_FIELD * np.sqrt(modulus / P.permittivity), rel=1e-12
    )
    assert float(found["stretch"]) == pytest.approx(2 ** (1 / 3), rel=1e-12)
    assert float(found["true_field"]) == pytest.approx(
        float(found["field"]) * float(found["stretch"]) ** 2, rel=1e-12
    )
    assert float(found["voltage"]) == pytest.approx(float(found["field"]) * 2e-3, rel=1e-15)
    assert found["found"].item() == found["first_limit"].item() == "pull-in"


def precise_fold(force: float, inelastic: tuple[float, float] | None, guess: tuple[float, float, float]):
    """λ_1, λ_2, E of the uniaxial limit point: gradient and determinant of the Hessian vanish."""

    def system(one, two, field):
        membrane = PreciseMembrane(force, field * 1e7, inelastic)
        slopes = [membrane.derivative((one, two), *orders) for orders in ((1, 0), (0, 1))]
        bends = [membrane.derivative((one, two), *orders) for orders in ((2, 0), (0, 2), (1, 1))]
        return [*slopes, bends[0] * bends[1] - bends[2] ** 2]

    one, two, field = mp.findroot(system, (guess[0], guess[1], guess[2] / 1e7))
    return float(one), float(two), float(field) * 1e7


@pytest.mark.parametrize(("dashpots", "inelastic"), [("frozen", (1.0, 1.0)), ("relaxed", None)])
def test_uniaxial_pull_in_is_that_of_the_energies(dashpots, inelastic):
    found = dl.pull_in("uniaxial", force=0.5, dashpots=dashpots)
    names = ("stretch_1", "stretch_2", "field")
    expected = precise_fold(0.5, inelastic, tuple(float(found[name]) for name in names))
    np.testing.assert_allclose([float(found[name]) for name in names], expected, rtol=1e-11)


def test_critical_field_against_force_is_a_map():
    forces = np.array([-0.2, 0.0, 0.5, 1.0])
    found = dl.pull_in("equal_biaxial", force=forces)
    stress = forces / (4 * P.half_length * P.half_thickness)
    stretch = found["stretch"].values
    balance = np.sqrt((MU * (stretch - stretch**-5) - stress) / (P.permittivity * stretch**3))
    np.testing.assert_allclose(found["field"], balance, rtol=1e-12)
    # d(E^2)/dλ = 0 of the same: 3 s λ^5 - 2 μ λ^6 + 8 μ = 0
    fold = (3 * stress * stretch**5 - 2 * MU * stretch**6 + 8 * MU) / MU
    np.testing.assert_allclose(fold / stretch**6, 0, atol=1e-11)
    assert np.all(np.diff(found["field"]) < 0)
    assert found["first_limit"].values.tolist() == ["loss of tension", "pull-in", "pull-in", "pull-in"]
    assert found["loss_of_tension_field"].values[0] == 0.0


def test_pure_shear_has_no_limit_point_but_loses_tension():
    found = dl.pull_in("pure_shear", force=[0.0, 0.3], held_stretch=[1.0, 2.0])
    assert found["field"].dims == ("force", "held_stretch")
    assert np.all(np.isnan(found["field"]))
    assert set(found["found"].values.ravel()) == {"no limit point up to the limits"}
    assert set(found["first_limit"].values.ravel()) == {"loss of tension"}
    assert found["loss_of_tension_field"].values[0, 0] == 0.0  # no prestretch, no force
    field, witness = float(found["loss_of_tension_field"][1, 1]), None
    at_loss = dl.equilibria("pure_shear", force=0.3, field=field, held_stretch=2.0, dashpots="frozen")
    witness = PreciseMembrane(0.0, field, (1.0, 2.0))
    reaction = witness.derivative((mp.mpf(float(at_loss["stretch"][0])), mp.mpf(2)), 0, 1)
    assert abs(float(reaction) / (2 * P.half_length)) < 1e-8  # [N]
    # without limit the stretch would grow for ever as ε E^2 λ_2p^2 comes to μ / ξ^2
    np.testing.assert_allclose(found["highest_field"][0, 1], np.sqrt(MU / P.permittivity) / 2, rtol=1e-3)


def test_breakdown_comes_first_where_it_does():
    strong, weak = 3e7, 1.5e7
    for strength, first in (
        (strong, "electrical breakdown"),
        (weak, "electrical breakdown"),
        (1e9, "pull-in"),
    ):
        found = dl.pull_in("equal_biaxial", breakdown_field=strength)
        assert found["first_limit"].item() == first
        field = float(found["breakdown_field_nominal"])
        assert np.isnan(field) == (first == "pull-in")
        if first != "pull-in":
            there = dl.equilibria("equal_biaxial", field=field, dashpots="frozen")
            assert float(there["true_field"][0]) == pytest.approx(strength, rel=1e-10)


def test_a_force_that_is_not_stood_is_an_answer():
    found = dl.pull_in("equal_biaxial", force=[0.0, 1e4])
    assert found["found"].values.tolist() == ["pull-in", "no equilibrium without field"]
    assert np.isnan(found["field"].values[1])


def test_a_tiny_force_is_like_none():
    tiny, none = (dl.pull_in("equal_biaxial", force=force) for force in (5e-324, 0.0))
    assert float(tiny["field"]) == pytest.approx(float(none["field"]), rel=1e-14)


@given(factor=st.floats(0.01, 100), force=st.floats(-0.2, 1.0))
@budget(max_examples=8)
def test_pull_in_scales_with_stiffness(factor, force):
    one = dl.pull_in("uniaxial", force=force)
    other = dl.pull_in(
        "uniaxial", force=factor * force,
        shear_modulus_alpha=factor * P.shear_modulus_alpha, shear_modulus_beta=factor * P.shear_modulus_beta,
    )  # fmt: skip
    np.testing.assert_allclose(other["field"], one["field"] * np.sqrt(factor), rtol=1e-11)
    np.testing.assert_allclose(other["stretch"], one["stretch"], rtol=1e-11)


def precise_dynamic(model_force: float, guess: tuple[float, float]):
    """λ_u, E of the equal-biaxial membrane from rest at λ = 1: Π(λ_u) = Π(1), Π'(λ_u) = 0, from its energies."""
    mu, eps, force = (mp.mpf(v) for v in (MU, P.permittivity, model_force))
    length, thickness = mp.mpf(P.half_length), mp.mpf(P.half_thickness)

    def potential(stretch, field):
        volume = 8 * thickness * length**2
        elastic = mu / 2 * (2 * stretch**2 + stretch**-4 - 3)
        return volume * (elastic - eps * field**2 * stretch**4 / 2) - 4 * length * force * stretch

    def system(stretch, field):
        field = field * 10**7
        return [
            (potential(stretch, field) - potential(mp.mpf(1), field)) * 10**6,
            mp.diff(lambda value: potential(value, field), stretch) * 10**6,
        ]

    stretch, field = mp.findroot(system, (guess[0], guess[1] / 1e7))
    return float(stretch), float(field) * 1e7


@pytest.mark.parametrize("force", [0.0, 0.5])
def test_dynamic_pull_in_is_the_energy_argument_and_the_integration(force):
    found = dl.dynamic_pull_in("equal_biaxial", force=force)
    stretch, field = precise_dynamic(force, (float(found["stretch"]), float(found["field"])))
    assert found["method"].item() == "energy"
    assert float(found["field"]) == pytest.approx(field, rel=1e-11)
    assert float(found["stretch"]) == pytest.approx(stretch, rel=1e-11)
    assert float(found["field_by_integration"]) == pytest.approx(field, rel=1e-10)
    assert float(found["bracket_width"]) < 1e-10 * field
    assert float(found["field"]) < float(found["static_field"])


def test_a_pressing_force_leaves_the_start_at_the_barrier():
    """Pressed so much that λ = 1 is beyond static pull-in: the membrane is lost where λ = 1 is in unstable balance."""
    found = dl.dynamic_pull_in("equal_biaxial", force=-5.0)
    stress = 5.0 / (4 * P.half_length * P.half_thickness)
    assert float(found["stretch"]) == pytest.approx(1.0, rel=1e-12)
    assert float(found["field"]) == pytest.approx(np.sqrt(stress / P.permittivity), rel=1e-12)
    assert float(found["field_by_integration"]) == pytest.approx(float(found["field"]), rel=1e-9)


def test_dynamic_pull_in_without_force_is_the_closed_form():
    """(λ^-2 - λ^-8) (λ^4 - 1) = 2 λ^2 + λ^-4 - 3 at the barrier."""
    found = dl.dynamic_pull_in("equal_biaxial")
    stretch = mp.findroot(
        lambda v: (v**-2 - v**-8) * (v**4 - 1) - (2 * v**2 + v**-4 - 3),
        (mp.mpf("1.3"), mp.mpf("1.6")),
        solver="anderson",
    )
    field = mp.sqrt((stretch**-2 - stretch**-8) * MU / mp.mpf(P.permittivity))
    assert float(found["stretch"]) == pytest.approx(float(stretch), rel=1e-11)
    assert float(found["field"]) == pytest.approx(float(field), rel=1e-11)


def test_from_the_equilibrium_under_force_more_is_stood():
    sudden = dl.dynamic_pull_in("equal_biaxial", force=0.5)
    loaded = dl.dynamic_pull_in("equal_biaxial", force=0.5, start="equilibrium")
    assert float(sudden["field"]) < float(loaded["field"]) < float(loaded["static_field"])
    assert float(loaded["field_by_integration"]) == pytest.approx(float(loaded["field"]), rel=1e-10)


def test_with_two_coordinates_energy_is_a_lower_bound():
    found = dl.dynamic_pull_in("uniaxial", force=[0.0, 0.5])
    assert found["method"].values.tolist() == ["integration"] * 2
    bound, field = found["field_by_energy_bound"].values, found["field"].values
    assert field[0] == pytest.approx(bound[0], rel=1e-10)  # both axes move alike: one coordinate in truth
    assert bound[1] < field[1] < float(found["static_field"][1])
    assert field[1] > bound[1] * (1 + 1e-6)
    symmetric = dl.dynamic_pull_in("equal_biaxial")
    assert field[0] == pytest.approx(float(symmetric["field"]), rel=1e-10)


def test_evolving_dashpots_are_integrated():
    short, long = (
        dl.dynamic_pull_in("equal_biaxial", dashpots="evolving", duration=duration)
        for duration in (0.02, 0.2)
    )
    frozen = dl.dynamic_pull_in("equal_biaxial")
    assert "field_by_energy" not in short
    assert float(long["field"]) < float(short["field"]) <= float(frozen["field"]) * (1 + 1e-9)
    assert float(long["duration"]) == 0.2


def test_without_a_barrier_it_says_so():
    found = dl.dynamic_pull_in("pure_shear", held_stretch=2.0, duration=0.05)
    assert found["found"].item() == "no barrier"
    assert np.isnan(found["field"])
    assert np.isfinite(found["field_by_integration"])


def test_a_force_that_alone_is_too_much_is_an_answer():
    found = dl.dynamic_pull_in("equal_biaxial", force=1e4, duration=0.01)
    assert found["found"].item() == "no equilibrium without field"
    sudden = dl.dynamic_pull_in("equal_biaxial", force=6.0, duration=0.05, dashpots="evolving")
    assert sudden["found"].item() in ("lost under the force alone", "dynamic pull-in")


def test_a_module_without_kernel_is_integrated_by_numpy():
    found = dl.dynamic_pull_in(gent_membrane(), duration=0.005, engine="numpy")
    assert found.attrs["integration_engine"] == "numpy"
    assert found["found"].item() == "dynamic snap-through"  # the stiff membrane is not lost
    assert 0 < float(found["field"]) < float(found["static_field"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dashpots": "evolving"}, "dashpots must be one of frozen, relaxed"),
        ({"force": [0.1, 0.1]}, "force must not hold a value twice"),
        ({"force": "much"}, "force must be a number in N"),
        ({"breakdown_exponent": np.inf}, "breakdown_exponent must be finite"),
        ({"field": 1e6}, "unknown parameter 'field'"),
    ],
)
def test_bad_input_of_pull_in(options, message):
    with pytest.raises(ValueError, match=message):
        dl.pull_in("equal_biaxial", **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dashpots": "relaxed"}, "dashpots must be one of frozen, evolving"),
        ({"start": "rest"}, "start must be one of reference, equilibrium"),
        ({"duration": 0.0}, "duration must lie from"),
        ({"engine": "magic"}, "engine must be one of"),
        ({"held_stretch": 2.0}, "holds no stretch"),
    ],
)
def test_bad_input_of_dynamic_pull_in(options, message):
    with pytest.raises(ValueError, match=message):
        dl.dynamic_pull_in("equal_biaxial", **options)
