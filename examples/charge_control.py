"""Charge control: the same membrane without pull-in.

A neo-Hookean membrane between electrodes at a given voltage pulls in at the stretch 2^(1/3): it thins, which
raises the true field, which thins it further, and the source delivers whatever charge that takes. With a given
charge on the electrodes, the field falls as the membrane spreads, and every stretch on the curve is stable.
Röntgen's experiments of 1880 with sprayed charges were of this kind; Keplinger et al. (2010, PNAS 107, 4505)
took them up: actuators without pull-in.

The description is made in Python, once; the two models differ in what drives the electrodes alone. Equilibria by
continuation, for voltage up to pull-in and back along the unstable part, for charge up to LARGEST_CHARGE; Newton's
method ends at rounding. `electrodes` of the emitted model gives the field that goes with a charge.

    python examples/charge_control.py --out out/examples
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
from delagrange.derive import ALPHA, CHARGE, EQUAL_BIAXIAL, MATERIALS, Description, Dielectric, Load
from delagrange.figures.style import BLACK, BLUE, VERMILION, caption, new_figure

LARGEST_CHARGE = 0.012  # nominal charge density [C/m^2]
CAPTION = (
    "Equilibria of a neo-Hookean membrane, equal-biaxial, without a force. Voltage control holds nothing beyond the "
    "limit point, {level:.3f} MV/m; charge control, here up to {charge:g} mC/m², holds every point."
)

UNDER_VOLTAGE = Description(
    name="under_voltage",
    title="Neo-Hookean membrane under voltage control",
    load=Load(EQUAL_BIAXIAL),
    equilibrium_spring=MATERIALS["neo-Hookean"](ALPHA),
    defaults={
        "half_length": 10e-3, "half_thickness": 0.5e-3, "density": 1e3, "permittivity": 40e-12,
        "shear_modulus_alpha": 30e3,
    },
    sources=("Values chosen for this example, of the size of those of an elastomer",),
)  # fmt: skip
UNDER_CHARGE = replace(
    UNDER_VOLTAGE,
    name="under_charge",
    title="Neo-Hookean membrane under charge control",
    dielectric=Dielectric(control=CHARGE),
)


def both_controls(folder: Path) -> xr.Dataset:
    """Equilibria under charge control, and where voltage control ends.

    Returns:
        Dataset over `nominal_charge_density` [C/m^2]: `stretch` [1], `field` [V/m] (nominal) and `stability`;
        `pull_in_field` [V/m] and `pull_in_stretch` [1] under voltage control, `pull_in_of_charge`, what the
        search for a limit point finds under charge control.
    """
    voltage, charge = (model_of(each, folder) for each in (UNDER_VOLTAGE, UNDER_CHARGE))
    charges = np.linspace(0.0, LARGEST_CHARGE, 121)
    found = dl.equilibria(charge, inputs={"nominal_charge_density": charges})
    only = found[["stretch", "stability"]].isel(branch=0, drop=True)
    limit = dl.pull_in(voltage)
    return only.assign(
        field=(
            "nominal_charge_density",
            _field(charge, only),
            {"units": "V/m", "long_name": "nominal field"},
        ),
        pull_in_field=limit["field"],
        pull_in_stretch=limit["stretch"],
        pull_in_of_charge=dl.pull_in(charge)["found"],
    )


def _field(model: ModuleType, found: xr.Dataset) -> np.ndarray:
    """Nominal field [V/m] between the electrodes at rest, from the emitted model."""
    stretch, charge = found["stretch"].values, found["nominal_charge_density"].values
    parameters = [UNDER_CHARGE.defaults[entry.name] for entry in model.PARAMETERS]
    field, _ = model.electrodes((stretch, np.zeros_like(stretch)), (0.0, charge), parameters)
    return field


def draw(found: xr.Dataset) -> Figure:
    """Field over stretch: the part that voltage control holds, and the rest that charge control holds as well."""
    figure = new_figure(height=3.4)
    axes = figure.subplots()
    stretch, field = found["stretch"].values, found["field"].values / MEGA
    level, limit = float(found["pull_in_field"]) / MEGA, float(found["pull_in_stretch"])
    held = stretch < limit
    axes.plot(stretch, field, color=BLUE, label="held by charge control")
    band = {"color": BLACK, "linewidth": 3.5, "alpha": 0.45, "solid_capstyle": "butt"}
    axes.plot([*stretch[held], limit], [*field[held], level], label="held by voltage control as well", **band)
    axes.plot(limit, level, "o", color=VERMILION, markerfacecolor="white", markersize=6)
    arrow = {"arrowstyle": "-", "color": VERMILION}
    beside = (limit + 0.12, 0.45 * level)
    axes.annotate("pull-in under\nvoltage control", (limit, level), beside, color=VERMILION, arrowprops=arrow)
    axes.set_xlabel(r"stretch $\lambda$ [1]")
    axes.set_ylabel(r"nominal field $E$ [MV/m]")
    axes.set_ylim(0.0, 1.12 * level)
    axes.set_xlim(1.0, stretch.max())
    axes.legend(loc="lower right")
    caption(figure, CAPTION.format(level=level, charge=LARGEST_CHARGE * 1e3))
    return figure


def main() -> None:
    folder = out_folder("A membrane under voltage and under charge control")
    found = both_controls(folder)
    print(f"voltage control: pull-in at {float(found['pull_in_field']) / MEGA:.5f} MV/m, "
          f"stretch {float(found['pull_in_stretch']):.5f}")  # fmt: skip
    print(f"charge control: {found['pull_in_of_charge'].item()}")
    last = found.isel(nominal_charge_density=-1)
    print(f"at {LARGEST_CHARGE * 1e3:g} mC/m^2: stretch {float(last['stretch']):.5f}, {last['stability'].item()}, "
          f"field {float(last['field']) / MEGA:.5f} MV/m")  # fmt: skip
    draw_into(folder / "charge_control", draw, found)


if __name__ == "__main__":
    main()
