"""The equations of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, verbatim.

The LaTeX is that of the text extraction, to the character; what the extraction got wrong is listed
as a repair beside it and never edited away. A misprint of the paper is not repaired: finding it is
the task of `verify`.
"""

from __future__ import annotations

from types import MappingProxyType

from delagrange.derive.notation import symbols as sym
from delagrange.derive.papers.printed_equation import PrintedEquation, TextRepair
from delagrange.derive.papers.sheng_2015 import symbols as own
from delagrange.derive.printed.latex import SymbolTable

TABLE = SymbolTable.of(
    {
        "T": sym.KINETIC_ENERGY,
        r"\Pi": sym.POTENTIAL_ENERGY,
        "L": sym.HALF_LENGTH,
        "H": sym.HALF_THICKNESS,
        r"\rho": sym.DENSITY,
        r"\varepsilon": sym.PERMITTIVITY,
        r"\mu^{\alpha}": sym.SHEAR_MODULUS_ALPHA,
        r"\mu^{\beta}": sym.SHEAR_MODULUS_BETA,
        r"\eta": sym.VISCOSITY,
        "P": sym.FORCE,
        "P_1": sym.FORCE_1,
        "P_2": sym.FORCE_2,
        "P_{2p}": sym.REACTION_2,
        "E": sym.FIELD,
        r"\lambda_1": sym.STRETCH_1,
        r"\lambda_2": sym.STRETCH_2,
        r"\xi_1": sym.INELASTIC_STRETCH_1,
        r"\xi_2": sym.INELASTIC_STRETCH_2,
        r"\lambda_{EB}": own.STRETCH_EB,
        r"\xi_{EB}": own.INELASTIC_STRETCH_EB,
        r"\lambda_{UA1}": own.STRETCH_UA1,
        r"\lambda_{UA2}": own.STRETCH_UA2,
        r"\xi_{UA1}": own.INELASTIC_STRETCH_UA1,
        r"\xi_{UA2}": own.INELASTIC_STRETCH_UA2,
        r"\lambda_{PS}": own.STRETCH_PS,
        r"\xi_{PS}": own.INELASTIC_STRETCH_PS,
        r"\lambda_{2p}": sym.HELD_STRETCH,
    },
    partners=((r"\lambda_{PS}", r"\lambda_{2p}"), ("P", "P_{2p}"), ("L", "H")),
)

