"""Sweeps that carry the motion on from one frequency to the next."""

from __future__ import annotations

import numpy as np
import pytest

import delagrange as dl

GIVEN = {"force": 0.1, "field_amplitude": 2e6, "relaxation_time": 1e-2}


def test_the_motion_is_carried_on():
    """Two steps are one run whose field changes its frequency, at phase 0, without a jump."""
    sweep = dl.stepped_sweep("equal_biaxial", frequency=[300.0, 310.0], settle=3, measure=2, **GIVEN)
    alone = dl.stepped_sweep("equal_biaxial", frequency=300.0, settle=3, measure=2, **GIVEN)
    state = np.array(
        [alone[f"final_{name}"].item() for name in ("stretch", "stretch_rate", "inelastic_stretch")]
    )
    run = dl.simulate(
        "equal_biaxial", force=0.1, field=dl.Sine(2e6, 310.0), relaxation_time=1e-2, initial_state=state,
        duration=5 / 310.0, rtol=1e-11, samples=5001,
    )  # fmt: skip
    assert sweep["final_stretch"][1].item() == pytest.approx(run["stretch"].values[-1], abs=1e-8)
    last = run["stretch"].values[3000:]
    assert sweep["maximum"][1].item() == pytest.approx(last.max(), abs=1e-6)
    assert sweep["amplitude"][1].item() == pytest.approx(np.ptp(last) / 2, abs=1e-6)


def test_up_and_down_agree_where_there_is_one_motion():
    frequencies = np.array([300.0, 330.0, 360.0])
    up = dl.stepped_sweep("equal_biaxial", frequency=frequencies, **GIVEN)
    down = dl.stepped_sweep("equal_biaxial", frequency=frequencies[::-1], **GIVEN)
    assert list(down["frequency"].values) == [360.0, 330.0, 300.0]
    assert up["amplitude"].values == pytest.approx(down["amplitude"].values[::-1], rel=1e-5)


def test_it_begins_at_rest_in_equilibrium():
    sweep = dl.stepped_sweep("equal_biaxial", frequency=300.0, field_amplitude=0.0, force=0.1, settle=0)
    assert sweep["amplitude"].item() == pytest.approx(0.0, abs=1e-9)
    assert sweep["final_stretch"].item() > 1.01


def test_with_frozen_dashpots_nothing_decays():
    given = {"force": 0.1, "field_amplitude": 0.0, "dashpots": "frozen", "settle": 200}
    sweep = dl.stepped_sweep(
        "equal_biaxial", frequency=[300.0, 310.0], initial_state={"stretch": 1.05}, **given
    )
    assert sweep["amplitude"].values[1] == pytest.approx(sweep["amplitude"].values[0], rel=1e-6)
    assert "nothing damps" in sweep.attrs["dashpots_note"]


def test_a_loss_ends_the_sweep():
    sweep = dl.stepped_sweep(
        "equal_biaxial", frequency=[300.0, 371.0, 400.0], force=0.5, field_amplitude=5e6, dashpots="frozen",
        limits=dl.Limits(largest_stretch=1.6),
    )  # fmt: skip
    status = list(sweep["status"].values)
    assert status == ["completed", "diverged", "interrupted"]
    assert np.all(np.isnan(sweep["amplitude"].values[1:])) and sweep["amplitude"].values[0] > 0
    assert sweep["status_time"].values[1] > sweep["status_time"].values[0]


BAD = [
    ({"frequency": [300.0, 310.0, 305.0]}, "frequency must be strictly increasing or strictly decreasing"),
    ({"frequency": []}, "of at least one value"),
    ({"frequency": [0.0, 310.0]}, "frequency must be positive and finite"),
    ({"dashpots": "evolving"}, "dashpots must be one of frozen, relaxed"),
    ({"settle": -1}, "settle must be an integer from 0"),
    ({"measure": 0}, "measure must be an integer from 1"),
    ({"force": [0.1, 0.2]}, "force must be a single number"),
    ({"field_bias": 1e8}, "no stable equilibrium under force = 0.1 N and field_bias = 1e[+]08 V/m"),
]


@pytest.mark.parametrize("change, message", BAD)
def test_bad_input(change, message):
    with pytest.raises(ValueError, match=message):
        dl.stepped_sweep("equal_biaxial", **({"frequency": [300.0, 310.0]} | GIVEN | change))
