"""How far a sine has turned, whole turns left out: exact, however many it has made."""

from __future__ import annotations

import numpy as np

Values = float | np.ndarray
_SPLIT = 134217729.0  # 2^27 + 1: parts a double in two halves whose products are exact


def fraction_of_turns(frequency: Values, time: Values) -> Values:
    """frequency [Hz] * time [s] without its whole turns [1]: the rounding of the product is made good.

    The product alone would be off by 1e-7 turns after 10^9 of them. Compiled kernels compute it the same way.
    Dekker (1971), Numer. Math. 18, 224, Sec. 5.
    """
    product = frequency * time
    frequency_high, frequency_low = _halves(frequency)
    time_high, time_low = _halves(time)
    slip = frequency_high * time_high - product
    slip = slip + frequency_high * time_low + frequency_low * time_high + frequency_low * time_low
    return (product - np.rint(product)) + slip


def _halves(value: Values) -> tuple[Values, Values]:
    rest = _SPLIT * value
    high = rest - (rest - value)
    return high, value - high


def fraction_of_period(phase: Values) -> Values:
    """Part of a period, in [0, 1), that an angle [rad] is; rounding must not make it a whole one."""
    fraction = np.mod(phase / (2 * np.pi), 1.0)
    return np.where(fraction == 1.0, 0.0, fraction)[()]
