"""From the description of a variational kernel to the text of a module that Numba compiles.

All choices are made here; the template places text. The same description gives the same text on any
machine.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from keyword import iskeyword
from typing import Any

import sympy as sp

from delagrange.derive.emit.code_lines import WIDTH, broken
from delagrange.derive.emit.compiled_lines import (
    PRINTER,
    assignment_lines,
    constants_lines,
    extreme_stretches_lines,
)
from delagrange.derive.emit.lane_rows import Rows, placed, total
from delagrange.derive.emit.runge_kutta import Pair, Row, dop853
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.spec import KernelFunction
from delagrange.derive.kernel.variational_spec import VariationalSpec

_TEMPLATE = "variational_module.py.jinja"
_CONTROL = {"safety": 0.9, "growth": 0.04375, "memory": 0.025}  # 0.7 / 8 and 0.4 / 8, of squared errors

_OWN_NAMES = frozenset(  # of the functions that the equations are placed in, and what they call
    {"frame", "sources", "columns", "vector", "rates", "out", "column", "at", "push", "least", "most"}
    | {"min", "max", "range", "np", "numba"}
)


def emit_variational(spec: VariationalSpec) -> str:
    """The text of the compiled module that `spec` describes.

    Raises:
        ValueError: a quantity of the model has a name that the module needs for itself.
    """
    _check_names(spec)
    return render(_TEMPLATE, _view(spec, dop853()))


def _check_names(spec: VariationalSpec) -> None:
    model = spec.model
    for quantity in (*model.state, *model.inputs, *model.parameters):
        if quantity.name in _OWN_NAMES or not quantity.name.isidentifier() or iskeyword(quantity.name):
            raise ValueError(
                f"{model.name}: no quantity of a compiled kernel may be called {quantity.name!r}"
            )


def _view(spec: VariationalSpec, pair: Pair) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    model, places = spec.model, _places(spec)
    return {
        **_CONTROL,
        "command": model.origin.command,
        "title": model.title,
        "name": model.name,
        "digest": model.digest,
        "sympy_version": sp.__version__,
        "operations": spec.operations,
        "state_count": len(model.state),
        "coordinate_count": model.coordinate_count,
        "input_count": len(model.inputs),
        "constant_count": len(spec.constants),
        "places": places,
        "frame_size": total(places),
        "last": pair.last,
        "nodes": ["0.0", *(repr(stage.node) for stage in pair.stages)],
        "table": [_row_text(row, pair.last, 8) for row in ((), *(stage.row for stage in pair.stages))],
        "fifth": _row_text(pair.errors[0], pair.last, 4),
        "third": _row_text(pair.errors[1], pair.last, 4),
        "constants_body": "\n".join(constants_lines(model.parameters, spec.volume, spec.constants)),
        "motion_body": "\n".join(_motion_lines(spec)),
        "stretches_body": "\n".join(_stretches_lines(spec)),
        "has_limits": spec.validity is not None,
        "validity_body": "\n".join(_validity_lines(spec)),
    }


def _places(spec: VariationalSpec) -> tuple[Rows, ...]:
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


def _loads(function: KernelFunction, spec: VariationalSpec) -> list[str]:
    """What the function needs of state, inputs and constants, from their places."""
    model = spec.model
    groups = (
        ("vector[{}]", [entry.name for entry in model.state]),
        ("frame[INPUT + {}]", [entry.name for entry in model.inputs]),
        ("frame[CONSTANT + {}]", [constant.name for constant in spec.constants]),
    )
    return [
        f"    {name} = {source.format(number)}"
        for source, names in groups
        for number, name in enumerate(names)
        if function.uses(name)
    ]


def _motion_lines(spec: VariationalSpec) -> list[str]:
    size = len(spec.model.state)
    slopes, slope_names = _named("slope", spec.slopes)
    pushes, push_names = _named("push", spec.input_slopes)
    trace = sp.Add(*(slope_names[place, place] for place in range(size)))
    return [
        *_loads(spec.motion, spec),
        *(line for a in spec.motion.assignments for line in assignment_lines(a, "    ")),
        *(line for place, rate in enumerate(spec.rates) for line in _store(f"out + {place}", rate, "    ")),
        *slopes,
        *_store("out + STATE_COUNT * (columns + 1)", trace, "    "),
        *pushes,
        "    for column in range(columns):",
        *(f"        {line}" for line in _column_lines(slope_names, push_names)),
    ]


def _store(place: str, value: sp.Expr, indent: str) -> list[str]:
    return broken(f"rates[{place}] = ", value, PRINTER, indent)


def _named(stem: str, matrix: sp.Matrix) -> tuple[list[str], sp.Matrix]:
    """Assignments of a name to every entry that is not a number, and the matrix in those names."""
    lines, names = [], sp.Matrix(matrix)
    for row, column in _entries(matrix):
        if not matrix[row, column].is_number:
            names[row, column] = sp.Symbol(f"{stem}_{row + 1}_{column + 1}")
            lines += broken(f"{names[row, column]} = ", matrix[row, column], PRINTER, "    ")
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
            *(f"    rates[out + at + {row}] += {PRINTER(value)} * push" for row, value in added),
        ]
    return lines


def _stretches_lines(spec: VariationalSpec) -> list[str]:
    function = spec.principal_stretches
    statements = (line for a in function.assignments for line in assignment_lines(a, "    "))
    return [*_loads(function, spec), *statements, *extreme_stretches_lines(function)]


def _validity_lines(spec: VariationalSpec) -> list[str]:
    function = spec.validity
    if function is None:
        return []
    statements = (line for a in function.assignments for line in assignment_lines(a, "    "))
    return [*_loads(function, spec), *statements, *broken("return ", function.outputs[0], PRINTER, "    ")]
