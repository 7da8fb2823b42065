"""Functions of a model module that say where energy is, where it goes, and how far the energies hold."""

from __future__ import annotations

import sympy as sp

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.equations.internal_rates import DashpotLoss
from delagrange.derive.kernel.function import kernel_function
from delagrange.derive.kernel.spec import Assignment, KernelFunction
from delagrange.derive.membrane.description import REACTION_IN_POTENTIAL
from delagrange.derive.notation import symbols as s

_POTENTIAL_NAMES = {"forces": "force_potential", "electrostatic": "electrostatic_energy"}


def dashpot_power(eom: EquationsOfMotion) -> KernelFunction:
    """Stress times strain rate by name: what flows gives squares, which no rounding makes negative."""
    lost, volume = eom.dissipation, eom.membrane.volume
    assignments: list[Assignment] = []
    densities: list[sp.Expr] = []
    for number, dashpot in enumerate(lost.dashpots, start=1):
        own, density = _dashpot_assignments(dashpot, f"_{number}" if len(lost.dashpots) > 1 else "")
        assignments += own
        densities.append(density)
    others = [(f"{term.name}_power", term) for term in lost.rayleigh]
    assignments += [
        Assignment(name, 2 * term.function, f"power lost to {term.meaning} [W]") for name, term in others
    ]
    power = sp.Add(volume * sp.Add(*densities), *(sp.Symbol(name) for name, _ in others))
    summary = "Power that the dashpots" + (" and the medium" if _in_medium(eom) else "") + " dissipate."
    return kernel_function(eom, "dashpot_power", summary, "W", (), assignments, [power])


def _in_medium(eom: EquationsOfMotion) -> bool:
    return any(term.name == "medium" for term in eom.dissipation.rayleigh)


def _dashpot_assignments(dashpot: DashpotLoss, branch: str) -> tuple[list[Assignment], sp.Expr]:
    """Stresses and strain rates of a branch's dashpot by name, and their product [W/m^3]."""
    of = f"dashpot {branch[1:]}" if branch else "dashpot"
    stresses = tuple(sp.Symbol(f"deviatoric_stress{branch}_{axis}") for axis in (1, 2, 3))
    rates = tuple(sp.Symbol(f"strain_rate{branch}_{axis}") for axis in (1, 2, 3))
    on = "the dashpot" if not branch else of
    assignments = [
        Assignment(name.name, value, comment if axis == 0 else "")
        for names, values, comment in (
            (stresses, dashpot.deviators, f"deviatoric stress on {on} [Pa]"),
            (rates, dashpot.strain_rates(stresses), f"strain rate of {on} [1/s]"),
        )
        for axis, (name, value) in enumerate(zip(names, values, strict=True))
    ]
    return assignments, sp.Add(*(stress * rate for stress, rate in zip(stresses, rates, strict=True)))


def potential(eom: EquationsOfMotion) -> KernelFunction:
    parts = tuple(
        (_POTENTIAL_NAMES.get(part.name, f"{part.name}_energy"), part.expression)
        for part in eom.energies.parts
    )
    total = sp.Add(*(sp.Symbol(name) for name, _ in parts), evaluate=True)
    has_reaction = eom.load_case.formulation == REACTION_IN_POTENTIAL
    inserted = ", each with its share of the inserted reaction" if has_reaction else ""
    drive = "field" if eom.membrane.field == s.FIELD else "charge"
    return kernel_function(
        eom,
        "potential_energy",
        f"Potential energy of springs, applied forces and {drive}" + inserted + ".",
        "J",
        (),
        tuple(Assignment(name, part) for name, part in parts),
        [total],
    )


def validity(eom: EquationsOfMotion) -> tuple[KernelFunction, ...]:
    """Where a strain energy has a limit: the least of what is left to the limits."""
    if not eom.validity:
        return ()
    assignments = tuple(
        Assignment(f"room_{number}", limit, "what is left to the limit of each strain energy" * (number == 1))
        for number, limit in enumerate(eom.validity, start=1)
    )
    least = sp.Min(*(sp.Symbol(assignment.name) for assignment in assignments))
    return (
        kernel_function(
            eom,
            "validity",
            "Positive where all strain energies hold, zero at the first of their limits.",
            "1",
            (),
            assignments,
            [least],
        ),
    )
