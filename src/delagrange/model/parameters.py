"""Material and size of the membrane: validated, frozen, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields

from delagrange.common import checks
from delagrange.model.material import RELAXATION_TIME, Material


def _material(symbol: str, unit: str, meaning: str):
    return field(metadata={"symbol": symbol, "unit": unit, "meaning": meaning})


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """A membrane of two parallel units: spring α, and spring β in series with a dashpot.

    | field                 | symbol | unit    |
    |-----------------------|--------|---------|
    | `half_length`         | L      | m       |
    | `half_thickness`      | H      | m       |
    | `density`             | ρ      | kg/m^3  |
    | `permittivity`        | ε      | F/m     |
    | `shear_modulus_alpha` | μ^α    | Pa      |
    | `shear_modulus_beta`  | μ^β    | Pa      |
    | `viscosity`           | η      | Pa s    |

    Raises:
        ValueError: a value is not positive and finite.
    """

    half_length: float = _material("L", "m", "half the side of the square membrane in the reference state")
    half_thickness: float = _material("H", "m", "half the thickness in the reference state")
    density: float = _material("ρ", "kg/m^3", "mass density")
    permittivity: float = _material("ε", "F/m", "permittivity")
    shear_modulus_alpha: float = _material("μ^α", "Pa", "shear modulus of spring α, the equilibrium spring")
    shear_modulus_beta: float = _material(
        "μ^β", "Pa", "shear modulus of spring β, in series with the dashpot"
    )
    viscosity: float = _material("η", "Pa s", "viscosity of the dashpot, τ_v μ^β")
    source: str = "given by the user"

    def __post_init__(self) -> None:
        for name, unit in MATERIAL_UNITS.items():
            value = checks.scalar(name, checks.positive(name, getattr(self, name), unit), unit)
            object.__setattr__(self, name, value)

    @property
    def relaxation_time(self) -> float:
        """Viscoelastic relaxation time τ_v = η / μ^β [s]."""
        return self.viscosity / self.shear_modulus_beta

    def replace(self, **changes: float) -> Parameters:
        """The same membrane with some values changed; `relaxation_time` [s] sets the viscosity to τ_v μ^β.

        Raises:
            ValueError: an unknown name, a value that is not positive and finite, or both
                `viscosity` and `relaxation_time` given.
        """
        source = changes.pop("source", None) or self.material.changed_source(changes)
        return Parameters(**self.material.changed(changes), source=source)

    @property
    def material(self) -> Material:
        """The values with their units, as any model has them."""
        values = {name: getattr(self, name) for name in MATERIAL_UNITS}
        return Material(values, CHANGEABLE_UNITS, frozenset(CHANGEABLE_UNITS), self.source)


MATERIAL_UNITS: Mapping[str, str] = {
    entry.name: entry.metadata["unit"] for entry in fields(Parameters) if "unit" in entry.metadata
}
CHANGEABLE_UNITS: Mapping[str, str] = {**MATERIAL_UNITS, RELAXATION_TIME: "s"}


SHENG_2015 = Parameters(
    half_length=5e-3,
    half_thickness=1e-3,
    density=1.2e3,
    permittivity=6.198e-11,
    shear_modulus_alpha=1.8e4,
    shear_modulus_beta=4.2e4,
    viscosity=400.0 * 4.2e4,  # τ_v = 400 s
    source="Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III",
)
