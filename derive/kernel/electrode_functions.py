"""Functions and values of a model module that say what its electrodes carry, and what they let through."""

from __future__ import annotations

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.kernel.function import kernel_function
from delagrange.derive.kernel.spec import Assignment, KernelFunction


def charge_assignments(eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    """The rate of change of the charge density by name; none where no charge is part of the state."""
    balance = eom.charge_balance
    if balance is None:
        return ()
    return (
        Assignment(balance.rate.name, balance.law, "current of the source less that which leaks [A/m^2]"),
    )


def electrodes(eom: EquationsOfMotion) -> KernelFunction:
    """Nominal field and nominal charge density by one name, whichever of them drives the electrodes."""
    return kernel_function(
        eom,
        "electrodes",
        "Nominal electric field and nominal charge density of the electrodes.",
        "V/m, C/m^2",
        (2,),
        (),
        [eom.electrodes.field, eom.electrodes.charge],
    )


def charge_powers(eom: EquationsOfMotion) -> tuple[KernelFunction, ...]:
    """What the source of the current puts in, and what the leakage takes."""
    balance, volume = eom.charge_balance, eom.membrane.volume
    if balance is None:
        return ()
    source, leakage = volume * balance.source_density, volume * balance.leakage_density
    return (
        kernel_function(
            eom, "source_power", "Power that the source of the current puts in.", "W", (), (), [source]
        ),
        kernel_function(eom, "leakage_power", "Power that the leakage dissipates.", "W", (), (), [leakage]),
    )
