"""`delagrange modes`: natural frequencies about an equilibrium."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import typer

from delagrange.cli import console, quantities
from delagrange.cli import options as o
from delagrange.cli.initial import initial_state
from delagrange.cli.interruption import interruptible
from delagrange.cli.named import inputs_given, material_given
from delagrange.cli.plots import check_plot, write_plot
from delagrange.common.files import check_writable, write_dataset
from delagrange.drives.inputs import ELECTRICAL
from delagrange.model.parameters import CHANGEABLE_UNITS

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_ROWS = 60  # of the printed table; the file has all
_INPUT_UNITS = {"force": "N", "field": "V/m", "held_stretch": "1"}


def modes(
    context: typer.Context,
    model: o.Model,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretches = None,
    force: o.Forces = None,
    field: o.StaticFields = None,
    dashpots: o.StaticDashpots = "frozen",
    initial: o.Initial = None,
    half_length: o.HalfLengths = None,
    half_thickness: o.HalfThicknesses = None,
    density: o.Densities = None,
    permittivity: o.Permittivities = None,
    shear_modulus_alpha: o.ShearModuliAlpha = None,
    shear_modulus_beta: o.ShearModuliBeta = None,
    viscosity: o.Viscosities = None,
    relaxation_time: o.RelaxationTimes = None,
    named_parameters: o.NamedParameters = None,
    named_inputs: o.NamedInputs = None,
    plot: o.PlotFile = None,
    out: o.OutFile = None,
    quiet: o.Quiet = False,
) -> None:
    """Natural frequencies and modes about the stable equilibrium.

    The equilibrium is the one that the unloaded membrane reaches under the force
    and then the field, 0 V/m where none is given; under charge control under
    --input nominal_charge_density=VALUES instead. The field enters squared: without
    a bias it excites a mode at half its natural frequency, the "field frequency" of
    the table.

    [bold]Examples[/]

      delagrange modes equal-biaxial --force 0.5
      delagrange modes uniaxial --force 0.2,0.5 --field 0:2e7:2e5 --plot modes.png
      delagrange modes uniaxial --force 0.5 --field 1e6 --dashpots relaxed
    """
    if out is not None:
        check_writable(out)
    check_plot(plot)
    from delagrange.model.load import load_model

    module = load_model(model, formulation, lateral_dashpot)
    units = _INPUT_UNITS | dict(CHANGEABLE_UNITS)
    values = {name: quantities.axis(name, context.params[name], unit) for name, unit in units.items()}
    values |= material_given(values, named_parameters, module)
    inputs = inputs_given(named_inputs, module)
    if plot is not None and not any(np.ndim(value) for value in (*values.values(), *(inputs or {}).values())):
        raise ValueError("--plot draws modes over what is varied: give an option two or more values")
    with interruptible("the modes were not finished, nothing was written"):
        from delagrange.analysis.rest.modes import modes as find_modes

        found = find_modes(
            model,
            dashpots=dashpots,
            inputs=inputs,
            formulation=formulation,
            lateral_dashpot=lateral_dashpot,
            initial_state=initial_state(initial, {entry.name: entry.unit for entry in module.STATE}),
            **{name: value for name, value in values.items() if value is not None},
        )
        if out is not None:
            write_dataset(found, out)
    console.show(f"{module.MODEL}: natural frequencies, dashpots {dashpots}", _table(found))
    if out is not None:
        print(f"written: {out}")
    if plot is not None:
        from delagrange.figures.modes_figure import draw_modes

        write_plot(lambda: draw_modes(found), plot)


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
