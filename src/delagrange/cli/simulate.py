"""`delagrange simulate`: one run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import typer

from delagrange.cli import console
from delagrange.cli import options as o
from delagrange.cli.drives import field_drive, force_drive
from delagrange.cli.initial import single_start
from delagrange.cli.interruption import interruptible
from delagrange.cli.named import inputs_given, material_given
from delagrange.common.files import check_writable, write_dataset

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table


def simulate(
    context: typer.Context,
    model: o.Model,
    duration: o.Duration,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretch = None,
    force: o.Force = None,
    force_frequency: o.ForceFrequency = None,
    force_bias: o.ForceBias = None,
    force_phase: o.ForcePhase = None,
    force_step_time: o.ForceStepTime = None,
    force_ramp: o.ForceRamp = None,
    force_table: o.ForceTable = None,
    field_amplitude: o.FieldAmplitude = None,
    frequency: o.Frequency = None,
    field_bias: o.FieldBias = None,
    field_phase: o.FieldPhase = None,
    field_step_time: o.FieldStepTime = None,
    field_ramp: o.FieldRamp = None,
    field_table: o.FieldTable = None,
    initial: o.Start = None,
    half_length: o.HalfLength = None,
    half_thickness: o.HalfThickness = None,
    density: o.Density = None,
    permittivity: o.Permittivity = None,
    shear_modulus_alpha: o.ShearModulusAlpha = None,
    shear_modulus_beta: o.ShearModulusBeta = None,
    viscosity: o.Viscosity = None,
    relaxation_time: o.RelaxationTime = None,
    named_parameters: o.NamedParameters = None,
    named_inputs: o.NamedInputs = None,
    method: o.Method = "DOP853",
    rtol: o.Rtol = 1e-9,
    atol: o.Atol = 1e-12,
    samples: o.Samples = None,
    energies: o.Energies = False,
    out: o.OutFile = None,
    quiet: o.Quiet = False,
) -> None:
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
    if out is not None:
        check_writable(out)
    force_load, field_load = force_drive(context.params), field_drive(context.params)
    from delagrange.model.load import load_model

    module = load_model(model, formulation, lateral_dashpot)
    start = single_start(initial, {entry.name: entry.unit for entry in module.STATE})
    with interruptible("the run was not finished, nothing was written"):
        from delagrange.run.simulation import simulate as integrate

        run = integrate(
            model,
            duration=duration,
            force=force_load,
            field=field_load,
            inputs=inputs_given(named_inputs, module),
            held_stretch=held_stretch,
            formulation=formulation,
            lateral_dashpot=lateral_dashpot,
            initial_state=start,
            samples=samples,
            method=method,
            rtol=rtol,
            atol=atol,
            energies=energies,
            progress=not quiet,
            **material_given(context.params, named_parameters, module),
        )
        if out is not None:
            write_dataset(run, out)
    _report(run)
    if out is not None:
        print(f"written: {out}")


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
