"""`delagrange sweep`: amplitude over frequency and whatever else varies."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from delagrange.cli import console
from delagrange.cli.membrane import arguments, limits_given, loaded, start_given
from delagrange.cli.options import Given
from delagrange.cli.results import Interrupted, interruptible, tell_written, write, write_plot

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_CURVES = 60  # rows of the printed table; the file has all
_AXES = (
    "force", "field_amplitude", "field_bias", "field_phase", "charge_amplitude", "charge_bias", "charge_phase",
    "current_amplitude", "current_bias", "current_phase", "frequency",
)  # fmt: skip
_SETTINGS = (
    "duration", "averages", "final_state", "section_points", "section_phase", "sample_interval", "window", "method",
    "rtol", "atol", "engine", "step_control", "extrema", "threads",
)  # fmt: skip


def sweep(given: Given) -> None:
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
    module = loaded(given)
    taken = arguments(given, module, start_given(given, module)) | given.some(*_AXES, *_SETTINGS)
    with interruptible("the sweep was not finished, nothing was written"):
        from delagrange.run.frequency_response import frequency_response

        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="interrupted")  # said once, at the end
            response = frequency_response(
                module, **taken, limits=limits_given(given), progress=not given.quiet
            )
        write(response, given)
    _report(response)
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures.sweep_figure import draw_sweep

        write_plot(given.plot, draw_sweep, response)
    _refuse_unfinished(response, f"are in {given.out} with that status" if given.out else "were not written")


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
