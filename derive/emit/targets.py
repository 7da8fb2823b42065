"""What is emitted for a model: a file of each target."""

from __future__ import annotations

from delagrange.derive.emit.c_header import HEADER
from delagrange.derive.emit.lanes_module import LANES
from delagrange.derive.emit.numpy_module import NUMPY_MODULE
from delagrange.derive.emit.target import Target
from delagrange.derive.emit.variational_module import VARIATIONAL
from delagrange.derive.kernel.spec import KernelSpec

Modules = tuple[tuple[str, str], ...]  # file name, text
TARGETS = (NUMPY_MODULE, HEADER, LANES, VARIATIONAL)


def emitted(spec: KernelSpec, targets: tuple[Target, ...] = TARGETS) -> Modules:
    """File name and text of what is emitted for a model.

    Raises:
        ValueError: a quantity has a name that the code of a target gives to something else, or an expression has
            a function that a target has no name for.
    """
    _check_names(spec, targets)
    _check_functions(spec, targets)
    return tuple((f"{spec.name}{target.suffix}", target.render(spec)) for target in targets)


def _check_names(spec: KernelSpec, targets: tuple[Target, ...]) -> None:
    functions = {function.name for function in spec.functions}
    given = functions | {each.name for function in spec.functions for each in function.assignments}
    for quantity in (*spec.state, *spec.inputs, *spec.parameters):
        name = quantity.name
        told = f"model {spec.name}: quantity {name!r} ({quantity.meaning})"
        if not (name.isidentifier() and name.isascii()):
            raise ValueError(f"{told} must be called by ASCII letters, digits and _, the first no digit")
        if name in given or any(target.reserves(name) for target in targets):
            raise ValueError(f"{told} has the name of something else in emitted code; choose another name")


def _check_functions(spec: KernelSpec, targets: tuple[Target, ...]) -> None:
    for function in spec.functions:
        expressions = (*(each.expression for each in function.assignments), *function.outputs)
        for target in targets:
            for unknown in (each for expression in expressions for each in target.printer.unknown(expression)):
                allowed = ", ".join(sorted(target.printer.functions.values()))
                raise ValueError(
                    f"model {spec.name}: {spec.name}{target.suffix} has no name for {unknown}; allowed are {allowed}"
                )
