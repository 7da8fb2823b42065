"""Extrema of a coordinate over one step of a batch, from the Taylor coefficients of that step.

Called after each step of heyoka, more than half a million times a sweep: as a compiled function without arguments,
on arrays whose places in memory are compiled in. A call costs 0.2 microseconds; with the arrays as arguments it took
about 1, and as a C function through ctypes 0.6.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import carray, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

_ITERATIONS = 8
_ENOUGH = (
    1e-9  # of the step: a move of Newton's method after which the turn is known to the rounding of its value
)


@njit(cache=True)
def widen(coefficients, step, state, rate, maximum, minimum):
    """Take the turns of coordinate 0 within the step into `maximum` and `minimum`, (n_lanes,).

    `coefficients` (n_state, order + 1, n_lanes) are those of the step just made, `step` (n_lanes,) its length,
    `state` (n_state, n_lanes) its end. A turn lies above the ends by less than their larger rate times the step.
    """
    for lane in range(len(step)):
        before, after = coefficients[rate, 0, lane], state[rate, lane]
        if before * after >= 0.0:
            continue
        first, last, h = coefficients[0, 0, lane], state[0, lane], step[lane]
        reach = max(abs(before), abs(after)) * h
        if max(first, last) + reach > maximum[lane] and before > 0.0:
            maximum[lane] = max(
                maximum[lane], _turn(coefficients, rate, lane, h * before / (before - after), h)
            )
        elif min(first, last) - reach < minimum[lane] and before < 0.0:
            minimum[lane] = min(
                minimum[lane], _turn(coefficients, rate, lane, h * before / (before - after), h)
            )


@njit(cache=True)
def _turn(coefficients, rate, lane, start, step):
    """Value where the rate is zero, by Newton's method on its polynomial; `start` is a first guess of the time."""
    time, last = start, coefficients.shape[1] - 1
    for _ in range(_ITERATIONS):
        slope, bend = 0.0, 0.0
        for k in range(last, -1, -1):
            bend = bend * time + slope
            slope = slope * time + coefficients[rate, k, lane]
        move = -slope / bend if bend != 0.0 else 0.0
        time = min(max(time + move, 0.0), step)
        if abs(move) < _ENOUGH * step:
            break
    value = 0.0
    for k in range(last, -1, -1):
        value = value * time + coefficients[0, k, lane]
    return value


@intrinsic
def _pointer(typing_context, address):
    """The pointer at an address known at compile time."""

    def generate(context, builder, signature, arguments):
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


def step_callback(
    coefficients: np.ndarray,
    step: np.ndarray,
    state: np.ndarray,
    rate: int,
    maximum: np.ndarray,
    minimum: np.ndarray,
) -> Callable[[object], bool]:
    """`widen` on these very arrays as a step callback of heyoka, which keeps them alive.

    Raises:
        ValueError: an array whose memory is not in one piece.
    """
    arrays = (coefficients, step, state, maximum, minimum)
    if not all(array.flags.c_contiguous for array in arrays):
        raise ValueError("step_callback needs arrays whose memory is in one piece")
    at_coefficients, at_step, at_state, at_maximum, at_minimum = (array.ctypes.data for array in arrays)
    shape, state_shape, lanes = coefficients.shape, state.shape, step.shape

    @njit
    def widen_at_places():
        widen(
            carray(_pointer(at_coefficients), shape, np.float64),
            carray(_pointer(at_step), lanes, np.float64),
            carray(_pointer(at_state), state_shape, np.float64),
            rate,
            carray(_pointer(at_maximum), lanes, np.float64),
            carray(_pointer(at_minimum), lanes, np.float64),
        )
        return True

    def after_step(_: object, _kept: tuple[np.ndarray, ...] = arrays) -> bool:
        return widen_at_places()

    return after_step
