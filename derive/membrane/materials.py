"""Strain energies by name, for whichever spring of a membrane; `own_energy` has those of a user's own.

`MATERIALS["Gent"](ALPHA)` is the Gent energy of the equilibrium spring with its parameters
`shear_modulus_alpha` and `locking_alpha`; `MATERIALS["Gent"](branch(2, of=3))` that of the second of three
Maxwell branches, with `shear_modulus_beta_2` and `locking_beta_2`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import sympy as sp

from delagrange.common.checks import count, did_you_mean
from delagrange.common.roles import Role, usual_sign
from delagrange.derive.membrane.description import numbered
from delagrange.derive.membrane.strain_energy import (
    StrainEnergy,
    arruda_boyce,
    gent,
    mooney_rivlin,
    neo_hookean,
    ogden,
    yeoh,
)
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity

MOST_OGDEN_TERMS = 9
_SHEAR_MODULI = (s.SHEAR_MODULUS_ALPHA, s.SHEAR_MODULUS_BETA)  # these say more of their springs


@dataclass(frozen=True)
class Spring:
    """A spring of the membrane: alpha in equilibrium, beta of the only branch, or beta of branch `number`."""

    letter: str = "alpha"  # "alpha" or "beta"
    number: int | None = None  # of the branch, from 1, where there are several


ALPHA, BETA = Spring("alpha"), Spring("beta")
_GREEK = MappingProxyType({"alpha": "α", "beta": "β"})


def branch(number: int, of: int) -> Spring:
    """The spring of branch `number` of `of` branches; a branch alone carries no number.

    Raises:
        ValueError: there is no such branch.
    """
    count("number of a branch", number, 1, of)
    return BETA if of == 1 else Spring("beta", number)


@dataclass(frozen=True)
class ParameterKind:
    """A parameter of a material, before it belongs to a spring."""

    name: str  # "locking": the quantity of spring alpha is then `locking_alpha`
    key: str  # "J": its symbol is then `J_alpha`
    text: str
    latex: str
    unit: str
    meaning: str  # "shear modulus of {}", the spring's name in the braces
    role: Role = Role.CONSTANT
    positive: bool = True  # whether its symbol is; False where published fits have either sign

    def of(self, spring: Spring) -> Quantity:
        """The quantity of a spring."""
        name = f"{self.name}_{spring.letter}"
        known = next((quantity for quantity in _SHEAR_MODULI if quantity.name == name), None)
        quantity = known or self._made(name, spring)
        return quantity if spring.number is None else numbered(quantity, spring.number)

    def _made(self, name: str, spring: Spring) -> Quantity:
        assumptions = {"positive": True} if self.positive else {"real": True}
        return Quantity(
            sp.Symbol(f"{self.key}_{spring.letter}", **assumptions),
            name,
            f"{self.text}^{_GREEK[spring.letter]}",
            rf"{self.latex}^{{\{spring.letter}}}",
            self.unit,
            self.meaning.format(f"spring {_GREEK[spring.letter]}"),
            self.role,
            usual_sign(self.role),
        )


@dataclass(frozen=True)
class MaterialForm:
    """A strain energy by name. Called with a spring, it gives that spring's energy."""

    name: str
    build: Callable[..., StrainEnergy]  # of one Quantity for each kind
    fixed_kinds: tuple[ParameterKind, ...] = ()
    kinds_of_term: Callable[[int], tuple[ParameterKind, ...]] | None = (
        None  # where there is a choice of terms
    )

    def kinds(self, terms: int = 1) -> tuple[ParameterKind, ...]:
        """What its parameters are, in the order of the energy's parameters.

        Raises:
            ValueError: more than one term is asked of a material whose form is fixed, or too many.
        """
        most = MOST_OGDEN_TERMS if self.kinds_of_term else 1
        count(f"number of terms of {self.name}", terms, 1, most)
        if self.kinds_of_term is None:
            return self.fixed_kinds
        by_term = [self.kinds_of_term(term) for term in range(1, terms + 1)]
        return tuple(kind for same in zip(*by_term, strict=True) for kind in same)

    def __call__(self, spring: Spring = ALPHA, terms: int = 1) -> StrainEnergy:
        """The energy of a spring; `terms` is for materials with a choice of terms (Ogden)."""
        return self.build(*(kind.of(spring) for kind in self.kinds(terms)))


