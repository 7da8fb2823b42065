"""Systems of first-order equations that are no membranes, through the emission of this package."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

import sympy as sp

from delagrange.derive.emit.c_header import emit_header
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.variational_module import emit_variational
from delagrange.derive.kernel.spec import KernelFunction, KernelSpec
from delagrange.derive.notation.symbols import Quantity


def first_order(
    name: str,
    rates: dict[str, sp.Expr],
    start: tuple[sp.Expr, ...],
    inputs: tuple[str, ...] = (),
    parameters: tuple[str, ...] = (),
    coordinate_count: int = 0,
) -> KernelSpec:
    """Described as a model, from the rate of every state variable by its name; its stretches are constant ones.

    `start`: the reference state. Quantities are pure numbers and time is in seconds.
    """
    state = tuple(rates)
    motion = sp.Matrix([sp.sympify(rate) for rate in rates.values()])

    def function(called: str, shape: tuple[int, ...], outputs: sp.Matrix | tuple) -> KernelFunction:
        return KernelFunction(called, f"{called} of {name}.", "1/s", shape, (), tuple(outputs))

    by_inputs = motion.jacobian([sp.Symbol(entry) for entry in inputs]) if inputs else ()
    functions = (
        function("rhs", (len(state),), motion),
        function(
            "jacobian", (len(state), len(state)), motion.jacobian([sp.Symbol(entry) for entry in state])
        ),
        function("input_jacobian", (len(state), len(inputs)), by_inputs),
        function("principal_stretches", (3,), (sp.S.One, sp.S.One, sp.S.One)),
    )
    return KernelSpec(
        name=name, title=f"The system {name}", load_case=name, formulation="given", remark="",
        coordinate_count=coordinate_count, state=_quantities(state), inputs=_quantities(inputs),
        parameters=_quantities(parameters), reactions=(), functions=functions,
        reference_state=tuple(map(sp.sympify, start)), formulas=(), verdicts=(), digest="none",
        quantities=(), body="A system", start="Where it begins.",
    )  # fmt: skip


def _quantities(names: tuple[str, ...]) -> tuple[Quantity, ...]:
    return tuple(Quantity(sp.Symbol(name), name, name, name, "1", name) for name in names)


def lorenz() -> KernelSpec:
    """Lorenz (1963), J. Atmos. Sci. 20, 130, Eqs. (25)-(27)."""
    x, y, z, sigma, rho, beta = sp.symbols("x y z sigma rho beta")
    rates = {"x": sigma * (y - x), "y": x * (rho - z) - y, "z": x * y - beta * z}
    return first_order("lorenz", rates, (1, 1, 1), parameters=("sigma", "rho", "beta"))


def duffing() -> KernelSpec:
    """x'' + damping x' - x + x^3 = force, two wells; the place is a coordinate, the speed its rate."""
    place, speed, damping, force = sp.symbols("place speed damping force")
    rates = {"place": speed, "speed": place - place**3 - damping * speed + force}
    return first_order("duffing", rates, (1, 0), ("force",), ("damping",), coordinate_count=1)


def written(spec: KernelSpec, folder: Path) -> ModuleType:
    """The emitted NumPy module, with its header and kernel beside it; `folder` must be on Python's path."""
    module = emit(spec)
    (folder / f"{spec.name}.py").write_text(module, encoding="utf-8")
    (folder / f"{spec.name}.h").write_text(emit_header(spec, module), encoding="utf-8")
    (folder / f"{spec.name}_variational.py").write_text(emit_variational(spec), encoding="utf-8")
    return import_module(spec.name)
