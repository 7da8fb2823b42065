"""Published parameter sets of elastomers, each value with its unit, its source and the text it was read in.

No value is given from memory. What was not found in a text that could be read is left out and named in
`MaterialSet.left_out`; in particular the parameters of the silicone membranes of Das, Breuer & Mathai (2020),
arXiv:2005.03165, of which only the abstract could be read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from delagrange.common.checks import choice
from delagrange.derive.membrane.description import MaxwellBranch, numbered
from delagrange.derive.membrane.materials import ALPHA, MATERIALS, Spring, branch
from delagrange.derive.membrane.strain_energy import StrainEnergy
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity


@dataclass(frozen=True)
class CitedValue:
    """A number as published, in SI units, and where it stands."""

    value: float
    unit: str
    source: str  # author, year, table or equation
    read_in: str  # the text in which it was read, where that is another


@dataclass(frozen=True)
class SpringData:
    """A material of `MATERIALS` and its values by the name of the parameter, without that of the spring."""

    material: str
    values: Mapping[str, CitedValue]
    terms: int = 1  # of an Ogden energy

    def energy(self, spring: Spring) -> StrainEnergy:
        """The energy of this material for a spring."""
        return MATERIALS[self.material](spring, self.terms)

    def defaults(self, spring: Spring) -> dict[str, float]:
        """Values [their SI units] by the names of the spring's parameters."""
        kinds = MATERIALS[self.material].kinds(self.terms)
        return {kind.of(spring).name: self.values[kind.name].value for kind in kinds}

    def shear_modulus(self) -> float:
        """Shear modulus at rest [Pa]."""
        energy, values = self.energy(ALPHA), self.defaults(ALPHA)
        at = {parameter.symbol: values[parameter.name] for parameter in energy.parameters}
        return float(energy.shear_modulus.subs(at))


@dataclass(frozen=True)
class BranchData:
    """A Maxwell branch: its spring and its relaxation time, of which its viscosity follows."""

    spring: SpringData
    relaxation_time: CitedValue  # [s]

    def viscosity(self) -> float:
        """Viscosity [Pa s] of the dashpot, shear modulus of the spring at rest times relaxation time."""
        return self.spring.shear_modulus() * self.relaxation_time.value


@dataclass(frozen=True)
class MaterialSet:
    """A material as published: springs, dashpots and, where the text has them, permittivity and density."""

    name: str
    title: str
    source: str
    equilibrium_spring: SpringData
    branches: tuple[BranchData, ...] = ()
    permittivity: CitedValue | None = None  # [F/m]
    density: CitedValue | None = None  # [kg/m^3]
    notes: tuple[str, ...] = ()
    left_out: tuple[str, ...] = field(default=())  # what the texts that were read do not give

    def energy(self) -> StrainEnergy:
        """The energy of the equilibrium spring."""
        return self.equilibrium_spring.energy(ALPHA)

    def maxwell_branches(self) -> tuple[MaxwellBranch, ...]:
        """The branches with the quantities of a description, in the order in which they are published."""
        return tuple(
            MaxwellBranch(each.spring.energy(branch(number, len(self.branches))), self._viscosity(number))
            for number, each in enumerate(self.branches, 1)
        )

    def defaults(self) -> Mapping[str, float]:
        """Values [their SI units] by the names of the parameters of a membrane of this material."""
        values = self.equilibrium_spring.defaults(ALPHA)
        for number, each in enumerate(self.branches, 1):
            values |= each.spring.defaults(branch(number, len(self.branches)))
            values[self._viscosity(number).name] = each.viscosity()
        for quantity, cited in ((s.PERMITTIVITY, self.permittivity), (s.DENSITY, self.density)):
            if cited is not None:
                values[quantity.name] = cited.value
        return MappingProxyType(values)

    def _viscosity(self, number: int) -> Quantity:
        return s.VISCOSITY if len(self.branches) == 1 else numbered(s.VISCOSITY, number)


_WANG = "Wang et al. (2016), J. Mech. Phys. Solids, as given by Stewart & Anand (November 2023)"
_STEWART = (
    "E. M. Stewart & L. Anand, Coupled theories FEniCS codes, "
    "github.com/SolidMechanicsCoupledTheories/example_codes (commit 23fb716), "
    "08_dielectric_viscoelastomers/DV02_3D_pullin_instability_rate_sweep.py, model parameters"
)


def _vhb(value: float, unit: str, source: str = _WANG) -> CitedValue:
    return CitedValue(value, unit, source, _STEWART)


def _vhb_branch(modulus: float, relaxation_time: float) -> BranchData:
    spring = SpringData("neo-Hookean", MappingProxyType({"shear_modulus": _vhb(modulus, "Pa")}))
    return BranchData(spring, _vhb(relaxation_time, "s"))


