"""What is wanted of the compiled engine, beside what was measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.markdown import table
from benchmarks.series import ratio_at

Measured = Callable[[dict], float | str]  # from all raw numbers; a text says why there is no number
NOT_MEASURED = "not measured"


@dataclass(frozen=True)
class Target:
    """A number that is to be reached, or not to be exceeded where `smaller`."""

    what: str
    unit: str
    at_least: float
    aim: float | None
    measured: Measured
    smaller: bool = False

    def verdict(self, value: float | str) -> str:
        """ "aim met", "met" or "not met"; the text itself where there is no number."""
        if isinstance(value, str):
            return NOT_MEASURED
        if self.aim is not None and self._reached(value, self.aim):
            return "aim met"
        return "met" if self._reached(value, self.at_least) else "not met"

    def _reached(self, value: float, bound: float) -> bool:
        return value <= bound if self.smaller else value >= bound

    def row(self, numbers: dict) -> tuple[str, ...]:
        value = self.measured(numbers)
        shown = value if isinstance(value, str) else self._shown(value)
        bounds = (self._bound(self.at_least), "" if self.aim is None else self._bound(self.aim))
        return (self.what, *bounds, shown, self.verdict(value))

    def _bound(self, value: float) -> str:
        return f"{'at most ' if self.smaller else ''}{value:g} {self.unit}"

    def _shown(self, value: float) -> str:
        return f"{value:.3g} {self.unit}" if value < 1000 else f"{value:.0f} {self.unit}"


def _ratio(case: str, contestant: str, error: float) -> Measured:
    def measured(numbers: dict) -> float | str:
        contestants = numbers.get(case, {}).get("contestants", {})
        if not {"compiled", contestant} <= set(contestants):
            return NOT_MEASURED
        return ratio_at(contestants, contestant, "compiled", error)

    return measured


def _share_of_peak(case: str) -> Measured:
    def measured(numbers: dict) -> float | str:
        one = numbers.get("kernel", {}).get("cases", {}).get(case, {})
        return 100 * one["share_of_peak"] if "share_of_peak" in one else NOT_MEASURED

    return measured


def _two_threads(numbers: dict) -> float | str:
    times = {one["threads"]: one["times"] for one in _compiled(numbers, "threads").get("counts", [])}
    return float(np.median(times[1]) / np.median(times[2])) if 2 in times else NOT_MEASURED


def _first_sweep(state: str, less_imports: bool) -> Measured:
    def measured(numbers: dict) -> float | str:
        found = _compiled(numbers, "compile_time")
        if not found.get(state) or not found.get("imports"):
            return NOT_MEASURED
        imports = float(np.median(found["imports"])) if less_imports else 0.0
        return float(np.median(found[state])) - imports

    return measured


def _memory(numbers: dict) -> float | str:
    sizes = _compiled(numbers, "ensembles").get("sizes", [])
    return max((beyond_result(one) / 2**20 for one in sizes), default=NOT_MEASURED)


def beyond_result(size: dict) -> int:
    """Memory at the peak beyond the result [byte], and beyond what the process had before."""
    return max(size["peak"] - size["before"] - size["result"], 0)


def _compiled(numbers: dict, part: str) -> dict:
    """A part, where it is of the compiled engine."""
    found = numbers.get(part, {})
    return found if found.get("engine") == "compiled" else {}


_HEYOKA = {
    "heyoka": "heyoka.py, batch 8",
    "heyoka_output": "heyoka.py, batch 8, continuous output",
    "heyoka_tuned": "heyoka.py, batch 8, tuned by us",
}
_ALONE = {
    "heyoka_alone": "heyoka.py, batch 8, no extrema",
    "heyoka_tuned_alone": "heyoka.py, batch 8, tuned by us, no extrema",
}
_AGAINST_HEYOKA = tuple(
    Target(
        f"equal-biaxial against {label}, error {error:g}", "x", *bounds, _ratio("equal_biaxial", name, error)
    )
    for error, bounds in ((1e-6, (10, 20)), (1e-8, (7, 12)))
    for name, label in _HEYOKA.items()
)
_AGAINST_ALONE = tuple(
    Target(f"uniaxial against {label}, error 1e-06", "x", 5, 8, _ratio("uniaxial", name, 1e-6))
    for name, label in _ALONE.items()
)
_COMPILING = tuple(
    Target(f"{what}, {state} cache", "s", *bounds, _first_sweep(key, less), smaller=True)
    for key, state, bounds in (("cold", "empty", (12, 3)), ("cached", "full", (1, 0.3)))
    for what, less in (("import and first tiny sweep", False), ("the same less imports alone", True))
)
_AGAINST_OTHERS = tuple(
    Target(f"equal-biaxial against {label}, error 1e-06", "x", *bounds, _ratio("equal_biaxial", name, 1e-6))
    for name, label, bounds in (
        ("numpy", "the NumPy ensemble", (35, 60)),
        ("scipy", "solve_ivp and lambdify", (3000, 5000)),
    )
)
TARGETS: tuple[Target, ...] = (
    *_AGAINST_HEYOKA,
    *_AGAINST_ALONE,
    *_AGAINST_OTHERS,
    Target("share of the multiply-add peak, equal-biaxial", "%", 25, 50, _share_of_peak("equal_biaxial")),
    Target("share of the multiply-add peak, uniaxial", "%", 25, 50, _share_of_peak("uniaxial")),
    Target("speed-up on two cores", "x", 1.8, 1.95, _two_threads),
    *_COMPILING,
    Target("memory beyond the result, up to a million trajectories", "MiB", 1024, None, _memory, smaller=True),
)  # fmt: skip


def targets_section(numbers: dict) -> str:
    """The table of all targets; those without a number say so. A quick run is too small to judge."""
    rows = [target.row(numbers) for target in TARGETS]
    if any(part.get("quick") for part in numbers.values()):
        rows = [(*row[:-1], "not judged: quick") for row in rows]
    return "## Targets\n\n" + table(("target", "at least", "aim", "measured", ""), rows)
