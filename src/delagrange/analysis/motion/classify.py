"""What kind of motion is it: at rest, periodic, quasi-periodic, chaotic, or not to be said?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.motion.evidence import Evidence, gather
from delagrange.analysis.motion.lyapunov import observed, spectrum_variables, status_variables
from delagrange.analysis.motion.motion import Motion, make_motion
from delagrange.analysis.motion.motion_dataset import motion_variables
from delagrange.analysis.motion.observation import Observation
from delagrange.analysis.motion.verdict import Verdict, decide, lost
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import Inputs
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import EVOLVING, FROZEN, RELAXED, is_damped
from delagrange.problem.status import COMPLETED, Limits

_VIBRATIONS = 8000  # of the fastest small vibration, to follow by default; 8.7 s of the paper's membrane
_FORCINGS = 4000  # periods of the forcing, at least
_CONTRACTION = 30.0  # a transient has died out when volumes per direction have shrunk by exp(-30)
_PILOT = 60  # periods in which the contraction is measured
_AFFORDABLE = 4.0  # a transient may be so many times as long as what is observed after it


def classify(
    model: str | ModuleType,
    *,
    force: Drive | float = 0.0,
    field: Drive | float = 0.0,
    inputs: Inputs | None = None,
    duration: float | None = None,
    transient: float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    held_stretch: float | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | str | None = None,
    dashpots: str = FROZEN,
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    tolerance: float = 1e-11,
    engine: str = "auto",
    progress: bool = False,
    **material: float,
) -> xr.Dataset:
    """The kind of one motion, with the evidence: Lyapunov spectrum, base frequencies and torus, 0-1 test.

    Three witnesses are heard. The tangent, carried by the variational equations: in a regular motion it
    grows in proportion to time, in a chaotic one exponentially. The spectrum: in a regular motion every
    line is a whole-number combination of a few base frequencies, which span a torus; a chaotic one has a
    broad band. And the 0-1 test of the stroboscopic section. "periodic" and "quasi-periodic" mean that
    base frequencies explain all but 1e-5 of the power and that the tangent does not grow exponentially;
    "chaotic" that it does, for as long as it was followed, and that they do not. In between it says
    "undecided", with the horizon that would do.

    Args:
        model, force, field, inputs, formulation, lateral_dashpot, held_stretch, parameters, limits, material: as
            for `simulate`; the drives are constant or sines. A field without bias enters squared and
            forces at twice its frequency.
        duration: time observed [s], at least 16 periods of the forcing; left out, 8000 periods of the fastest
            small vibration, and at least 4000 of the forcing.
        transient: time [s] left out before; if left out itself, none with frozen dashpots (nothing is
            damped), else until volumes have contracted by exp(-30) in each direction, where that takes no more
            than four times the duration, and none where it takes longer.
        initial_state: values of state variables at t = 0 by name; the rest is the reference state. Or "equilibrium",
            at rest and relaxed under the forces alone, as for `simulate`.
        dashpots: "frozen" where they stand at t = 0; "evolving" with the motion; or "relaxed": evolving, and
            the transient is waited for however long it is.
        tolerance: of the local error, in units of typical sizes of the state.
        engine: "auto", "compiled", "core" (the integrator in C) or "scipy".
        progress: show a progress bar on standard error.

    Returns:
        Dataset with `verdict` ("at rest", "periodic", "quasi-periodic", "chaotic", "undecided", "lost") and
        `evidence` in words; `lyapunov_exponents` and what `lyapunov_spectrum` gives; `base_frequencies`
        [Hz] over `base`, the drive's first (over `period_multiple`), and `torus_dimension`; the lines over
        `line`; `zero_one_K`; the stroboscopic `section_...` over `point`; `sufficient_horizon` [s] where
        undecided, else NaN; `status` and `status_time`.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is
            allowed. More than 2e7 samples are refused: a drive far slower than the membrane takes as many.
    """
    motion = make_motion(
        model, force, field, inputs=inputs, formulation=formulation, lateral_dashpot=lateral_dashpot,
        held_stretch=held_stretch, parameters=parameters, initial_state=initial_state, dashpots=dashpots,
        choices=(FROZEN, EVOLVING, RELAXED), limits=limits, tolerance=tolerance, engine=engine,
        material=material,
    )  # fmt: skip
    periods = _default_periods(motion) if duration is None else motion.periods(duration)
    left_out, settling = _transient(motion, transient, periods)
    observation = observed(motion, periods, left_out, progress)
    evidence = gather(observation, motion.model.COORDINATE_COUNT)
    verdict = lost(observation) if evidence is None else decide(evidence, settling)
    before = left_out * motion.forcing.period
    return _dataset(motion, observation, evidence, _with_notes(verdict, before, settling), before)


def _default_periods(motion: Motion) -> int:
    forcing = motion.forcing
    return max(round(_VIBRATIONS / (forcing.fastest * forcing.period)), _FORCINGS)


def _transient(motion: Motion, given: float | None, periods: int) -> tuple[int, float]:
    """Periods to leave out, and the time [s] that transients then still need to die out."""
    period = motion.forcing.period
    if given is not None:
        return motion.transient_periods(given), 0.0
    if motion.dashpots == FROZEN and not is_damped(motion.path.problem):
        return 0, 0.0
    needed = _relaxation(motion)
    if motion.dashpots == RELAXED or needed <= _AFFORDABLE * periods * period:
        return motion.transient_periods(needed + 0.5 * period), 0.0
    return 0, needed


def _relaxation(motion: Motion) -> float:
    """Time [s] in which volumes contract by exp(-30) in each direction, as at the start of the motion.

    Dashpots and a leak of charge contract them; what the rest of the Jacobian's trace gives averages out over a motion.
    """
    pilot = observed(motion, _PILOT)
    if pilot.status != COMPLETED:
        return 0.0
    flowing = motion.moving[2 * motion.model.COORDINATE_COUNT :]
    places = flowing if flowing.size and motion.dashpots != FROZEN else motion.moving
    slopes = [motion.path.problem.jacobian(time, state) for time, state in zip(pilot.times, pilot.states)]
    contraction = -float(np.mean(np.sum([np.diagonal(slope)[places] for slope in slopes], axis=1)))
    return _CONTRACTION * len(motion.moving) / contraction if contraction > 0 else 0.0


def _with_notes(verdict: Verdict, transient: float, settling: float) -> Verdict:
    notes = ()
    if transient:
        notes = (f"a transient of {transient:.3g} s was left out",)
    if settling:
        notes = (
            f"transients take about {settling:.3g} s to die out while the dashpots evolve: what is said holds "
            "for the stretch that was followed",
        )
    return replace(verdict, sentences=(*verdict.sentences, *notes))


def _dataset(
    motion: Motion, observation: Observation, evidence: Evidence | None, verdict: Verdict, transient: float
) -> xr.Dataset:
    attributes = motion.attributes | {
        "duration": observation.duration,
        "transient": transient,
        "forcing_period": motion.forcing.period,
        "samples_per_period": motion.forcing.samples,
    }
    return xr.Dataset(
        motion_variables(motion, observation, evidence, verdict)
        | spectrum_variables(observation, len(motion.moving))
        | status_variables(observation),
        attrs=attributes,
    )
