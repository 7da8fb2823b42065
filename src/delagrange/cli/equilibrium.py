"""`delagrange equilibrium`: where the membrane rests, whether that is stable, and where it pulls in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import typer

from delagrange.cli import console, quantities
from delagrange.cli import options as o
from delagrange.cli.initial import initial_state
from delagrange.cli.interruption import interruptible
from delagrange.cli.plots import check_plot, write_plot
from delagrange.files import check_writable, write_dataset
from delagrange.parameters import CHANGEABLE_UNITS

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_MOST_ROWS = 60  # of the printed table; the file has all
_DEFAULT_FIELDS = 12
_PAST = 1.05  # of the critical field: as far as the default goes
_CURVES = ("point", "limit_point")  # dimensions that a table over field and branch has no room for


def equilibrium(
    context: typer.Context,
    model: o.Model,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    held_stretch: o.HeldStretch = None,
    force: o.StaticForce = 0.0,
    field: o.StaticFields = None,
    voltage: o.Voltages = None,
    map_force: o.MapForces = None,
    dashpots: o.StaticDashpots = "relaxed",
    breakdown_field: o.BreakdownField = None,
    breakdown_exponent: o.BreakdownExponent = 0.0,
    smallest_tension: o.SmallestTension = 0.0,
    initial: o.Initial = None,
    half_length: o.HalfLength = None,
    half_thickness: o.HalfThickness = None,
    density: o.Density = None,
    permittivity: o.Permittivity = None,
    shear_modulus_alpha: o.ShearModulusAlpha = None,
    shear_modulus_beta: o.ShearModulusBeta = None,
    viscosity: o.Viscosity = None,
    relaxation_time: o.RelaxationTime = None,
    plot: o.PlotFile = None,
    out: o.OutFile = None,
    quiet: o.Quiet = False,
) -> None:
    """Equilibria: all branches over the field, their stability, where they end.

    Under a constant force and field, with dashpots relaxed or frozen. Branch 0 is
    that of the unloaded membrane; at a limit point it meets an unstable one and
    both end: pull-in. Loss of tension and electrical breakdown are told where the
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
    if out is not None:
        check_writable(out)
    check_plot(plot)
    if map_force and (field or voltage):
        raise ValueError(
            "--field and --voltage change nothing with --map-force, which finds the field; leave them out"
        )
    from delagrange.models import load_model

    module = load_model(model, formulation, lateral_dashpot)
    given = {name: context.params[name] for name in CHANGEABLE_UNITS}
    common = {
        "formulation": formulation,
        "lateral_dashpot": lateral_dashpot,
        "held_stretch": held_stretch,
        "initial_state": initial_state(initial, {entry.name: entry.unit for entry in module.STATE}),
        "breakdown_field": breakdown_field,
        "breakdown_exponent": breakdown_exponent,
        "smallest_tension": smallest_tension,
        **{name: value for name, value in given.items() if value is not None},
    }
    with interruptible("the equilibria were not finished, nothing was written"):
        if map_force:
            found = _critical_map(model, map_force, common, quiet)
        else:
            found = _equilibria(model, force, field, voltage, dashpots, common)
        if out is not None:
            write_dataset(_for_file(found, out.suffix), out)
    (_report_map if map_force else _report)(found)
    if out is not None:
        print(f"written: {out}")
    if plot is not None:
        from delagrange.figures import equilibrium_figure as figure

        draw = figure.draw_critical_map if map_force else figure.draw_equilibria
        write_plot(lambda: draw(found), plot)


def _critical_map(model: str, texts: list[str], common: dict[str, object], quiet: bool) -> xr.Dataset:
    from delagrange.analysis.rest.critical_map import critical_map
    from delagrange.progress import working

    forces = np.atleast_1d(quantities.axis("map-force", texts, "N"))
    with working(not quiet, f"critical fields at {len(forces)} forces"):
        return critical_map(model, force=forces, **common)


