"""Material x rheology x control x constraint: some 1,200 membranes, and the laws of mechanics that each obeys.

`CHEAP` are those of the tests of every day, chosen so that each two of their choices stand together in one;
`make test-matrix` takes all, about half an hour on two cores.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
import pytest
from described import (
    CURVED,
    RECTANGLE,
    SOFTENING,
    branches,
    emitted,
    inputs_of,
    parameters_of,
    slope,
    state_of,
)

from delagrange.derive.membrane.description import (
    BIAXIAL,
    CHARGE,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    RELATION,
    UNIAXIAL,
    Description,
    Dielectric,
    Load,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.notation import more_symbols as m

VISCOUS = {"parallel_viscosity": m.PARALLEL_VISCOSITY}
IMMERSED = {"medium_damping": m.MEDIUM_DAMPING}
RHEOLOGIES = {  # number of branches, of the material of the membrane, and what else dissipates
    "elastic": (0, {}),
    "Kelvin-Voigt": (0, VISCOUS),
    "immersed": (0, IMMERSED),
    "one branch": (1, {}),
    "two branches": (2, {}),
    "two branches and all else": (2, VISCOUS | IMMERSED),
}
CONTROLS = {
    "voltage": Dielectric(),
    "softening": Dielectric(SOFTENING),
    "charge": Dielectric(control=CHARGE),
    "current": Dielectric(control=CHARGE, leakage=m.CONDUCTIVITY),
    "softening, current": Dielectric(SOFTENING, control=CHARGE, leakage=m.CONDUCTIVITY),
}
CONSTRAINTS = {
    "equal-biaxial": (Load(EQUAL_BIAXIAL), rectangle()),
    "uniaxial": (Load(UNIAXIAL), rectangle()),
    "biaxial": (Load(BIAXIAL), rectangle()),
    "biaxial, rectangle": (Load(BIAXIAL), RECTANGLE),
    "pure shear": (Load(PURE_SHEAR), rectangle()),
    "pure shear, held": (Load(PURE_SHEAR, lateral_dashpots_free=False), RECTANGLE),
    "relation": (Load(RELATION, relation=CURVED), RECTANGLE),
}
_DEAR = ("uniaxial", "biaxial", "biaxial, rectangle")  # of two coordinates


@dataclass(frozen=True)
class Cell:
    """One membrane of the matrix."""

    material: str
    rheology: str
    control: str
    constraint: str

    @property
    def choices(self) -> tuple[str, ...]:
        return self.material, self.rheology, self.control, self.constraint

    @property
    def pairs(self) -> set[tuple]:
        """Each two of its choices, with their places."""
        return set(combinations(enumerate(self.choices), 2))

    def __str__(self) -> str:
        return " | ".join(self.choices)

    @property
    def cost(self) -> int:
        """How long its derivation takes, roughly."""
        count = 1 + RHEOLOGIES[self.rheology][0]
        return (
            count**2 * (4 if self.constraint in _DEAR else 1) * (2 if self.material == "Arruda-Boyce" else 1)
        )

    def description(self) -> Description:
        load, body = CONSTRAINTS[self.constraint]
        count, parts = RHEOLOGIES[self.rheology]
        return Description(
            "own", str(self), load, MATERIALS[self.material](ALPHA), branches(*[self.material] * count),
            body=body, dielectric=CONTROLS[self.control], **parts,
        )  # fmt: skip


MATRIX = tuple(Cell(*choices) for choices in product(MATERIALS, RHEOLOGIES, CONTROLS, CONSTRAINTS))


def covering(cells: tuple[Cell, ...]) -> tuple[Cell, ...]:
    """Cells in which each two choices that stand together in some cell do so, the cheapest that add most first."""
    pairs = {cell: cell.pairs for cell in cells}
    missing, chosen = set().union(*pairs.values()), []
    while missing:
        best = max(cells, key=lambda cell: (len(pairs[cell] & missing) / cell.cost, str(cell)))
        chosen.append(best)
        missing -= pairs[best]
    return tuple(chosen)


CHEAP = covering(tuple(cell for cell in MATRIX if cell.cost <= 4))


def check_laws(cell: Cell, rng) -> None:
    """All laws of one membrane, which is derived once."""
    module = emitted(cell.description())
    parameters, inputs = parameters_of(module), np.array(inputs_of(module))
    state = state_of(module, rng, parameters)
    check_energy_balance(module, state, inputs, parameters)
    check_jacobians(module, state, inputs, parameters)
    check_rest(module, parameters)
    if cell.constraint == "biaxial":
        check_symmetry(module, state, inputs, parameters)


def check_energy_balance(module, state, inputs, parameters):
    """d(T + Pi)/dt at constant inputs is what the source puts in less what dissipates."""

    def energy(at):
        return sum(
            getattr(module, name)(at, inputs, parameters) for name in ("kinetic_energy", "potential_energy")
        )

    rate = module.rhs(state, inputs, parameters)
    lost = module.dashpot_power(state, inputs, parameters)
    assert lost >= 0
    kinetic = slope(lambda at: module.kinetic_energy(at, inputs, parameters), state, rate)
    gained = power(module, "source_power", state, inputs, parameters) - lost
    gained -= power(module, "leakage_power", state, inputs, parameters)
    assert slope(energy, state, rate) == pytest.approx(gained, abs=1e-10 * (abs(kinetic) + lost), rel=1e-10)


def power(module, name, *arguments):
    """Of electrodes that leak; none of others."""
    return getattr(module, name)(*arguments) if hasattr(module, name) else 0.0


def check_jacobians(module, state, inputs, parameters):
    """Against complex steps of the rates."""
    for name, values, rates in (
        ("jacobian", state, lambda at: module.rhs(at, inputs, parameters)),
        ("input_jacobian", inputs, lambda at: module.rhs(state, at, parameters)),
    ):
        expected = np.transpose([slope(rates, values, direction) for direction in np.eye(len(values))])
        size = 1e-11 * np.abs(expected).max(axis=1, keepdims=True)
        found = getattr(module, name)(state, inputs, parameters)
        assert np.all(np.abs(found - expected) <= size + 1e-9 * np.abs(expected)), name


def check_rest(module, parameters):
    """Without load, the reference state stays; where a frame holds another state, dashpots at least do."""
    state = module.reference_state(parameters)
    rate = module.rhs(state, [0.0] * len(module.INPUTS), parameters)
    stays = rate if np.allclose(module.principal_stretches(state, [0.0] * 3, parameters), 1) else rate[:1]
    assert np.allclose(stays, 0, atol=1e-6)


def check_symmetry(module, state, inputs, parameters):
    """A square membrane does not know its axes apart."""
    pairs = len(module.STATE) // 2 * 2
    swapped = [place ^ 1 if place < pairs else place for place in range(len(module.STATE))]
    found = module.rhs(state[swapped], [inputs[1], inputs[0], *inputs[2:]], parameters)
    expected = module.rhs(state, inputs, parameters)[swapped]
    assert np.allclose(found, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())
