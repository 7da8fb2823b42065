"""The evidence on the kind of a motion as variables of a Dataset."""

from __future__ import annotations

import numpy as np

from delagrange.analysis.motion.evidence import Evidence
from delagrange.analysis.motion.motion import Motion
from delagrange.analysis.motion.observation import Observation
from delagrange.analysis.motion.verdict import Verdict
from delagrange.run.run_dataset import state_variables, variable

_BASES = (
    "the forcing's first, over the period multiple; then the strongest lines that make, by whole numbers, all "
    "the others; where the motion is not regular, the forcing's only"
)

_MIXED = "of the first coordinate, plus 0.618 times the second where there are two"


def motion_variables(
    motion: Motion, observation: Observation, evidence: Evidence | None, verdict: Verdict
) -> dict[str, tuple]:
    """Verdict, torus, lines, 0-1 test and section."""
    return {
        "verdict": ((), np.array(verdict.kind, dtype=object), {"long_name": "kind of the motion"}),
        "evidence": ((), np.array(verdict.text, dtype=object), {"long_name": "what the verdict stands on"}),
        "sufficient_horizon": variable(
            (), verdict.sufficient_horizon, "s", "time to follow the motion for a verdict, where undecided"
        ),
        **_torus_variables(motion, evidence, verdict),
        **_line_variables(evidence, verdict),
        **_band_variables(evidence),
        "zero_one_K": variable(
            (), np.nan if evidence is None else evidence.zero_one, "1",
            "0-1 test for chaos: near 0 for a regular motion, near 1 for a chaotic one", "K",
        ),
        **_section_variables(motion, observation),
    }  # fmt: skip


def _torus_variables(motion: Motion, evidence: Evidence | None, verdict: Verdict) -> dict[str, tuple]:
    if evidence is not None and verdict.regular:
        torus = evidence.torus
        bases, accuracy = torus.base_frequencies, torus.accuracy
        dimension, multiple = float(torus.dimension), float(torus.period_multiple)
    else:
        bases = np.array(motion.forcing.frequencies)
        accuracy, dimension, multiple = np.zeros(len(bases)), np.nan, np.nan
    return {
        "base_frequencies": variable("base", bases, "Hz", "base frequency of the motion", "f_i", definition=_BASES),
        "base_accuracy": variable("base", accuracy, "Hz", "accuracy of the base frequency"),
        "torus_dimension": variable((), dimension, "1", "dimension of the torus, the forcing included"),
        "period_multiple": variable((), multiple, "1", "periods of the forcing in the first base frequency's"),
    }  # fmt: skip


def _line_variables(evidence: Evidence | None, verdict: Verdict) -> dict[str, tuple]:
    if evidence is None:
        nothing = np.zeros(0)
        frequency, amplitude, accuracy, unexplained = nothing, nothing, nothing, np.nan
        explained, integers = np.zeros(0, dtype=bool), None
    else:
        lines = evidence.lines
        frequency, amplitude, accuracy = lines.frequency, lines.amplitude, lines.accuracy
        unexplained, explained = evidence.unexplained, evidence.torus.explained
        integers = evidence.torus.integers if verdict.regular else None
    found = {
        "line_frequency": variable("line", frequency, "Hz", "frequency of the spectral line", "f"),
        "line_amplitude": variable(
            "line", amplitude, "1", "amplitude of the spectral line of the coordinates",
            definition=_MIXED,
        ),
        "line_accuracy": variable("line", accuracy, "Hz", "accuracy of the frequency of the spectral line"),
        "line_explained": variable("line", explained, "1", "whether the bases explain the line"),
        "unexplained_power": variable(
            (), unexplained, "1", "share of the power that the base frequencies do not explain"
        ),
    }  # fmt: skip
    if integers is not None:
        found["line_integers"] = variable(
            ("line", "base"), integers, "1", "how often the line has each base frequency", "k_i"
        )
    return found


def _band_variables(evidence: Evidence | None) -> dict[str, tuple]:
    nothing = np.zeros(0)
    frequency, amplitude = (
        (nothing, nothing) if evidence is None else (evidence.band.frequency, evidence.band.amplitude)
    )
    return {
        "band_frequency": variable("band", frequency, "Hz", "middle of a part of the frequency axis", "f"),
        "band_amplitude": variable(
            "band",
            amplitude,
            "1",
            "highest amplitude of the coordinates' spectrum in that part",
            definition=_MIXED,
        ),
    }


def _section_variables(motion: Motion, observation: Observation) -> dict[str, tuple]:
    section = observation.section
    times = observation.times[:: motion.forcing.samples]
    forced = bool(motion.forcing.frequencies)
    when = "once in a period of the forcing" if forced else "once in a period of the fastest small vibration"
    data = state_variables(motion.model, "point", section.T, when, "section_")
    return data | {"section_time": variable("point", times, "s", f"time of the section, {when}", "t")}
