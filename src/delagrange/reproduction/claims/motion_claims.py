"""What the paper says of its time histories, as tests on computed ones."""

from __future__ import annotations

import xarray as xr

from delagrange.reproduction.claims import measures
from delagrange.reproduction.claims.claim import Claim
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import MOTIONS, MotionFigures

_MOTION = {figure.model: figure for figure in MOTIONS}


def _histories(runs: Runs, figure: MotionFigures, formulation: str | None) -> list[xr.Dataset]:
    motions = runs.motions(figure.history_number, formulation)
    return [motions.sel(frequency=frequency) for frequency in figure.frequencies]


def _first_coordinate(dataset: xr.Dataset) -> str:
    return "stretch" if "stretch" in dataset else "stretch_1"


def beats_at_resonance(model: str) -> Claim:
    """A beating near twice the field's frequency (it enters squared) in the middle one of three runs only."""

    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        figure = _MOTION[model]
        found = [
            measures.beating(history[_first_coordinate(history)].values, _spacing(history), 2 * frequency)
            for history, frequency in zip(
                _histories(runs, figure, formulation), figure.frequencies, strict=True
            )
        ]
        beats = [depth > measures.BEATING_DEPTH and share > measures.BEATING_SHARE for depth, share in found]
        text = ", ".join(
            f"{depth:.0%} of {share:.0%} at {frequency:g} Hz"
            for (depth, share), frequency in zip(found, figure.frequencies, strict=True)
        )
        return beats == [False, True, False], f"modulation near 2f, of what share of the swing: {text}"

    return test


def _spacing(history: xr.Dataset) -> float:
    time = history["time"].values
    return float(time[1] - time[0])


def creeps_little(model: str) -> Claim:
    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        ratios = []
        for history in _histories(runs, _MOTION[model], formulation):
            name = _first_coordinate(history)
            ratios.append(measures.creep_ratio(history[name].values, history[f"inelastic_{name}"].values))
        return max(ratios) < measures.SMALL_CREEP, f"inelastic strain at most {max(ratios):.1e} of the strain"

    return test


def more_lines_than_equal_biaxial(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    counts = {}
    for model in ("uniaxial", "equal_biaxial"):
        history = _histories(runs, _MOTION[model], None)[1]
        time = history["time"].values
        lines = measures.spectral_lines(history[_first_coordinate(history)].values, float(time[1] - time[0]))
        counts[model] = len(lines)
    text = f"{counts['uniaxial']} spectral lines over 10 % of the highest, {counts['equal_biaxial']} in equal-biaxial"
    return counts["uniaxial"] > counts["equal_biaxial"], text
