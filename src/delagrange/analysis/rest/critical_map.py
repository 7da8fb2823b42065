"""The critical field, or charge, against the force: static pull-in, dashpots relaxed or frozen, and dynamic."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.rest.dynamic_pull_in import dynamic_pull_in
from delagrange.analysis.rest.pull_in import critical_names, pull_in
from delagrange.common import checks
from delagrange.drives.inputs import ELECTRICAL
from delagrange.model.load import load_model
from delagrange.problem.dashpots import FROZEN, RELAXED
from delagrange.run.run_dataset import variable

SLOW, FAST, SUDDEN = "static, dashpots relaxed", "static, dashpots frozen", "dynamic, dashpots frozen"
_CRITERIA = ("breakdown_field", "breakdown_exponent", "smallest_tension")


def critical_map(
    model: str | ModuleType,
    *,
    force: np.ndarray,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    **options: object,
) -> xr.Dataset:
    """Critical fields over an increasing array of forces.

    Args:
        force: on each loaded edge [N].
        formulation, lateral_dashpot, options: single values, as for `pull_in` without `dashpots`.

    Returns:
        Dataset over (`load`, `force`): `field` [V/m], `voltage`, `stretch` and `found` for a field that grows
        slowly against relaxation, one that grows fast against it and slowly against vibration, and one that is
        applied at once, together with the force, to the membrane at rest in the reference state. For the first
        two `highest_field`, `loss_of_tension_field` and `breakdown_field_nominal` as well. Under charge control
        names as in `pull_in`.

    Raises:
        ValueError: as `pull_in`.
    """
    force = checks.increasing("force", force, "N")
    dynamic_options = {name: value for name, value in options.items() if name not in _CRITERIA}
    module = load_model(model, formulation, lateral_dashpot)
    slow, fast = (pull_in(module, force=force, dashpots=dashpots, **options) for dashpots in (RELAXED, FROZEN))
    sudden = dynamic_pull_in(module, force=force, dashpots=FROZEN, resolution=None, **dynamic_options)
    electrical = ELECTRICAL[fast.attrs["varied_input"]]
    first = "stretch" if "stretch" in fast else fast.attrs["coordinates"].split(", ")[0]
    shared = [name for name in (electrical.argument, "voltage", first, "found") if name in fast]
    loads = np.array([SLOW, FAST, SUDDEN], dtype=object)
    data = {
        name: (
            ("load", "force"),
            np.array([part[name].values for part in (slow, fast, sudden)]),
            fast[name].attrs,
        )
        for name in shared
    }
    nothing = np.full(len(force), np.nan)
    data |= {
        name: (("load", "force"), np.array([slow[name].values, fast[name].values, nothing]), fast[name].attrs)
        for name in critical_names(electrical).values()
    }
    coordinates = {
        "load": ("load", loads, {"long_name": "how the field is applied, and what the dashpots do"}),
        "force": variable("force", force, "N", "applied force", "P"),
    }
    attributes = {name: value for name, value in fast.attrs.items() if not name.startswith("dashpots")}
    return xr.Dataset(data, coords=coordinates, attrs=attributes)
