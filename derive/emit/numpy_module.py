"""From a kernel description to the text of a Python module.

All choices are made here; the template places text and decides nothing. The same description gives
the same text on any machine: no date, no path, no host, no set iterated.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

import sympy as sp

from delagrange.derive.check.verdict import Outcome, Verdict
from delagrange.derive.emit.python_lines import NUMPY, PYTHON_WORDS, WIDTH, assignment_lines, broken, unpacked
from delagrange.derive.emit.target import Target
from delagrange.derive.emit.template import render
from delagrange.derive.kernel.spec import KernelFunction, KernelSpec, SpringAtRest
from delagrange.derive.notation.printer import ExpressionPrinter, text_printer
from delagrange.derive.notation.symbols import Quantity

_TEMPLATE = "numpy_module.py.jinja"

def _arguments(function: KernelFunction, quantities: tuple[Quantity, ...], source: str) -> list[str]:
    """Unpack what the function uses, `_` for what it does not; nothing where it uses none."""
    names = [quantity.name if function.uses(quantity.name) else "_" for quantity in quantities]
    return [] if all(name == "_" for name in names) else unpacked(names, source)


def _return_lines(function: KernelFunction) -> list[str]:
    if not function.shape:
        return broken("return ", function.outputs[0], NUMPY, "    ")
    return _stacked_lines(function.shape, [NUMPY(output) for output in function.outputs])


def _stacked_lines(shape: tuple[int, ...], outputs: list[str]) -> list[str]:
    line = f"    return _stack({shape!r}, {', '.join(outputs)})"
    if len(line) <= WIDTH:
        return [line]
    return [
        "    return _stack(",
        f"        {shape!r},",
        *(f"        {output}," for output in outputs),
        "    )",
    ]


def _acceleration_lines(function: KernelFunction, spec: KernelSpec) -> list[str]:
    if not function.accelerations:
        return []
    n, names = spec.coordinate_count, function.accelerations
    if n == 1:
        return [f"    {names[0]} = rhs(state, inputs, parameters)[1]"]
    return [f"    {', '.join(names)} = rhs(state, inputs, parameters)[{n}:{2 * n}]"]


def _shape_text(shape: tuple[int, ...]) -> str:
    return f"({', '.join(str(size) for size in shape)}, ...)" if shape else "(...)"


def _function_view(function: KernelFunction, spec: KernelSpec) -> dict[str, Any]:
    body = [
        *_arguments(function, spec.state, "state"),
        *_arguments(function, spec.inputs, "inputs"),
        *_arguments(function, spec.parameters, "parameters"),
        *_acceleration_lines(function, spec),
        *(line for assignment in function.assignments for line in assignment_lines(assignment)),
        *_return_lines(function),
    ]
    return {
        "name": function.name,
        "arguments": "state, inputs, parameters",
        "summary": function.summary,
        "returns": f"Array {_shape_text(function.shape)} [{function.unit}].",
        "body": "\n".join(body),
    }


def _equation_lines(left: sp.Expr, right: sp.Expr, printer: ExpressionPrinter) -> list[str]:
    return broken(f"{printer(left)} = ", right, printer, "    ")


def _verdict_line(verdict: Verdict, printer: ExpressionPrinter) -> str:
    text = f"Eq. ({verdict.number}): {verdict.outcome}"
    if verdict.outcome is Outcome.SCALED:
        text += f" of the derived one by {printer(verdict.factor)}"
    return text


def _source_line(source: str) -> str:
    return textwrap.fill(source, WIDTH, initial_indent="    ", subsequent_indent="        ")


def _default_lines(defaults: Mapping[str, float]) -> list[str]:
    return [f"    {name!r}: {float(value)!r},".replace("'", '"') for name, value in defaults.items()]


def _as_float(value: sp.Expr) -> str:
    return f"{value}.0" if value.is_Integer else NUMPY(value)


def _of_parameters(
    spec: KernelSpec, name: str, summary: str, unit: str, outputs: tuple[sp.Expr, ...]
) -> dict[str, str]:
    """A function of the parameters alone."""
    used = {symbol.name for output in outputs for symbol in output.free_symbols}
    names = [quantity.name if quantity.name in used else "_" for quantity in spec.parameters]
    shape = (len(outputs),)
    return {
        "name": name,
        "arguments": "parameters",
        "summary": summary,
        "returns": f"Array {_shape_text(shape)} [{unit}].",
        "body": "\n".join(
            [
                *(unpacked(names, "parameters") if used else ()),
                *_stacked_lines(shape, [_as_float(output) for output in outputs]),
            ]
        ),
    }


def _at_rest(spec: KernelSpec) -> list[dict[str, str]]:
    """What is so at rest: the state in which a run begins, and how stiff the springs are."""
    start = _of_parameters(spec, "reference_state", spec.start, "the units of STATE", spec.reference_state)
    moduli = tuple(spring.shear_modulus for spring in spec.springs)
    text = "Shear modulus of each of SPRINGS at rest."
    return [start, *([_of_parameters(spec, "shear_moduli_at_rest", text, "Pa", moduli)] if moduli else [])]


def _variables(quantities: tuple[Quantity, ...]) -> str:
    return "\n".join(line for quantity in quantities for line in _variable_lines(quantity))


def _variable_lines(quantity: Quantity) -> list[str]:
    """One line, or two within brackets where it would be too long."""
    told = f'"{quantity.name}", "{quantity.text}", "{quantity.unit}", "{quantity.meaning}"'
    facts = f'"{quantity.role}", "{quantity.sign}"'
    line = f"    Variable({told}, {facts}),"
    if len(line) <= WIDTH:
        return [line]
    return ["    Variable(", f"        {told},", f"        {facts},", "    ),"]


def _spring_line(spring: SpringAtRest) -> str:
    constants = "".join(f'"{name}", ' for name in spring.constants).rstrip()
    return f'    "{spring.name}": ({constants if len(spring.constants) == 1 else constants.rstrip(",")}),'


def _view(spec: KernelSpec) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    printer = text_printer(spec.quantities)
    return {
        "body": spec.body,
        "notation": f", in the notation of {spec.origin.notation}" if spec.origin.notation else "",
        "citation": spec.origin.citation,
        "sources": "\n".join(_source_line(source) for source in spec.origin.sources),
        "has_defaults": spec.defaults is not None,
        "defaults": "\n".join(_default_lines(spec.defaults or {})),
        "title": spec.title,
        "name": spec.name,
        "load_case": spec.load_case,
        "formulation": spec.formulation,
        "remark": textwrap.fill(spec.remark, WIDTH),
        "equations": "\n".join(
            line for left, right in spec.formulas for line in _equation_lines(left, right, printer)
        ),
        "verdicts": "\n".join(
            textwrap.fill(
                _verdict_line(v, printer), WIDTH, initial_indent="    ", subsequent_indent="        "
            )
            for v in spec.verdicts
        ),
        "digest": spec.digest,
        "sympy_version": sp.__version__,
        "coordinate_count": spec.coordinate_count,
        "state": _variables(spec.state),
        "inputs": _variables(spec.inputs),
        "parameters": _variables(spec.parameters),
        "reactions": _variables(spec.reactions),
        "springs": "\n".join(_spring_line(spring) for spring in spec.springs),
        "functions": [*_at_rest(spec), *(_function_view(function, spec) for function in spec.functions)],
    }


def emit(spec: KernelSpec) -> str:
    """The text of the NumPy module that `spec` describes."""
    return render(_TEMPLATE, _view(spec))


NUMPY_MODULE = Target(
    ".py",
    NUMPY,
    emit,
    PYTHON_WORDS | {"state", "inputs", "parameters", "reference_state", "shear_moduli_at_rest"},
)
