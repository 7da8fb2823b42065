"""How loads of the paper's figures are written on axes and in captions."""

from __future__ import annotations

from delagrange.figures.quantities import LOADS
from delagrange.reproduction.runs.cases import CurveLoad

DRIVE_TEXT = (
    "from rest in the reference state, force a step at t = 0, "
    "nominal field E\N{SUBSCRIPT ZERO}\N{NO-BREAK SPACE}sin(2πft)"
)
_QUANTITIES = ("force", "field_amplitude", "held_stretch")


def quantity_label(quantity: str) -> str:
    """`P [N]`, `E_0 [MV/m]` or `λ_2p [1]`, in TeX."""
    return f"{LOADS[quantity].symbol} [{LOADS[quantity].unit}]"


def value_label(load: CurveLoad, quantity: str) -> str:
    """The value of a quantity in the unit of `quantity_label`."""
    return f"{getattr(load, quantity) / LOADS[quantity].size:g}"


def load_label(load: CurveLoad, without: str | None = None, plain: bool = False) -> str:
    """`P = 0.1 N, E_0 = 3 MV/m, λ_2p = 2`, without the quantity that varies; in TeX, or plain for a caption."""
    given = {name: getattr(load, name) for name in _QUANTITIES if name != without}
    return ", ".join(LOADS[name].value(value, plain) for name, value in given.items() if value is not None)
