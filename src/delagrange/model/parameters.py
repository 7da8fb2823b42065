"""Material and size of the membrane: validated, frozen, in SI units; and what those of any model are before a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import ModuleType

from delagrange.common import checks
from delagrange.generated import equal_biaxial
from delagrange.model.material import RELAXATION_TIME, Material, defaults_of
from delagrange.model.variables import material_parameters

MATERIAL_UNITS: Mapping[str, str] = {entry.name: entry.unit for entry in material_parameters(equal_biaxial)}
CHANGEABLE_UNITS: Mapping[str, str] = {**MATERIAL_UNITS, RELAXATION_TIME: "s"}


def _told(name: str):
    """A field of which the emitted modules of the paper's membrane say symbol, unit and meaning."""
    entry = next(entry for entry in equal_biaxial.PARAMETERS if entry.name == name)
    return field(metadata=entry._asdict())


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

    half_length: float = _told("half_length")
    half_thickness: float = _told("half_thickness")
    density: float = _told("density")
    permittivity: float = _told("permittivity")
    shear_modulus_alpha: float = _told("shear_modulus_alpha")
    shear_modulus_beta: float = _told("shear_modulus_beta")
    viscosity: float = _told("viscosity")
    source: str = "given by the user"

    def __post_init__(self) -> None:
        given = {name: getattr(self, name) for name in MATERIAL_UNITS}
        for name, value in Material(equal_biaxial, {}, self.source).changed(given).items():
            object.__setattr__(self, name, checks.scalar(name, value, MATERIAL_UNITS[name]))

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
        """The values as any model has them."""
        return Material(equal_biaxial, {name: getattr(self, name) for name in MATERIAL_UNITS}, self.source)


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


def material_of(model: ModuleType, parameters: Parameters | None) -> Material:
    """What the parameters of `model` are before a run changes them.

    What is given counts: `parameters` replaces the `DEFAULTS` of the model whose names fit. None leaves a model its
    `DEFAULTS`, and gives one without any those of SHENG_2015 whose names fit. What then has no value must be given by
    name.

    Raises:
        ValueError: `parameters` is no `Parameters`, or `DEFAULTS` name something that is no parameter of the model, or
            have a value that it cannot take.
    """
    defaults, names = defaults_of(model), [entry.name for entry in material_parameters(model)]
    given = SHENG_2015 if parameters is None and not defaults else parameters
    if given is not None:
        checks.instance("parameters", given, Parameters)
    own = {name: value for name, value in defaults.items() if name in names}
    fitting = {name: getattr(given, name) for name in names if name in MATERIAL_UNITS} if given else {}
    return Material(model, own | fitting, _source(model, names, given if fitting else None))


def _source(model: ModuleType, names: list[str], given: Parameters | None) -> str:
    if given is not None and not hasattr(model, "DEFAULTS") and set(names) <= set(MATERIAL_UNITS):
        return given.source
    own = f"{'defaults of' if getattr(model, 'DEFAULTS', {}) else 'given for'} the model {model.MODEL}"
    return own if given is None else f"{own}; replaced by those of: {given.source}"
