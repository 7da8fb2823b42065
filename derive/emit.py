"""From a kernel description to the text of a Python module.

All choices are made here; the template places text and decides nothing. The same description gives
the same text on any machine: no date, no path, no host, no set iterated.
"""

from __future__ import annotations

import textwrap
from typing import Any

import jinja2
import jinja2.meta
import sympy as sp

from delagrange.derive.kernel_spec import Assignment, KernelFunction, KernelSpec
from delagrange.derive.printer import PAPER_TEXT, ExpressionPrinter
from delagrange.derive.symbols import Quantity
from delagrange.derive.verdict import Outcome, Verdict

_WIDTH = 110
_TEMPLATE = "numpy_module.py.jinja"

_NUMPY = ExpressionPrinter(lambda symbol: symbol.name, {sp.log: "np.log", sp.exp: "np.exp"})


def _folded(text: str, indent: str, times: str) -> list[str]:
    """A term inside brackets, folded before factors where it is too long."""
    first, *others = _factors(text, times)
    lines = [f"{indent}{first}"]
    for factor in others:
        if len(lines[-1]) + len(times) + len(factor) > _WIDTH:
            lines.append(f"{indent}    {times.lstrip()}{factor}")
        else:
            lines[-1] += f"{times}{factor}"
    return lines


def _factors(text: str, times: str) -> list[str]:
    """The factors of a printed product that stand outside of brackets."""
    pieces, depth, start = [], 0, 0
    for place, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth == 0 and text.startswith(times, place) and times.strip():
            pieces.append(text[start:place])
            start = place + len(times)
    return [*pieces, text[start:]]


def _broken(head: str, expression: sp.Expr, printer: ExpressionPrinter, indent: str) -> list[str]:
    """`head expression` on one line, or in brackets over several where it is too long."""
    line = f"{indent}{head}{printer(expression)}"
    if len(line) <= _WIDTH:
        return [line]
    if isinstance(expression, sp.Add):
        return _broken_sum(head, expression, printer, indent)
    return _broken_product(head, expression, printer, indent)


def _broken_sum(head: str, expression: sp.Add, printer: ExpressionPrinter, indent: str) -> list[str]:
    """A term a line."""
    first, *others = printer.terms(expression)
    first = first[2:] if first.startswith("+ ") else "-" + first[2:]
    body = [line for term in (first, *others) for line in _folded(term, f"{indent}    ", printer.times)]
    return [f"{indent}{head}(", *body, f"{indent})"]


def _broken_product(head: str, expression: sp.Expr, printer: ExpressionPrinter, indent: str) -> list[str]:
    """The factors on one line and the longest sum among them over the next; or folded, where there is none."""
    sums = [factor for factor in sp.Mul.make_args(expression) if isinstance(factor, sp.Add)]
    if not sums:
        return [
            f"{indent}{head}(",
            *_folded(printer(expression), f"{indent}    ", printer.times),
            f"{indent})",
        ]
    longest = max(sums, key=lambda factor: len(printer(factor)))
    rest = expression / longest
    before = printer(rest) if sp.denom(rest) == 1 else f"({printer(rest)})"
    return _broken_sum(f"{head}{before}{printer.times}", longest, printer, indent)


def _assignment_lines(assignment: Assignment) -> list[str]:
    comment = [f"    # {assignment.comment}"] if assignment.comment else []
    return comment + _broken(f"{assignment.name} = ", assignment.expression, _NUMPY, "    ")


def _unpacked(names: list[str], source: str) -> list[str]:
    """`a, b = source`, a name a line where it is too long."""
    joined = f"    {', '.join(names)}{',' if len(names) == 1 else ''} = {source}"
    if len(joined) <= _WIDTH:
        return [joined]
    return ["    (", *(f"        {name}," for name in names), f"    ) = {source}"]


