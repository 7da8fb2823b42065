"""The symbols that Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, give to what moves in each load case."""

from __future__ import annotations

from delagrange.common.roles import Role
from delagrange.derive.notation.symbols import moving

CITATION = "Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384"

STRETCH_EB = moving("lambda_EB", "stretch", "λ_EB", r"\lambda_{EB}", "in-plane stretch", Role.STRETCH)
INELASTIC_STRETCH_EB = moving(
    "xi_EB",
    "inelastic_stretch",
    "ξ_EB",
    r"\xi_{EB}",
    "inelastic stretch of the dashpot",
    Role.INELASTIC_STRETCH,
)

STRETCH_UA1 = moving(
    "lambda_UA1", "stretch_1", "λ_UA1", r"\lambda_{UA1}", "stretch along the force", Role.STRETCH
)
STRETCH_UA2 = moving(
    "lambda_UA2", "stretch_2", "λ_UA2", r"\lambda_{UA2}", "stretch across the force", Role.STRETCH
)
INELASTIC_STRETCH_UA1 = moving(
    "xi_UA1",
    "inelastic_stretch_1",
    "ξ_UA1",
    r"\xi_{UA1}",
    "inelastic stretch of the dashpot along the force",
    Role.INELASTIC_STRETCH,
)
INELASTIC_STRETCH_UA2 = moving(
    "xi_UA2",
    "inelastic_stretch_2",
    "ξ_UA2",
    r"\xi_{UA2}",
    "inelastic stretch of the dashpot across the force",
    Role.INELASTIC_STRETCH,
)

STRETCH_PS = moving("lambda_PS", "stretch", "λ_PS", r"\lambda_{PS}", "stretch along the force", Role.STRETCH)
INELASTIC_STRETCH_PS = moving(
    "xi_PS",
    "inelastic_stretch",
    "ξ_PS",
    r"\xi_{PS}",
    "inelastic stretch of the dashpot along the force",
    Role.INELASTIC_STRETCH,
)
INELASTIC_STRETCH_PS2 = moving(
    "xi_PS2",
    "inelastic_stretch_2",
    "ξ_PS2",
    r"\xi_{PS2}",
    "inelastic stretch of the dashpot along the held axis",
    Role.INELASTIC_STRETCH,
)
