"""`delagrange simulate`: one run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delagrange.cli import console
from delagrange.cli.drives import electrical_drives, force_drive
from delagrange.cli.membrane import arguments, limits_given, loaded, single_start
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible, tell_written, write, write_plot

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table


def simulate(given: Given) -> None:
    """Integrate one run: stretches over time under a force and an electric field.

    From rest in the reference state, unless --initial says otherwise, the
    Euler-Lagrange equation d/dt (∂l/∂λ̇) - ∂l/∂λ = 0 with l = T - Π and the flow
    of the dashpot are integrated over the duration. The field is nominal: voltage over reference
    thickness. A run ends 'completed', 'collapsed' (a principal stretch fell
    below 1e-3: pulled in), 'diverged' (a stretch passed 100 or was no longer
    finite) or 'locked' (the strain energy ceased to hold); after such a loss the
    state is NaN.

    [bold]Examples[/]

      delagrange simulate equal-biaxial --force 0.5 --field-amplitude 5e6 \\
          --frequency 371 --duration 0.1 --out run.nc
      delagrange simulate pure-shear --held-stretch 2 --force 0.1 \\
          --field-ramp 0:3e6:0.05 --duration 0.1 --energies \\
          --initial equilibrium
      delagrange simulate uniaxial --force 0.5 --relaxation-time 1e-3 \\
          --method Radau --duration 0.05 --out run.csv
    """
    module = loaded(given)
    taken = arguments(given, module, single_start(given, module))
    taken |= {"force": force_drive(given), **electrical_drives(given, taken["inputs"])}
    with interruptible("the run was not finished, nothing was written"):
        from delagrange.run.simulation import simulate as integrate

        run = integrate(
            module,
            **taken,
            **given.some("duration", "samples", "method", "rtol", "atol", "energies"),
            limits=limits_given(given),
            progress=not given.quiet,
        )
        write(run, given)
    _report(run)
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures.run_figure import draw_run

        write_plot(given.plot, draw_run, run)


def _report(run: xr.Dataset) -> None:
    title = f"{run.attrs['model']}, {run.sizes['time']} output times to {run.attrs['duration']:g} s"
    console.show(title, _summary(run))
    status = run.attrs["status"]
    colour = "green" if status == "completed" else "yellow"
    console.output().print(f"[{colour}]{status}[/] at {run.attrs['status_time']:.6g} s")


def _summary(run: xr.Dataset) -> Table:
    """Extrema of everything that varies over time."""
    table = console.table("quantity", "symbol", "unit", "minimum", "maximum", "last")
    for name, data in run.data_vars.items():
        if data.dims == ("time",):
            values = data.values[np.isfinite(data.values)]
            numbers = (values.min(), values.max(), values[-1]) if values.size else (np.nan,) * 3
            table.add_row(
                str(name), data.attrs.get("symbol", ""), data.attrs["units"], *(f"{x:.6g}" for x in numbers)
            )
    return table
