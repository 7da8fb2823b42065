"""Extrema of a batch of heyoka by a step callback in Python, from its dense output.

As cheap as was found: NumPy tells over the batch whether a rate has changed its sign in the step; the one or two
lanes that have are gone through as plain numbers, which took half of the time of arrays of eight.
"""

from __future__ import annotations

import numpy as np

_ENOUGH = 1e-6  # of the rate at the ends of the step: the value at the turn is then right to about 1e-12


class StepExtrema:
    """Step callback of an integrator: largest and smallest value so far of coordinate 0 of every lane."""

    def __init__(self, one, rate: int) -> None:
        self._update = one.update_d_output
        self._value, self._rate, self._time, self._step = one.state[0], one.state[rate], one.time, one.last_h
        self._inner_value, self._inner_rate = one.d_output[0], one.d_output[rate]
        lanes = len(self._value)
        self._old_value, self._old_rate = np.empty(lanes), np.empty(lanes)
        self._product, self._at = np.empty(lanes), np.empty(lanes)
        self.begin()

    def begin(self) -> None:
        """Forget all but the state at which the integrator stands."""
        self.maximum, self.minimum = self._value.tolist(), self._value.tolist()
        self._old_value[:], self._old_rate[:] = self._value, self._rate

    def __call__(self, one) -> bool:
        np.multiply(self._old_rate, self._rate, out=self._product)
        if self._product.min() < 0.0:
            for lane in np.flatnonzero(self._product < 0.0).tolist():
                self._turn(lane)
        self._old_value[:], self._old_rate[:] = self._value, self._rate
        return True

    def amplitude(self) -> np.ndarray:
        """Half of peak to peak, the state at which the integrator stands included, (n_lanes,)."""
        return (np.maximum(self.maximum, self._value) - np.minimum(self.minimum, self._value)) / 2

    def _turn(self, lane: int) -> None:
        """Take the turn of a lane within the step, unless it cannot beat the record."""
        before, after = self._old_rate.item(lane), self._rate.item(lane)
        step, end = self._step.item(lane), self._time.item(lane)
        first, last = self._old_value.item(lane), self._value.item(lane)
        reach = max(abs(before), abs(after)) * step
        if before > 0.0:
            if max(first, last) + reach > self.maximum[lane]:
                top = self._value_at_turn(lane, end - step, end, before, after)
                self.maximum[lane] = max(self.maximum[lane], top)
        elif min(first, last) - reach < self.minimum[lane]:
            top = self._value_at_turn(lane, end - step, end, before, after)
            self.minimum[lane] = min(self.minimum[lane], top)

    def _value_at_turn(self, lane: int, low: float, high: float, before: float, after: float) -> float:
        """By the Illinois variant of the false position on the rate."""
        enough, rising, side = _ENOUGH * max(abs(before), abs(after)), before > 0.0, 0
        while True:
            time = high - after * (high - low) / (after - before)
            self._at.fill(time)
            self._update(self._at)
            rate = self._inner_rate.item(lane)
            if abs(rate) <= enough or not low < time < high:
                return self._inner_value.item(lane)
            if (rate > 0.0) == rising:
                low, before, after, side = time, rate, after / 2 if side == 1 else after, 1
            else:
                high, after, before, side = time, rate, before / 2 if side == -1 else before, -1
