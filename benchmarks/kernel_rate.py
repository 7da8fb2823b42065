"""How fast the compiled kernel is: time of an evaluation, and the share of the peak of multiply-adds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import delagrange
from benchmarks.cases import CASES, Case
from benchmarks.machine import full_width
from benchmarks.multiply_add_peak import REGISTERS, peak
from benchmarks.operation_count import EVALUATIONS_PER_STEP, operations_per_evaluation
from benchmarks.peer_delagrange import ABSOLUTE_SHARE
from benchmarks.timing import timed
from delagrange.engines.engines import resolve_numerics
from delagrange.model.kernels import kernel_name, load_kernel
from delagrange.problem.problem import make_specimen
from delagrange.reproduction.runs.cases import Panel
from delagrange.run.measures import Measures
from delagrange.run.sweep import Sweep, make_settings, make_sweep, run_sweep

RTOL = 1e-6


def measured(every: int, repeats: int, keep: Callable[[dict], None]) -> dict[str, object]:
    """Both cases, and the peak beside them, on one thread; JSON."""
    doubles = next(count for count, name in REGISTERS.items() if name == full_width())
    found: dict[str, object] = {"rtol": RTOL, "peak_gigaflops": 0.0, "cases": {}}
    sweeps = {name: _sweeps(case.thinned(every)) for name, case in CASES.items()}
    for name, some in sweeps.items():
        found["cases"][name] = _about(name, some)
    for _ in range(repeats):
        best = peak(doubles, repeats=2).rate
        found["peak_gigaflops"] = max(found["peak_gigaflops"], best)
        for name, some in sweeps.items():
            found["cases"][name]["times"].append(timed(lambda some=some: _run_all(some))[0])
        keep(found)
    for one in found["cases"].values():
        one |= _rates(one, found["peak_gigaflops"])
    keep(found)
    return found


def _sweeps(case: Case) -> list[Sweep]:
    return [_sweep(case, panel) for panel in case.panels]


def _sweep(case: Case, panel: Panel) -> Sweep:
    """As `frequency_response` makes it; here the counts of steps are needed too."""
    specimen = make_specimen(case.model, None, None, delagrange.SHENG_2015)
    numerics = resolve_numerics("DOP853", "compiled", None, "dense", specimen.model)
    limits = delagrange.Limits()
    settings = make_settings(case.duration, None, RTOL, RTOL * ABSOLUTE_SHARE, numerics, limits, threads=1)
    first = panel.loads[0]
    values = {"force": first.force, "field_amplitude": first.field_amplitude, "field_bias": 0.0}
    values |= {panel.varied: [getattr(load, panel.varied) for load in panel.loads]}
    values |= {"field_phase": 0.0, "held_stretch": None, "frequency": case.frequency}
    return make_sweep(specimen, values, settings, "compiled", Measures())


def _run_all(sweeps: list[Sweep]) -> np.ndarray:
    """Steps tried in each run, one entry a run."""
    outcomes = [run_sweep(sweep, False) for sweep in sweeps]
    return np.concatenate([outcome.steps + outcome.rejections for outcome in outcomes])


def _about(name: str, sweeps: list[Sweep]) -> dict[str, object]:
    """What is evaluated, from a run that also compiles."""
    tries = _run_all(sweeps)
    kernel = load_kernel(kernel_name(delagrange.load_model(CASES[name].model)))
    return {
        "runs": len(tries),
        "lanes": kernel.LANES,
        "evaluations": int(EVALUATIONS_PER_STEP * tries.sum()),
        "operations": operations_per_evaluation(kernel),
        "times": [],
    }


def _rates(one: dict, peak_rate: float) -> dict[str, float]:
    nanoseconds = float(np.median(one["times"])) / one["evaluations"] * 1e9
    rate = one["operations"]["total"] / nanoseconds
    return {"nanoseconds": nanoseconds, "gigaflops": rate, "share_of_peak": rate / peak_rate}
