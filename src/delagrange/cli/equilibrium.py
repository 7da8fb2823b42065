"""`delagrange equilibrium`: where the membrane rests, whether that is stable, and where it pulls in."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from delagrange.cli import console
from delagrange.cli.membrane import arguments, loaded, refuse_many, state_given
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible, tell_written, write_plot
from delagrange.common.files import write_dataset
from delagrange.drives.inputs import ELECTRIC_FIELD, ELECTRICAL, ElectricalInput, electrical_input

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_ROWS = 60  # of the printed table; the file has all
_DEFAULT_FIELDS = 12
_PAST = 1.05  # of the critical field: as far as the default goes
_PART = 0.05  # of a charge up to which nothing happens
_DASHPOTS = "relaxed"  # where nothing is said
_BESIDE_MAP = {
    "field": "finds the field",
    "voltage": "finds the voltage",
    "force": "gives the forces itself",
    "dashpots": "has relaxed and frozen ones side by side",
}  # options that mean nothing there, and why
_CURVES = ("point", "limit_point")  # dimensions that a table over field and branch has no room for


def equilibrium(given: Given) -> None:
    """Equilibria: all branches over the field, their stability, where they end.

    Under a constant force and field, with dashpots relaxed or frozen; where a charge
    or current drives the model, over --input nominal_charge_density=START:STOP:STEP
    or nominal_current_density. Branch 0 is that of the unloaded membrane; at a limit
    point it meets an unstable one and both end: pull-in. Loss of tension and electrical breakdown are told where the
    criteria say so. Without --field or --voltage, fields up to a little beyond
    pull-in are taken.

    With --map-force, instead, the critical field over the force: static pull-in
    with relaxed and with frozen dashpots, and dynamic pull-in under field and force
    that are applied at once.

    [bold]Examples[/]

      delagrange equilibrium equal-biaxial --force 0.5 --plot branches.png
      delagrange equilibrium uniaxial --force 0.5 --field 0:2e7:1e6 --dashpots frozen \\
          --breakdown-field 5e7 --out branches.nc
      delagrange equilibrium uniaxial --map-force 0:2:0.1 --plot map.png
    """
    mapped = given.map_force is not None
    if mapped:
        _refuse_beside_map(given)
    module = loaded(given)
    taken = arguments(given, module, state_given(given, module))
    taken |= given.some("breakdown_field", "breakdown_exponent", "smallest_tension")
    refuse_many(taken, module, but=None if mapped else electrical_input(module).name)
    with interruptible("the equilibria were not finished, nothing was written"):
        found = _critical_map(module, given, taken) if mapped else _equilibria(module, given, taken)
        if given.out is not None:
            write_dataset(_for_file(found, given.out.suffix), given.out)
    (_report_map if mapped else _report)(found)
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures import equilibrium_figure as figure

        write_plot(given.plot, figure.draw_critical_map if mapped else figure.draw_equilibria, found)


def _refuse_beside_map(given: Given) -> None:
    """Refuse what a map of the critical field would not use: it was meant to change something."""
    for name, reason in _BESIDE_MAP.items():
        if given.get(name) is not None:
            raise ValueError(f"--{name} changes nothing with --map-force, which {reason}; leave it out")


def _critical_map(module: ModuleType, given: Given, taken: dict[str, Any]) -> xr.Dataset:
    from delagrange.analysis.rest.critical_map import critical_map
    from delagrange.common.progress import working

    forces = np.atleast_1d(given.map_force)
    with working(not given.quiet, f"critical fields at {len(forces)} forces"):
        return critical_map(module, force=forces, **taken)


def _equilibria(module: ModuleType, given: Given, taken: dict[str, Any]) -> xr.Dataset:
    from delagrange.analysis.rest.equilibria import equilibria

    load = {"dashpots": _DASHPOTS} | given.some("force", "dashpots")
    varied = given.some("field", "voltage")
    if not varied and electrical_input(module).name not in (taken["inputs"] or {}):
        varied = _default_values(module, load | taken)
    return equilibria(module, **(load | taken | varied))


def _default_values(module: ModuleType, taken: dict[str, Any]) -> dict[str, Any]:
    """From none to a little beyond where the stable branch ends: of the field, or of the charge among the inputs."""
    from delagrange.analysis.rest.pull_in import critical_names, pull_in

    found = pull_in(module, **taken)
    electrical = ELECTRICAL[found.attrs["varied_input"]]
    ended = np.isfinite(float(found[electrical.argument]))
    highest = float(found[critical_names(electrical)["highest"]]) * (
        1.0 if ended or electrical is ELECTRIC_FIELD else _PART
    )
    values = np.linspace(0.0, _PAST * highest, _DEFAULT_FIELDS) if highest > 0 else np.zeros(1)
    if electrical is ELECTRIC_FIELD:
        return {"field": values}
    return {"inputs": {**(taken["inputs"] or {}), electrical.name: values}}


def _for_file(found: xr.Dataset, suffix: str) -> xr.Dataset:
    """A table has one grid alone: without the curves, unless the file can hold both."""
    return found if suffix == ".nc" else found.drop_dims([name for name in _CURVES if name in found.dims])


def _report(found: xr.Dataset) -> None:
    from delagrange.run.run_dataset import forces_text

    attributes = found.attrs
    title = f"{attributes['model']}: equilibria under {forces_text(found)}, dashpots {attributes['dashpots']}"
    console.show(title, _table(found))
    output = console.output()
    electrical = _electrical(found)
    name, unit = electrical.argument, electrical.unit
    for limit in range(found.sizes["limit_point"]):
        here = found.isel(limit_point=limit)
        voltage = f" ({here['limit_voltage'].item():.7g} V)" if "limit_voltage" in found else ""
        output.print(
            f"[bold]{here['limit_kind'].item()}[/] at {here[f'limit_{name}'].item():.7g} {unit}{voltage}"
        )
    for branch in found["branch"].values:
        here = found.isel(branch=int(branch))
        low, high = float(here[f"branch_lowest_{name}"]), float(here[f"branch_highest_{name}"])
        lower, upper = here["branch_lower_end"].item(), here["branch_upper_end"].item()
        output.print(f"branch {branch}: {lower} at {low:.6g} {unit}, {upper} at {high:.6g} {unit}")
    if not found.sizes["branch"]:
        output.print(f"[yellow]no equilibrium[/] at any of these {electrical.stem}s")
    if "unloaded_lost" in found.attrs:
        output.print(f"none from the unloaded membrane: {found.attrs['unloaded_lost']}", markup=False)


def _electrical(found: xr.Dataset) -> ElectricalInput:
    return ELECTRICAL[found.attrs["varied_input"]]


def _table(found: xr.Dataset) -> Table:
    """Every equilibrium, in the order of the file."""
    names, electrical = found.attrs["coordinates"].split(", "), _electrical(found)
    along, unit = electrical.argument, electrical.unit
    table = console.table(
        f"{electrical.text} [{unit}]", "branch", *(f"{name} [1]" for name in names), "stability",
        f"margin [{unit}]", "beyond",
    )  # fmt: skip
    over = found if along in found.dims else found.expand_dims(along)
    rows = [place for place in np.ndindex(over.sizes[along], over.sizes["branch"]) if _there(over, place)]
    for value, branch in rows[:_MOST_ROWS]:
        here = over.isel({along: value, "branch": branch})
        numbers = [f"{here[name].item():.7g}" for name in names]
        margin = f"{here['margin'].item():.5g}"
        flags = [name.replace("_", " ") for name in ("tension_lost", "breakdown") if here[name].item()]
        table.add_row(
            f"{here[along].item():.6g}",
            str(branch),
            *numbers,
            here["stability"].item(),
            margin,
            ", ".join(flags),
        )
    if len(rows) > _MOST_ROWS:
        table.caption = f"and {len(rows) - _MOST_ROWS} more equilibria"
    return table


def _there(found: xr.Dataset, place: tuple[int, int]) -> bool:
    return bool(np.isfinite(found["true_field"].values[place]))


def _report_map(critical: xr.Dataset) -> None:
    loads = critical["load"].values
    table = console.table("force [N]", *(f"{load} [{_electrical(critical).unit}]" for load in loads))
    for place, force in enumerate(critical["force"].values[:_MOST_ROWS]):
        cells = [_cell(critical.isel(load=number, force=place)) for number in range(len(loads))]
        table.add_row(f"{force:.6g}", *cells)
    if (more := critical.sizes["force"] - _MOST_ROWS) > 0:
        table.caption = f"and {more} more forces"
    console.show(f"{critical.attrs['model']}: critical {_electrical(critical).stem} over the force", table)


def _cell(here: xr.Dataset) -> str:
    field = here[_electrical(here).argument].item()
    return f"{field:.7g}" if np.isfinite(field) else here["found"].item()
