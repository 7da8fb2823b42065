"""From the description of a module to that of its header: what the C core is compiled together with.

One set of constants for all of it, those of the rates first, so that a run of many trajectories carries no others.
Nothing is differentiated here: the Jacobians are those of the module. Rates and both Jacobians become one function,
so that what they share is computed once.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.kernel.arranged import arranged, constants_for, operations_of, volume_of
from delagrange.derive.kernel.compiled_spec import joined
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec

ENERGIES = ("kinetic_energy", "potential_energy")
POWERS = ("force_power", "dashpot_power", "source_power", "leakage_power")


@dataclass(frozen=True)
class HeaderSpec:
    """The equations of a model as compiled code needs them, whatever language it is written in."""

    model: KernelSpec
    volume: Assignment | None  # of the membrane, in terms of the parameters, where constants need it
    constants: tuple[Assignment, ...]  # what does not move, in terms of volume and parameters
    constant_count: int  # how many of them, the first, are enough for the rates and for the limits
    rates: KernelFunction  # of the state, in terms of state, inputs and constants
    principal_stretches: KernelFunction
    validity: (
        KernelFunction | None
    )  # what is left to the limits of the energies [1]; None where there are none
    motion: KernelFunction  # rates, then the Jacobian by the state, then that by the inputs, row by row
    energies: KernelFunction | None  # energies and powers, as far as the module has them
    energy_names: tuple[str, ...]

    @property
    def operations(self) -> int:
        """Of one evaluation of the rates, per trajectory."""
        return operations_of(self.rates)

    @property
    def slopes(self) -> sp.Matrix:
        """Jacobian of the rates by the state, (n_state, n_state), in the names of `motion`."""
        size = len(self.model.state)
        return sp.Matrix(size, size, list(self.motion.outputs[size : size + size * size]))

    @property
    def input_slopes(self) -> sp.Matrix:
        """Jacobian of the rates by the inputs, (n_state, n_inputs), in the names of `motion`."""
        size, inputs = len(self.model.state), len(self.model.inputs)
        return sp.Matrix(size, inputs, list(self.motion.outputs[size + size * size :]))


def header_spec(spec: KernelSpec) -> HeaderSpec:
    """Describe the header of a model."""
    functions = {function.name: function for function in spec.functions}
    constants = constants_for(spec)
    rates = arranged(functions["rhs"], spec, constants)
    principal = arranged(functions["principal_stretches"], spec, constants)
    limit = functions.get("validity")
    validity = None if limit is None else arranged(limit, spec, constants)
    count = len(constants.values)
    parts = [functions[name] for name in ("rhs", "jacobian", "input_jacobian")]
    motion = arranged(joined("motion", parts), spec, constants)
    energy_names = tuple(name for name in (*ENERGIES, *POWERS) if name in functions)
    energies = None
    if energy_names:
        energies = arranged(joined("energies", [functions[n] for n in energy_names]), spec, constants)
    volume = volume_of(functions["rhs"])
    return HeaderSpec(
        spec,
        volume,
        constants.assignments(),
        count,
        rates,
        principal,
        validity,
        motion,
        energies,
        energy_names,
    )
