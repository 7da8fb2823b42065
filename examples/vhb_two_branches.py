"""Pull-in of a viscoelastic membrane: the faster the field grows, the more of it the membrane stands.

An acrylic elastomer (VHB 4910) relaxes while the field grows. Where the ramp is slow against all relaxation, the
equilibrium spring alone resists: pull-in at the limit point with relaxed dashpots. Where it is fast against
relaxation, all springs resist: the limit point with frozen dashpots, about twice the field. Between the two
limits the field at pull-in grows with the rate; that of ramps that are not even slow against the vibration of
the membrane goes beyond the upper one, since its inertia delays it. Stewart & Anand (2023, see
`delagrange.derive.membrane.material_data`) sweep the rate in the same way, with finite elements.

The description is made in Python: the published springs and the two branches of VHB 4910 that relax in 0.6 s and
6.6 s; the third, 61 s, is left out. The size of the membrane and a small dashpot beside all springs (10 Pa s, it
lets vibrations die out) are chosen for the example. Ramps of 0.03 s to 83 h to the upper limit, from rest, each
until the membrane is thinner than a tenth (`collapsed`); Radau at rtol 1e-6, atol 1e-8.

    python examples/vhb_two_branches.py --out out/examples
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from shared import MEGA, draw_into, model_of, out_folder

import delagrange as dl
from delagrange.derive import EQUAL_BIAXIAL, PARALLEL_VISCOSITY, VHB_4910, Description, Load
from delagrange.figures.style import BLACK, BLUE, VERMILION, caption, new_figure

TWO_BRANCHES = replace(VHB_4910, branches=VHB_4910.branches[:2])
CHOSEN = {"half_length": 5e-3, "half_thickness": 0.5e-3, "parallel_viscosity": 10.0}  # [m], [m], [Pa s]
DURATIONS = np.geomspace(3e5, 0.03, 15)  # in which the field grows to the upper limit [s]
COLLAPSED = dl.Limits(smallest_stretch=0.1)  # of the thickness
NUMERICS = {"method": "Radau", "rtol": 1e-6, "atol": 1e-8, "samples": 2}

MEMBRANE = Description(
    name="vhb_membrane",
    title="VHB 4910 with two Maxwell branches, equal-biaxial",
    load=Load(EQUAL_BIAXIAL),
    equilibrium_spring=TWO_BRANCHES.energy(),
    branches=TWO_BRANCHES.maxwell_branches(),
    parallel_viscosity=PARALLEL_VISCOSITY,
    defaults={**TWO_BRANCHES.defaults(), **CHOSEN},
    sources=(TWO_BRANCHES.source, "Size and parallel dashpot chosen for this example"),
)


def pull_in_of_ramp(model: ModuleType, rate: float, highest: float, **changes: float) -> float:
    """Nominal field [V/m] at which the membrane is lost while it grows at a rate [V/m/s].

    highest: field [V/m] at which the ramp is given up, and the answer NaN
    """
    ramp = dl.Ramp(0.0, highest, highest / rate)
    run = dl.simulate(model, duration=ramp.duration, field=ramp, limits=COLLAPSED, **NUMERICS, **changes)
    return rate * run.attrs["status_time"] if run.attrs["status"] == "collapsed" else np.nan


def pull_in_over_rate(folder: Path) -> xr.Dataset:
    """Field at pull-in [V/m] over the rate of the ramp [V/m/s], with both limits of statics.

    Returns:
        Dataset over `rate`: `field`; `frozen_limit` and `relaxed_limit` [V/m].
    """
    model = model_of(MEMBRANE, folder)
    limits = {kind: float(dl.pull_in(model, dashpots=kind)["field"]) for kind in ("frozen", "relaxed")}
    rates = limits["frozen"] / DURATIONS
    fields = [pull_in_of_ramp(model, rate, 2 * limits["frozen"]) for rate in rates]
    units = {"units": "V/m"}
    return xr.Dataset(
        {"field": ("rate", fields, {**units, "long_name": "nominal field at pull-in"})}
        | {f"{kind}_limit": ((), field, {**units, "long_name": f"limit point with {kind} dashpots"})
           for kind, field in limits.items()},
        {"rate": ("rate", rates, {"units": "V/m/s", "long_name": "rate of the nominal field"})},
    )  # fmt: skip


def draw(found: xr.Dataset) -> Figure:
    """Field at pull-in over the rate, between its two limits."""
    figure = new_figure(height=3.4)
    axes = figure.subplots()
    axes.semilogx(found["rate"] / MEGA, found["field"] / MEGA, "o-", color=BLACK, markersize=4, label="ramps")
    for kind, colour in (("frozen", BLUE), ("relaxed", VERMILION)):
        level = float(found[f"{kind}_limit"]) / MEGA
        axes.axhline(level, color=colour, linestyle="--", label=f"{kind} dashpots, {level:.2f} MV/m")
    axes.set_xlabel(r"rate of the nominal field $\dot{E}$ [MV/m/s]")
    axes.set_ylabel(r"nominal field at pull-in $E$ [MV/m]")
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower right")
    caption(figure, "Field at pull-in of VHB 4910 with two Maxwell branches (0.6 s and 6.6 s), equal-biaxial without a "
            "force, under a field that grows from 0 at a constant rate. Dashed: limit points of statics. At the "
            "highest rates inertia and the dashpot beside all springs delay the pull-in.")  # fmt: skip
    return figure


def main() -> None:
    folder = out_folder("Pull-in of VHB 4910 over the rate at which the field grows")
    found = pull_in_over_rate(folder)
    for kind in ("relaxed", "frozen"):
        print(f"limit point with {kind} dashpots: {float(found[f'{kind}_limit']) / MEGA:.4f} MV/m")
    for rate, field in zip(found["rate"].values, found["field"].values, strict=True):
        print(f"growing at {rate / MEGA:10.4g} MV/m/s: pull-in at {field / MEGA:.4f} MV/m")
    draw_into(folder / "vhb_two_branches", draw, found)


if __name__ == "__main__":
    main()
