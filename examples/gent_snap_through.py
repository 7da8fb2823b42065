"""Snap-through: a stiffening membrane jumps from one stretch to a much larger one, and survives.

A membrane under an equal-biaxial dead load thins as the voltage grows, which raises the true field, which thins
it further: at a limit point the voltage can be held no longer. A neo-Hookean membrane is lost there. One whose
chains lock (Gent 1996, Rubber Chem. Technol. 69, 59) stiffens first: its voltage-stretch curve is S-shaped, and
at the limit point it snaps to the stiff part of the curve. Zhao & Suo (2010, Phys. Rev. Lett., Theory of
dielectric elastomers capable of giant deformation of actuation) made this the road to large actuation.

The curve is followed by continuation from the unloaded membrane, fields from 0 to 1.4 times the snap-through;
Newton's method ends at rounding. The model is that of gent_snap_through.toml.

    python examples/gent_snap_through.py --out out/examples
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from shared import MEGA, draw_into, model_of_file, out_folder

import delagrange as dl
from delagrange.figures.style import BLACK, BLUE, VERMILION, caption, new_figure

FORCE = 0.5  # on each edge [N]
FIELDS = 1.4  # largest field of the curve, in those at snap-through


def snap_through(folder: Path) -> xr.Dataset:
    """Equilibria over the field, with its value and the stretches before and after the jump.

    Returns:
        Dataset of `delagrange.equilibria` with `snap_field` [V/m], `stretch_before` and `stretch_after` [1].
    """
    model = model_of_file("gent_snap_through.toml", folder)
    limit = dl.pull_in(model, force=FORCE)
    field = float(limit["field"])
    there = dl.equilibria(model, force=FORCE, field=field)
    after = float(there["stretch"].where(there["stability"] == "stable").max())
    curve = dl.equilibria(model, force=FORCE, field=np.linspace(0.0, FIELDS * field, 71))
    return curve.assign(
        snap_field=((), field, {"units": "V/m", "long_name": "nominal field at snap-through"}),
        stretch_before=((), float(limit["stretch"]), {"units": "1", "long_name": "stretch before the jump"}),
        stretch_after=((), after, {"units": "1", "long_name": "stretch after the jump"}),
    )


def draw(found: xr.Dataset) -> Figure:
    """Field over stretch, stable and unstable, with the jump."""
    figure = new_figure(height=3.4)
    axes = figure.subplots()
    _draw_curve(axes, found)
    level = float(found["snap_field"]) / MEGA
    before, after = float(found["stretch_before"]), float(found["stretch_after"])
    axes.annotate("", (after, level), (before, level), arrowprops={"arrowstyle": "-|>", "color": BLACK})
    axes.plot([before, after], [level, level], "o", color=BLACK, markerfacecolor="white", markersize=5)
    axes.text((before + after) / 2, 1.02 * level, f"snap-through at {level:.3f} MV/m", ha="center")
    axes.set_xlabel(r"stretch $\lambda$ [1]")
    axes.set_ylabel(r"nominal field $E$ [MV/m]")
    axes.set_ylim(0.0, FIELDS * level)
    axes.legend(loc="lower right")
    caption(figure, f"Gent membrane, J = 70, under an equal-biaxial dead load of {FORCE:g} N on each edge. At the "
            f"limit point it jumps from the stretch {before:.3f} to {after:.3f}.")  # fmt: skip
    return figure


def _draw_curve(axes: Axes, found: xr.Dataset) -> None:
    """Points of the continuation and those at the fields of the grid, in the order of the stretch."""
    field = np.broadcast_to(found["field"].values[:, None], found["stretch"].shape)
    stretch = np.concatenate([found["curve_stretch"], found["stretch"].values.ravel()])
    field = np.concatenate([found["curve_field"], field.ravel()]) / MEGA
    kinds = np.concatenate([found["curve_stability"], found["stability"].values.ravel()])
    order = np.argsort(stretch)[: np.isfinite(stretch).sum()]
    stretch, field, stable = stretch[order], field[order], kinds[order] == "stable"
    axes.plot(stretch, np.where(stable, field, np.nan), color=BLUE, label="stable")
    joined = ~stable  # and up to the neighbours on either side
    joined[1:] |= ~stable[:-1]
    joined[:-1] |= ~stable[1:]
    axes.plot(stretch, np.where(joined, field, np.nan), color=VERMILION, linestyle="--", label="unstable")


def main() -> None:
    folder = out_folder("Snap-through of a Gent membrane under a dead load")
    found = snap_through(folder)
    print(f"snap-through at a nominal field of {float(found['snap_field']) / MEGA:.5f} MV/m")
    print(f"stretch before {float(found['stretch_before']):.5f}, after {float(found['stretch_after']):.5f}")
    draw_into(folder / "gent_snap_through", draw, found)


if __name__ == "__main__":
    main()
