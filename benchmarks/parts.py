"""The parts of the benchmark, by name: each gives JSON and keeps it as it goes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from benchmarks import machine, scaling, tangents, understanding, vector_width
from benchmarks.cases import CASES, Case, spread
from benchmarks.contestant import refusal
from benchmarks.contestants import CONTESTANTS, available
from benchmarks.engines import has_compiled_engine
from benchmarks.series import equal_error_ratios
from benchmarks.timing import one_core
from benchmarks.work_precision import measure, prepared
from delagrange.common import checks

REPEATS = 5
QUICK_REPEATS = 2
_CHECKED_RUNS = 4  # of the reference, by SciPy
_CHECK_RTOL = 1e-13
_NO_KERNEL = {"left_out": "Left out: the compiled engine cannot run here."}


@dataclass(frozen=True)
class Plan:
    """How much is measured, and where what is kept lies."""

    folder: Path
    quick: bool
    engine: str  # of the parts on threads, ensembles and compiling


Keep = Callable[[dict], None]
Part = Callable[[Plan, Keep], None]


def _machine(plan: Plan, keep: Keep) -> None:
    keep(machine.facts())


def _case_part(name: str) -> Part:
    def part(plan: Plan, keep: Keep) -> None:
        if find_spec("heyoka") is None:
            keep({"left_out": "Left out: heyoka, which gives the reference, is not installed."})
            return
        case = CASES[name].thinned(scaling.QUICK_EVERY if plan.quick else 1)
        with one_core():
            _measure_case(case, plan, keep)

    return part


def _measure_case(case: Case, plan: Plan, keep: Keep) -> None:
    from benchmarks.reference import reference

    known = reference(case, plan.folder)
    about = {
        "cross_check": cross_check(case, known),
        "refusals": [refusal(one) for one in CONTESTANTS if one.missing()],
    }
    entries = prepared(case, available(), QUICK_REPEATS if plan.quick else REPEATS, 2 if plan.quick else 1)
    found = measure(case, entries, known, lambda numbers: keep(numbers | about))
    keep(found | about | {"ratios": equal_error_ratios(found["contestants"])})


def cross_check(case: Case, known: np.ndarray) -> dict[str, float]:
    """The reference against SciPy's tightest on a few runs spread over all."""
    from benchmarks.peer_scipy import amplitudes

    places = spread(len(known), _CHECKED_RUNS + 2)[1:-1]
    found = amplitudes(case, case.runs.take(places), _CHECK_RTOL, _CHECK_RTOL)
    difference = float(np.abs(found - known[places]).max())
    return {"runs": len(places), "rtol": _CHECK_RTOL, "largest_difference": difference}


def _peak(plan: Plan, keep: Keep) -> None:
    if find_spec("numba") is None:
        keep({"left_out": "Left out: numba not installed."})
        return
    from benchmarks.multiply_add_peak import measured

    with one_core():
        keep(measured())


def _kernel(plan: Plan, keep: Keep) -> None:
    if not has_compiled_engine():
        keep(_NO_KERNEL)
        return
    from benchmarks.kernel_rate import measured

    with one_core():
        measured(scaling.QUICK_EVERY if plan.quick else 1, QUICK_REPEATS if plan.quick else REPEATS, keep)


def _vectors(plan: Plan, keep: Keep) -> None:
    if not has_compiled_engine():
        keep(_NO_KERNEL)
        return
    keep(vector_width.measured())


def _threads(plan: Plan, keep: Keep) -> None:
    scaling.threads(plan.engine, plan.quick, keep)


def _ensembles(plan: Plan, keep: Keep) -> None:
    scaling.ensembles(plan.engine, plan.quick, keep)


def _compile_time(plan: Plan, keep: Keep) -> None:
    scaling.compile_time(plan.engine, plan.quick, keep)


def _tangents(plan: Plan, keep: Keep) -> None:
    if not has_compiled_engine():
        keep(_NO_KERNEL)
        return
    if find_spec("heyoka") is None:
        keep({"left_out": "Left out: heyoka, which gives the reference, is not installed."})
        return
    models = ("equal_biaxial",) if plan.quick else ("equal_biaxial", "uniaxial")
    with one_core():
        tangents.measured(models, QUICK_REPEATS if plan.quick else REPEATS, keep)


def _understanding(plan: Plan, keep: Keep) -> None:
    understanding.measured(plan.quick, keep)


PARTS: Mapping[str, Part] = {
    "machine": _machine,
    **{name: _case_part(name) for name in CASES},
    "peak": _peak,
    "kernel": _kernel,
    "vectors": _vectors,
    "threads": _threads,
    "ensembles": _ensembles,
    "compile_time": _compile_time,
    "tangents": _tangents,
    "understanding": _understanding,
}


def checked_parts(names: list[str] | None) -> tuple[str, ...]:
    """Names of the parts to run, in their order; all for None. The machine is always among them.

    Raises:
        ValueError: there is no part of a name.
    """
    asked = [checks.choice("part", name, PARTS) for name in names or PARTS]
    return tuple(name for name in PARTS if name in ("machine", *asked))
