"""What is emitted for a model: the files of each target, and the names that their code keeps for itself."""

from __future__ import annotations

import re

from delagrange.derive.emit.lanes_module import emit_lanes
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.emit.variational_module import emit_variational
from delagrange.derive.kernel.lane_spec import lane_spec
from delagrange.derive.kernel.spec import KernelSpec
from delagrange.derive.kernel.variational_spec import variational_spec

_NAMES_IN_CODE = (  # beside the values and functions of a module: what its functions and kernels are written with
    "state", "inputs", "parameters", "np", "numba", "work", "rows", "out", "k", "columns", "frame", "sources", "vector",
    "rates", "reference_state", "shear_moduli_at_rest", "volume", "least", "most",
)  # fmt: skip
_NUMBERED_IN_CODE = re.compile("(constant|factor|product|reciprocal|shared|room)(_[0-9]+)?")


def emitted(spec: KernelSpec) -> tuple[tuple[str, str], ...]:
    """File name and text of what is emitted for a model: its NumPy module and its two compiled kernels."""
    return (
        (f"{spec.name}.py", emit(spec)),
        (f"{spec.name}_lanes.py", emit_lanes(lane_spec(spec))),
        (f"{spec.name}_variational.py", emit_variational(variational_spec(spec))),
    )


def check_taken(spec: KernelSpec) -> None:
    """No quantity may have a name that emitted code gives to something else.

    Raises:
        ValueError: one has.
    """
    functions = [function.name for function in spec.functions]
    values = [each.name for function in spec.functions for each in function.assignments]
    for quantity in (*spec.state, *spec.inputs, *spec.parameters):
        name = quantity.name
        if name in (*functions, *values, *_NAMES_IN_CODE) or _NUMBERED_IN_CODE.fullmatch(name):
            raise ValueError(
                f"model {spec.name}: quantity {name!r} ({quantity.meaning}) has the name of something else "
                "in emitted code; choose another name"
            )
