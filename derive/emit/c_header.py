"""From the description of a header to its text, which the C core is compiled together with.

All choices are made here; the template places text. The same description gives the same text on any machine. What a
header has to hold is said in `delagrange/core/delagrange.h`.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from delagrange.common.header_digest import UNSTATED, header_digest
from delagrange.derive.emit.c_names import c_name, comment_text
from delagrange.derive.emit.c_printer import CPrinter, VectorPrinter
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.target import Target
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.arranged import NUMBERED
from delagrange.derive.kernel.header_spec import HeaderSpec, header_spec
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec
from delagrange.derive.notation.printer import FUNCTIONS, ExpressionPrinter
from delagrange.derive.notation.symbols import Quantity

_TEMPLATE = "model.h.jinja"
_WIDTH = 110
_INDENT = "    "

_DOUBLES = CPrinter(lambda symbol: c_name(symbol.name))


@dataclass(frozen=True)
class _Style:
    """How values are declared and read: of one vector, or of several abreast."""

    printer: VectorPrinter
    declare: str
    source: str
    store: str

    def declared(self, name: str, code: str, indent: str = _INDENT) -> list[str]:
        return _broken(f"{self.declare.format(name)} = {code};", indent)

    def stored(self, place: str, code: str, indent: str = _INDENT) -> list[str]:
        return _broken(f"{self.store.format(place)} = {code};", indent)


_ONE = _Style(VectorPrinter(lambda symbol: c_name(symbol.name)), "vec {}", "{}[{}]", "{}")
_ABREAST = _Style(
    VectorPrinter(lambda symbol: f"{c_name(symbol.name)}[v]"), "VALUE({})", "{}[v][{}]", "EACH {}"
)


def emit_header(spec: KernelSpec, module: str) -> str:
    """The text of the header of a model whose NumPy module has the text `module`; it states a digest of both.

    Raises:
        ValueError: a name or a text of the model cannot stand in C.
    """
    text = render(_TEMPLATE, _view(header_spec(spec)))
    return text.replace(UNSTATED, header_digest(module.encode(), text.encode()))


def _view(spec: HeaderSpec) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    model = spec.model
    _check(model)
    return {
        "title": "\n".join(_filled(f"{comment_text(model.title)}.")),
        "name": model.name,
        "formulation": comment_text(model.formulation),
        "digest": model.digest,
        "unstated": UNSTATED,
        "sympy_version": sp.__version__,
        "operations": spec.operations,
        "state": "\n".join(_listed(model.state)),
        "inputs": "\n".join(_listed(model.inputs)),
        "parameters": "\n".join(_listed(model.parameters)),
        "state_count": len(model.state),
        "coordinate_count": model.coordinate_count,
        "input_count": len(model.inputs),
        "parameter_count": len(model.parameters),
        "constant_count": spec.constant_count,
        "all_constant_count": len(spec.constants),
        "has_validity": int(spec.validity is not None),
        "energy_count": len(spec.energy_names),
        "constants_body": "\n".join(_constants_lines(spec)),
        "reference_body": "\n".join(_reference_lines(spec)),
        "rates_body": "\n".join(_rates_lines(spec)),
        "stretches_body": "\n".join(_stretches_lines(spec)),
        "validity_body": "\n".join(_validity_lines(spec)),
        "motion_body": "\n".join(_motion_lines(spec)),
        "columns_body": "\n".join(_columns_lines(spec)),
        "energies_body": "\n".join(_energies_lines(spec)),
        "energies": ", ".join(spec.energy_names),
    }


def _check(model: KernelSpec) -> None:
    """That names stay apart and no text ends its comment."""
    quantities = (*model.state, *model.inputs, *model.parameters)
    names = [c_name(quantity.name) for quantity in quantities]
    if c_name(model.name) == "" or len(set(names)) < len(names):
        raise ValueError(f"model {model.name}: two quantities have one name in C")
    for quantity in quantities:
        for text in (quantity.text, quantity.unit, quantity.meaning):
            comment_text(text)


def _broken(line: str, indent: str) -> list[str]:
    """A statement over as many lines as it needs."""
    return textwrap.wrap(
        line, _WIDTH, initial_indent=indent, subsequent_indent=indent + 2 * _INDENT,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip


def _filled(text: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, subsequent_indent=" * ", break_on_hyphens=False)


def _listed(quantities: Sequence[Quantity]) -> list[str]:
    """A quantity a line, for a comment."""
    if not quantities:
        return [" *     none"]
    return [
        f" *     {place} {quantity.name} [{quantity.unit}], {quantity.meaning}"
        for place, quantity in enumerate(quantities)
    ]


# --- bodies of functions ---------------------------------------------------------------------------------


def _statements(assignments: Iterable[Assignment], style: _Style) -> list[str]:
    lines: list[str] = []
    for assignment in assignments:
        lines += [f"{_INDENT}/* {comment_text(assignment.comment)} */"] if assignment.comment else []
        lines += style.declared(c_name(assignment.name), style.printer.argument(assignment.expression))
    return lines


def _loads(function: KernelFunction, spec: HeaderSpec, style: _Style) -> list[str]:
    """What a function needs of state, inputs and constants; those that it does not need at all are named."""
    groups = (
        ("state", [entry.name for entry in spec.model.state]),
        ("input", [entry.name for entry in spec.model.inputs]),
        ("constant", [constant.name for constant in spec.constants]),
    )
    lines: list[str] = []
    for source, names in groups:
        used = [(place, name) for place, name in enumerate(names) if function.uses(name)]
        lines += [] if used else [f"{_INDENT}(void){source};"]
        for place, name in used:
            lines += style.declared(c_name(name), style.source.format(source, place))
    return lines


def _body(function: KernelFunction, spec: HeaderSpec, style: _Style) -> list[str]:
    return [*_loads(function, spec, style), *_statements(function.assignments, style)]


def _rates_lines(spec: HeaderSpec) -> list[str]:
    lines = _body(spec.rates, spec, _ABREAST)
    for place, rate in enumerate(spec.rates.outputs):
        lines += _ABREAST.stored(f"rate[v][{place}]", _ABREAST.printer.argument(rate))
    return lines


def _stretches_lines(spec: HeaderSpec) -> list[str]:
    """`least` of the principal stretches and `most` of those in the plane; the one through the thickness last."""
    function = spec.principal_stretches
    first, second, thickness = map(_ONE.printer.argument, function.outputs)
    in_plane = [first] if first == second else [first, second]
    return [
        *_body(function, spec, _ONE),
        *_ONE.stored("*least", _nested("smaller", [*in_plane, thickness])),
        *_ONE.stored("*most", _nested("larger", in_plane)),
    ]


def _nested(function: str, values: list[str]) -> str:
    first, *others = values
    return f"{function}({first}, {_nested(function, others)})" if others else first


def _validity_lines(spec: HeaderSpec) -> list[str]:
    function = spec.validity
    if function is None:
        return []
    return [*_body(function, spec, _ONE), *_ONE.stored("*room", _ONE.printer.argument(function.outputs[0]))]


def _motion_lines(spec: HeaderSpec) -> list[str]:
    size = len(spec.model.state)
    lines = _body(spec.motion, spec, _ONE)
    for place, rate in enumerate(spec.motion.outputs[:size]):
        lines += _ONE.stored(f"rate[{place}]", _ONE.printer.argument(rate))
    slopes, slope_names = _named("slope", spec.slopes)
    pushes, _ = _named("push", spec.input_slopes)
    trace = sp.Add(*(slope_names[place, place] for place in range(size)))
    return [*lines, *slopes, *_ONE.stored("*trace", _ONE.printer.argument(trace)), *pushes]


def _named(stem: str, matrix: sp.Matrix) -> tuple[list[str], sp.Matrix]:
    """Values of a name of their own for every entry that is not a number, and the matrix in those names."""
    lines, names = [], sp.Matrix(matrix)
    for row in range(matrix.rows):
        for column in range(matrix.cols):
            if not matrix[row, column].is_number:
                names[row, column] = sp.Symbol(f"{stem}_{row + 1}_{column + 1}")
                code = _ONE.printer.argument(matrix[row, column])
                lines += _ONE.declared(names[row, column].name, code)
    return lines, names


def _columns_lines(spec: HeaderSpec) -> list[str]:
    """Rate of a group of columns: the Jacobian times them, and what the drives that they follow add."""
    size, inputs = len(spec.model.state), len(spec.model.inputs)
    _, slopes = _named("slope", spec.slopes)
    _, pushes = _named("push", spec.input_slopes)
    along = [sp.Symbol(f"along_{place + 1}") for place in range(size)]
    pushed = [sp.Symbol(f"pushed_{place + 1}") for place in range(inputs)]
    rates = [
        sp.Add(
            *(slopes[row, column] * along[column] for column in range(size)),
            *(pushes[row, column] * pushed[column] for column in range(inputs)),
        )
        for row in range(size)
    ]
    used = {symbol for rate in rates for symbol in rate.free_symbols}
    indent, lines = 2 * _INDENT, []
    for source, symbols in (("tangent", along), ("push", pushed)):
        for place, symbol in enumerate(symbols):
            if symbol in used:
                lines += _ONE.declared(symbol.name, f"{source}[group][{place}]", indent)
    if not used & set(pushed):
        lines.append(f"{indent}(void)push;")
    for place, rate in enumerate(rates):
        lines += _ONE.stored(f"moved[group][{place}]", _ONE.printer.argument(rate), indent)
    return lines


def _energies_lines(spec: HeaderSpec) -> list[str]:
    function = spec.energies
    if function is None:
        return []
    lines = _body(function, spec, _ONE)
    for place, value in enumerate(function.outputs):
        lines += _ONE.stored(f"energy[{place}]", _ONE.printer.argument(value))
    return lines


def _constants_lines(spec: HeaderSpec) -> list[str]:
    """Of plain doubles, once a trajectory."""
    values = [constant.expression for constant in spec.constants]
    volume = spec.volume
    uses_volume = volume is not None and any(volume.name in _names_in(value) for value in values)
    needed = [volume.expression, *values] if uses_volume else values
    lines = _parameter_loads(needed, spec.model)
    if uses_volume:
        lines.append(f"{_INDENT}/* {comment_text(volume.comment)} */")
        lines += _broken(f"const double {c_name(volume.name)} = {_DOUBLES(volume.expression)};", _INDENT)
    for place, value in enumerate(values):
        lines += _broken(f"constant[{place}] = {_DOUBLES(value)};", _INDENT)
    return lines if values else [*lines, f"{_INDENT}(void)constant;"]


def _reference_lines(spec: HeaderSpec) -> list[str]:
    values = spec.model.reference_state
    lines = _parameter_loads(values, spec.model)
    for place, value in enumerate(values):
        lines += _broken(f"state[{place}] = {_DOUBLES(value)};", _INDENT)
    return lines


def _parameter_loads(values: Sequence[sp.Expr], model: KernelSpec) -> list[str]:
    used = {name for value in values for name in _names_in(value)}
    lines = [
        f"{_INDENT}const double {c_name(parameter.name)} = parameter[{place}];"
        for place, parameter in enumerate(model.parameters)
        if parameter.name in used
    ]
    return lines or [f"{_INDENT}(void)parameter;"]


def _names_in(expression: sp.Expr) -> set[str]:
    return {symbol.name for symbol in expression.free_symbols}


HEADER = Target(
    ".h",
    ExpressionPrinter(FUNCTIONS),
    lambda spec: emit_header(spec, emit(spec)),
    numbered=NUMBERED | {"slope", "push", "along", "pushed", "room"},
)
