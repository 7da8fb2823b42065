"""From evidence to a verdict on the kind of a motion: said only where the evidence leaves a wide gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.analysis.motion.evidence import Evidence
from delagrange.analysis.motion.observation import Observation
from delagrange.problem.status import STATUS

AT_REST, PERIODIC, QUASI_PERIODIC = "at rest", "periodic", "quasi-periodic"
CHAOTIC, UNDECIDED, LOST = "chaotic", "undecided", "lost"
VERDICTS = (AT_REST, PERIODIC, QUASI_PERIODIC, CHAOTIC, UNDECIDED, LOST)

_STILL = 1e-8  # peak to peak [1] below which nothing moves
_REGULAR_GAIN = 3.0  # of the log of the tangent in the second half; growth in proportion to time gives ln 2
_CHAOTIC_GAIN = 8.0
_ROUNDING_GAIN = 40.0  # by then even rounding has grown to the size of the motion
_EXPLAINED = 1e-5  # share of the power that may stay unexplained in a regular motion
_FEWEST_PERIODS = 200  # of the forcing, and of the fastest small vibration
_FAIR_PERIODS = 2000  # the same, of a horizon that is named as sufficient
_FEWEST_TURNS = 10  # of the slowest strong line, and of the fastest small vibration of what is at rest
_WALKING = 0.8  # K of the 0-1 test, against a regular motion
_LONGER = 4.0


@dataclass(frozen=True)
class Verdict:
    """The kind of a motion, the sentences it stands on, and for "undecided" the horizon [s] that would do."""

    kind: str
    sentences: tuple[str, ...]
    sufficient_horizon: float = float("nan")

    @property
    def regular(self) -> bool:
        """Whether the base frequencies describe the motion."""
        return self.kind in (PERIODIC, QUASI_PERIODIC)

    @property
    def text(self) -> str:
        """The evidence for a reader."""
        return "; ".join(self.sentences)


def lost(observation: Observation) -> Verdict:
    """Of a motion that did not last."""
    return Verdict(LOST, (f"the run {STATUS[observation.status]} at {observation.status_time:.6g} s",))


def decide(evidence: Evidence, settling: float = 0.0) -> Verdict:
    """The verdict on a motion that lasted, while transients needed `settling` [s] more to die out."""
    if evidence.extent < _STILL and _could_move(evidence):
        return Verdict(AT_REST, (f"nothing moves by more than {_STILL:g}", _tangent_sentence(evidence)))
    facts = (_tangent_sentence(evidence), _lines_sentence(evidence), *_zero_one_sentences(evidence))
    if _parts(evidence) and not _explained(evidence) and _long(evidence):
        return Verdict(CHAOTIC, facts)
    doubt = _doubt(evidence, settling)
    if doubt is not None:
        return _undecided(*doubt, facts)
    unstable = ("unstable: neighbours part exponentially",) if _parts(evidence) else ()
    kind = PERIODIC if evidence.torus.dimension <= 1 else QUASI_PERIODIC
    return Verdict(kind, (*_torus_sentences(evidence), *facts, *unstable))


def _could_move(evidence: Evidence) -> bool:
    """Whether the membrane had the time to vibrate."""
    observation = evidence.observation
    return observation.duration >= _FEWEST_TURNS / observation.forcing.fastest


def _parts(evidence: Evidence) -> bool:
    """Whether neighbours part exponentially."""
    return evidence.growth.gain >= _CHAOTIC_GAIN and evidence.growth.sustained


def _explained(evidence: Evidence) -> bool:
    """Whether base frequencies explain the spectrum."""
    return evidence.unexplained < _EXPLAINED


def _long(evidence: Evidence) -> bool:
    """Whether the motion was followed for long enough to be called anything."""
    return evidence.observation.duration >= _periods(evidence, _FEWEST_PERIODS)


def _periods(evidence: Evidence, count: int) -> float:
    """So many periods [s] of the forcing or of the fastest small vibration, whichever takes longer."""
    forcing = evidence.observation.forcing
    return count * max(forcing.period, 1 / forcing.fastest)


def _doubt(evidence: Evidence, settling: float) -> tuple[str, float] | None:
    """Why nothing can be said, and the horizon [s] that would do; None where a regular motion is established."""
    horizon, growth = evidence.observation.duration, evidence.growth
    fair = _periods(evidence, _FAIR_PERIODS)
    turns = _FEWEST_TURNS / evidence.slowest
    longer = settling + max(fair, _LONGER * horizon)
    if not _long(evidence) or (horizon < turns and not _parts(evidence)):
        return f"{horizon:.3g} s is too short to tell lines apart", settling + max(fair, 1.1 * turns)
    if _parts(evidence) and growth.gain < _ROUNDING_GAIN:
        return "neighbours part, the spectrum shows nothing of it", horizon * 50 / growth.gain
    if not _explained(evidence):
        return "neither do neighbours part nor is the spectrum explained", longer
    if _REGULAR_GAIN <= growth.gain < _CHAOTIC_GAIN and growth.sustained:
        return "neighbours part slowly", horizon * 2 * _CHAOTIC_GAIN / growth.gain
    if evidence.zero_one > _WALKING:
        return "the 0-1 test speaks against a regular motion", longer
    return None


def _undecided(why: str, horizon: float, facts: tuple[str, ...]) -> Verdict:
    return Verdict(UNDECIDED, (why, f"a horizon of about {horizon:.3g} s would do", *facts), float(horizon))


def _tangent_sentence(evidence: Evidence) -> str:
    growth, found = evidence.growth, evidence.spectrum
    largest = (
        "" if found is None
        else f"largest Lyapunov exponent {found.exponents[0]:.3g} ± {found.uncertainty[0]:.2g} 1/s, "
    )  # fmt: skip
    return (
        f"{largest}the tangent grew by exp({growth.gain:.3g}) in the second half of "
        f"{evidence.observation.duration:.4g} s (growth in proportion to time: by exp(0.69))"
    )


def _lines_sentence(evidence: Evidence) -> str:
    count = len(evidence.lines.frequency)
    return (
        f"{count} spectral lines, {evidence.unexplained:.2g} of the power not explained by base frequencies"
    )


def _zero_one_sentences(evidence: Evidence) -> tuple[str, ...]:
    return () if np.isnan(evidence.zero_one) else (f"0-1 test K = {evidence.zero_one:.3f}",)


def _torus_sentences(evidence: Evidence) -> tuple[str, ...]:
    torus = evidence.torus
    frequencies = ", ".join(f"{value:.6g}" for value in torus.base_frequencies)
    if torus.dimension == 1:
        made = f"all lines are multiples of {frequencies} Hz"
    else:
        made = f"base frequencies {frequencies} Hz span a torus of dimension {torus.dimension}"
    return (
        made,
        *(_multiple_sentence(torus.period_multiple) if torus.drives else ()),
    )


def _multiple_sentence(multiple: int) -> tuple[str, ...]:
    return () if multiple == 1 else (f"the motion repeats after {multiple} periods of the forcing",)
