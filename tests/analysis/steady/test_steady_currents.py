"""Periodic motions of a leaking membrane under a sine of the current: those of the sine of charge that it feeds."""

from __future__ import annotations

import numpy as np
import pytest
from electrical_membranes import LEAKY_FILE
from emitted_once import described_in, loaded

import delagrange as dl

CHARGE, CURRENT = "nominal_charge_density", "nominal_current_density"
LEAK = 100.0  # [1/s], 6 nS/m over 60 pF/m
FREQUENCY, AMPLITUDE = 430.0, 1.0  # [Hz], [A/m^2]
FED = AMPLITUDE / np.hypot(LEAK, 2 * np.pi * FREQUENCY)  # [C/m^2], amplitude of the charge


@pytest.fixture(scope="module")
def leaky(tmp_path_factory):
    return loaded(described_in(tmp_path_factory.mktemp("leaky"), "leaky", LEAKY_FILE))


@pytest.fixture(scope="module")
def charged(tmp_path_factory):
    text = LEAKY_FILE.replace('conductivity = "6 nS/m"\n', "").replace('"leaky"', '"held"')
    return loaded(described_in(tmp_path_factory.mktemp("held"), "held", text))


def test_a_sine_of_the_current_moves_it_as_the_charge_that_it_feeds(leaky, charged):
    """With a constant permittivity D' = i - D σ / ε at any stretch; one multiplier more is that of the leak."""
    given = {"frequency": (FREQUENCY, FREQUENCY + 2), "dashpots": "relaxed", "seeds": 2, "resolution": 10}
    fed = dl.steady_response(leaky, current_amplitude=AMPLITUDE, **given)
    held = dl.steady_response(charged, charge_amplitude=FED, **given)
    assert fed["current_amplitude"].units == "A/m^2" and fed.attrs["forcing_period"] == "1/f"
    assert set(fed["stability"].values) == {"stable"}
    first = fed.isel(point=int(np.argmin(fed["frequency"].values)))
    expected = held.isel(point=int(np.argmin(held["frequency"].values)))
    assert float(first["frequency"]) == float(expected["frequency"]) == FREQUENCY
    assert float(first["amplitude"]) == pytest.approx(float(expected["amplitude"]), rel=1e-8)
    lag = -AMPLITUDE * 2 * np.pi * FREQUENCY / (LEAK**2 + (2 * np.pi * FREQUENCY) ** 2)
    assert float(first[CHARGE]) == pytest.approx(lag, rel=1e-9)
    of_leak = np.abs(first["multiplier_real"] - np.exp(-LEAK / FREQUENCY)) + np.abs(first["multiplier_imag"])
    assert float(of_leak.min()) < 1e-9
    twice = 2 * expected["multiplier_logarithm"].values  # the charge forces at twice its frequency
    logarithms = np.sort(first["multiplier_logarithm"].values)
    np.testing.assert_allclose(logarithms, np.sort(np.append(twice, -LEAK / FREQUENCY)), rtol=1e-7, atol=1e-9)


def test_with_frozen_dashpots_the_leak_alone_damps(leaky):
    found = dl.steady_response(
        leaky, frequency=(300.0, 301.0), current_amplitude=0.2, current_bias=-0.05, seeds=2, resolution=10
    )
    assert found.sizes["multiplier"] == 3 and found.attrs["dashpots"] == "frozen"
    assert "a leak damps" in found.attrs["explanation"]
    assert np.all(found[CHARGE] < 0)
    assert float(np.abs(found["product_error"]).max()) < 1e-8


def test_a_stepped_sweep_settles_on_the_branch(leaky):
    found = dl.stepped_sweep(leaky, frequency=[FREQUENCY + 1, FREQUENCY], current_amplitude=AMPLITUDE, settle=100)
    given = {"frequency": (FREQUENCY, FREQUENCY + 1), "dashpots": "relaxed", "seeds": 2, "resolution": 10}
    steady = dl.steady_response(leaky, current_amplitude=AMPLITUDE, **given)
    there = steady["amplitude"].values[np.argmin(steady["frequency"].values)]
    assert float(found["amplitude"].sel(frequency=FREQUENCY)) == pytest.approx(float(there), rel=1e-5)
    assert "current_bias + current_amplitude" in found.attrs[f"{CURRENT}_drive"]
    assert found["frequency"].long_name == "frequency of the current density"


def test_a_stepped_sweep_begins_where_the_bias_holds_it(leaky):
    """Of either sign."""
    given = {"frequency": [300.0], "current_amplitude": 0.0, "settle": 0, "measure": 1}
    for bias in (0.3, -0.3):
        found = dl.stepped_sweep(leaky, current_bias=bias, **given)
        rest = dl.rest_state(leaky, inputs={CURRENT: bias})
        assert float(found["amplitude"][0]) < 1e-9
        assert float(found[f"final_{CHARGE}"][0]) == pytest.approx(rest[CHARGE], rel=1e-9)


def test_frozen_dashpots_leave_the_charge_in_the_lyapunov_spectrum(leaky):
    found = dl.lyapunov_spectrum(leaky, duration=0.5, force=0.1, inputs={CURRENT: 0.2})
    assert found.sizes["exponent"] == 3
    assert float(found["lyapunov_exponents"][-1]) == pytest.approx(-LEAK, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"field_amplitude": 1e6}, "field_amplitude given as 1000000, but the electrical input of leaky is"),
        ({}, r"current_amplitude must be a number in A/m\^2, got none"),
        ({"current_amplitude": 0.1, "inputs": {CURRENT: 0.1}}, "nominal_current_density is what varies here"),
    ],
)
@pytest.mark.parametrize("analysis", [dl.steady_response, dl.stepped_sweep])
def test_another_sine_is_refused(leaky, analysis, given, says):
    with pytest.raises(ValueError, match=says):
        analysis(leaky, frequency=(300.0, 310.0), **given)
