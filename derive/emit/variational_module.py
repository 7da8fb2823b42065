"""From the description of a variational kernel to the text of a module that Numba compiles.

All choices are made here; the template places text. The same description gives the same text on any
machine.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import sympy as sp

from delagrange.derive.emit.compiled import (
    COMPILED_WORDS,
    Places,
    Rows,
    body_lines,
    compiled_view,
    placed,
    total,
)
from delagrange.derive.emit.python_lines import NUMPY, WIDTH, broken
from delagrange.derive.emit.runge_kutta import Pair, Row, dop853
from delagrange.derive.emit.target import Target
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.arranged import NUMBERED
from delagrange.derive.kernel.compiled_spec import CompiledSpec, variational_spec
from delagrange.derive.kernel.spec import KernelSpec

_TEMPLATE = "variational_module.py.jinja"
_PLACES = Places("vector[{}]".format, "frame[INPUT + {}]".format, "frame[CONSTANT + {}]".format)


def emit_variational(spec: KernelSpec) -> str:
    """The text of the variational kernel of the model that `spec` describes."""
    return render(_TEMPLATE, _view(variational_spec(spec), dop853()))


VARIATIONAL = Target(
    "_variational.py",
    NUMPY,
    emit_variational,
    COMPILED_WORDS
    | {"frame", "sources", "columns", "vector", "rates", "column", "at", "push", "COLUMN", "STATE_COUNT"},
    NUMBERED | {"slope", "push", "tangent"},
)


def _view(spec: CompiledSpec, pair: Pair) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    places = _places(spec)
    return {
        **compiled_view(spec, _PLACES),
        "places": places,
        "frame_size": total(places),
        "last": pair.last,
        "nodes": ["0.0", *(repr(stage.node) for stage in pair.stages)],
        "table": [_row_text(row, pair.last, 8) for row in ((), *(stage.row for stage in pair.stages))],
        "fifth": _row_text(pair.errors[0], pair.last, 4),
        "third": _row_text(pair.errors[1], pair.last, 4),
        "motion_body": "\n".join(_motion_lines(spec)),
    }


def _places(spec: CompiledSpec) -> tuple[Rows, ...]:
    inputs = len(spec.model.inputs)
    return placed(
        [
            ("CONSTANT", len(spec.constants), "what of the equations does not move"),
            ("DRIVE", 4 * inputs, "the drives, as below"),
            ("WEIGHT", len(spec.model.state), "typical sizes of the state variables"),
            ("TOLERANCE", 1, "of a step, in units of the weights"),
            ("SMALLEST", 1, "principal stretch [1] below which the state is lost"),
            ("LARGEST", 1, "in-plane stretch [1] above which it is"),
            ("TURNS", inputs, "of each drive at the start of the step, whole ones left out"),
            ("INPUT", inputs, "inputs at a stage"),
            ("TIME", 1, "[s], at the start of the step"),
            ("ROW", 1, "the last of the times that was reached"),
            ("SINCE", 1, "[s], the time since then"),
            ("WISH", 1, "[s], the step that the error asks for; 0 where nothing is known"),
            ("OLD_ERROR", 1, "squared error of the last accepted step"),
            ("STATUS", 1, "one of the four below"),
            ("STATUS_TIME", 1, "[s], when it came to that"),
            ("STEPS", 1, "accepted"),
            ("REJECTIONS", 1, "steps tried in vain"),
        ]
    )


def _row_text(row: Row, length: int, indent: int) -> str:
    """The coefficients over all stages of a step but its last one, a tuple over as many lines as it needs."""
    known = dict(row)
    text = ", ".join(repr(known.get(stage, 0.0)) for stage in range(length))
    inner = " " * (indent + 4)
    lines = textwrap.wrap(text, WIDTH, initial_indent=inner, subsequent_indent=inner)
    return "\n".join([" " * indent + "(", *lines, " " * indent + ")"])


def _motion_lines(spec: CompiledSpec) -> list[str]:
    size = len(spec.model.state)
    slopes, slope_names = _named("slope", spec.slopes)
    pushes, push_names = _named("push", spec.input_slopes)
    trace = sp.Add(*(slope_names[place, place] for place in range(size)))
    return [
        *body_lines(spec.motion, spec, _PLACES, "    "),
        *(line for place, rate in enumerate(spec.rates) for line in _store(f"out + {place}", rate, "    ")),
        *slopes,
        *_store("out + STATE_COUNT * (columns + 1)", trace, "    "),
        *pushes,
        "    for column in range(columns):",
        *(f"        {line}" for line in _column_lines(slope_names, push_names)),
    ]


def _store(place: str, value: sp.Expr, indent: str) -> list[str]:
    return broken(f"rates[{place}] = ", value, NUMPY, indent)


def _named(stem: str, matrix: sp.Matrix) -> tuple[list[str], sp.Matrix]:
    """Assignments of a name to every entry that is not a number, and the matrix in those names."""
    lines, names = [], sp.Matrix(matrix)
    for row, column in _entries(matrix):
        if not matrix[row, column].is_number:
            names[row, column] = sp.Symbol(f"{stem}_{row + 1}_{column + 1}")
            lines += broken(f"{names[row, column]} = ", matrix[row, column], NUMPY, "    ")
    return lines, names


def _entries(matrix: sp.Matrix) -> Iterator[tuple[int, int]]:
    return ((row, column) for row in range(matrix.rows) for column in range(matrix.cols))


def _column_lines(slopes: sp.Matrix, pushes: sp.Matrix) -> list[str]:
    """Rate of one column of the tangent: the Jacobian times it, and what the drive that it follows adds."""
    size = slopes.rows
    tangent = sp.Matrix([sp.Symbol(f"tangent_{place + 1}") for place in range(size)])
    moving = slopes * tangent
    lines = [
        "at = STATE_COUNT * (column + 1)",
        *(f"{name} = vector[at + {place}]" for place, name in enumerate(tangent)),
        *(line for place in range(size) for line in _store(f"out + at + {place}", moving[place], "")),
    ]
    for source in range(pushes.cols):
        added = [(row, pushes[row, source]) for row in range(size) if pushes[row, source] != 0]
        lines += [
            f"if sources[column, 0] == {source}:",
            "    push = frame[COLUMN + column]",
            *(f"    rates[out + at + {row}] += {NUMPY(value)} * push" for row, value in added),
        ]
    return lines
