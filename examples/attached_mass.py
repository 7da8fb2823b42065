"""A mass on the edges of a membrane: how much lower it vibrates.

The clamps and wires at the edges of a membrane move with it. Each of the four edges of a square membrane carries
a mass m here. About the reference state the motion of one stretch is that of a mass on a spring: the membrane of
sides 2 L and thickness 2 H has, from its energies, the stiffness k = 96 mu H L^2 and the inertia
M = 16 rho H L^2 (L^2 + 2 H^2)/3 + 4 m L^2 of the stretch, so that f = sqrt(k/M)/(2 pi). Under a dead load, the
stiffness is another one; the program finds it from the equations that it derived.

Natural frequencies from the emitted Jacobian about the equilibrium under two loads, masses from 10 mg to 100 g;
Newton's method ends at rounding. The model is that of attached_mass.toml.

    python examples/attached_mass.py --out out/examples
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from shared import draw_into, model_of_file, out_folder

import delagrange as dl
from delagrange.figures.style import BLACK, BLUE, ORANGE, caption, new_figure

FORCES = np.array([0.0, 1.0])  # on each edge [N]
MASSES = np.geomspace(1e-5, 0.1, 17)  # on each edge [kg]
CAPTION = (
    "Natural frequency of a neo-Hookean membrane over the mass on each of its four edges, under two equal-biaxial "
    "dead loads. Dotted: without a mass. Dashed: with a mass that is large beside the membrane, without load."
)
SHOWN = 1e-3  # mass of which the frequency is told [kg]


def frequencies(folder: Path) -> xr.Dataset:
    """Natural frequency [Hz] over force [N] and mass of each edge [kg], of `delagrange.modes`.

    Also `bare_frequency` [Hz] over the force, of the membrane that carries nothing.
    """
    model = model_of_file("attached_mass.toml", folder)
    found = dl.modes(model, force=FORCES, edge_mass=MASSES).isel(mode=0)
    bare = dl.modes(model, force=FORCES, edge_mass=0.0)["frequency"].isel(mode=0, drop=True)
    return found.assign(bare_frequency=bare.drop_vars("edge_mass").assign_attrs(long_name="without a mass"))


def draw(found: xr.Dataset) -> Figure:
    """Frequency over mass for each force, with the frequency without a mass and the limit of a massless membrane."""
    figure = new_figure(height=3.4)
    axes = figure.subplots()
    grams = found["edge_mass"].values * 1e3
    for force, colour in zip(found["force"].values, (BLACK, BLUE), strict=True):
        of_load = found.sel(force=force)
        axes.loglog(grams, of_load["frequency"], color=colour, label=f"force {force:g} N")
        axes.axhline(float(of_load["bare_frequency"]), color=colour, linestyle=":", linewidth=0.9)
    heaviest = found.sel(force=0.0).isel(edge_mass=-1)
    massless = heaviest["frequency"].values * np.sqrt(grams[-1] / grams)
    axes.loglog(
        grams, massless, color=ORANGE, linestyle="--", label=r"$\propto m^{-1/2}$, without own inertia"
    )
    axes.set_ylim(top=2 * float(found["bare_frequency"].max()))
    axes.set_xlabel(r"mass on each edge $m$ [g]")
    axes.set_ylabel(r"natural frequency $f_n$ [Hz]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    axes.margins(x=0.0)
    axes.legend(loc="lower left")
    caption(figure, CAPTION)
    return figure


def main() -> None:
    folder = out_folder("Natural frequencies of a membrane with a mass on each edge")
    found = frequencies(folder)
    one = found.sel(edge_mass=SHOWN, method="nearest")
    grams = float(one["edge_mass"]) * 1e3
    for force in FORCES:
        bare, heavy = (float(one[name].sel(force=force)) for name in ("bare_frequency", "frequency"))
        print(
            f"force {force:g} N: {bare:.4f} Hz without a mass, {heavy:.4f} Hz with {grams:.4g} g on each edge"
        )
    draw_into(folder / "attached_mass", draw, found)


if __name__ == "__main__":
    main()
