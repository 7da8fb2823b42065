"""From the description of a module to that of a compiled kernel, arranged for speed.

Nothing is differentiated here: the Jacobians by the state and by the inputs are those of the module. What a
kernel computes together becomes one function, so that what its parts share is computed once.
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
class CompiledSpec:
    """A kernel, whatever language it is written in."""

    model: KernelSpec
    volume: Assignment | None  # of the membrane, in terms of the parameters, where constants need it
    constants: tuple[Assignment, ...]  # what does not move, in terms of volume and parameters
    motion: KernelFunction  # rates, then row by row the Jacobians that the kernel has, by state and by inputs
    principal_stretches: KernelFunction
    validity: KernelFunction | None  # what is left to the limits of the energies [1]; None: they have none

    @property
    def operations(self) -> int:
        """Of one evaluation of `motion`."""
        return operations_of(self.motion)

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


def lane_spec(spec: KernelSpec) -> CompiledSpec:
    """Describe the kernel of many trajectories side by side."""
    return _compiled(spec, "rhs")


def variational_spec(spec: KernelSpec) -> CompiledSpec:
    """Describe the kernel of one trajectory with its variational equations."""
    return _compiled(spec, "rhs", "jacobian", "input_jacobian")


def _compiled(spec: KernelSpec, *parts: str) -> CompiledSpec:
    functions = {function.name: function for function in spec.functions}
    constants = constants_for(spec)
    motion = arranged(joined("motion", [functions[name] for name in parts]), spec, constants)
    principal = arranged(functions["principal_stretches"], spec, constants)
    limit = functions.get("validity")
    validity = None if limit is None else arranged(limit, spec, constants)
    return CompiledSpec(
        spec, volume_of(functions["rhs"]), constants.assignments(), motion, principal, validity
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
