"""`delagrange classify`: what kind of motion is it?"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import typer
from rich.text import Text

from delagrange.cli import charge, console
from delagrange.cli import options as o
from delagrange.cli.drives import field_drive, force_drive
from delagrange.cli.initial import single_start
from delagrange.cli.interruption import interruptible
from delagrange.cli.named import inputs_given, material_given
from delagrange.cli.plots import check_plot, write_plot
from delagrange.common.files import check_writable, write_dataset
from delagrange.drives.drive import Drive

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_COLOURS = {"undecided": "yellow", "lost": "yellow"}
_MOST_LINES = 12  # of the printed table; the file has all


def classify(
    context: typer.Context,
    model: o.Model,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretch = None,
    force: o.Force = None,
    force_frequency: o.ForceFrequency = None,
    force_bias: o.ForceBias = None,
    force_phase: o.ForcePhase = None,
    field_amplitude: o.FieldAmplitude = None,
    frequency: o.Frequency = None,
    field_bias: o.FieldBias = None,
    field_phase: o.FieldPhase = None,
    charge_amplitude: charge.ChargeAmplitude = None,
    charge_bias: charge.ChargeBias = None,
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
    dashpots: o.MotionDashpots = "frozen",
    duration: o.MotionDuration = None,
    transient: o.Transient = None,
    tolerance: o.MotionTolerance = 1e-11,
    plot: o.PlotFile = None,
    out: o.MotionFile = None,
    quiet: o.Quiet = False,
) -> None:
    """Kind of motion: at rest, periodic, quasi-periodic, chaotic, or not to be said.

    Three witnesses are heard: the Lyapunov spectrum from the variational
    equations, the lines of the spectrum and the base frequencies that they are
    made of, and the 0-1 test for chaos. Where they leave room for doubt the
    verdict is 'undecided', with the duration that would do. A field without bias
    enters squared and forces at twice its frequency; so does a charge, with
    --charge-amplitude and --frequency.

    [bold]Examples[/]

      delagrange classify equal-biaxial --force 0.5 --field-amplitude 5e6 \\
          --frequency 371 --plot motion.png
      delagrange classify uniaxial --force 0.25 --force-bias 0.25 \\
          --force-frequency 490 --relaxation-time 0.01 --dashpots evolving
    """
    if out is not None:
        _check_netcdf(out)
    check_plot(plot)
    from delagrange.model.load import load_model

    module = load_model(model, formulation, lateral_dashpot)
    start = single_start(initial, {entry.name: entry.unit for entry in module.STATE})
    force_load, inputs = force_drive(context.params), inputs_given(named_inputs, module)
    field_load: Drive | float = 0.0
    if charge_amplitude is None and charge_bias is None:
        field_load = field_drive(context.params)
    else:
        inputs = charge.with_charge(inputs, context.params)
    with interruptible("the motion was not followed to the end, nothing was written"):
        from delagrange.analysis.motion.classify import classify as judge

        motion = judge(
            model,
            force=force_load,
            field=field_load,
            inputs=inputs,
            formulation=formulation,
            lateral_dashpot=lateral_dashpot,
            held_stretch=held_stretch,
            initial_state=start,
            dashpots=dashpots,
            duration=duration,
            transient=transient,
            tolerance=tolerance,
            progress=not quiet,
            **material_given(context.params, named_parameters, module),
        )
        if out is not None:
            write_dataset(motion, out)
    _report(motion)
    if out is not None:
        print(f"written: {out}")
    if plot is not None:
        from delagrange.figures.motion_figure import draw_motion

        write_plot(lambda: draw_motion(motion), plot)


def _check_netcdf(out: Path) -> None:
    """Refuse a table: the evidence has too many dimensions for one."""
    if out.suffix != ".nc":
        raise ValueError(f"output file {out} must end in .nc (NetCDF), got {out.suffix or 'no suffix'!r}")
    check_writable(out)


def _report(motion: xr.Dataset) -> None:
    verdict = motion["verdict"].item()
    output = console.output()
    told = (verdict, f"bold {_COLOURS.get(verdict, 'green')}")
    output.print(Text.assemble(f"{motion.attrs['model']}: ", told))
    for sentence in motion["evidence"].item().split("; "):
        output.print(Text(f"  {sentence}"))
    if motion.sizes["exponent"] and np.all(np.isfinite(motion["lyapunov_exponents"])):
        console.show("Lyapunov spectrum", _exponents(motion))
    if motion.sizes["line"]:
        console.show(f"strongest of {motion.sizes['line']} spectral lines", _lines(motion))


def _exponents(motion: xr.Dataset) -> Table:
    table = console.table("exponent [1/s]", "uncertainty [1/s]")
    for exponent, uncertainty in zip(
        motion["lyapunov_exponents"].values, motion["lyapunov_uncertainty"].values
    ):
        table.add_row(f"{exponent:.6g}", f"{uncertainty:.2g}")
    return table


def _lines(motion: xr.Dataset) -> Table:
    """The strongest lines, with the integers by which the base frequencies make them."""
    made = "line_integers" in motion
    bases = [f"x {value:.7g} Hz" for value in motion["base_frequencies"].values] if made else []
    table = console.table("frequency [Hz]", "amplitude [1]", *bases)
    for place in range(min(_MOST_LINES, motion.sizes["line"])):
        line = motion.isel(line=place)
        integers = [str(k) for k in line["line_integers"].values] if made else []
        table.add_row(
            f"{line['line_frequency'].item():.9g}", f"{line['line_amplitude'].item():.4g}", *integers
        )
    return table
