"""How the electrical input of a result is written on axes and in captions: the nominal field, charge or current."""

from __future__ import annotations

from dataclasses import dataclass

import xarray as xr

from delagrange.drives.inputs import CHARGE_DENSITY, CURRENT_DENSITY, ELECTRIC_FIELD, ElectricalInput


@dataclass(frozen=True)
class ElectricalAxis:
    """The unit that is shown, and its size in SI units."""

    electrical: ElectricalInput
    unit: str
    size: float  # of the unit that is shown [SI]

    @property
    def name(self) -> str:
        """In the data."""
        return self.electrical.argument

    @property
    def symbol(self) -> str:
        """In TeX, without dollars."""
        return self.electrical.symbol

    @property
    def long_name(self) -> str:
        """`nominal field`, or `nominal charge density`."""
        return self.electrical.long_name.replace("electric ", "")

    @property
    def label(self) -> str:
        """Of an axis."""
        return f"{self.long_name} ${self.symbol}$ [{self.unit}]"


FIELD_AXIS = ElectricalAxis(ELECTRIC_FIELD, "MV/m", 1e6)
_OTHERS = (ElectricalAxis(CHARGE_DENSITY, "mC/m²", 1e-3), ElectricalAxis(CURRENT_DENSITY, "mA/m²", 1e-3))
AXES = {axis.electrical.name: axis for axis in (FIELD_AXIS, *_OTHERS)}


def electrical_axis(data: xr.Dataset) -> ElectricalAxis:
    """The axis of the electrical input that a result says it varies; the field where it says nothing."""
    return AXES.get(data.attrs.get("varied_input"), FIELD_AXIS)
