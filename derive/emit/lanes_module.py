"""From the description of an ensemble kernel to the text of a module that Numba compiles.

All choices are made here; the template places text. The same description gives the same text on any
machine.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath

from delagrange.derive.emit.compiled import (
    COMPILED_WORDS,
    Places,
    Rows,
    body_lines,
    compiled_view,
    placed,
    total,
)
from delagrange.derive.emit.lane_rows import result_rows, table_rows, work_rows
from delagrange.derive.emit.python_lines import NUMPY, WIDTH
from delagrange.derive.emit.runge_kutta import Pair, Row, Stage, dop853, quadrature
from delagrange.derive.emit.target import Target
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.arranged import NUMBERED, operations_of
from delagrange.derive.kernel.compiled_spec import CompiledSpec, lane_spec
from delagrange.derive.kernel.spec import KernelSpec

_TEMPLATE = "lanes_module.py.jinja"
_LANES = 64  # enough to hide how long an operation takes, and to share what a loop costs to set up
_SINE_TERMS = 8  # right to 4e-16
_SINE_DIGITS = 60
_QUADRATURE_POINTS = 8  # exact for the square of the interpolant, of degree 14
_ENDS = ("LEAST", "MOST")  # rows of the stretches at the ends of queued steps


def emit_lanes(spec: KernelSpec) -> str:
    """The text of the ensemble kernel of the model that `spec` describes."""
    return render(_TEMPLATE, _view(lane_spec(spec), dop853()))


LANES = Target(
    "_lanes.py", NUMPY, emit_lanes, COMPILED_WORDS | {"work", "rows", "k", "LANES", "POINT", "WHOLE"}, NUMBERED
)


def _place(row: str, number: int) -> str:
    return f"{row} + k" if number == 0 else f"{row} + {f'{number} * ' if number > 1 else ''}LANES + k"


def _entry(row: str) -> Callable[[int], str]:
    return lambda number: f"work[{_place(row, number)}]"


_PLACES = Places(_entry("POINT"), _entry("INPUT"), _entry("CONSTANT"))


def _view(spec: CompiledSpec, pair: Pair) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    sine = sine_coefficients(_SINE_TERMS)
    return {
        **compiled_view(spec, _PLACES),
        **_rows(spec, pair),
        "lanes": _LANES,
        "last": pair.last,
        "sine_operations": _sine_operations(len(sine)),
        "rates_body": "\n".join(_rates_lines(spec)),
        "validity_operations": 0 if spec.validity is None else operations_of(spec.validity),
        "sine_body": "\n".join(_horner_lines(sine)),
        "stages": [_stage_view(stage, dict(pair.weights), "work") for stage in pair.stages],
        "extra_stages": [_stage_view(stage, {}, "queue") for stage in pair.extra_stages],
        "first_weight": dict(pair.weights)[0],
        "fifth_body": "\n".join(_sum_lines("fifth = scale * (", pair.errors[0], "work")),
        "third_body": "\n".join(_sum_lines("third = scale * (", pair.errors[1], "work")),
        "dense_bodies": [
            "\n".join(_sum_lines(f"queue[DENSE_{term} + at] = step * (", row, "queue"))
            for term, row in enumerate(pair.interpolant, start=3)
        ],
        "quadrature": [(repr(node), repr(weight)) for node, weight in quadrature(_QUADRATURE_POINTS)],
    }


def _rows(spec: CompiledSpec, pair: Pair) -> dict[str, Any]:
    work = _needed(work_rows(spec, pair.last + 1 + len(pair.extra_stages)), spec)
    table, results = table_rows(spec), result_rows(spec)
    return {
        "rows": work,
        "size": total(work),
        "table_rows": table,
        "table_size": total(table),
        "result_rows": results,
        "result_size": total(results),
    }


def _needed(rows: tuple[Rows, ...], spec: CompiledSpec) -> tuple[Rows, ...]:
    """Where energies have limits, a lost step is marked before it is queued, and its end is looked at no more."""
    if spec.validity is None:
        return rows
    return placed((row.name, row.count, row.meaning) for row in rows if row.name not in _ENDS)


def sine_coefficients(count: int) -> tuple[float, ...]:
    """c with sin(2 pi x) = x (c_0 + c_1 x^2 + ...) for -1/4 <= x <= 1/4, nearly minimax, rounded to doubles."""
    with mpmath.workdps(_SINE_DIGITS):
        highest_first = mpmath.chebyfit(_sine_over_x, [0, mpmath.mpf(1) / 16], count)
        return tuple(float(coefficient) for coefficient in reversed(highest_first))


def _sine_over_x(square: mpmath.mpf) -> mpmath.mpf:
    """sin(2 pi x) / x as a function of x^2."""
    x = mpmath.sqrt(square)
    return mpmath.sin(2 * mpmath.pi * x) / x if x else 2 * mpmath.pi


def _sine_operations(terms: int) -> int:
    """Of one input with a sine: argument 2, fold 5, square 1, polynomial 2 a term, amplitude and line 4."""
    return 2 + 5 + 1 + (2 * terms - 1) + 4


def _horner_lines(coefficients: Sequence[float]) -> list[str]:
    """`value` of the polynomial in `square`, lowest power first, by Horner's rule."""
    *others, highest = coefficients
    return [
        f"    value = {highest!r}",
        *(f"    value = {coefficient!r} + square * value" for coefficient in reversed(others)),
    ]


def _stage_view(stage: Stage, weights: dict[int, float], array: str) -> dict[str, Any]:
    head = f"{array}[POINT + at] = {array}[STATE + at] + {array}[STEP + k] * ("
    return {
        "number": stage.number,
        "node": repr(stage.node),
        "weight": repr(weights[stage.number]) if stage.number in weights else "",
        "body": "\n".join(_sum_lines(head, stage.row, array)),
    }


def _sum_lines(head: str, row: Row, array: str) -> list[str]:
    """`head c * rate + ... )`, as many terms on a line as it holds."""
    indent = " " * 12
    terms = [f"{'- ' if c < 0 else '+ '}{abs(c)!r} * {array}[RATE_{stage} + at]" for stage, c in row]
    terms[0] = terms[0].removeprefix("+ ").replace("- ", "-", 1)
    lines = [f"{indent}{head}"]
    body = [f"{indent}    {terms[0]}"]
    for term in terms[1:]:
        if len(body[-1]) + 1 + len(term) > WIDTH:
            body.append(f"{indent}    {term}")
        else:
            body[-1] += f" {term}"
    return [*lines, *body, f"{indent})"]


def _rates_lines(spec: CompiledSpec) -> list[str]:
    indent = " " * 8
    stores = [
        f"{indent}work[{_place('out', number)}] = {NUMPY(rate)}" for number, rate in enumerate(spec.rates)
    ]
    return [*body_lines(spec.motion, spec, _PLACES, indent), *stores]
