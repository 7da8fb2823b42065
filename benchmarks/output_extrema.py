"""Extrema of a batch of heyoka from its continuous output, all steps of the batch at once by NumPy."""

from __future__ import annotations

import numpy as np

_ITERATIONS = 4  # of Newton's method from the false position: the value at the turn is then right to rounding


def amplitudes(output, state: np.ndarray, rate: int) -> np.ndarray:
    """Half of peak to peak of coordinate 0 of every lane, (n_lanes,); `state` is that at the end."""
    value, speed = output.tcs[:, 0, 0, :], output.tcs[:, rate, 0, :]  # at the starts of steps
    next_value, next_speed = _shifted(value, state[0]), _shifted(speed, state[rate])
    length = np.diff(output.times, axis=0)
    highest, lowest = (extreme(value, state[0]) for extreme in (_highest, _lowest))
    reach = np.maximum(np.abs(speed), np.abs(next_speed)) * length
    can_rise = np.maximum(value, next_value) + reach > highest
    can_fall = np.minimum(value, next_value) - reach < lowest
    steps, lanes = np.nonzero((speed * next_speed < 0.0) & np.where(speed > 0.0, can_rise, can_fall))
    guess = (length * speed / (speed - next_speed + (speed == next_speed)))[steps, lanes]
    turned = _values_at_turns(
        output.tcs[steps, 0, :, lanes].T, output.tcs[steps, rate, :, lanes].T, guess, length[steps, lanes]
    )
    np.maximum.at(highest, lanes, turned)
    np.minimum.at(lowest, lanes, turned)
    return (highest - lowest) / 2


def _shifted(at_starts: np.ndarray, at_end: np.ndarray) -> np.ndarray:
    return np.concatenate([at_starts[1:], at_end[None]])


def _highest(values: np.ndarray, last: np.ndarray) -> np.ndarray:
    return np.maximum(values.max(axis=0), last)


def _lowest(values: np.ndarray, last: np.ndarray) -> np.ndarray:
    return np.minimum(values.min(axis=0), last)


def _values_at_turns(
    values: np.ndarray, rates: np.ndarray, guess: np.ndarray, length: np.ndarray
) -> np.ndarray:
    """Polynomials (order + 1, n_turns) and first guesses of the time within each step, (n_turns,)."""
    bends = rates[1:] * np.arange(1, len(rates))[:, None]
    time = guess
    for _ in range(_ITERATIONS):
        time = np.clip(time - _polynomial(rates, time) / _polynomial(bends, time), 0.0, length)
    return _polynomial(values, time)


def _polynomial(coefficients: np.ndarray, time: np.ndarray) -> np.ndarray:
    total = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        total = total * time + coefficient
    return total
