"""Natural frequencies against closed forms, eigenvalues in high precision, and simulated vibrations."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st
from precise_membrane import P, PreciseMembrane

import delagrange as dl

MU = P.shear_modulus_alpha + P.shear_modulus_beta


@pytest.fixture(autouse=True)
def precise():
    with mp.workdps(40):
        yield


def equal_biaxial_frequency(stretch: float, field: float, modulus: float) -> float:
    """f_n [Hz] of the neo-Hookean membrane about an equal-biaxial equilibrium, on paper."""
    ratio = (P.half_length / P.half_thickness) ** 2
    stiffness = modulus * (1 + 5 * stretch**-6) - 3 * P.permittivity * field**2 * stretch**2
    return np.sqrt(3 * stiffness / (P.density * P.half_thickness**2 * (ratio + 2 * stretch**-6))) / (
        2 * np.pi
    )


def test_the_undeformed_membrane_vibrates_at_the_closed_form():
    found = dl.modes("equal_biaxial", force=0.0, field=0.0, dashpots="frozen")
    exact = np.sqrt(
        18 * MU / (P.density * P.half_thickness**2 * (2 + (P.half_length / P.half_thickness) ** 2))
    )
    assert float(found["frequency"][0]) == pytest.approx(exact / (2 * np.pi), rel=1e-13)
    assert float(found["frequency"][0]) == pytest.approx(918.9, abs=0.05)
    assert float(found["resonant_field_frequency"][0]) == float(found["frequency"][0]) / 2
    assert "squared" in found["resonant_field_frequency"].attrs["explanation"]


def test_frequencies_move_with_force_and_field_as_on_paper():
    found = dl.modes("equal_biaxial", force=[0.0, 0.5], field=[0.0, 5e6, 1.6e7])
    for force in range(2):
        for field in range(3):
            here = found.isel(force=force, field=field, mode=0)
            expected = equal_biaxial_frequency(float(here["stretch"]), float(here["field"]), MU)
            assert float(here["frequency"]) == pytest.approx(expected, rel=1e-11)
    assert np.all(np.diff(found["frequency"].values, axis=1) < 0)


@pytest.mark.parametrize(("force", "field"), [(0.0, 0.0), (0.5, 0.0), (0.5, 1.5e7)])
def test_uniaxial_modes_are_those_of_the_energies(force, field):
    found = dl.modes("uniaxial", force=force, field=field)
    witness = PreciseMembrane(force, field)
    place = witness.rest(float(found["stretch_1"]), float(found["stretch_2"]))
    expected = [float(value) for value in witness.frequencies(place)]
    np.testing.assert_allclose(found["frequency"], expected, rtol=1e-12)
    assert found["shape"].dims == ("coordinate", "mode")
    np.testing.assert_allclose(np.linalg.norm(found["shape"], axis=0), 1, rtol=1e-12)


def test_pure_shear_modes_are_those_of_the_energies():
    found = dl.modes("pure_shear", force=0.3, field=6e6, held_stretch=[1.5, 2.0])
    for place, held in enumerate((1.5, 2.0)):
        witness = PreciseMembrane(0.3, 6e6, (1.0, held), held=held)
        rest = witness.rest(float(found["stretch"][place]))
        assert float(found["frequency"][place, 0]) == pytest.approx(
            float(witness.frequencies(rest)[0]), rel=1e-12
        )


def test_without_force_one_mode_breathes_and_one_does_not():
    found = dl.modes("uniaxial")
    breathing = dl.modes("equal_biaxial")
    np.testing.assert_allclose(found["frequency"][1], breathing["frequency"][0], rtol=1e-12)
    shape = found["shape"].values
    np.testing.assert_allclose(shape[:, 1], [0.5**0.5, 0.5**0.5], rtol=1e-9)
    np.testing.assert_allclose(shape[:, 0], [0.5**0.5, -(0.5**0.5)], rtol=1e-9)


def test_a_small_vibration_has_that_frequency():
    """The phase of a simulated vibration about a loaded equilibrium after ten periods."""
    found = dl.modes("equal_biaxial", force=0.5, field=1e7)
    frequency, stretch = float(found["frequency"][0]), float(found["stretch"])
    period = 1 / frequency
    run = _simulated(stretch, period)
    assert run == pytest.approx(frequency, rel=1e-8)


def _simulated(stretch: float, period: float) -> float:
    """Frequency [Hz] over ten periods, from the phase that the state has come by."""
    outcome = dl.frequency_response(
        "equal_biaxial", force=0.5, field_amplitude=0.0, field_bias=1e7, frequency=[1.0],
        duration=10 * period, initial_state={"stretch": stretch * (1 + 1e-6)}, final_state=True,
        relaxation_time=1e12, rtol=1e-13, atol=1e-16,
    )  # fmt: skip
    displacement = float(outcome["final_stretch"][0]) / stretch - 1
    rate = float(outcome["final_stretch_rate"][0]) / stretch
    phase = np.arctan2(-rate * period / (2 * np.pi), displacement)
    return (10 + phase / (2 * np.pi)) / (10 * period)


def test_relaxed_dashpots_damp_and_relax():
    found = dl.modes("equal_biaxial", force=0.5, field=1e6, dashpots="relaxed")
    frozen_there = dl.modes(
        "equal_biaxial", force=0.5, field=1e6,
        initial_state={"inelastic_stretch": float(found["inelastic_stretch"])},
    )  # fmt: skip
    np.testing.assert_allclose(found["stretch"], frozen_there["stretch"], rtol=1e-12)
    np.testing.assert_allclose(found["frequency"], frozen_there["frequency"], rtol=1e-9)  # τ is long
    assert 0 < float(found["decay_rate"][0]) < 1
    assert "1e-15" in found["decay_rate"].attrs["accuracy"]
    assert 0 < float(found["relaxation_rate"][0]) < 1
    # the sum of all rates is the trace of the Jacobian
    model = dl.load_model("equal_biaxial")
    state = [float(found[entry.name]) for entry in model.STATE]
    values = [getattr(P, entry.name) for entry in model.PARAMETERS]
    trace = np.trace(model.jacobian(state, (0.5, 1e6), values))
    total = -2 * float(found["decay_rate"][0]) - float(found["relaxation_rate"][0])
    assert total == pytest.approx(trace, rel=1e-6)


def test_beyond_pull_in_there_is_no_mode_but_an_answer():
    found = dl.modes("equal_biaxial", field=[1e7, 3e7])
    assert found["status"].values[0] == "stable"
    assert found["status"].values[1].startswith("no equilibrium: beyond the limit point at 2.138")
    assert np.isnan(found["frequency"].values[1, 0])
    never = dl.modes("equal_biaxial", force=1e4)
    assert never["status"].item().startswith("no equilibrium: ")


def test_frequency_falls_to_zero_at_pull_in():
    limit = float(dl.pull_in("equal_biaxial")["field"])
    field = limit * (1 - np.array([1e-2, 1e-4, 1e-6]))
    frequency = dl.modes("equal_biaxial", field=field)["frequency"].values[:, 0]
    np.testing.assert_allclose(frequency[:-1] / frequency[1:], 10**0.5, rtol=0.05)  # as (1 - E/E_c)^(1/4)


@given(factor=st.floats(0.1, 10), size=st.floats(0.5, 2))
@budget(max_examples=8)
def test_frequencies_scale(factor, size):
    """f ~ (μ/ρ)^(1/2) / length: stiffness, density and size together."""
    one = dl.modes("uniaxial", force=0.2)
    other = dl.modes(
        "uniaxial", force=0.2 * factor * size**2, density=P.density * 3,
        shear_modulus_alpha=factor * P.shear_modulus_alpha, shear_modulus_beta=factor * P.shear_modulus_beta,
        half_length=P.half_length * size, half_thickness=P.half_thickness * size,
    )  # fmt: skip
    np.testing.assert_allclose(other["frequency"], one["frequency"] * np.sqrt(factor / 3) / size, rtol=1e-11)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dashpots": "evolving"}, "dashpots must be one of frozen, relaxed"),
        ({"field": [1e6, 1e6]}, "field must not hold a value twice"),
        ({"field": np.inf}, "field must be finite"),
        ({"frequency": 3.0}, "unknown parameter 'frequency'"),
    ],
)
def test_bad_input(options, message):
    with pytest.raises(ValueError, match=message):
        dl.modes("equal_biaxial", **options)
