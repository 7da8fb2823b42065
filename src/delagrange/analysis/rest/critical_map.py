"""The critical field against the force: static pull-in with relaxed and frozen dashpots, and dynamic pull-in."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import xarray as xr

from delagrange import checks
from delagrange.analysis.rest.dynamic_pull_in import dynamic_pull_in
from delagrange.analysis.rest.pull_in import pull_in
from delagrange.dashpots import FROZEN, RELAXED
from delagrange.dataset import variable

SLOW, FAST, SUDDEN = "static, dashpots relaxed", "static, dashpots frozen", "dynamic, dashpots frozen"
_CRITERIA = ("breakdown_field", "breakdown_exponent", "smallest_tension")
_SHARED = ("field", "voltage", "stretch", "found")
_RESOLUTION = 1e-7  # of the integration, finer than any picture
_STATIC = ("highest_field", "loss_of_tension_field", "breakdown_field_nominal")


def critical_map(model: str | ModuleType, *, force: np.ndarray, **options: object) -> xr.Dataset:
    """Critical fields over an increasing array of forces.

    Args:
        force: on each loaded edge [N].
        options: single values, as for `pull_in` without `dashpots`.

    Returns:
        Dataset over (`load`, `force`): `field` [V/m], `voltage`, `stretch` and `found` for a field that grows
        slowly against relaxation, one that grows fast against it and slowly against vibration, and one that is
        applied at once, together with the force, to the membrane at rest in the reference state. For the first
        two `highest_field`, `loss_of_tension_field` and `breakdown_field_nominal` as well.

    Raises:
        ValueError: as `pull_in`.
    """
    force = checks.increasing("force", force, "N")
    dynamic_options = {name: value for name, value in options.items() if name not in _CRITERIA}
    slow, fast = (pull_in(model, force=force, dashpots=dashpots, **options) for dashpots in (RELAXED, FROZEN))
    sudden = dynamic_pull_in(model, force=force, dashpots=FROZEN, resolution=_RESOLUTION, **dynamic_options)
    loads = np.array([SLOW, FAST, SUDDEN], dtype=object)
    data = {
        name: (
            ("load", "force"),
            np.array([part[name].values for part in (slow, fast, sudden)]),
            fast[name].attrs,
        )
        for name in _SHARED
    }
    nothing = np.full(len(force), np.nan)
    data |= {
        name: (("load", "force"), np.array([slow[name].values, fast[name].values, nothing]), fast[name].attrs)
        for name in _STATIC
    }
    coordinates = {
        "load": ("load", loads, {"long_name": "how the field is applied, and what the dashpots do"}),
        "force": variable("force", force, "N", "applied force", "P"),
    }
    attributes = {name: value for name, value in fast.attrs.items() if not name.startswith("dashpots")}
    return xr.Dataset(data, coords=coordinates, attrs=attributes)
