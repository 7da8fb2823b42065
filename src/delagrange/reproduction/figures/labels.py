"""How loads and integrators of the paper's figures are written on axes and in captions."""

from __future__ import annotations

import numpy as np

from delagrange.reproduction.runs.cases import CurveLoad
from delagrange.reproduction.runs.numerics import NumericsVariant

DRIVE_TEXT = (
    "from rest in the reference state, force a step at t = 0, "
    "nominal field E\N{SUBSCRIPT ZERO}\N{NO-BREAK SPACE}sin(2πft)"
)
_SYMBOLS = {"force": "$P$", "field_amplitude": "$E_0$", "held_stretch": r"$\lambda_\mathrm{2p}$"}
_PLAIN_SYMBOLS = {
    "force": "P",
    "field_amplitude": "E\N{SUBSCRIPT ZERO}",
    "held_stretch": "λ\N{SUBSCRIPT TWO}ₚ",
}
_SHOWN_UNITS = {"force": ("N", 1.0), "field_amplitude": ("MV/m", 1e6), "held_stretch": ("1", 1.0)}


def integrator_text(numerics: NumericsVariant) -> str:
    """`DOP853, rtol 1e-9, atol 1e-12`."""
    rtol, atol = (
        np.format_float_scientific(value, trim="-", exp_digits=1) for value in (numerics.rtol, numerics.atol)
    )
    return f"{numerics.method}, rtol {rtol}, atol {atol}"


def quantity_label(quantity: str) -> str:
    """`P [N]`, `E_0 [MV/m]` or `λ_2p [1]`, in TeX."""
    return f"{_SYMBOLS[quantity]} [{_SHOWN_UNITS[quantity][0]}]"


def value_label(load: CurveLoad, quantity: str) -> str:
    """The value of a quantity in the unit of `quantity_label`."""
    return f"{getattr(load, quantity) / _SHOWN_UNITS[quantity][1]:g}"


def load_label(load: CurveLoad, without: str | None = None, plain: bool = False) -> str:
    """`P = 0.1 N, E_0 = 3 MV/m, λ_2p = 2`, without the quantity that varies; in TeX, or plain for a caption."""
    symbols = _PLAIN_SYMBOLS if plain else _SYMBOLS
    shown = [name for name in symbols if name != without and getattr(load, name) is not None]
    units = {name: "" if unit == "1" else f" {unit}" for name, (unit, _) in _SHOWN_UNITS.items()}
    return ", ".join(f"{symbols[name]} = {value_label(load, name)}{units[name]}" for name in shown)
