"""A sine that holds arrays and drives a sweep: the same bits as its numbers by their own arguments."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from electrical_membranes import emitted

import delagrange as dl

CHARGE, CURRENT = "nominal_charge_density", "nominal_current_density"
SHORT = {"duration": 2e-3, "force": 0.1, "engine": "numpy"}
NUMBERS = {"amplitude": [1.0, 1.5], "bias": [0.0, 0.2, 0.4], "phase": 0.3, "frequency": [200.0, 300.0]}


def by_arguments(stem: str, size: float) -> dict[str, object]:
    named = {f"{stem}_{name}": NUMBERS[name] for name in ("amplitude", "bias", "phase")}
    sizes = {name: np.multiply(size, value) for name, value in named.items() if not name.endswith("phase")}
    return named | sizes | {"frequency": NUMBERS["frequency"]}


def as_drive(size: float) -> dl.Sine:
    scaled = {name: np.multiply(size, NUMBERS[name]) for name in ("amplitude", "bias")}
    return dl.Sine(**(NUMBERS | scaled))


@pytest.mark.parametrize(
    ("driven", "stem", "size"), [("voltage", "field", 2e6), ("charge", "charge", 2e-4), ("current", "current", 0.2)]
)
def test_a_drive_is_what_drives_the_model_bit_for_bit(driven, stem, size):
    model = emitted(driven)
    more = {"final_state": True, "viscosity": [400.0, 800.0], **SHORT}
    expected = dl.frequency_response(model, **by_arguments(stem, size), **more)
    found = dl.frequency_response(model, drive=as_drive(size), **more)
    assert found["amplitude"].dims == (f"{stem}_amplitude", f"{stem}_bias", "viscosity", "frequency")
    xr.testing.assert_identical(found, expected)


def test_a_drive_of_single_numbers_and_the_compiled_engine():
    given = {"duration": 2e-3, "held_stretch": [1.5, 2.0]}
    found = dl.frequency_response("pure_shear", drive=dl.Sine(1e6, 300.0), **given)
    expected = dl.frequency_response("pure_shear", field_amplitude=1e6, frequency=300.0, **given)
    assert found["amplitude"].dims == ("held_stretch", "frequency")
    xr.testing.assert_identical(found, expected)


SINE = dl.Sine(1e6, 300.0)
REFUSED = {
    "no sine": ({"drive": dl.Constant(1e6)}, r"drive must be a delagrange.Sine, got Constant"),
    "a number": ({"drive": 1e6}, "drive must be a delagrange.Sine, got 1000000"),
    "a frequency": ({"drive": SINE, "frequency": [300.0]}, "frequency is given as .* and in drive as well; give one"),
    "an amplitude": ({"drive": SINE, "field_amplitude": 0.0}, "field_amplitude is given as 0 and in drive"),
    "a bias": ({"drive": SINE, "field_bias": 1e5}, "field_bias is given as 100000 and in drive as well; give one"),
    "a phase": ({"drive": SINE, "field_phase": [0.0, 1.0]}, "field_phase is given as .* and in drive as well"),
    "of another": ({"drive": SINE, "charge_amplitude": 1e-3}, "charge_amplitude is given as 0.001 and in drive"),
    "by name": ({"drive": SINE, "inputs": {"field": 1e6}}, "field is given by field_amplitude, .* not by inputs"),
    "not increasing": ({"drive": dl.Sine(1e6, [300.0, 200.0])}, "frequency must be strictly increasing"),
    "twice": ({"drive": dl.Sine([1e6, 1e6], 300.0)}, "field_amplitude must not hold a value twice"),
    "two dimensions": ({"drive": dl.Sine([[1e6, 2e6]], 300.0)}, "field_amplitude must be one value or a one-dim"),
    "neither": ({"field_amplitude": 1e6}, "frequency must be a number in Hz, got None"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_told_in_one_line(case):
    given, says = REFUSED[case]
    with pytest.raises(ValueError, match=says) as refusal:
        dl.frequency_response("equal_biaxial", duration=1e-3, **given)
    assert "\n" not in str(refusal.value)


def test_a_model_without_an_electrical_input_has_no_drive():
    source = emitted("charge")
    bare = type(source)("bare")
    bare.__dict__.update({name: value for name, value in vars(source).items() if not name.startswith("__")})
    bare.MODEL, bare.INPUTS = "bare", source.INPUTS[:1]
    with pytest.raises(ValueError, match="the model bare has no input nominal_electric_field"):
        dl.frequency_response(bare, drive=SINE, duration=1e-3)
