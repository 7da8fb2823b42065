"""What the paper says of its time histories, phase paths and Poincaré maps, as tests on computed ones."""

from __future__ import annotations

import xarray as xr

from delagrange.reproduction import measures
from delagrange.reproduction.all_runs import Runs
from delagrange.reproduction.cases import MOTIONS, MotionFigures
from delagrange.reproduction.claim import Claim
from delagrange.reproduction.separation import separation

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


def _section_dimensions(runs: Runs, figure: MotionFigures, formulation: str | None) -> list[float]:
    sections = runs.sections(figure.phase_number, formulation)
    name = _first_coordinate(sections)
    rate = name.replace("stretch", "stretch_rate")
    return [
        measures.correlation_dimension(one[name].values, one[rate].values)
        for one in (sections.sel(frequency=frequency) for frequency in figure.frequencies)
    ]


def _dimension_text(figure: MotionFigures, dimensions: list[float]) -> str:
    text = ", ".join(f"{d:.2f} at {f:g} Hz" for d, f in zip(dimensions, figure.frequencies, strict=True))
    return f"correlation dimension {text} (1 a curve, 2 an area)"


def sections_are_curves(model: str) -> Claim:
    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        dimensions = _section_dimensions(runs, _MOTION[model], formulation)
        holds = all(dimension < measures.CURVE_DIMENSION for dimension in dimensions)
        return holds, _dimension_text(_MOTION[model], dimensions)

    return test


def sections_are_no_curves(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    dimensions = _section_dimensions(runs, _MOTION["uniaxial"], formulation)
    holds = all(dimension >= measures.CURVE_DIMENSION for dimension in dimensions)
    return holds, _dimension_text(_MOTION["uniaxial"], dimensions)


def is_aperiodic(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """A chaotic motion separates neighbours exponentially; a quasi-periodic one in proportion to time."""
    figure = _MOTION["uniaxial"]
    found = separation(figure, figure.frequencies[1], formulation)
    apart = f"two runs started {found.start:.0e} apart separate {found.growth:.3g} times in {found.duration:.2g} s"
    if found.exponential:
        return True, f"{apart}, exponentially"
    return False, (
        f"{apart}, as time to the power {found.power:.2g}: no exponential separation; three base frequencies "
        "fill an area too"
    )


def more_lines_than_equal_biaxial(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    counts = {}
    for model in ("uniaxial", "equal_biaxial"):
        history = _histories(runs, _MOTION[model], None)[1]
        time = history["time"].values
        lines = measures.spectral_lines(history[_first_coordinate(history)].values, float(time[1] - time[0]))
        counts[model] = len(lines)
    text = f"{counts['uniaxial']} spectral lines over 10 % of the highest, {counts['equal_biaxial']} in equal-biaxial"
    return counts["uniaxial"] > counts["equal_biaxial"], text
