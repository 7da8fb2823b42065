"""What the paper says of the kind of a motion, judged by Lyapunov exponents, base frequencies and the 0-1 test."""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange.reproduction.claims.claim import Claim
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import MOTIONS

_PHASE_NUMBER = {figure.model: figure.phase_number for figure in MOTIONS}
_REGULAR = ("periodic", "quasi-periodic")


def _each(runs: Runs, model: str, formulation: str | None) -> list[xr.Dataset]:
    kinds = runs.kinds(_PHASE_NUMBER[model], formulation)
    return [kinds.isel(frequency=place) for place in range(kinds.sizes["frequency"])]


def _verdict(one: xr.Dataset) -> str:
    return str(one["verdict"].values)


def kind_text(one: xr.Dataset) -> str:
    """`371 Hz: quasi-periodic, base frequencies 742, 736.8 Hz, largest exponent 0.19 ± 0.39 1/s, K = -0.01`."""
    bases = one["base_frequencies"].values
    listed = ", ".join(f"{base:.5g}" for base in bases[np.isfinite(bases)])
    exponent, doubt = float(one["lyapunov_exponents"][0]), float(one["lyapunov_uncertainty"][0])
    return (
        f"{float(one['frequency']):g} Hz: {_verdict(one)}, base frequencies {listed} Hz, largest exponent "
        f"{exponent:.2g} ± {doubt:.2g} 1/s in {float(one['followed']):.3g} s, K = {float(one['zero_one_K']):.2f}"
    )


def _text(found: list[xr.Dataset]) -> str:
    return ", ".join(kind_text(one) for one in found)


def sections_are_closed(model: str) -> Claim:
    """Quasi-periodic on a torus of dimension 2, the drive included: its section is a closed curve."""

    def test(runs: Runs, formulation: str | None) -> tuple[bool, str]:
        found = _each(runs, model, formulation)
        closed = [_verdict(one) in _REGULAR and float(one["torus_dimension"]) <= 2 for one in found]
        return all(closed), _text(found)

    return test


def sections_fill_an_area(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """A torus of dimension 3, or no torus: the section is no curve."""
    found = _each(runs, "uniaxial", formulation)
    spread = [_verdict(one) == "chaotic" or float(one["torus_dimension"]) > 2 for one in found]
    return all(spread), "; ".join(_section_text(one) for one in found)


def _section_text(one: xr.Dataset) -> str:
    """What a stroboscopic section cuts: of a torus, one dimension less."""
    start, dimension = f"{float(one['frequency']):g} Hz: {_verdict(one)}", float(one["torus_dimension"])
    if _verdict(one) not in _REGULAR:
        return start
    cut = {1: "points", 2: "loops", 3: "a projected surface, neither a loop nor disorder"}
    what = cut.get(int(dimension), f"{dimension - 1:g} dimensions of it, projected")
    return (
        f"{start}, a torus of dimension {dimension:g}, the drive included, of which the section shows {what}"
    )


def is_aperiodic(runs: Runs, formulation: str | None) -> tuple[bool, str]:
    """Chaotic in all three cases. A quasi-periodic motion never repeats either, but every line of it is known."""
    found = _each(runs, "uniaxial", formulation)
    return all(_verdict(one) == "chaotic" for one in found), _text(found)
