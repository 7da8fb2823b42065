"""What Figs. 4-12 of the paper were computed for: loads, fields, frequencies, as data.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III. The field is the nominal one,
E = E_0 sin(2 pi f t); the force is a step at t = 0; the membrane starts at rest in the reference
state. The windows and grids are not stated in the paper; those here fit its numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CurveLoad:
    """One constant force, field amplitude and, in pure shear, held stretch."""

    force: float  # P [N]
    field_amplitude: float  # E_0 [V/m]
    held_stretch: float | None = None  # lambda_2p [1]


@dataclass(frozen=True)
class Panel:
    """A panel of a response figure: curves that differ in one quantity."""

    letter: str
    varied: str  # "force", "field_amplitude" or "held_stretch"
    loads: tuple[CurveLoad, ...]


@dataclass(frozen=True)
class ResponseFigure:
    """An amplitude-frequency figure."""

    number: int
    model: str
    panels: tuple[Panel, ...]
    first_frequency: float  # [Hz]
    last_frequency: float  # [Hz]
    frequency_step: float  # [Hz]
    window: float  # [s], from t = 0

    @property
    def frequency(self) -> np.ndarray:
        """Excitation frequencies [Hz], (n_frequencies,)."""
        count = round((self.last_frequency - self.first_frequency) / self.frequency_step) + 1
        return self.first_frequency + self.frequency_step * np.arange(count)

    @property
    def loads(self) -> tuple[CurveLoad, ...]:
        """All loads of the figure, each once."""
        return tuple(dict.fromkeys(load for panel in self.panels for load in panel.loads))


@dataclass(frozen=True)
class MotionFigures:
    """A figure of time histories and the figure of phase paths and Poincaré maps of the same runs."""

    history_number: int
    phase_number: int
    model: str
    load: CurveLoad
    frequencies: tuple[float, float, float]  # half the resonance, the resonance, twice the resonance [Hz]
    window: float  # of the time histories [s]


def _loads(
    forces: tuple[float, ...], fields: tuple[float, ...], held: tuple[float | None, ...]
) -> tuple[CurveLoad, ...]:
    return tuple(CurveLoad(p, e, h) for p in forces for e in fields for h in held)


def _force_and_field_panels() -> tuple[Panel, Panel]:
    return (
        Panel("a", "force", _loads((0.2, 0.5, 0.8), (1e6,), (None,))),
        Panel("b", "field_amplitude", _loads((0.5,), (1e6, 3e6, 5e6), (None,))),
    )


RESPONSES: tuple[ResponseFigure, ...] = (
    ResponseFigure(4, "equal_biaxial", _force_and_field_panels(), 100.0, 800.0, 1.0, 0.1),
    ResponseFigure(7, "uniaxial", _force_and_field_panels(), 100.0, 800.0, 1.0, 0.1),
    ResponseFigure(
        10,
        "pure_shear",
        (
            Panel("a", "force", _loads((0.1, 0.3, 0.5), (3e6,), (2.0,))),
            Panel("b", "field_amplitude", _loads((0.1,), (3e6, 4e6, 5e6), (2.0,))),
            Panel("c", "held_stretch", _loads((0.1,), (3e6,), (2.0, 3.0, 4.0))),
        ),
        1.0,
        801.0,
        5.0,
        0.12,
    ),
)

MOTIONS: tuple[MotionFigures, ...] = (
    MotionFigures(5, 6, "equal_biaxial", CurveLoad(0.5, 5e6), (185.0, 371.0, 742.0), 0.1),
    MotionFigures(8, 9, "uniaxial", CurveLoad(0.5, 5e6), (212.0, 424.0, 848.0), 0.1),
    MotionFigures(11, 12, "pure_shear", CurveLoad(0.1, 3e6, 2.0), (190.0, 381.0, 762.0), 0.12),
)
