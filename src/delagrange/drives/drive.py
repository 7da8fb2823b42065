"""What drives a membrane over time: force [N] or nominal field [V/m] as a function of time.

A drive has no unit of its own: its values are in the unit of the input that it drives. Numbers in a
drive may be arrays of one value a lane, for many runs at once (not in `Tabulated`).
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from delagrange.common import checks
from delagrange.common.units import with_unit

Values = float | np.ndarray
_INPUT_UNIT = "the unit of the driven input"


class Drive:
    """A function of time, smooth between its breakpoints."""

    def at(self, time: Values) -> Values:
        """Value at `time` [s]; broadcasts over both."""
        raise NotImplementedError

    def breakpoints(self, start: float, stop: float) -> tuple[float, ...]:
        """Times [s] strictly between `start` and `stop` at which the drive is not smooth, increasing."""
        return ()

    def piece(self, start: float, stop: float) -> Drive:
        """A smooth drive equal to this one between `start` and `stop` [s], where it has no breakpoint.

        At the ends it takes the limit from inside: a step of an integrator that lands on a jump must
        not see the value after it.
        """
        return self

    def check_window(self, name: str, start: float, stop: float) -> None:
        """Raise ValueError where the drive says nothing about a part of `start` to `stop` [s]."""

    def take(self, lanes: np.ndarray | slice) -> Drive:
        """The drive of some of the lanes."""
        arrays = {f.name: getattr(self, f.name) for f in fields(self) if np.ndim(getattr(self, f.name))}
        return replace(self, **{name: array[lanes] for name, array in arrays.items()}) if arrays else self

    def __str__(self) -> str:
        numbers = ", ".join(f"{f.name}={with_unit(getattr(self, f.name), '1')}" for f in fields(self))
        return f"{type(self).__name__}({numbers})"


def _set_finite(drive: Drive, *names: str, unit: str = _INPUT_UNIT) -> None:
    for name in names:
        checked = checks.finite(f"{type(drive).__name__} {name}", getattr(drive, name), unit)
        object.__setattr__(drive, name, checked)


def _set_positive(drive: Drive, name: str, unit: str) -> None:
    checked = checks.positive(f"{type(drive).__name__} {name}", getattr(drive, name), unit)
    object.__setattr__(drive, name, checked)


def _inside(times: Values, start: float, stop: float) -> tuple[float, ...]:
    """The distinct times strictly between `start` and `stop`, increasing."""
    distinct = np.unique(times)
    return tuple(float(time) for time in distinct[(distinct > start) & (distinct < stop)])


@dataclass(frozen=True)
class Constant(Drive):
    """`value` at all times: for a run from rest, a step at its start."""

    value: Values

    def __post_init__(self) -> None:
        _set_finite(self, "value")

    def at(self, time: Values) -> Values:
        return self.value + np.zeros(np.shape(time)) if np.ndim(time) else self.value


@dataclass(frozen=True)
class Sine(Drive):
    """`bias + amplitude * sin(2 pi frequency t + phase)`, frequency in Hz, phase in rad.

    As it is written, and so right to a microturn after 10^9 turns; compiled kernels compute the phase exactly.
    """

    amplitude: Values
    frequency: Values  # [Hz]
    bias: Values = 0.0
    phase: Values = 0.0  # [rad]

    def __post_init__(self) -> None:
        _set_finite(self, "amplitude", "bias")
        _set_finite(self, "phase", unit="rad")
        _set_positive(self, "frequency", "Hz")

    def at(self, time: Values) -> Values:
        return self.bias + self.amplitude * np.sin(2 * np.pi * self.frequency * time + self.phase)


@dataclass(frozen=True)
class Step(Drive):
    """`before` until `time` [s], `value` from then on."""

    value: Values
    time: Values = 0.0  # [s]
    before: Values = 0.0

    def __post_init__(self) -> None:
        _set_finite(self, "value", "before")
        _set_finite(self, "time", unit="s")

    def at(self, time: Values) -> Values:
        return np.where(time >= self.time, self.value, self.before)[()]

    def breakpoints(self, start: float, stop: float) -> tuple[float, ...]:
        return _inside(self.time, start, stop)

    def piece(self, start: float, stop: float) -> Drive:
        return Constant(self.at(start))


SHORTEST_RAMP = 1e-12  # [s]; a shorter one is a step to any integrator


@dataclass(frozen=True)
class Ramp(Drive):
    """From `start` to `stop`, linearly, within `duration` [s] after `begin` [s]; constant outside."""

    start: Values
    stop: Values
    duration: Values  # [s]
    begin: Values = 0.0  # [s]

    def __post_init__(self) -> None:
        _set_finite(self, "start", "stop")
        _set_finite(self, "begin", unit="s")
        _set_positive(self, "duration", "s")
        if np.min(self.duration) < SHORTEST_RAMP:
            raise ValueError(
                f"Ramp duration must be at least {SHORTEST_RAMP:g} s, got {self.duration} s; use a Step"
            )

    def at(self, time: Values) -> Values:
        done = np.clip((time - self.begin) / self.duration, 0.0, 1.0)
        return self.start + done * (self.stop - self.start)

    def breakpoints(self, start: float, stop: float) -> tuple[float, ...]:
        return _inside(np.append(self.begin, np.add(self.begin, self.duration)), start, stop)

    def piece(self, start: float, stop: float) -> Drive:
        return _line_through(self, start, stop)


@dataclass(frozen=True, eq=False)
class Tabulated(Drive):
    """Linear interpolation between `values` at `times` [s]; says nothing outside of them.

    Every time of the table is a breakpoint at which integration restarts.
    """

    times: np.ndarray  # (n_times,) [s], strictly increasing
    values: np.ndarray  # (n_times,)

    def __post_init__(self) -> None:
        times = checks.increasing("Tabulated times", self.times, "s")
        values = np.atleast_1d(checks.finite("Tabulated values", self.values, _INPUT_UNIT))
        if times.shape != values.shape or len(times) < 2:
            raise ValueError(
                f"Tabulated times and values must be of one length of at least 2, got {len(times)} times [s] "
                f"and {values.shape} values"
            )
        for name, array in (("times", times.copy()), ("values", values.copy())):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def at(self, time: Values) -> Values:
        return np.interp(time, self.times, self.values)

    def breakpoints(self, start: float, stop: float) -> tuple[float, ...]:
        return _inside(self.times, start, stop)

    def piece(self, start: float, stop: float) -> Drive:
        return _line_through(self, start, stop)

    def check_window(self, name: str, start: float, stop: float) -> None:
        first, last = self.times[0], self.times[-1]
        if first > start or last < stop:
            raise ValueError(
                f"{name} table covers {first:g} s to {last:g} s and does not cover the run, "
                f"{start:g} s to {stop:g} s"
            )

    def take(self, lanes: np.ndarray | slice) -> Drive:
        return self


@dataclass(frozen=True)
class Line(Drive):
    """`value + slope * (t - origin)`: one smooth piece of a ramp or a table."""

    value: Values
    slope: Values  # [unit of the input / s]
    origin: float  # [s]

    def at(self, time: Values) -> Values:
        return self.value + self.slope * (time - self.origin)


def _line_through(drive: Drive, start: float, stop: float) -> Drive:
    first, last = drive.at(start), drive.at(stop)
    return Line(first, (last - first) / (stop - start), start)


def as_drive(name: str, given: Drive | Values, unit: str) -> Drive:
    """The drive itself, or a constant one from a number (or an array, one number a lane).

    Raises:
        ValueError: neither a drive nor a finite number.
    """
    return given if isinstance(given, Drive) else Constant(checks.finite(name, given, unit))
