"""What is so at rest, by the parameters of the model: the state in which it begins, and how stiff its springs are."""

from __future__ import annotations

import sympy as sp

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.kernel.function import named
from delagrange.derive.kernel.spec import SpringAtRest


def reference_state(eom: EquationsOfMotion) -> tuple[sp.Expr, ...]:
    """At rest in the reference configuration, uncharged; a dashpot along a held axis has relaxed to its stretch.

    Where the relation between the stretches begins elsewhere, dashpots have relaxed to the stretches there.
    """
    load_case, n = eom.load_case, len(eom.load_case.coordinates)
    begin = load_case.start or (sp.Integer(1),) * n
    at_start = dict(zip((c.value.symbol for c in load_case.coordinates), begin, strict=True))
    stretches = [stretch.subs(at_start) for stretch in load_case.stretches]
    relaxed = {
        xi: stretches[place % len(stretches)]
        for place, xi in reversed([*enumerate(load_case.inelastic_stretches)])
    }
    uncharged = () if eom.charge_balance is None else (sp.Integer(0),)
    flowing = (relaxed[internal.value.symbol] for internal in load_case.internals)
    values = (*begin, *[sp.Integer(0)] * n, *flowing, *uncharged)
    return tuple(named(value, eom.quantities) for value in values)


def springs_at_rest(eom: EquationsOfMotion) -> tuple[SpringAtRest, ...]:
    """Every spring with its shear modulus at rest, which must be positive for it to be one."""
    return tuple(
        SpringAtRest(
            name,
            tuple(parameter.name for parameter in energy.parameters),
            named(energy.shear_modulus, eom.quantities),
        )
        for name, energy in eom.membrane.springs
    )


def start_text(eom: EquationsOfMotion) -> str:
    """What that state is, in a sentence."""
    if eom.load_case.start is not None:
        return "State at rest where the relation between the stretches begins; dashpots have relaxed to the stretches."
    if eom.load_case.reactions:
        return (
            "State at rest with the free axis undeformed; a dashpot along the held axis has relaxed "
            "to its stretch."
        )
    return "State at rest in the reference configuration."