def _equilibria(
    model: str,
    force: float,
    field: list[str] | None,
    voltage: list[str] | None,
    dashpots: str,
    common: dict[str, object],
) -> xr.Dataset:
    from delagrange.analysis.rest.equilibria import equilibria

    fields = quantities.axis("field", field, "V/m")
    voltages = quantities.axis("voltage", voltage, "V")
    if fields is None and voltages is None:
        fields = _default_fields(model, force, dashpots, common)
    return equilibria(model, force=force, field=fields, voltage=voltages, dashpots=dashpots, **common)


def _default_fields(model: str, force: float, dashpots: str, common: dict[str, object]) -> np.ndarray:
    """From none to a little beyond where the stable branch ends [V/m]."""
    from delagrange.analysis.rest.pull_in import pull_in

    highest = float(pull_in(model, force=force, dashpots=dashpots, **common)["highest_field"])
    return np.linspace(0.0, _PAST * highest, _DEFAULT_FIELDS) if highest > 0 else np.zeros(1)


def _for_file(found: xr.Dataset, suffix: str) -> xr.Dataset:
    """A table has one grid alone: without the curves, unless the file can hold both."""
    return found if suffix == ".nc" else found.drop_dims([name for name in _CURVES if name in found.dims])


def _report(found: xr.Dataset) -> None:
    attributes = found.attrs
    title = f"{attributes['model']}: equilibria under {float(found['force']):g} N, dashpots {attributes['dashpots']}"
    console.show(title, _table(found))
    output = console.output()
    for kind, field, voltage in zip(
        found["limit_kind"].values, found["limit_field"].values, found["limit_voltage"].values
    ):
        output.print(f"[bold]{kind}[/] at {field:.7g} V/m ({voltage:.7g} V)")
    for branch in found["branch"].values:
        here = found.isel(branch=int(branch))
        low, high = float(here["branch_lowest_field"]), float(here["branch_highest_field"])
        lower, upper = here["branch_lower_end"].item(), here["branch_upper_end"].item()
        output.print(f"branch {branch}: {lower} at {low:.6g} V/m, {upper} at {high:.6g} V/m")
    if not found.sizes["branch"]:
        output.print("[yellow]no equilibrium[/] at any of these fields")


def _table(found: xr.Dataset) -> Table:
    """Every equilibrium, in the order of the file."""
    names = [name for name in ("stretch_1", "stretch_2") if name in found] or ["stretch"]
    table = console.table(
        "field [V/m]", "branch", *(f"{name} [1]" for name in names), "stability", "margin [V/m]", "beyond"
    )
    over = found if "field" in found.dims else found.expand_dims("field")
    rows = [place for place in np.ndindex(over.sizes["field"], over.sizes["branch"]) if _there(over, place)]
    for field, branch in rows[:_MOST_ROWS]:
        here = over.isel(field=field, branch=branch)
        numbers = [f"{here[name].item():.7g}" for name in names]
        margin = f"{here['margin'].item():.5g}"
        flags = [name.replace("_", " ") for name in ("tension_lost", "breakdown") if here[name].item()]
        table.add_row(
            f"{here['field'].item():.6g}",
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
    return bool(np.isfinite(found["stretch"].values[place]))


def _report_map(critical: xr.Dataset) -> None:
    loads = critical["load"].values
    table = console.table("force [N]", *(f"{load} [V/m]" for load in loads))
    for place, force in enumerate(critical["force"].values[:_MOST_ROWS]):
        cells = [_cell(critical.isel(load=number, force=place)) for number in range(len(loads))]
        table.add_row(f"{force:.6g}", *cells)
    if (more := critical.sizes["force"] - _MOST_ROWS) > 0:
        table.caption = f"and {more} more forces"
    console.show(f"{critical.attrs['model']}: critical field over the force", table)


def _cell(here: xr.Dataset) -> str:
    field = here["field"].item()
    return f"{field:.7g}" if np.isfinite(field) else here["found"].item()
