"""The equations of the second paper, verbatim: (1) is right; the sign of the last term of (2) is not."""

from __future__ import annotations

from delagrange.derive.notation import symbols as s
from delagrange.derive.papers.printed_equation import PrintedEquation
from delagrange.derive.printed.latex import SymbolTable
from more_papers.second_paper.symbols import CITATION, LOCKING, MODULUS, SIDE

TABLE = SymbolTable.of(
    {
        "T": s.KINETIC_ENERGY, r"\rho": s.DENSITY, "L": s.HALF_LENGTH, "H": s.HALF_THICKNESS, "F": s.FORCE,
        "E": s.FIELD, r"\epsilon": s.PERMITTIVITY, r"\mu": MODULUS, "J": LOCKING, "x": SIDE,
    }
)  # fmt: skip


def _printed(number: str, quantity: str, latex: str) -> PrintedEquation:
    return PrintedEquation(number, quantity, "equal_biaxial", f"{CITATION}, Eq. ({number})", latex)


EQUATIONS = (
    _printed("1", "kinetic_energy", r"T = \frac{8}{3} \rho L^2 H \left(L^2 + 2 H^2 x^{-6}\right) \dot{x}^2"),
    _printed(
        "2",
        "equation_of_motion_1",
        r"\frac{\rho}{3} \left(L^2 + 2 H^2 x^{-6}\right) \ddot{x} - 2 \rho H^2 x^{-7} \dot{x}^2"
        r" + \frac{\mu J (x - x^{-5})}{J + 3 - 2 x^2 - x^{-4}} - \frac{F}{4HL} + \epsilon E^2 x^3 = 0",
    ),
)
