"""`delagrange sweep`: amplitude over frequency and whatever else varies."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np
import typer

from delagrange.cli import console, quantities
from delagrange.cli import options as o
from delagrange.cli.initial import start_given
from delagrange.cli.interruption import Interrupted, interruptible
from delagrange.cli.named import inputs_given, material_given
from delagrange.common.files import check_writable, write_dataset

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_CURVES = 60  # rows of the printed table; the file has all


def sweep(
    context: typer.Context,
    model: o.Model,
    frequency: o.Frequencies,
    duration: o.Duration,
    field_amplitude: o.FieldAmplitudes = None,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretches = None,
    force: o.Forces = None,
    field_bias: o.FieldBiases = None,
    field_phase: o.FieldPhases = None,
    charge_amplitude: o.ChargeAmplitudes = None,
    charge_bias: o.ChargeBiases = None,
    charge_phase: o.ChargePhases = None,
    current_amplitude: o.CurrentAmplitudes = None,
    current_bias: o.CurrentBiases = None,
    current_phase: o.CurrentPhases = None,
    initial: o.Starts = None,
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
    averages: o.Averages = False,
    final_state: o.FinalState = False,
    section_points: o.SectionPoints = None,
    section_phase: o.SectionPhase = 0.0,
    sample_interval: o.SampleInterval = None,
    window: o.Window = None,
    method: o.SweepMethod = "DOP853",
    rtol: o.Rtol = 1e-9,
    atol: o.Atol = 1e-12,
    engine: o.Engine = "auto",
    step_control: o.StepControl = None,
    extrema: o.Extrema = "dense",
    threads: o.Threads = None,
    out: o.OutFile = None,
    quiet: o.Quiet = False,
) -> None:
    """Frequency response: the amplitude of forced motion over frequency and more.

    Every combination of the given values is a run, from rest unless --initial
    says otherwise, under E = bias + amplitude sin(2 pi f t + phase); a model that
    is driven by a charge or a current has that instead of the field. The amplitude
    is half of peak to peak of the first stretch over the window, transient
    included; the peak of a curve is its largest amplitude among the computed
    frequencies. A run that is lost has no amplitude; its status says why, and no
    other run is touched by it.

    An option with many values makes an axis: --force 0.2 --force 0.5, or
    --force 0.2,0.5, or --frequency 300:500:1, which is START:STOP:STEP; STOP is
    included where a step lands on it.

    [bold]Examples[/]

      delagrange sweep uniaxial --force 0.2 --force 0.5 --field-amplitude 1e6 \\
          --frequency 300:500:1 --duration 0.1 --out response.nc
      delagrange sweep pure-shear --held-stretch 2,3,4 --force 0.1 \\
          --field-amplitude 3e6 --frequency 1:801:5 --duration 0.12
    """
    if out is not None:
        check_writable(out)
    from delagrange.model.load import load_model
    from delagrange.run.sweep import SWEEP_UNITS

    module = load_model(model, formulation, lateral_dashpot)
    start = start_given(initial, {entry.name: entry.unit for entry in module.STATE})
    axes = {name: quantities.axis(name, context.params[name], unit) for name, unit in SWEEP_UNITS.items()}
    axes |= material_given(axes, named_parameters, module)
    with interruptible("the sweep was not finished, nothing was written"):
        from delagrange.run.frequency_response import frequency_response

        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="interrupted")  # said once, at the end
            response = frequency_response(
                model,
                duration=duration,
                formulation=formulation,
                lateral_dashpot=lateral_dashpot,
                initial_state=start,
                inputs=inputs_given(named_inputs, module),
                averages=averages,
                final_state=final_state,
                section_points=section_points,
                section_phase=section_phase,
                sample_interval=sample_interval,
                window=quantities.window(window),
                method=method,
                rtol=rtol,
                atol=atol,
                engine=engine,
                step_control=step_control,
                extrema=extrema,
                threads=threads,
                progress=not quiet,
                **{name: values for name, values in axes.items() if values is not None},
            )
        if out is not None:
            write_dataset(response, out)
    _report(response)
    if out is not None:
        print(f"written: {out}")
    _refuse_unfinished(response, f"are in {out} with that status" if out else "were not written")


def _refuse_unfinished(response: xr.Dataset, where: str) -> None:
    left = int(np.sum(response["status"].values == "interrupted"))
    if left:
        raise Interrupted(f"{left} of {response['status'].size} runs were not computed and {where}")


def _report(response: xr.Dataset) -> None:
    console.show(_title(response), _peak_table(response))
    output = console.output()
    for status, count in zip(
        *np.unique(response["status"].values.astype(str), return_counts=True), strict=True
    ):
        colour = "green" if status == "completed" else "yellow"
        output.print(f"[{colour}]{status}[/]: {count} of {response['status'].size} runs")


def _title(response: xr.Dataset) -> str:
    frequency = response["frequency"]
    first, last = float(frequency[0]), float(frequency[-1])
    window = f"{response.attrs['window_start']:g} to {response.attrs['window_stop']:g} s"
    return (
        f"{response.attrs['model']}: peaks among {frequency.size} frequencies, {first:g} to {last:g} Hz; "
        f"window {window}"
    )


def _peak_table(response: xr.Dataset) -> Table:
    """The peak of every curve, in the order of the file."""
    from delagrange.run.frequency_response import peaks

    found = peaks(response)
    axes = list(found["peak_amplitude"].dims)
    headings = (f"{name} [{found[name].attrs['units']}]" for name in axes)
    table = console.table(*headings, "frequency [Hz]", "amplitude [1]")
    shape = found["peak_amplitude"].shape
    for place in list(np.ndindex(shape))[:_MOST_CURVES]:
        curve = found.isel(dict(zip(axes, place, strict=True)))
        numbers = [curve[name].item() for name in (*axes, "resonance_frequency", "peak_amplitude")]
        table.add_row(*(f"{number:.6g}" for number in numbers))
    if (more := int(np.prod(shape, dtype=int)) - _MOST_CURVES) > 0:
        table.caption = f"and {more} more curves"
    return table