def _ogden_of(*quantities: Quantity) -> StrainEnergy:
    half = len(quantities) // 2
    return ogden(quantities[:half], quantities[half:])


def _modulus(
    name: str, key: str, number: int | None, meaning: str, *, positive: bool = True
) -> ParameterKind:
    tail = "" if number is None else f"_{number}"
    latex = rf"\mu_{{{number}}}" if number else r"\mu"
    return ParameterKind(name + tail, key + tail, f"μ{tail}", latex, "Pa", meaning, Role.MODULUS, positive)


def _ogden_term(term: int) -> tuple[ParameterKind, ...]:
    return (
        _modulus("ogden_modulus", "ogden_mu", term, f"modulus of Ogden term {term} of {{}}", positive=False),
        ParameterKind(
            f"ogden_exponent_{term}",
            f"ogden_a_{term}",
            f"a_{term}",
            f"a_{{{term}}}",
            "1",
            f"exponent of Ogden term {term} of {{}}",
            Role.EXPONENT,
            positive=False,
        ),
    )


def _yeoh_coefficient(power: int) -> ParameterKind:
    return ParameterKind(
        f"yeoh_coefficient_{power}",
        f"C_{power}",
        f"C_{power}",
        f"C_{{{power}}}",
        "Pa",
        f"coefficient of (I_1 - 3){'' if power == 1 else f'^{power}'} of {{}}",
        Role.MODULUS,
        positive=power == 1,
    )


_SHEAR_MODULUS = _modulus("shear_modulus", "mu", None, "shear modulus of {}")
_SECOND_MODULUS = ParameterKind(
    "second_modulus", "mu_2", "μ_2", r"\mu_{2}", "Pa", "second modulus of {}", Role.MODULUS
)
_LOCKING = ParameterKind(
    "locking", "J", "J", "J", "1", "locking limit of {}, of its first invariant less 3", Role.LOCKING_LIMIT
)
_CHAIN_MODULUS = _modulus("chain_modulus", "chain_mu", None, "modulus of the chains of {}")
_LOCKING_STRETCH = ParameterKind(
    "locking_stretch",
    "lambda_m",
    "λ_m",
    r"\lambda_{m}",
    "1",
    "stretch of a chain at its full length, of {}",
    Role.LOCKING_LIMIT,
)

MATERIALS: Mapping[str, MaterialForm] = MappingProxyType(
    {
        material.name: material
        for material in (
            MaterialForm("neo-Hookean", neo_hookean, (_SHEAR_MODULUS,)),
            MaterialForm("Mooney-Rivlin", mooney_rivlin, (_SHEAR_MODULUS, _SECOND_MODULUS)),
            MaterialForm("Yeoh", yeoh, tuple(_yeoh_coefficient(power) for power in (1, 2, 3))),
            MaterialForm("Ogden", _ogden_of, kinds_of_term=_ogden_term),
            MaterialForm("Gent", gent, (_SHEAR_MODULUS, _LOCKING)),
            MaterialForm("Arruda-Boyce", arruda_boyce, (_CHAIN_MODULUS, _LOCKING_STRETCH)),
        )
    }
)


def material(name: str) -> MaterialForm:
    """The material of a name; capitals, spaces, hyphens and underscores make no difference.

    Raises:
        ValueError: there is none of that name.
    """
    plain = {_plain(known): found for known, found in MATERIALS.items()}
    if not isinstance(name, str) or _plain(name) not in plain:
        hint = did_you_mean(name, MATERIALS)
        raise ValueError(f"material must be one of {', '.join(MATERIALS)}; got {name!r}{hint}")
    return plain[_plain(name)]


def _plain(name: str) -> str:
    return "".join(letter for letter in name.casefold() if letter.isalnum())