_LATEX = MappingProxyType(
    {
        "4": (
            r"$$\Pi = 8HL^{2} \left[ \frac{\mu^{\alpha}}{2} \left( \lambda_{1}^{2} + \lambda_{2}^{2} + "
            r"\lambda_{1}^{-2} \lambda_{2}^{-2} - 3 \right) + \frac{\mu^{\beta}}{2} \left( "
            r"\lambda_{1}^{2} \xi_{1}^{-2} + \lambda_{2}^{2} \xi_{2}^{-2} + \lambda_{1}^{-2} "
            r"\lambda_{2}^{-2} \xi_{1}^{2} \xi_{2}^{2} - 3 \right) - \frac{P_{1}}{4HL} \lambda_{1} - "
            r"\frac{P_{2}}{4HL} \lambda_{2} - \frac{\varepsilon}{2} E^{2} \lambda_{1}^{2} \lambda_{2}^{2} "
            r"\right]$$"
        ),
        "5": (
            r"$$\frac{\mathrm{d}\xi_{1}}{\mathrm{d}t} = \frac{\xi_{1}}{3\eta} \left[ \mu^{\beta} \left( "
            r"\lambda_{1}^{2} \xi_{1}^{-2} - \lambda_{1}^{-2} \lambda_{2}^{-2} \xi_{1}^{2} \xi_{2}^{2} "
            r"\right) - \frac{\mu^{\beta}}{2} \left( \lambda_{2}^{2} \xi_{2}^{-2} - \lambda_{1}^{-2} "
            r"\lambda_{2}^{-2} \xi_{1}^{2} \xi_{2}^{2} \right) \right], \tag{5}$$"
        ),
        "6": (
            r"$$\frac{\mathrm{d}\xi_{2}}{\mathrm{d}t} = \frac{\xi_{2}}{3\eta} \left[ \mu^{\beta} \left( "
            r"\lambda_{2}^{2} \xi_{2}^{-2} - \lambda_{1}^{-2} \lambda_{2}^{-2} \xi_{1}^{2} \xi_{2}^{2} "
            r"\right) - \frac{\mu^{\beta}}{2} \left( \lambda_{1}^{2} \xi_{1}^{-2} - \lambda_{1}^{-2} "
            r"\lambda_{2}^{-2} \xi_{1}^{2} \xi_{2}^{2} \right) \right], \tag{6}$$"
        ),
        "7": (
            r"$$T = \frac{8}{3}\rho L^4 H \dot{\lambda}_{EB}^2 + \frac{16}{3}\rho L^2 H^3 \frac{\dot{"
            r"\lambda}_{EB}^2}{\lambda_{EB}^6},\tag{7}$$"
        ),
        "8": (
            r"$$\Pi = 8HL^{2} \left[ \frac{\mu^{\alpha}}{2} \left( 2\lambda_{EB}^{2} + \lambda_{EB}^{-4} "
            r"- 3 \right) + \frac{\mu^{\beta}}{2} \left( 2\lambda_{EB}^{2} \xi_{EB}^{-2} + "
            r"\lambda_{EB}^{-4} \xi_{EB}^{4} - 3 \right) - \frac{P}{2HL} \lambda_{EB} - \frac{"
            r"\varepsilon}{2} E^{2} \lambda_{EB}^{4} \right].$$"
        ),
        "9": (
            r"$$\ddot{\lambda}_{EB} - \frac{6}{\lambda_{EB}(2 + L^{2}H^{-2}\lambda_{EB}^{6})} \dot{"
            r"\lambda}_{EB}^{2} + \frac{3}{\rho H^{2}(2 + L^{2}H^{-2}\lambda_{EB}^{6})} \times \left[ "
            r"\mu^{\alpha} (\lambda_{EB}^{7} - \lambda_{EB}) + \mu^{\beta} (\lambda_{EB}^{7} "
            r"\xi_{EB}^{-2} - \lambda_{EB} \xi_{EB}^{4}) - \frac{P}{4HL} \lambda_{EB}^{6} - \varepsilon "
            r"E^{2} \lambda_{EB}^{9} \right] = 0.$$"
        ),
        "10": (
            r"$$\frac{d\xi_{\rm EB}}{dt} = \frac{\mu^{\beta}}{6n} \left( \lambda_{\rm EB}^2 \xi_{\rm "
            r"EB}^{-1} - \lambda_{\rm EB}^{-4} \xi_{\rm EB}^5 \right). \tag{10}$$"
        ),
        "11": (
            r"$$T = \frac{4}{3}\rho L^4 H \dot{\lambda}_{\mathrm{UA1}}^2 + \frac{4}{3}\rho L^4 H \dot{"
            r"\lambda}_{\mathrm{UA2}}^2 + \frac{4}{3}\rho L^2 H^3 \lambda_{\mathrm{UA1}}^{-2} \lambda_{"
            r"\mathrm{UA2}}^{-2} \left( \lambda_{\mathrm{UA1}}^{-2} \dot{\lambda}_{\mathrm{UA1}}^2 + "
            r"\lambda_{\mathrm{UA2}}^{-2} \dot{\lambda}_{\mathrm{UA2}}^2 + 2 \lambda_{\mathrm{UA1}}^{-1} "
            r"\lambda_{\mathrm{UA2}}^{-1} \dot{\lambda}_{\mathrm{UA1}} \dot{\lambda}_{\mathrm{UA2}} "
            r"\right), \tag{11}$$"
        ),
        "12": (
            r"$$\Pi = 8HL^{2} \left[ \frac{\mu^{\alpha}}{2} \left( \lambda_{\text{UA}1}^{2} + \lambda_{"
            r"\text{UA}2}^{2} + \lambda_{\text{UA}1}^{-2} \lambda_{\text{UA}2}^{-2} - 3 \right) + \frac{"
            r"\mu^{\beta}}{2} \left( \lambda_{\text{UA}1}^{2} \xi_{\text{UA}1}^{-2} + \lambda_{"
            r"\text{UA}2}^{2} \xi_{\text{UA}2}^{-2} + \lambda_{\text{UA}1}^{-2} \lambda_{\text{UA}2}^{-2} "
            r"\xi_{\text{UA}1}^{2} \xi_{\text{UA}2}^{2} - 3 \right) - \frac{P}{4HL} \lambda_{\text{UA}1} "
            r"- \frac{\varepsilon}{2} E^{2} \lambda_{\text{UA}1}^{2} \lambda_{\text{UA}2}^{2} \right].$$"
        ),
        "13": (
            r"$$\frac{8}{3}\rho L^{2}H^{3}\left[\left(L^{2}H^{-2} + \lambda_{\text{UA1}}^{-4}\lambda_{"
            r"\text{UA2}}^{-2}\right)\ddot{\lambda}_{\text{UA1}} + \lambda_{\text{UA1}}^{-3}\lambda_{"
            r"\text{UA2}}^{-3}\ddot{\lambda}_{\text{UA2}}\right] - \frac{16}{3}\rho L^{2}H^{3}\left("
            r"\lambda_{\text{UA1}}^{-5}\lambda_{\text{UA2}}^{-2}\dot{\lambda}_{\text{UA1}}^{2} + \lambda_{"
            r"\text{UA1}}^{-4}\lambda_{\text{UA2}}^{-3}\dot{\lambda}_{\text{UA1}}\dot{\lambda}_{"
            r"\text{UA2}} + \lambda_{\text{UA1}}^{-3}\lambda_{\text{UA2}}^{-4}\dot{\lambda}_{"
            r"\text{UA2}}^{2}\right) \\"
            "\n"
            r"+ 8HL^{2}\left[\mu^{\alpha}\left(\lambda_{\text{UA1}} - \lambda_{\text{UA1}}^{-3}\lambda_{"
            r"\text{UA2}}^{-2}\right) + \mu^{\beta}\left(\lambda_{\text{UA1}}\xi_{\text{UA1}}^{-2} - "
            r"\lambda_{\text{UA1}}^{-3}\lambda_{\text{UA2}}^{-2}\xi_{\text{UA1}}^{2}\xi_{\text{UA2}}^{2}"
            r"\right) - \frac{P}{4HL} - \varepsilon E^{2}\lambda_{\text{UA1}}\lambda_{\text{UA2}}^{2}"
            r"\right] = 0,$$"
        ),
        "14": (
            r"$$\frac{8}{3}\rho L^{2}H^{3}\left[\left(L^{2}H^{-2} + \lambda_{\mathrm{UA1}}^{-2}\lambda_{"
            r"\mathrm{UA2}}^{-4}\right)\ddot{\lambda}_{\mathrm{UA2}} + \lambda_{\mathrm{UA1}}^{-3}"
            r"\lambda_{\mathrm{UA2}}^{-3}\ddot{\lambda}_{\mathrm{UA1}}\right] - \frac{16}{3}\rho "
            r"L^{2}H^{3}\left(\lambda_{\mathrm{UA1}}^{-2}\lambda_{\mathrm{UA2}}^{-5}\dot{\lambda}_{"
            r"\mathrm{UA2}}^{2} + \lambda_{\mathrm{UA1}}^{-3}\lambda_{\mathrm{UA2}}^{-4}\dot{\lambda}_{"
            r"\mathrm{UA1}}\dot{\lambda}_{\mathrm{UA2}} + \lambda_{\mathrm{UA1}}^{-4}\lambda_{"
            r"\mathrm{UA2}}^{-3}\dot{\lambda}_{\mathrm{UA1}}^{2}\right) \\"
            "\n"
            r"+8HL^{2}\left[\mu^{\alpha}\left(\lambda_{\mathrm{UA2}} - \lambda_{\mathrm{UA1}}^{-2}"
            r"\lambda_{\mathrm{UA2}}^{-3}\right) + \mu^{\beta}\left(\lambda_{\mathrm{UA2}}\xi_{"
            r"\mathrm{UA2}}^{-2} - \lambda_{\mathrm{UA1}}^{-2}\lambda_{\mathrm{UA2}}^{-3}\xi_{"
            r"\mathrm{UA1}}^{2}\xi_{\mathrm{UA2}}^{2}\right) - \varepsilon E^{2}\lambda_{\mathrm{UA1}}^{2}"
            r"\lambda_{\mathrm{UA2}}\right] = 0.$$"
        ),
        "15": (
            r"$$\frac{\mathrm{d}\xi_{\mathrm{UA1}}}{\mathrm{d}t} = \frac{\mu^{\beta}}{6\eta} \left( 2"
            r"\lambda_{\mathrm{UA1}}^{2} \xi_{\mathrm{UA1}}^{-1} - \lambda_{\mathrm{UA2}}^{2} \xi_{"
            r"\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}} - \lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3} "
            r"+ \lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3} \xi_{\mathrm{UA2}}^{2} \right), "
            r"\tag{15}$$"
        ),
        "16": (
            r"$$\frac{\mathrm{d}\xi_{\mathrm{UA2}}}{\mathrm{d}t} = \frac{\mu^{\beta}}{3n} \left( 2"
            r"\lambda_{\mathrm{UA2}}^{2} \xi_{\mathrm{UA2}}^{-1} - \lambda_{\mathrm{UA1}}^{2} \xi_{"
            r"\mathrm{UA1}}^{-2} \xi_{\mathrm{UA2}} - \lambda_{\mathrm{UA1}}^{-2} \lambda_{"
            r"\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{2} \xi_{\mathrm{UA2}}^{3} \right). \tag{16}$$"
        ),
        "17": (
            r"$$T = \frac{4}{3}\rho L^4 H \dot{\lambda}_{PS}^2 + \frac{4}{3}\rho L^2 H^3 \frac{\dot{"
            r"\lambda}_{PS}^2}{\lambda_{2p}^2 \lambda_{PS}^4},$$"
        ),
        "18": (
            r"$$\Pi = 8HL^{2} \left[ \frac{\mu^{\alpha}}{2} \left( \lambda_{PS}^{2} + \lambda_{2p}^{2} + "
            r"\lambda_{2p}^{-2} \lambda_{PS}^{-2} - 3 \right) + \frac{\mu^{\beta}}{2} \left( "
            r"\lambda_{PS}^{2} \xi_{PS}^{-2} + \lambda_{PS}^{-2} \xi_{PS}^{2} - 2 \right) - \frac{P}{4HL} "
            r"\lambda_{PS} - \frac{P_{2p}}{4HL} \lambda_{2p} - \frac{\varepsilon}{2} E^{2} "
            r"\lambda_{2p}^{2} \lambda_{PS}^{2} \right],$$"
        ),
        "19": (
            r"$$\frac{P_{2p}}{4HL}\lambda_{2p} = \mu^{\alpha} \left(\lambda_{2p}^{2} - \lambda_{PS}^{-2}"
            r"\lambda_{2p}^{-2}\right) + \mu^{\beta} \left(1 - \lambda_{PS}^{-2}\xi_{PS}^{2}\right) - "
            r"\varepsilon E^{2}\lambda_{PS}^{2}\lambda_{2p}^{2}.$$"
        ),
        "20": (
            r"$$\Pi = 8HL^{2} \left[ \frac{\mu^{\alpha}}{2} \left( \lambda_{PS}^{2} - \lambda_{2p}^{2} + 3"
            r"\lambda_{2p}^{-2} \lambda_{PS}^{-2} - 3 \right) + \frac{\mu^{\beta}}{2} \left( "
            r"\lambda_{PS}^{2} \xi_{PS}^{-2} + 3\lambda_{PS}^{-2} \xi_{PS}^{2} - 4 \right) - "
            r"\frac{P}{4HL} \lambda_{PS} + \frac{\varepsilon}{2} E^{2} \lambda_{2p}^{2} \lambda_{PS}^{2} "
            r"\right].$$"
        ),
        "21": (
            r"$$\ddot{\lambda}_{PS} - \frac{2\lambda_{2p}^{-2}}{\lambda_{PS}(\lambda_{2p}^{-2} + "
            r"L^{2}H^{-2}\lambda_{PS}^{4})}\dot{\lambda}_{PS}^{2} + \frac{3}{\rho H^{2}(\lambda_{2p}^{-2} "
            r"+ L^{2}H^{-2}\lambda_{PS}^{4})}$$"
            "\n\n"
            r"$$\times \left[\mu^{\alpha}\left(\lambda_{PS}^{5} - 3\lambda_{2p}^{-2}\lambda_{PS}\right) + "
            r"\mu^{\beta}\left(\lambda_{PS}^{5}\xi_{PS}^{-2} - 3\lambda_{PS}\xi_{PS}^{2}\right)\right]$$"
            "\n\n"
            r"$$-\frac{P}{4HL}\lambda_{PS}^{4} + \varepsilon E^{2}\lambda_{2p}^{2}\lambda_{PS}^{5} = 0.$$"
        ),
    }
)

