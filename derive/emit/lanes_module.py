"""From the description of an ensemble kernel to the text of a module that Numba compiles.

All choices are made here; the template places text. The same description gives the same text on any
machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from delagrange.derive.emit.code_lines import WIDTH, broken
from delagrange.derive.emit.compiled_lines import (
    PRINTER,
    assignment_lines,
    constants_lines,
    extreme_stretches_lines,
)
from delagrange.derive.emit.lane_rows import Rows, placed, result_rows, table_rows, total, work_rows
from delagrange.derive.emit.runge_kutta import Pair, Row, Stage, dop853, quadrature
from delagrange.derive.emit.sine import sine_coefficients
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.arranged import operations_of
from delagrange.derive.kernel.lane_spec import LaneSpec
from delagrange.derive.kernel.spec import KernelFunction

_TEMPLATE = "lanes_module.py.jinja"
_LANES = 64  # enough to hide how long an operation takes, and to share what a loop costs to set up
_SINE_TERMS = 8  # right to 4e-16
_QUADRATURE_POINTS = 8  # exact for the square of the interpolant, of degree 14
_ENDS = ("LEAST", "MOST")  # rows of the stretches at the ends of queued steps
_CONTROL = {"safety": 0.9, "growth": 0.03, "memory": 0.015}


def emit_lanes(spec: LaneSpec) -> str:
    """The text of the compiled module that `spec` describes."""
    return render(_TEMPLATE, _view(spec, dop853()))


def _view(spec: LaneSpec, pair: Pair) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    sine = sine_coefficients(_SINE_TERMS)
    return {
        **_names_and_sizes(spec, pair),
        **_CONTROL,
        "operations": spec.operations,
        "sine_operations": _sine_operations(len(sine)),
        "constants_body": "\n".join(constants_lines(spec.model.parameters, spec.volume, spec.constants)),
        "rates_body": "\n".join(_rates_lines(spec)),
        "stretches_body": "\n".join(_stretches_lines(spec)),
        **_limits(spec),
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


def _limits(spec: LaneSpec) -> dict[str, Any]:
    """Whether the energies of the model have limits, and what is left to them."""
    validity = spec.validity
    return {
        "has_limits": validity is not None,
        "validity_body": "" if validity is None else "\n".join(_validity_lines(validity, spec)),
        "validity_operations": 0 if validity is None else operations_of(validity),
    }


def _names_and_sizes(spec: LaneSpec, pair: Pair) -> dict[str, Any]:
    work = _needed(work_rows(spec, pair.last + 1 + len(pair.extra_stages)), spec)
    table, results = table_rows(spec), result_rows(spec)
    return {
        "command": spec.model.origin.command,
        "title": spec.model.title,
        "name": spec.model.name,
        "digest": spec.model.digest,
        "sympy_version": sp.__version__,
        "lanes": _LANES,
        "last": pair.last,
        "state_count": len(spec.model.state),
        "coordinate_count": spec.model.coordinate_count,
        "input_count": len(spec.model.inputs),
        "constant_count": len(spec.constants),
        "rows": work,
        "size": total(work),
        "table_rows": table,
        "table_size": total(table),
        "result_rows": results,
        "result_size": total(results),
    }


def _needed(rows: tuple[Rows, ...], spec: LaneSpec) -> tuple[Rows, ...]:
    """Where energies have limits, a lost step is marked before it is queued, and its end is looked at no more."""
    if spec.validity is None:
        return rows
    return placed((row.name, row.count, row.meaning) for row in rows if row.name not in _ENDS)


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


def _loads(function: KernelFunction, spec: LaneSpec, indent: str) -> list[str]:
    """What the function needs of state, inputs and constants, from their rows of lane k."""
    groups = (
        ("POINT", [entry.name for entry in spec.model.state]),
        ("INPUT", [entry.name for entry in spec.model.inputs]),
        ("CONSTANT", [constant.name for constant in spec.constants]),
    )
    return [
        f"{indent}{name} = work[{_place(row, number)}]"
        for row, names in groups
        for number, name in enumerate(names)
        if function.uses(name)
    ]


def _place(row: str, number: int) -> str:
    return f"{row} + k" if number == 0 else f"{row} + {f'{number} * ' if number > 1 else ''}LANES + k"


def _body(function: KernelFunction, spec: LaneSpec, indent: str) -> list[str]:
    statements = (line for a in function.assignments for line in assignment_lines(a, indent))
    return [*_loads(function, spec, indent), *statements]


def _rates_lines(spec: LaneSpec) -> list[str]:
    indent = " " * 8
    stores = [
        f"{indent}work[{_place('out', number)}] = {PRINTER(output)}"
        for number, output in enumerate(spec.rates.outputs)
    ]
    return [*_body(spec.rates, spec, indent), *stores]


def _stretches_lines(spec: LaneSpec) -> list[str]:
    function = spec.principal_stretches
    return [*_body(function, spec, "    "), *extreme_stretches_lines(function)]


def _validity_lines(validity: KernelFunction, spec: LaneSpec) -> list[str]:
    return [*_body(validity, spec, "    "), *broken("return ", validity.outputs[0], PRINTER, "    ")]
