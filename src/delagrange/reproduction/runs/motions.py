"""Time histories and stroboscopic sections of Figs. 5, 6, 8, 9, 11 and 12, accurately integrated.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III; what is run stands in `cases`.
"""

from __future__ import annotations

from collections.abc import Iterable

import xarray as xr

from delagrange.analysis.motion.sections import stroboscopic_section
from delagrange.drives.drive import Sine
from delagrange.reproduction.runs.cases import MotionFigures
from delagrange.reproduction.runs.numerics import ACCURATE
from delagrange.run.run_dataset import variable
from delagrange.run.simulation import simulate

SECTION_POINTS = {"equal_biaxial": 250, "pure_shear": 250, "uniaxial": 500}  # an area needs more than a curve
_SPACING = 20e-6  # [s], of the time histories: some 35 samples in a period of 2 x 742 Hz


def motion(figures: MotionFigures, frequency: float, formulation: str | None = None) -> xr.Dataset:
    """Time history of one run over the window of the figure, accurate, on a fine grid.

    Returns:
        Dataset over `time` [s] as `simulate` gives it: stretches, their rates, inelastic stretches, ...
    """
    arguments = run_arguments(figures, frequency, formulation)
    samples = round(figures.window / _SPACING) + 1
    return simulate(figures.model, **arguments, duration=figures.window, samples=samples)


def section(
    figures: MotionFigures, frequency: float, formulation: str | None = None, count: int | None = None
) -> xr.Dataset:
    """Stroboscopic points of one run at the drive phases t_k = k / f, k = 0 .. count - 1, from rest.

    `count` is that of `SECTION_POINTS` if left out.

    Returns:
        Dataset over `point` with the variables of `simulate` and the coordinate `time` [s].
    """
    count = SECTION_POINTS[figures.model] if count is None else count
    return stroboscopic_section(figures.model, **run_arguments(figures, frequency, formulation), count=count)


def run_arguments(figures: MotionFigures, frequency: float, formulation: str | None) -> dict[str, object]:
    load = figures.load
    return {
        "formulation": formulation,
        "force": load.force,
        "field": Sine(load.field_amplitude, frequency),
        "held_stretch": load.held_stretch,
        "method": ACCURATE.method,
        "rtol": ACCURATE.rtol,
        "atol": ACCURATE.atol,
    }


def motions(figures: MotionFigures, formulation: str | None = None) -> xr.Dataset:
    """`motion` at the three frequencies of a figure: Dataset over (frequency, time)."""
    runs = (motion(figures, frequency, formulation) for frequency in figures.frequencies)
    return _side_by_side(figures, figures.history_number, runs)


def sections(figures: MotionFigures, formulation: str | None = None, count: int | None = None) -> xr.Dataset:
    """`section` at the three frequencies of a figure: Dataset over (frequency, point)."""
    runs = (section(figures, frequency, formulation, count) for frequency in figures.frequencies)
    return _side_by_side(figures, figures.phase_number, runs)


def _side_by_side(figures: MotionFigures, number: int, runs: Iterable[xr.Dataset]) -> xr.Dataset:
    joined = xr.concat(
        list(runs), dim="frequency", data_vars="all", coords="different", compat="equals",
        combine_attrs="drop_conflicts",
    )  # fmt: skip
    frequency = variable("frequency", list(figures.frequencies), "Hz", "frequency of the electric field", "f")
    attributes = ACCURATE.attributes() | {
        "figure": number,
        "force_drive": f"{figures.load.force:g} N from t = 0",
        "nominal_electric_field_drive": f"{figures.load.field_amplitude:g} V/m sin(2 pi frequency t)",
        "field_amplitude": figures.load.field_amplitude,
    }
    joined = joined.drop_attrs(deep=False).assign_attrs(_of_all_runs(joined.attrs) | attributes)
    return joined.assign_coords(frequency=frequency)


def _of_all_runs(attributes: dict[str, object]) -> dict[str, object]:
    """What is said of the runs together; how each ended stands in `status` and `status_time`."""
    return {name: value for name, value in attributes.items() if name not in ("status", "status_time")}
