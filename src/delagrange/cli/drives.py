"""Force and field over time, from the options that say how they are driven."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from delagrange.cli import quantities
from delagrange.common import checks
from delagrange.drives.drive import Constant, Drive, Ramp, Sine, Step, Tabulated


@dataclass(frozen=True)
class DriveOptions:
    """What a person said about one input, and under which names."""

    name: str  # "force" or "field"
    unit: str
    value_option: str
    frequency_option: str
    value: float | None = None  # amplitude of a sine, else a constant [unit]
    frequency: float | None = None  # [Hz]
    bias: float | None = None  # [unit]
    phase: float | None = None  # [rad]
    step_time: float | None = None  # [s]
    ramp: str | None = None
    table: Path | None = None

    def drive(self) -> Drive:
        """The drive; zero at all times where nothing was said.

        Raises:
            ValueError: options that contradict each other, or a bad value in one.
        """
        self._refuse_two_drives()
        self._refuse_idle()
        self._check_numbers()
        if self.table is not None:
            return Tabulated(*quantities.table(self.name, self.table, self.unit))
        if self.ramp is not None:
            return Ramp(*quantities.ramp(f"{self.name}-ramp", self.ramp, self.unit))
        if self.frequency is not None:
            return Sine(self.value, self.frequency, self.bias or 0.0, self.phase or 0.0)
        if self.step_time is not None:
            return Step(self.value, self.step_time)
        return Constant(self.value or 0.0)

    def _refuse_two_drives(self) -> None:
        given = {
            self.value_option: self.value,
            f"--{self.name}-ramp": self.ramp,
            f"--{self.name}-csv": self.table,
        }
        said = [option for option, value in given.items() if value is not None]
        if len(said) > 1:
            raise ValueError(f"{self.name} [{self.unit}] is driven by {' and '.join(said)} at once; give one")
        if self.frequency is not None and self.step_time is not None:
            raise ValueError(
                f"{self.name} [{self.unit}] is driven by {self.frequency_option} and --{self.name}-step-time "
                "at once; give one"
            )

    def _check_numbers(self) -> None:
        """Name the option of a bad number: a drive by itself knows neither it nor the unit."""
        finite = (
            (self.value_option, self.value, self.unit),
            (f"--{self.name}-bias", self.bias, self.unit),
            (f"--{self.name}-phase", self.phase, "rad"),
            (f"--{self.name}-step-time", self.step_time, "s"),
        )
        for option, given, unit in finite:
            if given is not None:
                checks.finite(option, given, unit)
        if self.frequency is not None:
            checks.positive(self.frequency_option, self.frequency, "Hz")

    def _refuse_idle(self) -> None:
        """Refuse what would change nothing: it was meant to."""
        amplitude, sine = (self.value, self.value_option), (self.frequency, self.frequency_option)
        dependent = (
            (self.frequency_option, self.frequency, "Hz", amplitude),
            (f"--{self.name}-step-time", self.step_time, "s", amplitude),
            (f"--{self.name}-bias", self.bias, self.unit, sine),
            (f"--{self.name}-phase", self.phase, "rad", sine),
        )
        for option, given, unit, (needed, needed_option) in dependent:
            if given is not None and needed is None:
                raise ValueError(
                    f"{option} {given:g} {unit} changes nothing without {needed_option}; give that, too"
                )


def force_drive(given: Mapping[str, Any]) -> Drive:
    """The force, from the values of a command's options by name; options that it has not count as not given."""
    return _drive_of("force", "N", ("--force", "force"), ("--force-frequency", "force_frequency"), given)


def field_drive(given: Mapping[str, Any]) -> Drive:
    """The field, likewise."""
    return _drive_of(
        "field", "V/m", ("--field-amplitude", "field_amplitude"), ("--frequency", "frequency"), given
    )


def _drive_of(
    name: str, unit: str, value: tuple[str, str], frequency: tuple[str, str], given: Mapping[str, Any]
) -> Drive:
    """`value` and `frequency`: option and name of its value."""
    return DriveOptions(
        name,
        unit,
        value[0],
        frequency[0],
        value=given[value[1]],
        frequency=given[frequency[1]],
        bias=given.get(f"{name}_bias"),
        phase=given.get(f"{name}_phase"),
        step_time=given.get(f"{name}_step_time"),
        ramp=given.get(f"{name}_ramp"),
        table=given.get(f"{name}_table"),
    ).drive()