VHB_4910 = MaterialSet(
    name="vhb_4910",
    title="Acrylic elastomer VHB 4910, Arruda-Boyce spring and three Maxwell branches",
    source=_WANG,
    equilibrium_spring=SpringData(
        "Arruda-Boyce",
        MappingProxyType({"chain_modulus": _vhb(15.36e3, "Pa"), "locking_stretch": _vhb(5.99, "1")}),
    ),
    branches=(_vhb_branch(26.06e3, 0.6074), _vhb_branch(26.53e3, 6.56), _vhb_branch(10.83e3, 61.25)),
    permittivity=_vhb(
        4.8 * 8.85e-12,
        "F/m",
        "Stewart & Anand (November 2023): relative permittivity 4.8, vacuum 8.85e-12 F/m",
    ),
    density=_vhb(1000.0, "kg/m^3", "Stewart & Anand (November 2023), as a round number"),
    notes=(
        "The text read has the inverse Langevin function by Cohen's Pade approximant, with its prefactor 15.36 kPa "
        "as modulus of the chains; the series of five terms used here is softer, in uniaxial tension by 2 % at the "
        "stretch 4.7, 3 % at 6, 11 % at 8, 23 % at 8.85 (the last point of the measured curve).",
        "The viscous stretches of the text flow by dA/dt = (C^-1 - A)/tau without the constraint det A = 1. For "
        "small strains that is a dashpot of viscosity G tau; for large ones it is another law than the Newtonian "
        "dashpot used here. The codes of Stewart & Anand (2024), Int. J. Solids Struct. 303, 113023, with the same "
        "moduli and times, enforce the constraint, which is then the Newtonian dashpot of a neo-Hookean branch.",
        "The codes of Stewart & Anand (2024) give the locking stretch as 5.85, those of 2023 as 5.99.",
    ),
    left_out=("The tables of Wang et al. (2016) themselves could not be read.",),
)

_DAWOOD = (
    "Dawood, Zhang, Osman, Suulker, Abdulali, Angelmahr & Althoefer (2026), Hyperelastic Characterisation of "
    "Silicone Tissue Phantoms: A Parametric Database with Model Selection and Inverse Design Framework; "
    "sample EF30_0T, fit to engineering stress"
)
_DATABASE = (
    "github.com/abubakardawood/tissue-phantom-material-database (commit 52b1271, CC BY 4.0), "
    "data/hyperelastic_parameters.json"
)
_ECOFLEX_NOTES = (
    "Fitted to ten uniaxial compressions of cylinders at 10 mm/min, stretches from 1 to 1/3; tension was not measured.",
)
_ECOFLEX_LEFT_OUT = (
    "The texts read give no permittivity, density or relaxation times: the spring is elastic.",
)


def _ecoflex(name: str, value: float, unit: str) -> CitedValue:
    return CitedValue(value, unit, f"{_DAWOOD}, {name}", _DATABASE)


ECOFLEX_00_30_YEOH = MaterialSet(
    name="ecoflex_00_30_yeoh",
    title="Silicone Ecoflex 00-30 without thinner, Yeoh spring",
    source=_DAWOOD,
    equilibrium_spring=SpringData(
        "Yeoh",
        MappingProxyType(
            {
                "yeoh_coefficient_1": _ecoflex("Yeoh_o3", 14.6899960308889e3, "Pa"),
                "yeoh_coefficient_2": _ecoflex("Yeoh_o3", -0.1943757158057544e3, "Pa"),
                "yeoh_coefficient_3": _ecoflex("Yeoh_o3", 0.3107486648843412e3, "Pa"),
            }
        ),
    ),
    notes=_ECOFLEX_NOTES,
    left_out=_ECOFLEX_LEFT_OUT,
)

ECOFLEX_00_30_OGDEN = MaterialSet(
    name="ecoflex_00_30_ogden",
    title="Silicone Ecoflex 00-30 without thinner, Ogden spring of two terms",
    source=_DAWOOD,
    equilibrium_spring=SpringData(
        "Ogden",
        MappingProxyType(
            {
                "ogden_modulus_1": _ecoflex("Ogden_o2", 0.11597852052455487e3, "Pa"),
                "ogden_modulus_2": _ecoflex("Ogden_o2", 21.929799010391598e3, "Pa"),
                "ogden_exponent_1": _ecoflex("Ogden_o2", 10.61399087811772, "1"),
                "ogden_exponent_2": _ecoflex("Ogden_o2", 2.6050267697526204, "1"),
            }
        ),
        terms=2,
    ),
    notes=(
        *_ECOFLEX_NOTES,
        "The four numbers of the file are read as two moduli and then two exponents, with the nominal stress "
        "mu (lambda^(a-1) - lambda^(-a/2-1)) of each term: so they give the measured curves to about the "
        "standard error that the file states, 1.5 kPa, while modulus and exponent by turns, as the web page beside the "
        "file labels them, give 512 kPa in place of 108 kPa at the stretch 0.5.",
    ),
    left_out=_ECOFLEX_LEFT_OUT,
)

MATERIAL_DATA: Mapping[str, MaterialSet] = MappingProxyType(
    {each.name: each for each in (VHB_4910, ECOFLEX_00_30_YEOH, ECOFLEX_00_30_OGDEN)}
)


def material_data(name: str) -> MaterialSet:
    """The published set of a name.

    Raises:
        ValueError: there is none of that name.
    """
    return MATERIAL_DATA[choice("material data", name, MATERIAL_DATA)]
