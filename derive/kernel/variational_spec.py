"""From the description of a module to that of a kernel that carries a state and its tangent along.

Nothing is differentiated here: the Jacobians by the state and by the inputs are those of the module. The
rates and both matrices become one function, so that what they share is computed once, the accelerations
among it.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.kernel.arranged import (
    arranged,
    constants_for,
    operations_of,
    volume_of,
    without_helpers,
)
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec


@dataclass(frozen=True)
class VariationalSpec:
    """A kernel for one trajectory with its variational equations, whatever language it is written in."""

    model: KernelSpec
    volume: Assignment | None  # of the membrane, in terms of the parameters, where constants need it
    constants: tuple[Assignment, ...]  # what does not move, in terms of volume and parameters
    motion: KernelFunction  # rates, then the Jacobian by the state, then that by the inputs, row by row
    principal_stretches: KernelFunction
    validity: (
        KernelFunction | None
    )  # what is left to the limits of the energies [1]; None where there are none
    operations: int  # of one evaluation of `motion`, beside the tangent

    @property
    def rates(self) -> tuple[sp.Expr, ...]:
        """Rate of change of the state."""
        return self.motion.outputs[: len(self.model.state)]

    @property
    def slopes(self) -> sp.Matrix:
        """Jacobian of the rates by the state, (n_state, n_state)."""
        size = len(self.model.state)
        return sp.Matrix(size, size, list(self.motion.outputs[size : size + size * size]))

    @property
    def input_slopes(self) -> sp.Matrix:
        """Jacobian of the rates by the inputs, (n_state, n_inputs)."""
        size, inputs = len(self.model.state), len(self.model.inputs)
        return sp.Matrix(size, inputs, list(self.motion.outputs[size + size * size :]))


def variational_spec(spec: KernelSpec) -> VariationalSpec:
    """Describe the kernel of a model's motion and variational equations."""
    functions = {function.name: function for function in spec.functions}
    constants = constants_for(spec)
    parts = [functions[name] for name in ("rhs", "jacobian", "input_jacobian")]
    motion = arranged(joined("motion", parts), spec, constants)
    principal = arranged(functions["principal_stretches"], spec, constants)
    limit = functions.get("validity")
    validity = None if limit is None else arranged(limit, spec, constants)
    volume = volume_of(functions["rhs"])
    return VariationalSpec(
        spec, volume, constants.assignments(), motion, principal, validity, operations_of(motion)
    )


def joined(name: str, functions: list[KernelFunction]) -> KernelFunction:
    """One function with the outputs of several, one after the other, and each of their named values once.

    Raises:
        ValueError: two of the functions call different values by one name.
    """
    known: dict[str, Assignment] = {}
    outputs: list[sp.Expr] = []
    for function in functions:
        kept, own = without_helpers(function)
        for assignment in kept:
            if known.setdefault(assignment.name, assignment).expression != assignment.expression:
                raise ValueError(f"{assignment.name} of {function.name} is not what it is before")
        outputs += own
    return KernelFunction(name, "", "", (len(outputs),), tuple(known.values()), tuple(outputs))