_VISCOSITY_GLYPH = r"n has no meaning in the paper; it stands where Eqs. (5), (6) and (15) have \eta"
_REPAIRS = MappingProxyType(
    {
        "10": (TextRepair(r"{6n}", r"{6\eta}", _VISCOSITY_GLYPH),),
        "16": (TextRepair(r"{3n}", r"{3\eta}", _VISCOSITY_GLYPH),),
    }
)


def _printed(number: str, quantity: str, load: str, note: str = "") -> PrintedEquation:
    source = f"{own.CITATION}, Eq. ({number})"
    return PrintedEquation(number, quantity, load, source, _LATEX.get(number), _REPAIRS.get(number, ()), note)


EQUATIONS = (
    _printed("4", "potential_energy", "biaxial"),
    _printed("5", "dashpot_rate_1", "biaxial"),
    _printed("6", "dashpot_rate_2", "biaxial"),
    _printed("7", "kinetic_energy", "equal_biaxial"),
    _printed("8", "potential_energy", "equal_biaxial"),
    _printed("9", "equation_of_motion_1", "equal_biaxial"),
    _printed("10", "dashpot_rate_1", "equal_biaxial"),
    _printed("11", "kinetic_energy", "uniaxial"),
    _printed("12", "potential_energy", "uniaxial"),
    _printed("13", "equation_of_motion_1", "uniaxial"),
    _printed("14", "equation_of_motion_2", "uniaxial"),
    _printed("15", "dashpot_rate_1", "uniaxial"),
    _printed("16", "dashpot_rate_2", "uniaxial"),
    _printed("17", "kinetic_energy", "pure_shear"),
    _printed("18", "potential_with_reactions", "pure_shear"),
    _printed("19", "reaction_force", "pure_shear"),
    _printed("20", "potential_energy", "pure_shear"),
    _printed("21", "equation_of_motion_1", "pure_shear"),
    _printed(
        "22",
        "dashpot_rate_1",
        "pure_shear",
        'the text ends at "can be simplified by Eqs. (5) and (6) as"',
    ),
)
