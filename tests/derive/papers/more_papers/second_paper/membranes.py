"""The membrane of the second paper: Gent, lossless, with as much force along both axes."""

from __future__ import annotations

from delagrange.derive.membrane.description import EQUAL_BIAXIAL, Description, Load, Notation
from more_papers.second_paper.symbols import CITATION, GENT, SIDE

DESCRIPTIONS = (
    Description(
        name="letter_2020",
        title="Gent membrane of a letter",
        load=Load(EQUAL_BIAXIAL),
        equilibrium_spring=GENT,
        defaults={"shear_modulus_alpha": 2e4, "locking_alpha": 80.0},
        notation=Notation(coordinates=(SIDE,), source=CITATION),
        sources=(CITATION,),
    ),
)
