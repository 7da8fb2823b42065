"""What `delagrange response` prints of the transient amplitude and of branches of periodic motions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from delagrange.cli import console

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_ROWS = 40


def report_transient(result: xr.Dataset, varied: str) -> None:
    """Print the largest amplitude, and where along what varies it is."""
    amplitude = result["amplitude"].values
    table = console.table(
        f"{varied} [{result[varied].attrs['units']}]", "largest amplitude [1]", "points", "lost"
    )
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


def report_steady(result: xr.Dataset, varied: str) -> None:
    """Print the branches and the bifurcations on them."""
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
    unit = result[varied].attrs["units"]
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
    table = console.table("kind", f"{varied} [{result[varied].attrs['units']}]", "amplitude [1]", "branch")
    count = result.sizes["bifurcation"]
    for place in range(min(count, _MOST_ROWS)):
        numbers = (result[f"bifurcation_{name}"].values[place] for name in (varied, "amplitude"))
        kind, branch = result["bifurcation_kind"].values[place], result["bifurcation_branch"].values[place]
        table.add_row(str(kind), *(f"{number:.8g}" for number in numbers), str(branch))
    if count > _MOST_ROWS:
        table.caption = f"and {count - _MOST_ROWS} more"
    return table
