"""Each qualitative statement of Secs. III and IV of the paper, judged from accurate runs.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384. "Only as printed" says that a statement
holds for the printed pure-shear equation but not for the one that mechanics gives.
"""

from __future__ import annotations

from dataclasses import dataclass

from delagrange.reproduction.claims import kind_claims as kind
from delagrange.reproduction.claims import motion_claims as motion
from delagrange.reproduction.claims import response_claims as response
from delagrange.reproduction.claims.claim import Claim
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.runs import formulations

YES, NO, ONLY_AS_PRINTED, ONLY_CONSISTENT = "yes", "no", "only as printed", "only in the consistent form"
_ANSWERS = {  # holds (as printed, in the consistent form)
    (True, True): YES,
    (True, False): ONLY_AS_PRINTED,
    (False, True): ONLY_CONSISTENT,
    (False, False): NO,
}


@dataclass(frozen=True)
class Statement:
    """A statement of the paper in our words, with the claim that decides it for one formulation."""

    figure: str
    model: str
    text: str
    claim: Claim


@dataclass(frozen=True)
class Judgement:
    """A statement, the answer, and the evidence for each formulation."""

    statement: Statement
    answer: str
    evidence: str


def judge(runs: Runs) -> tuple[Judgement, ...]:
    """All statements, in the order of the paper."""
    return tuple(_judge(runs, statement) for statement in STATEMENTS)


def _judge(runs: Runs, statement: Statement) -> Judgement:
    found = {formulation: statement.claim(runs, formulation) for formulation in formulations(statement.model)}
    if len(found) == 1:
        ((holds, evidence),) = found.values()
        return Judgement(statement, YES if holds else NO, evidence)
    evidence = "; ".join(f"{name.replace('_', ' ')}: {text}" for name, (_, text) in found.items())
    return Judgement(statement, _ANSWERS[found["as_printed"][0], found["consistent"][0]], evidence)


def _statements(model: str, *said: tuple[str, str, Claim]) -> tuple[Statement, ...]:
    return tuple(Statement(figure, model, text, claim) for figure, text, claim in said)


_LOWERS = "a larger {} lowers the resonant frequency"
_RAISES = "a larger {} raises the resonant frequency"
_PEAK = "a larger {} raises the peak"
_WEAK = "the field moves the resonance less than the force does"
_BEATS = "the vibration beats at resonance, not at half or twice that frequency"
_CREEP = "the inelastic stretch hardly moves"
_CLOSED = "the Poincaré maps are closed loops (quasi-periodic)"


def _force_and_field(figure: int, model: str) -> tuple[tuple[str, str, Claim], ...]:
    """What the paper says alike of the equal-biaxial and the uniaxial response."""
    return (
        (f"{figure}a", _LOWERS.format("force"), response.resonance(model, "a", rises=False)),
        (f"{figure}a", _PEAK.format("force"), response.peak_rises(model, "a")),
        (f"{figure}b", _LOWERS.format("field"), response.resonance(model, "b", rises=False)),
        (f"{figure}b", _PEAK.format("field"), response.peak_rises(model, "b")),
        (f"{figure}", _WEAK, response.field_moves_resonance_less(model)),
    )


_MORE_IRREGULAR = "the vibration is more irregular at resonance than equal-biaxial"
_AWAY = "away from resonance a larger held stretch lowers the amplitude"

STATEMENTS: tuple[Statement, ...] = (
    *_statements(
        "equal_biaxial",
        *_force_and_field(4, "equal_biaxial"),
        ("5", _BEATS, motion.beats_at_resonance("equal_biaxial")),
        ("5", _CREEP, motion.creeps_little("equal_biaxial")),
        ("6", _CLOSED, kind.sections_are_closed("equal_biaxial")),
    ),
    *_statements(
        "uniaxial",
        *_force_and_field(7, "uniaxial"),
        ("7", "the response has several resonances", response.many_modes),
        ("8", _BEATS, motion.beats_at_resonance("uniaxial")),
        ("8", _CREEP, motion.creeps_little("uniaxial")),
        ("8", _MORE_IRREGULAR, motion.more_lines_than_equal_biaxial),
        ("9", "the Poincaré maps are disordered, no closed loops", kind.sections_fill_an_area),
        ("9", "the motion is aperiodic", kind.is_aperiodic),
    ),
    *_statements(
        "pure_shear",
        ("10a", _LOWERS.format("force"), response.resonance("pure_shear", "a", rises=False)),
        ("10a", _PEAK.format("force"), response.peak_rises("pure_shear", "a")),
        ("10b", _RAISES.format("field"), response.resonance("pure_shear", "b", rises=True)),
        ("10b", _PEAK.format("field"), response.peak_rises("pure_shear", "b")),
        ("10b", "a larger field makes the peak very large", response.grows_large),
        ("10c", _RAISES.format("held stretch"), response.resonance("pure_shear", "c", rises=True)),
        ("10c", _PEAK.format("held stretch"), response.peak_rises("pure_shear", "c")),
        ("10c", _AWAY, response.held_stretch_reduces_away),
        ("10c", "a larger held stretch needs a larger holding force", response.reaction_grows),
        ("11", _BEATS, motion.beats_at_resonance("pure_shear")),
        ("11", _CREEP, motion.creeps_little("pure_shear")),
        ("12", _CLOSED, kind.sections_are_closed("pure_shear")),
    ),
)
