"""The kind of motion of the nine cases of Figs. 6, 9 and 12: periodic, quasi-periodic or chaotic, with evidence.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III; what is run stands in `cases`. The dashpots are
frozen: with a relaxation time of 400 s they hardly move in a run of seconds.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange.analysis.motion.classify import classify
from delagrange.drives.drive import Sine
from delagrange.problem.dashpots import FROZEN
from delagrange.reproduction.runs.cases import MotionFigures
from delagrange.run.run_dataset import variable

_KEPT = (
    "verdict", "evidence", "lyapunov_exponents", "lyapunov_uncertainty", "base_frequencies", "torus_dimension",
    "zero_one_K", "sufficient_horizon",
)  # fmt: skip


def kind(figures: MotionFigures, frequency: float, formulation: str | None = None) -> xr.Dataset:
    """What `classify` finds of one case, from rest in the reference state.

    Where it cannot decide, the motion is followed once more, for as long as it asks for.
    """
    found = _classified(figures, frequency, formulation)
    horizon = float(found["sufficient_horizon"])
    return found if np.isnan(horizon) else _classified(figures, frequency, formulation, duration=horizon)


def _classified(
    figures: MotionFigures, frequency: float, formulation: str | None, duration: float | None = None
) -> xr.Dataset:
    load = figures.load
    found = classify(
        figures.model,
        formulation=formulation,
        force=load.force,
        field=Sine(load.field_amplitude, frequency),
        held_stretch=load.held_stretch,
        dashpots=FROZEN,
        duration=duration,
    )
    return found[list(_KEPT)].assign(followed=variable((), found.attrs["duration"], "s", "time followed"))


def kinds(figures: MotionFigures, formulation: str | None = None) -> xr.Dataset:
    """`kind` at the three frequencies of a figure: Dataset over (frequency, exponent, base), filled with NaN."""
    found = [kind(figures, frequency, formulation) for frequency in figures.frequencies]
    bases = max(one.sizes["base"] for one in found)
    even = [one.pad(base=(0, bases - one.sizes["base"])) for one in found]
    joined = xr.concat(
        even,
        dim="frequency",
        data_vars="all",
        coords="different",
        compat="equals",
        combine_attrs="drop_conflicts",
    )
    frequency = variable("frequency", list(figures.frequencies), "Hz", "frequency of the electric field", "f")
    attributes = {"figure": figures.phase_number, "field_amplitude": figures.load.field_amplitude}
    return joined.assign_coords(frequency=frequency).assign_attrs(attributes)
