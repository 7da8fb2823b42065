"""Branches of periodic motions as a Dataset."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain

import numpy as np
import xarray as xr

from delagrange.analysis.steady import floquet
from delagrange.analysis.steady.branches import Findings
from delagrange.analysis.steady.load import load_names
from delagrange.analysis.steady.search import Search
from delagrange.analysis.steady.shooting import Orbit
from delagrange.drives.sines import LOAD_UNITS, sine_long_names
from delagrange.run.run_dataset import coordinate_variables, state_variables, variable

PERIODIC_AMPLITUDE = "half of peak to peak over one period of the periodic motion, without any transient"
_CLOSURE = "distance between the state at the end of the period and at its begin, in units of typical sizes"
_PRODUCT = (
    "|product of the multipliers / exp(integral of the divergence) - 1|, zero but for the numerical error; from "
    "logarithms, so that nothing underflows"
)


def steady_dataset(search: Search, findings: Findings, attributes: Mapping[str, object]) -> xr.Dataset:
    """Everything found, over `point`, `bifurcation`, `branch` and `multiplier`."""
    branches = findings.branches
    orbits = [point.payload for branch in branches for point in branch.points]
    numbers = list(chain.from_iterable([place] * len(branch.points) for place, branch in enumerate(branches)))
    data = _motion_variables(search, orbits, "point", "")
    data["branch_number"] = variable("point", np.array(numbers, dtype=int), "1", "number of the branch")
    data |= _state_variables(search, orbits)
    data |= _stability_variables(search, orbits)
    data |= _bifurcation_variables(search, findings)
    data |= _branch_variables(findings)
    return xr.Dataset(data, coords=_coordinates(findings), attrs=dict(attributes))


def _motion_variables(search: Search, orbits: list[Orbit], dimension: str, prefix: str) -> dict[str, tuple]:
    """Loads, and the extrema of every coordinate; those of the first go without its name."""
    data = {}
    model = search.shooting.path.problem.model
    long_names = {"force": "applied force"} | sine_long_names(search.electrical)
    for name in load_names(search.electrical):
        values = np.array([orbit.load[name] for orbit in orbits], dtype=float)
        data[prefix + name] = variable(dimension, values, LOAD_UNITS[name], long_names[name])
    measured = {
        what: np.array([getattr(orbit, what) for orbit in orbits], dtype=float).reshape(-1, model.COORDINATE_COUNT).T
        for what in ("amplitude", "maximum", "minimum")
    }
    about = {"amplitude": {"definition": PERIODIC_AMPLITUDE}}
    return data | coordinate_variables(model, dimension, measured, about, prefix)


def _state_variables(search: Search, orbits: list[Orbit]) -> dict[str, tuple]:
    model = search.shooting.path.problem.model
    states = np.array([orbit.state for orbit in orbits]).reshape(-1, len(model.STATE)).T
    data = state_variables(model, "point", states, f"at phase 0 of the {search.electrical.stem}")
    period = np.array([orbit.period for orbit in orbits], dtype=float)
    return data | {"period": variable("point", period, "s", "period of the motion", "T")}


def _stability_variables(search: Search, orbits: list[Orbit]) -> dict[str, tuple]:
    size = len(search.shooting.unknowns)
    spectra = [floquet.spectrum(orbit) for orbit in orbits]
    values = np.array([spectrum.multipliers for spectrum in spectra]).reshape(-1, size)
    logarithms = np.array([spectrum.logarithms for spectrum in spectra]).reshape(-1, size)
    names = np.array([spectrum.stability(search.conservative) for spectrum in spectra], dtype=object)
    over = ("point", "multiplier")
    divergence = np.array([orbit.divergence for orbit in orbits], dtype=float)
    errors = np.array([spectrum.product_error for spectrum in spectra], dtype=float)
    closure = np.array([orbit.closure_error for orbit in orbits], dtype=float)
    return {
        "stability": ("point", names, {"long_name": "stability", "meaning": floquet.STABILITY_MEANING}),
        "multiplier_real": variable(over, values.real, "1", "real part of the Floquet multiplier"),
        "multiplier_imag": variable(over, values.imag, "1", "imaginary part of the Floquet multiplier"),
        "multiplier_logarithm": variable(over, logarithms.real, "1", "natural logarithm of the multiplier's modulus"),
        "divergence": variable("point", divergence, "1", "integral of the divergence over the period"),
        "product_error": variable("point", errors, "1", "error of the multipliers' product", definition=_PRODUCT),
        "closure_error": variable("point", closure, "1", "what is missing to a periodic motion", definition=_CLOSURE),
    }  # fmt: skip


def _bifurcation_variables(search: Search, findings: Findings) -> dict[str, tuple]:
    entries = [
        (place, bifurcation)
        for place, branch in enumerate(findings.branches)
        for bifurcation in branch.bifurcations
    ]
    kinds = np.array([bifurcation.kind for _, bifurcation in entries], dtype=object)
    numbers = np.array([place for place, _ in entries], dtype=int)
    orbits = [bifurcation.point.payload for _, bifurcation in entries]
    data = _motion_variables(search, orbits, "bifurcation", "bifurcation_")
    kind = {"long_name": "kind of the bifurcation", "meaning": floquet.KIND_MEANING}
    data["bifurcation_kind"] = ("bifurcation", kinds, kind)
    data["bifurcation_branch"] = variable("bifurcation", numbers, "1", "number of the branch")
    return data


def _branch_variables(findings: Findings) -> dict[str, tuple]:
    endings = np.array([branch.endings for branch in findings.branches], dtype=object).reshape(-1, 2)
    origins = np.array([branch.origin for branch in findings.branches], dtype=object)
    return {
        "ending": (("branch", "end"), endings, {"long_name": "why the branch ends"}),
        "origin": ("branch", origins, {"long_name": "how the branch was found"}),
    }


def _coordinates(findings: Findings) -> dict[str, tuple]:
    return {
        "branch": ("branch", np.arange(len(findings.branches)), {"long_name": "number of the branch"}),
        "end": ("end", np.array(["first", "last"], dtype=object), {"long_name": "end of the branch"}),
    }
