"""The kinds of motion of the paper's nine cases, as statements need them."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from delagrange.analysis.motion.classify import classify
from delagrange.drives.drive import Sine
from delagrange.reproduction.claims.kind_claims import (
    is_aperiodic,
    sections_are_closed,
    sections_fill_an_area,
)
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import MOTIONS, CurveLoad, MotionFigures
from delagrange.reproduction.runs.kinds import kind, kinds
from delagrange.reproduction.runs.runs import KINDS

SLOW_BEAT = MotionFigures(11, 12, "pure_shear", CurveLoad(0.1, 3e6, 2.0), (190.0, 381.0, 762.0), 0.12)


def found(*verdicts: str, dimension: float) -> xr.Dataset:
    """What `kinds` gives, with these verdicts."""
    count = len(verdicts)
    return xr.Dataset(
        {
            "verdict": ("frequency", np.array(verdicts, dtype=object)),
            "torus_dimension": ("frequency", np.full(count, dimension)),
            "base_frequencies": (("frequency", "base"), np.tile([742.0, np.nan], (count, 1))),
            "lyapunov_exponents": (("frequency", "exponent"), np.ones((count, 2))),
            "lyapunov_uncertainty": (("frequency", "exponent"), np.ones((count, 2))),
            "zero_one_K": ("frequency", np.zeros(count)),
            "followed": ("frequency", np.full(count, 9.0)),
        },
        {"frequency": np.arange(count) + 100.0},
    )


@pytest.mark.parametrize(
    ("verdicts", "dimension", "closed", "area", "aperiodic"),
    [
        (("quasi-periodic",) * 3, 2.0, True, False, False),
        (("quasi-periodic",) * 3, 3.0, False, True, False),
        (("quasi-periodic", "undecided", "quasi-periodic"), 2.0, False, False, False),
        (("chaotic",) * 3, np.nan, False, True, True),
        (("chaotic", "chaotic", "undecided"), np.nan, False, False, False),
    ],
)
def test_what_a_verdict_says_of_a_statement(verdicts, dimension, closed, area, aperiodic):
    runs = Runs({(9, None, KINDS): found(*verdicts, dimension=dimension)})
    assert sections_are_closed("uniaxial")(runs, None)[0] is closed
    assert sections_fill_an_area(runs, None)[0] is area
    assert is_aperiodic(runs, None)[0] is aperiodic


def test_what_a_section_shows_is_read_from_the_verdict():
    runs = Runs({(9, None, KINDS): found("quasi-periodic", "chaotic", "undecided", dimension=np.nan)})
    shown = runs.kinds(9)["torus_dimension"].copy(data=[3.0, np.nan, np.nan])
    runs = Runs({(9, None, KINDS): runs.kinds(9).assign(torus_dimension=shown)})
    first, second, third = sections_fill_an_area(runs, None)[1].split("; ")
    assert "dimension 3" in first
    assert "surface" in first
    assert (second, third) == ("101 Hz: chaotic", "102 Hz: undecided")


def test_a_case_is_what_classify_says_of_it():
    case = MOTIONS[0]
    ours = kind(case, case.frequencies[0])
    drive = Sine(case.load.field_amplitude, case.frequencies[0])
    theirs = classify(case.model, force=case.load.force, field=drive)
    assert ours["verdict"].item() == theirs["verdict"].item() == "quasi-periodic"
    np.testing.assert_array_equal(ours["base_frequencies"], theirs["base_frequencies"])


def test_cases_with_different_numbers_of_bases_stand_side_by_side(monkeypatch):
    monkeypatch.setattr("delagrange.reproduction.runs.kinds.kind", lambda case, frequency, form: one(frequency))
    joined = kinds(MOTIONS[1])
    assert joined["base_frequencies"].shape == (3, 3)
    assert np.isnan(joined["base_frequencies"].values).sum() == 2
    assert list(joined["frequency"].values) == list(MOTIONS[1].frequencies)


def one(frequency: float) -> xr.Dataset:
    """A case with two bases at low and three at other frequencies."""
    count = 2 if frequency < 500 else 3
    return (
        found("quasi-periodic", dimension=count)
        .isel(frequency=0, drop=True)
        .drop_vars("base_frequencies")
        .assign(base_frequencies=("base", np.full(count, frequency)))
    )


def test_what_cannot_be_decided_is_followed_for_longer(monkeypatch):
    asked = []

    def stub(model, *, duration, **options):
        asked.append(duration)
        kept = found("undecided", dimension=np.nan).isel(frequency=0, drop=True)
        horizon = 45.0 if duration is None else np.nan
        return kept.assign(sufficient_horizon=horizon, evidence="").assign_attrs(duration=duration or 11.0)

    monkeypatch.setattr("delagrange.reproduction.runs.kinds.classify", stub)
    assert kind(SLOW_BEAT, 381.0)["followed"].item() == 45.0
    assert asked == [None, 45.0]
