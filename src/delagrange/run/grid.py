"""The grid of a sweep: axes over which values vary, laid out as lanes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from delagrange.common import checks

MOST_RUNS = 50_000_000  # the outcome of each takes some hundred bytes


@dataclass(frozen=True)
class Grid:
    """Named axes in order; the last varies fastest over the lanes. Values of one number make no axis."""

    axes: Mapping[str, np.ndarray]  # name -> (n_values,)
    single: Mapping[str, float]  # name -> the one value
    units: Mapping[str, str]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def size(self) -> int:
        """Number of lanes."""
        return int(np.prod(self.shape, dtype=int))

    def lane_values(self, lanes: slice) -> dict[str, float | np.ndarray]:
        """Value of every name in the lanes: (n_lanes,) along an axis, a number where there is but one."""
        places = np.unravel_index(np.arange(lanes.start, lanes.stop), self.shape)
        return dict(self.single) | {name: self.axes[name][place] for name, place in zip(self.axes, places)}


def make_grid(values: Mapping[str, float | np.ndarray], units: Mapping[str, str], always: str) -> Grid:
    """The grid over checked `values`; the name `always` makes an axis even with one value, and is checked as one.

    Raises:
        ValueError: values along an axis that are not one-dimensional, none, or not distinct.
    """
    axes, single = {}, {}
    for name, given in values.items():
        array = np.asarray(given)
        if array.ndim == 0 and name != always:
            single[name] = float(array)
        else:
            axes[name] = array if name == always else checks.distinct(name, array, units[name])
    grid = Grid(axes, single, dict(units))
    if grid.size > MOST_RUNS:
        lengths = " x ".join(f"{len(along)} {name}" for name, along in axes.items())
        raise ValueError(f"grid of {lengths} has {grid.size} runs; at most {MOST_RUNS} are allowed")
    return grid
