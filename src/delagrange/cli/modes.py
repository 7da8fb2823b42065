"""`delagrange modes`: natural frequencies about an equilibrium."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delagrange.cli import console
from delagrange.cli.membrane import arguments, loaded, state_given
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible, tell_written, write, write_plot
from delagrange.drives.inputs import ELECTRICAL

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_ROWS = 60  # of the printed table; the file has all


def modes(given: Given) -> None:
    """Natural frequencies and modes about the stable equilibrium.

    The equilibrium is the one that the unloaded membrane reaches under the force
    and then the field, 0 V/m where none is given; where a charge or current drives
    the model, under --input nominal_charge_density=VALUES or nominal_current_density
    instead. The field enters squared: without a bias it excites a mode at half its
    natural frequency, the "field frequency" of the table.

    [bold]Examples[/]

      delagrange modes equal-biaxial --force 0.5
      delagrange modes uniaxial --force 0.2,0.5 --field 0:2e7:2e5 --plot modes.png
      delagrange modes uniaxial --force 0.5 --field 1e6 --dashpots relaxed
    """
    module = loaded(given)
    taken = arguments(given, module, state_given(given, module)) | given.some("force", "field", "dashpots")
    if given.plot is not None and not any(map(np.ndim, (*taken.values(), *(taken["inputs"] or {}).values()))):
        raise ValueError("--plot draws modes over what is varied: give an option two or more values")
    with interruptible("the modes were not finished, nothing was written"):
        from delagrange.analysis.rest.modes import modes as find_modes

        found = find_modes(module, **taken)
        write(found, given)
    console.show(f"{module.MODEL}: natural frequencies, dashpots {given.dashpots}", _table(found))
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures.modes_figure import draw_modes

        write_plot(given.plot, draw_modes, found)


def _table(found: xr.Dataset) -> Table:
    axes = [str(name) for name in found["frequency"].dims if name != "mode"]
    stretches, stem = found.attrs["coordinates"].split(", "), ELECTRICAL[found.attrs["varied_input"]].stem
    damped = "decay_rate" in found
    headings = [f"{name} [{found[name].attrs['units']}]" for name in axes]
    table = console.table(
        *headings, *(f"{name} [1]" for name in stretches), "mode", "frequency [Hz]", f"{stem} frequency [Hz]",
        *(["decay [1/s]"] if damped else []), "equilibrium",
    )  # fmt: skip
    places = list(np.ndindex(*(found.sizes[name] for name in axes), found.sizes["mode"]))
    for place in places[:_MOST_ROWS]:
        here = found.isel(dict(zip((*axes, "mode"), place, strict=True)))
        names = (*axes, *stretches, "mode", "frequency", f"resonant_{stem}_frequency")
        numbers = [f"{here[name].item():.7g}" for name in (*names, *(["decay_rate"] if damped else []))]
        table.add_row(*numbers, here["status"].item())
    if len(places) > _MOST_ROWS:
        table.caption = f"and {len(places) - _MOST_ROWS} more modes"
    return table
