"""From the description of a module to that of an ensemble kernel: many trajectories side by side."""

from __future__ import annotations

from dataclasses import dataclass

from delagrange.derive.kernel.arranged import arranged, constants_for, operations_of, volume_of
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec


@dataclass(frozen=True)
class LaneSpec:
    """An ensemble kernel, whatever language it is written in."""

    model: KernelSpec
    volume: Assignment  # of the membrane, in terms of the parameters
    constants: tuple[Assignment, ...]  # what does not move, in terms of volume and parameters
    rates: KernelFunction  # rate of change of the state, in terms of state, inputs and constants
    principal_stretches: KernelFunction
    validity: KernelFunction | None  # what is left to the limits of the energies [1]; None: they have none
    operations: int  # of one evaluation of `rates`, per trajectory


def lane_spec(spec: KernelSpec) -> LaneSpec:
    """Describe the ensemble kernel of a model."""
    functions = {function.name: function for function in spec.functions}
    constants = constants_for(spec)
    rates = arranged(functions["rhs"], spec, constants)
    principal = arranged(functions["principal_stretches"], spec, constants)
    limit = functions.get("validity")
    validity = None if limit is None else arranged(limit, spec, constants)
    volume = volume_of(functions["rhs"])
    return LaneSpec(spec, volume, constants.assignments(), rates, principal, validity, operations_of(rates))
