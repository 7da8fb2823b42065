"""Floating-point operations of the compiled kernel, counted for its rate.

Counted, for each evaluation of the equations: the rates and the sine as the kernel itself states them, the sums of
the stages and the error estimate, shared out over the twelve evaluations of a step. A product and the sum it goes
into are two operations. Not counted, though the kernel does them: the drives, the choice of the next step, the
search for extrema with its interpolants, comparisons. So the rate is that of the integration alone.
"""

from __future__ import annotations

from types import ModuleType

from delagrange.engines.tableau import Tableau, tableau

EVALUATIONS_PER_STEP = 12  # DOP853: the last rate of a step is the first of the next
_SCALE_OPERATIONS = 3  # 1 / (atol + rtol * size), for each state variable
_NORM_OPERATIONS = 8  # step^2 * fifth^2 / (n * (fifth + 0.01 * third + tiny)), for the step


def stage_operations(pair: Tableau) -> int:
    """Of the sums y + h * (a_1 K_1 + ... + a_n K_n), 2 n each, for a state variable and a step."""
    return 2 * (sum(len(row) for row in pair.coupling) + len(pair.weights))


def error_operations(pair: Tableau, states: int) -> int:
    """Of both estimates of a step: a sum of n terms (2 n - 1), its scale and its square, and their norm."""
    one_state = sum(2 * len(row) + 2 for row in pair.errors) + _SCALE_OPERATIONS
    return states * one_state + _NORM_OPERATIONS


def operations_per_evaluation(kernel: ModuleType) -> dict[str, float]:
    """By what they are for; `total` is their sum."""
    pair, states = tableau("DOP853"), kernel.STATE_COUNT
    parts = {
        "rates_and_sine": float(kernel.OPERATIONS_PER_EVALUATION),
        "stage_sums": states * stage_operations(pair) / EVALUATIONS_PER_STEP,
        "error_estimate": error_operations(pair, states) / EVALUATIONS_PER_STEP,
    }
    return parts | {"total": sum(parts.values())}