def _arguments(function: KernelFunction, quantities: tuple[Quantity, ...], source: str) -> list[str]:
    """Unpack what the function uses, `_` for what it does not; nothing where it uses none."""
    names = [quantity.name if function.uses(quantity.name) else "_" for quantity in quantities]
    return [] if all(name == "_" for name in names) else _unpacked(names, source)


def _return_lines(function: KernelFunction) -> list[str]:
    outputs = [_NUMPY(output) for output in function.outputs]
    if not function.shape:
        return _broken("return ", function.outputs[0], _NUMPY, "    ")
    line = f"    return _stack({function.shape!r}, {', '.join(outputs)})"
    if len(line) <= _WIDTH:
        return [line]
    return [
        "    return _stack(",
        f"        {function.shape!r},",
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
        *(line for assignment in function.assignments for line in _assignment_lines(assignment)),
        *_return_lines(function),
    ]
    return {
        "name": function.name,
        "summary": function.summary,
        "returns": f"Array {_shape_text(function.shape)} [{function.unit}].",
        "body": "\n".join(body),
    }


def _equation_lines(left: sp.Expr, right: sp.Expr) -> list[str]:
    return _broken(f"{PAPER_TEXT(left)} = ", right, PAPER_TEXT, "    ")


def _verdict_line(verdict: Verdict) -> str:
    text = f"Eq. ({verdict.number}): {verdict.outcome}"
    if verdict.outcome is Outcome.SCALED:
        text += f" of the derived one by {PAPER_TEXT(verdict.factor)}"
    return text


def _as_float(value: sp.Expr) -> str:
    return f"{value}.0" if value.is_Integer else _NUMPY(value)


def _reference_names(spec: KernelSpec) -> list[str]:
    used = {symbol.name for value in spec.reference_state for symbol in value.free_symbols}
    return [quantity.name if quantity.name in used else "_" for quantity in spec.parameters]


def _view(spec: KernelSpec) -> dict[str, Any]:
    """Everything that the template places, ready as text."""
    names = _reference_names(spec)
    return {
        "title": spec.title,
        "name": spec.name,
        "load_case": spec.load_case,
        "formulation": spec.formulation,
        "remark": textwrap.fill(spec.remark, _WIDTH),
        "equations": "\n".join(
            line for left, right in spec.formulas for line in _equation_lines(left, right)
        ),
        "verdicts": "\n".join(
            textwrap.fill(_verdict_line(v), _WIDTH, initial_indent="    ", subsequent_indent="        ")
            for v in spec.verdicts
        ),
        "digest": spec.digest,
        "sympy_version": sp.__version__,
        "coordinate_count": spec.coordinate_count,
        "state": spec.state,
        "inputs": spec.inputs,
        "parameters": spec.parameters,
        "reactions": spec.reactions,
        "functions": [_function_view(function, spec) for function in spec.functions],
        "reference_lines": "\n".join([] if set(names) == {"_"} else _unpacked(names, "parameters")),
        "reference_state": ", ".join(_as_float(value) for value in spec.reference_state),
        "held": bool(any(value.free_symbols for value in spec.reference_state)) or spec.reactions != (),
        "state_size": len(spec.state),
    }


def _environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.PackageLoader("delagrange.derive", "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def _check_keys(environment: jinja2.Environment, view: dict[str, Any]) -> None:
    """A key that the template does not place, or lacks, is a slip in one of the two.

    Raises:
        KeyError: naming the keys without a partner.
    """
    source, _, _ = environment.loader.get_source(environment, _TEMPLATE)  # type: ignore[union-attr]
    placed = jinja2.meta.find_undeclared_variables(environment.parse(source))
    if unmatched := sorted(placed ^ set(view)):
        raise KeyError(f"template {_TEMPLATE} and its view differ in {', '.join(unmatched)}")


def emit(spec: KernelSpec) -> str:
    """The text of the NumPy module that `spec` describes."""
    environment = _environment()
    view = _view(spec)
    _check_keys(environment, view)
    return environment.get_template(_TEMPLATE).render(view)
