"""`delagrange response`: the transient amplitude, or the branches of periodic motions beside it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np
import typer

from delagrange.cli import charge
from delagrange.cli import options as o
from delagrange.cli.initial import initial_state
from delagrange.cli.interruption import Interrupted, interruptible
from delagrange.cli.named import inputs_given, material_given, refuse_many
from delagrange.cli.plots import check_plot, write_plot
from delagrange.cli.response_load import Span, electrical_load, load_given, varied_name
from delagrange.cli.response_tables import report_steady, report_transient
from delagrange.common import checks
from delagrange.common.files import check_writable, write_dataset
from delagrange.drives.inputs import electrical_input

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_SWEEP_STEPS = 60


def response(
    context: typer.Context,
    model: o.Model,
    frequency: o.SpannedFrequency,
    field_amplitude: o.SpannedFieldAmplitude = None,
    charge_amplitude: charge.SpannedChargeAmplitude = None,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretch = None,
    force: o.SpannedForce = None,
    field_bias: o.SpannedFieldBias = None,
    charge_bias: charge.SpannedChargeBias = None,
    initial: o.Initial = None,
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
    steady: o.Steady = False,
    dashpots: o.SteadyDashpots = None,
    largest_amplitude: o.LargestAmplitude = None,
    period_multiple: o.PeriodMultiple = 1,
    most_points: o.MostPoints = 400,
    sweeps: o.Sweeps = False,
    duration: o.TransientDuration = 0.1,
    plot: o.PlotFile = None,
    out: o.OutFile = None,
    quiet: o.Quiet = False,
) -> None:
    """Response to a sine field: transient amplitude, or steady branches.

    Without --steady, half of peak to peak over the first --duration from rest,
    as the paper takes it, transient included. With --steady, the branches of
    periodic motions, stable or not, along the one quantity of the load that is
    given as START:STOP, with Floquet multipliers and bifurcations; the picture
    shows the transient amplitude beside them. Without bias the field, which
    enters squared, forces at twice its frequency. Under charge control the charge
    stands for the field.

    [bold]Examples[/]

      delagrange response equal-biaxial --force 0.5 --field-amplitude 5e6 \\
          --frequency 100:800 --steady --largest-amplitude 1.5 --plot response.png
      delagrange response equal-biaxial --force 0.1 --field-amplitude 4e6 \\
          --frequency 350:480 --relaxation-time 0.01 --steady --dashpots relaxed \\
          --sweeps --plot damped.png
    """
    if out is not None:
        check_writable(out)
    check_plot(plot)
    load = load_given(context.params)
    varied = varied_name(load)
    _refuse_idle(
        steady, {"--dashpots": dashpots, "--largest-amplitude": largest_amplitude, "--sweeps": sweeps or None}
    )
    if sweeps:
        _check_sweeps(varied, dashpots)
    from delagrange.model.load import load_model

    module = load_model(model, formulation, lateral_dashpot)
    load = electrical_load(load, electrical_input(module), module.MODEL)
    common = {
        "formulation": formulation,
        "lateral_dashpot": lateral_dashpot,
        "held_stretch": held_stretch,
        "initial_state": initial_state(initial, {entry.name: entry.unit for entry in module.STATE}),
        "inputs": inputs_given(named_inputs, module),
        **material_given(context.params, named_parameters, module),
    }
    refuse_many(common, module)
    with interruptible("the response was not finished, nothing was written"):
        if steady:
            limits = {"largest_amplitude": largest_amplitude, "most_points": most_points}
            more = limits | {"period_multiple": period_multiple, "dashpots": dashpots or "frozen"}
            result = _steady(model, load, common | more, quiet)
        else:
            result = _transient(model, load, varied, common, duration, quiet)
        if out is not None:
            write_dataset(_as_table(result) if out.suffix == ".csv" else result, out)
        draw = None
        if plot is not None:
            draw = _drawing(result, model, load, varied, common, duration, sweeps, quiet)
    (report_steady if steady else report_transient)(result, varied)
    if out is not None:
        print(f"written: {out}")
    if draw is not None:
        write_plot(draw, plot)
    if steady and result.attrs["search"] == "interrupted":
        raise Interrupted("the search was not finished; the branches found until then are above")


def _refuse_idle(steady: bool, given: Mapping[str, object]) -> None:
    """Refuse what would change nothing: it was meant to."""
    for option, value in given.items():
        if value is not None and not steady:
            raise ValueError(f"{option} changes nothing without --steady; give that, too")


def _check_sweeps(varied: str, dashpots: str | None) -> None:
    if varied != "frequency":
        raise ValueError(f"--sweeps steps the frequency, and {varied} is the range; leave it out")
    if dashpots != "relaxed":
        raise ValueError(
            f"--sweeps needs --dashpots relaxed, got {dashpots or 'frozen'}: without damping no motion settles"
        )


def _steady(
    model: str, load: Mapping[str, float | Span], more: Mapping[str, object], quiet: bool
) -> xr.Dataset:
    from delagrange.analysis.steady.steady_response import steady_response

    pairs = {
        name: (value.start, value.stop) if isinstance(value, Span) else value for name, value in load.items()
    }
    return steady_response(model, **pairs, **more, progress=not quiet)


def _transient(
    model: str,
    load: Mapping[str, float | Span],
    varied: str,
    common: Mapping[str, object],
    duration: float,
    quiet: bool,
) -> xr.Dataset:
    """Over the varied quantity alone."""
    from delagrange.run.frequency_response import frequency_response

    checks.positive("duration", duration, "s")
    grid = {name: value.values() if isinstance(value, Span) else value for name, value in load.items()}
    found = frequency_response(model, duration=duration, progress=not quiet, **grid, **common)
    return found if varied == "frequency" else found.isel(frequency=0)


def _stepped(model: str, load: Mapping[str, float | Span], common: Mapping[str, object], quiet: bool) -> list:
    from delagrange.analysis.steady.stepped_sweep import stepped_sweep

    span = load["frequency"]
    low, high = sorted((span.start, span.stop))
    up = np.linspace(low, high, _SWEEP_STEPS + 1)
    fixed = {name: value for name, value in load.items() if name != "frequency"}
    return [
        stepped_sweep(model, frequency=values, dashpots="relaxed", progress=not quiet, **fixed, **common)
        for values in (up, up[::-1])
    ]


def _drawing(
    result: xr.Dataset,
    model: str,
    load: Mapping[str, float | Span],
    varied: str,
    common: Mapping[str, object],
    duration: float,
    sweeps: bool,
    quiet: bool,
) -> Callable[[], Figure]:
    """What draws the result, with what is to stand beside it computed."""
    from delagrange.figures.steady_figure import draw_steady
    from delagrange.figures.sweep_figure import draw_sweep

    if "branch" not in result.dims:
        return lambda: draw_sweep(result, varied)
    transient = _transient(model, load, varied, common, duration, quiet)
    stepped = _stepped(model, load, common, quiet) if sweeps else ()
    return lambda: draw_steady(result, transient, stepped)


def _as_table(result: xr.Dataset) -> xr.Dataset:
    """What has a row a point: for CSV, whose rows are a grid of all dimensions."""
    dropped = [name for name in ("bifurcation", "branch", "end") if name in result.dims]
    return result.drop_dims(dropped)
