"""`delagrange response`: the transient amplitude, or the branches of periodic motions beside it."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from delagrange.cli.membrane import arguments, limits_given, loaded, refuse_many, state_given
from delagrange.cli.options import Given, flag_of
from delagrange.cli.response_tables import report_steady, report_transient
from delagrange.cli.results import Interrupted, interruptible, tell_written, write_plot
from delagrange.cli.values import Span
from delagrange.common import checks
from delagrange.common.files import write_dataset

if TYPE_CHECKING:
    import xarray as xr

Load = dict[str, float | Span]

_LOAD = ("force", "field_amplitude", "field_bias", "frequency")
_INSTEAD = ("charge_amplitude", "charge_bias", "current_amplitude", "current_bias")  # where they are given
_SWEEP_STEPS = 60


def response(given: Given) -> None:
    """Response to a sine field: transient amplitude, or steady branches.

    Without --steady, half of peak to peak over the first --duration from rest,
    as the paper takes it, transient included. With --steady, the branches of
    periodic motions, stable or not, along the one quantity of the load that is
    given as START:STOP, with Floquet multipliers and bifurcations; the picture
    shows the transient amplitude beside them. Without bias the field, which
    enters squared, forces at twice its frequency. The charge or current of a
    model that is driven by one stands for the field.

    [bold]Examples[/]

      delagrange response equal-biaxial --force 0.5 --field-amplitude 5e6 \\
          --frequency 100:800 --steady --largest-amplitude 1.5 --plot response.png
      delagrange response equal-biaxial --force 0.1 --field-amplitude 4e6 \\
          --frequency 350:480 --relaxation-time 0.01 --steady --dashpots relaxed \\
          --sweeps --plot damped.png
    """
    load = given.some(*_LOAD, *_INSTEAD)
    varied = _varied(load)
    _refuse_idle(given, varied)
    module = loaded(given)
    taken = arguments(given, module, state_given(given, module)) | {"limits": limits_given(given)}
    refuse_many(taken, module)
    with interruptible("the response was not finished, nothing was written"):
        result = (
            _steady(module, given, load, taken) if given.steady else _transient(module, given, load, taken)
        )
        if given.out is not None:
            write_dataset(_as_table(result) if given.out.suffix == ".csv" else result, given.out)
        beside = _beside(module, given, load, taken) if given.plot is not None and given.steady else ()
    (report_steady if given.steady else report_transient)(result, varied)
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures.steady_figure import draw_steady
        from delagrange.figures.sweep_figure import draw_sweep

        draw, about = (draw_steady, beside) if given.steady else (draw_sweep, (varied,))
        write_plot(given.plot, draw, result, *about)
    if given.steady and result.attrs["search"] == "interrupted":
        raise Interrupted("the search was not finished; the branches found until then are above")


def _varied(load: Load) -> str:
    """The one quantity of the load that is a range.

    Raises:
        ValueError: none is, or several are.
    """
    spans = [name for name, value in load.items() if isinstance(value, Span)]
    if len(spans) != 1:
        names = [*_LOAD, *(name for name in _INSTEAD if name in load)]
        raise ValueError(
            f"exactly one of {', '.join(map(flag_of, names))} must be a range START:STOP, got {len(spans)}"
        )
    return spans[0]


def _refuse_idle(given: Given, varied: str) -> None:
    """Refuse what would change nothing: it was meant to."""
    for name in ("dashpots", "largest_amplitude", "sweeps"):
        if given.get(name) not in (None, False) and not given.steady:
            raise ValueError(f"{flag_of(name)} changes nothing without --steady; give that, too")
    if given.sweeps and varied != "frequency":
        raise ValueError(f"--sweeps steps the frequency, and {varied} is the range; leave it out")
    if given.sweeps and given.dashpots != "relaxed":
        raise ValueError(
            f"--sweeps needs --dashpots relaxed, got {given.dashpots or 'frozen'}: without damping no motion settles"
        )


def _steady(module: ModuleType, given: Given, load: Load, taken: dict[str, Any]) -> xr.Dataset:
    from delagrange.analysis.steady.steady_response import steady_response

    pairs = {name: value.ends if isinstance(value, Span) else value for name, value in load.items()}
    settings = given.some("dashpots", "largest_amplitude", "period_multiple", "most_points")
    return steady_response(module, **pairs, **taken, **settings, progress=not given.quiet)


def _transient(module: ModuleType, given: Given, load: Load, taken: dict[str, Any]) -> xr.Dataset:
    """Over the varied quantity alone."""
    from delagrange.run.frequency_response import frequency_response

    checks.positive("duration", given.duration, "s")
    grid = {name: value.values() if isinstance(value, Span) else value for name, value in load.items()}
    found = frequency_response(module, duration=given.duration, progress=not given.quiet, **grid, **taken)
    return found if isinstance(load["frequency"], Span) else found.isel(frequency=0)


def _beside(
    module: ModuleType, given: Given, load: Load, taken: dict[str, Any]
) -> tuple[xr.Dataset, list[xr.Dataset]]:
    """What is drawn beside the branches: the transient amplitude, and sweeps up and down where they are wanted."""
    from delagrange.analysis.steady.stepped_sweep import stepped_sweep

    transient = _transient(module, given, load, taken)
    if not given.sweeps:
        return transient, []
    up = np.linspace(*sorted(load["frequency"].ends), _SWEEP_STEPS + 1)
    return transient, [
        stepped_sweep(module, **(load | taken | {"frequency": values}), progress=not given.quiet)
        for values in (up, up[::-1])
    ]


def _as_table(result: xr.Dataset) -> xr.Dataset:
    """What has a row a point: for CSV, whose rows are a grid of all dimensions."""
    dropped = [name for name in ("bifurcation", "branch", "end") if name in result.dims]
    return result.drop_dims(dropped)
