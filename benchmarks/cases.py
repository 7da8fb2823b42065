"""What is computed: the amplitude-frequency curves of Figs. 4 and 7 of Sheng et al. (2015), as runs.

The loads, frequencies and the window are those of `delagrange.reproduction.runs.cases`: two panels of three curves,
the curve that stands in both panels computed twice, since six curves are drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from delagrange.reproduction.runs.cases import RESPONSES, Panel, ResponseFigure


@dataclass(frozen=True)
class Runs:
    """One run an entry, from rest, each array (n_runs,)."""

    force: np.ndarray  # P [N]
    field_amplitude: np.ndarray  # E_0 [V/m]
    frequency: np.ndarray  # f [Hz]

    def __len__(self) -> int:
        return len(self.force)

    def take(self, places: np.ndarray) -> Runs:
        return Runs(self.force[places], self.field_amplitude[places], self.frequency[places])


@dataclass(frozen=True)
class Case:
    """Panels of response curves of one model, of SHENG_2015's membrane; the measure is the amplitude of its
    first coordinate over the duration."""

    name: str
    model: str
    panels: tuple[Panel, ...]
    frequency: np.ndarray  # (n_frequencies,) [Hz]
    duration: float  # [s]

    @property
    def runs(self) -> Runs:
        """All runs: panel after panel, curve after curve, frequency after frequency."""
        loads = [load for panel in self.panels for load in panel.loads]
        count = len(self.frequency)
        return Runs(
            np.repeat([load.force for load in loads], count),
            np.repeat([load.field_amplitude for load in loads], count),
            np.tile(self.frequency, len(loads)),
        )

    def thinned(self, every: int) -> Case:
        """The same curves at every n-th frequency."""
        return replace(self, frequency=self.frequency[::every])


def _case(figure: ResponseFigure) -> Case:
    return Case(figure.model, figure.model, figure.panels, figure.frequency, figure.window)


CASES: dict[str, Case] = {
    figure.model: _case(figure) for figure in RESPONSES if figure.model in ("equal_biaxial", "uniaxial")
}


def spread(size: int, count: int | None, group: int = 1) -> np.ndarray:
    """Places of about `count` runs spread evenly over `size`, so over all curves and all frequencies; all for None.

    group: so many neighbours stay together, as they would among all
    """
    if count is None or count >= size:
        return np.arange(size)
    groups = -(-size // group)
    first = group * np.unique(np.round(np.linspace(0, groups - 1, count // group)).astype(int))
    places = (first[:, None] + np.arange(group)).ravel()
    return places[places < size]
