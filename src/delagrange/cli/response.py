"""`delagrange response`: the transient amplitude, or the branches of periodic motions beside it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import typer
from rich.text import Text

from delagrange import checks
from delagrange.cli import console, quantities
from delagrange.cli import options as o
from delagrange.cli.initial import initial_state
from delagrange.cli.interruption import Interrupted, interruptible
from delagrange.cli.plots import check_plot, write_plot
from delagrange.files import check_writable, write_dataset
from delagrange.parameters import CHANGEABLE_UNITS
from delagrange.units import unit_name

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from rich.table import Table

_LOAD_UNITS = {"force": "N", "field_amplitude": "V/m", "field_bias": "V/m", "frequency": "Hz"}
_STEPS = 500  # of the transient amplitude over a range without a step
_SWEEP_STEPS = 60
_MOST_ROWS = 40


@dataclass(frozen=True)
class _Span:
    """A range as typed: START:STOP or START:STOP:STEP."""

    start: float
    stop: float
    step: float | None

    def values(self) -> np.ndarray:
        """Increasing, both ends included as far as steps land on them."""
        low, high = sorted((self.start, self.stop))
        step = (high - low) / _STEPS if self.step is None else self.step
        return low + step * np.arange(int((high - low) / step + 1e-9) + 1)


def response(
    context: typer.Context,
    model: o.Model,
    field_amplitude: o.SpannedFieldAmplitude,
    frequency: o.SpannedFrequency,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretch = None,
    force: o.SpannedForce = None,
    field_bias: o.SpannedFieldBias = None,
    initial: o.Initial = None,
    half_length: o.HalfLength = None,
    half_thickness: o.HalfThickness = None,
    density: o.Density = None,
    permittivity: o.Permittivity = None,
    shear_modulus_alpha: o.ShearModulusAlpha = None,
    shear_modulus_beta: o.ShearModulusBeta = None,
    viscosity: o.Viscosity = None,
    relaxation_time: o.RelaxationTime = None,
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
    enters squared, forces at twice its frequency.

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
    load = {name: _load_value(name, context.params[name]) for name in _LOAD_UNITS}
    varied = _varied(load)
    _refuse_idle(
        steady, {"--dashpots": dashpots, "--largest-amplitude": largest_amplitude, "--sweeps": sweeps or None}
    )
    if sweeps:
        _check_sweeps(varied, dashpots)
    from delagrange.models import load_model

    module = load_model(model, formulation, lateral_dashpot)
    common = {
        "formulation": formulation,
        "lateral_dashpot": lateral_dashpot,
        "held_stretch": held_stretch,
        "initial_state": initial_state(initial, {entry.name: entry.unit for entry in module.STATE}),
        **{name: context.params[name] for name in CHANGEABLE_UNITS if context.params[name] is not None},
    }
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
    (_report_steady if steady else _report_transient)(result, varied)
    if out is not None:
        print(f"written: {out}")
    if draw is not None:
        write_plot(draw, plot)
    if steady and result.attrs["search"] == "interrupted":
        raise Interrupted("the search was not finished; the branches found until then are above")


def _load_value(name: str, text: str | None) -> float | _Span:
    """The number or the range that an option says.

    Raises:
        ValueError: it says neither.
    """
    unit = _LOAD_UNITS[name]
    if text is None:
        return 0.0
    parts = [quantities.number(name, part, unit) for part in text.split(":")]
    if len(parts) == 1:
        return parts[0]
    finite = bool(np.all(np.isfinite(parts)))
    if len(parts) > 3 or not finite or parts[0] == parts[1] or (len(parts) == 3 and parts[2] <= 0):
        raise ValueError(
            f"{name} must be a number or START:STOP or START:STOP:STEP in {unit_name(unit)} with two distinct finite "
            f"ends and STEP > 0, got {text!r}"
        )
    return _Span(parts[0], parts[1], parts[2] if len(parts) == 3 else None)


def _varied(load: Mapping[str, float | _Span]) -> str:
    """The one quantity of the load that is a range."""
    spans = [name for name, value in load.items() if isinstance(value, _Span)]
    if len(spans) != 1:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in _LOAD_UNITS)
        raise ValueError(f"exactly one of {options} must be a range START:STOP, got {len(spans)}")
    return spans[0]


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
    model: str, load: Mapping[str, float | _Span], more: Mapping[str, object], quiet: bool
) -> xr.Dataset:
    from delagrange.analysis.steady.response import steady_response

    pairs = {
        name: (value.start, value.stop) if isinstance(value, _Span) else value for name, value in load.items()
    }
    return steady_response(model, **pairs, **more, progress=not quiet)


def _transient(
    model: str,
    load: Mapping[str, float | _Span],
    varied: str,
    common: Mapping[str, object],
    duration: float,
    quiet: bool,
) -> xr.Dataset:
    """Over the varied quantity alone."""
    from delagrange.response import frequency_response

    checks.positive("duration", duration, "s")
    grid = {name: value.values() if isinstance(value, _Span) else value for name, value in load.items()}
    found = frequency_response(model, duration=duration, progress=not quiet, **grid, **common)
    return found if varied == "frequency" else found.isel(frequency=0)


def _stepped(
    model: str, load: Mapping[str, float | _Span], common: Mapping[str, object], quiet: bool
) -> list:
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
    load: Mapping[str, float | _Span],
    varied: str,
    common: Mapping[str, object],
    duration: float,
    sweeps: bool,
    quiet: bool,
) -> Callable[[], Figure]:
    """What draws the result, with what is to stand beside it computed."""
    from delagrange.figures.steady_figure import draw_steady, draw_transient

    if "branch" not in result.dims:
        return lambda: draw_transient(result, varied)
    transient = _transient(model, load, varied, common, duration, quiet)
    stepped = _stepped(model, load, common, quiet) if sweeps else ()
    return lambda: draw_steady(result, transient, stepped)


def _as_table(result: xr.Dataset) -> xr.Dataset:
    """What has a row a point: for CSV, whose rows are a grid of all dimensions."""
    dropped = [name for name in ("bifurcation", "branch", "end") if name in result.dims]
    return result.drop_dims(dropped)


def _report_transient(result: xr.Dataset, varied: str) -> None:
    amplitude = result["amplitude"].values
    table = console.table(f"{varied} [{_LOAD_UNITS[varied]}]", "largest amplitude [1]", "points", "lost")
    lost = int(np.sum(~np.isfinite(amplitude)))
    if lost == len(amplitude):
        table.add_row("-", "-", str(len(amplitude)), str(lost))
    else:
        place = int(np.nanargmax(amplitude))
        row = (
            f"{float(result[varied][place]):.6g}",
            f"{amplitude[place]:.6g}",
            str(len(amplitude)),
            str(lost),
        )
        table.add_row(*row)
    window = f"{result.attrs['window_start']:g} to {result.attrs['window_stop']:g} s"
    console.show(f"{result.attrs['model']}: transient amplitude, window {window}", table)


def _report_steady(result: xr.Dataset, varied: str) -> None:
    model, dashpots = result.attrs["model"], result.attrs["dashpots"]
    console.show(
        f"{model}: periodic motions along {varied}, dashpots {dashpots}", _branch_table(result, varied)
    )
    if result.sizes["bifurcation"]:
        console.show("Bifurcations", _bifurcation_table(result, varied))
    output = console.output()
    output.print(f"search: {result.attrs['search']}")
    output.print(Text(result.attrs["explanation"]))
    if result.sizes["point"]:
        output.print(
            f"multipliers' product: relative error at most {float(result['product_error'].max()):.1g}"
        )


def _branch_table(result: xr.Dataset, varied: str) -> Table:
    unit = _LOAD_UNITS[varied]
    headings = ("branch", "points", f"from [{unit}]", f"to [{unit}]", "amplitude [1]", "stability", "ends")
    table = console.table(*headings)
    for number in range(min(result.sizes["branch"], _MOST_ROWS)):
        one = result.isel(point=np.flatnonzero(result["branch_number"].values == number))
        values, amplitude = one[varied].values, one["amplitude"].values
        names, counts = np.unique(one["stability"].values.astype(str), return_counts=True)
        table.add_row(
            str(number), str(len(values)), f"{values[0]:.6g}", f"{values[-1]:.6g}",
            f"{amplitude.min():.3g} to {amplitude.max():.3g}",
            ", ".join(f"{count} {name}" for name, count in zip(names, counts)),
            "; ".join(dict.fromkeys(result["ending"].values[number])),
        )  # fmt: skip
    return table


def _bifurcation_table(result: xr.Dataset, varied: str) -> Table:
    table = console.table("kind", f"{varied} [{_LOAD_UNITS[varied]}]", "amplitude [1]", "branch")
    count = result.sizes["bifurcation"]
    for place in range(min(count, _MOST_ROWS)):
        numbers = (result[f"bifurcation_{name}"].values[place] for name in (varied, "amplitude"))
        kind, branch = result["bifurcation_kind"].values[place], result["bifurcation_branch"].values[place]
        table.add_row(str(kind), *(f"{number:.8g}" for number in numbers), str(branch))
    if count > _MOST_ROWS:
        table.caption = f"and {count - _MOST_ROWS} more"
    return table
