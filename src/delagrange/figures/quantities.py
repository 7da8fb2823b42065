"""How loads and whatever else varies are written on axes, in legends and in titles: symbol, unit and its size."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import xarray as xr

from delagrange.drives.inputs import input_name
from delagrange.figures.electrical_axis import AXES


@dataclass(frozen=True)
class Shown:
    """A quantity as figures show it."""

    long_name: str
    symbol: str  # in TeX, with dollars
    plain: str  # the symbol where there is no TeX
    unit: str = "1"
    size: float = 1.0  # of the unit that is shown [SI]

    @property
    def label(self) -> str:
        """Of an axis: `amplitude of the field E_0 [MV/m]`."""
        return f"{self.long_name} {self.symbol} [{self.unit}]"

    def value(self, number: float, plain: bool = False) -> str:
        """`E_0 = 5 MV/m`; the unit of a pure number is not told."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.plain if plain else self.symbol} = {number / self.size:g}{unit}"


def _sines() -> dict[str, Shown]:
    """Amplitude and bias of the sine of each electrical input."""
    shown = {}
    for axis in AXES.values():
        stem, symbol = axis.electrical.stem, axis.symbol
        about = {"unit": axis.unit, "size": axis.size}
        shown[f"{stem}_amplitude"] = Shown(f"amplitude of the {stem}", f"${symbol}_0$", f"{symbol}₀", **about)
        shown[f"{stem}_bias"] = Shown(
            f"bias of the {stem}", rf"${symbol}_\mathrm{{b}}$", f"{symbol}_b", **about
        )
    return shown


LOADS = {
    "force": Shown("force", "$P$", "P", "N"),
    "force_1": Shown("force", "$P_1$", "P₁", "N"),
    "force_2": Shown("force", "$P_2$", "P₂", "N"),
    **_sines(),
    **{
        axis.name: Shown(axis.long_name, f"${axis.symbol}$", axis.symbol, axis.unit, axis.size)
        for axis in AXES.values()
    },
    "frequency": Shown("frequency", "$f$", "f", "Hz"),
    "held_stretch": Shown("held stretch", r"$\lambda_\mathrm{2p}$", "λ₂ₚ"),
}  # in the order of titles


_INPUTS = {axis.name: axis.electrical.name for axis in AXES.values()}  # as models call them


def shown_as(data: xr.Dataset, name: str) -> Shown:
    """A coordinate or an input of a result; one that has no symbol of its own by its name."""
    about = data[name].attrs
    text = name.replace("_", " ")
    return LOADS.get(input_name(name)) or Shown(
        about.get("long_name", text), "", text, about.get("units", "1")
    )


def symbol_in_tex(symbol: str) -> str:
    r"""`λ_EB` -> `\lambda_\mathrm{EB}`, without dollars."""
    stem, _, index = symbol.partition("_")
    greek = {"λ": r"\lambda", "λ̇": r"\dot\lambda", "ξ": r"\xi"}
    upright = rf"\mathrm{{{index}}}" if len(index) > 1 else index
    return greek.get(stem, stem) + (f"_{upright}" if index else "")


def load_text(values: Mapping[str, float | None]) -> str:
    """`P = 0.5 N, E₀ = 1 MV/m`, of loads by name; those of zero are left out, but of a force.

    values: None where there is no single one
    """
    known = {name: values[name] for name in LOADS if values.get(name) is not None}
    own = [name for name in known if name.startswith("force_")]  # in place of the one force of others
    told = [name for name in known if known[name] != 0 or name in own or (name == "force" and not own)]
    return ", ".join(LOADS[name].value(known[name], plain=True) for name in told)


def single_loads(data: xr.Dataset) -> dict[str, float | None]:
    """The loads that are constant, from the coordinates or from what is said of their drives; None where they vary."""
    return {name: _single(data, name) for name in LOADS}


def _single(data: xr.Dataset, name: str) -> float | None:
    if name in data.coords:
        return float(data.coords[name]) if data.coords[name].ndim == 0 else None
    if isinstance(said := data.attrs.get(name), int | float):
        return float(said)
    drive = data.attrs.get(f"{_INPUTS.get(name, name)}_drive", "")
    found = re.fullmatch(r"Constant\(value=(.*)\)", str(drive))
    return float(found[1]) if found else None


def model_title(data: xr.Dataset, loads: Mapping[str, float | None]) -> str:
    """`equal biaxial: P = 0.5 N`."""
    text = load_text(loads)
    return str(data.attrs["model"]).replace("_", " ") + (f": {text}" if text else "")
