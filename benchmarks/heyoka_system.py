"""A model as heyoka sees it: one integrator for all runs, eight of them at a time.

heyoka: Biscani & Izzo (2021), Mon. Not. R. Astron. Soc. 504, 2614. Written in two ways: PLAIN, as its documentation
does, in SI units with the field as hy.sin of hy.time; TUNED, after what was found to make it faster here. In both
the equations are those of the emitted module on heyoka's symbols, so that heyoka gets the shared subexpressions found
at the derivation: at tight tolerances faster by 1/4 (uniaxial: by half) than the derived expressions as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import delagrange
from benchmarks.cases import Case, Runs
from benchmarks.membrane import parameter_values

BATCH = 8


@dataclass(frozen=True)
class Writing:
    """A way to write the same equations down."""

    time_unit: float  # [s]
    sine_as_states: bool  # sin(2 pi f t) by two more equations


PLAIN = Writing(time_unit=1.0, sine_as_states=False)
TUNED = Writing(time_unit=1e-4, sine_as_states=True)
TUNING = (
    "time in units of 0.1 ms, so that stretches and rates are of one size and the norm of the state, which sets "
    "the step, is not that of the rate alone: about 2/5 fewer steps than in seconds",
    "sin(2 pi f t) as two more states, s' = w c and c' = -w s: up to 5 % faster than heyoka's sine of the time",
    "extrema by a callback compiled by Numba, on the Taylor coefficients of the step, at places in memory that are "
    "compiled in: 0.2 µs a call where a callback in Python takes several",
    "an extremum is looked for only where the rate changes sign within the step and the record can be beaten",
)
TRIED = (
    "eight runs a batch (4, 16, 32 and 64 took longer a run) and fast_math; compact mode took twice as long, "
    "force_avx512 and slp_vectorize changed nothing; heyoka's own events took longer than its continuous output"
)


def system(model: str, writing: Writing) -> list[tuple]:
    """Equations (symbol, derivative by the time of the writing); pars are P [N], E_0 [V/m], f [Hz]."""
    import heyoka

    module = delagrange.load_model(model)
    symbols = np.array(heyoka.make_vars(*(entry.name for entry in module.STATE)), dtype=object)
    sine, more = _sine_states(writing) if writing.sine_as_states else _sine_of_time(writing)
    inputs = (heyoka.par[0], heyoka.par[1] * sine)
    if writing.time_unit == 1.0:
        return [*zip(symbols, module.rhs(list(symbols), inputs, parameter_values(model))), *more]
    scale = _state_scale(model, writing)
    slopes = module.rhs(list(symbols / scale), inputs, parameter_values(model))
    count = module.COORDINATE_COUNT
    scaled = (slopes * scale * writing.time_unit)[count:]
    return [*zip(symbols, [*symbols[count : 2 * count], *scaled]), *more]


def _sine_of_time(writing: Writing) -> tuple[object, list[tuple]]:
    import heyoka

    return heyoka.sin(2 * np.pi * writing.time_unit * heyoka.par[2] * heyoka.time), []


def _sine_states(writing: Writing) -> tuple[object, list[tuple]]:
    import heyoka

    sine, cosine = heyoka.make_vars("sine", "cosine")
    turn = 2 * np.pi * writing.time_unit * heyoka.par[2]
    return sine, [(sine, turn * cosine), (cosine, -turn * sine)]


def _state_scale(model: str, writing: Writing) -> np.ndarray:
    """Scaled state over state, (n_state,): rates are by the time of the writing."""
    module = delagrange.load_model(model)
    count = module.COORDINATE_COUNT
    scale = np.ones(len(module.STATE))
    scale[count : 2 * count] = writing.time_unit
    return scale


def initial_state(model: str, writing: Writing) -> np.ndarray:
    """At rest in the reference state, (n_state or n_state + 2, BATCH)."""
    rest = delagrange.load_model(model).reference_state(parameter_values(model))
    more = [0.0, 1.0] if writing.sine_as_states else []
    return np.repeat(np.concatenate([rest, more])[:, None], BATCH, axis=1)


def batches(runs: Runs) -> np.ndarray:
    """Parameters of each batch, (n_batches, 3, BATCH); the last run fills up the last batch."""
    places = np.arange(-(-len(runs) // BATCH) * BATCH).clip(max=len(runs) - 1)
    padded = runs.take(places)
    table = np.array([padded.force, padded.field_amplitude, padded.frequency])
    return np.ascontiguousarray(table.reshape(3, -1, BATCH).swapaxes(0, 1))


def integrator(model: str, writing: Writing, tolerance: float, **options: object):
    """A compiled integrator of BATCH runs; opt_level 3 and no compact mode are heyoka's defaults."""
    import heyoka

    return heyoka.taylor_adaptive_batch(
        system(model, writing),
        initial_state(model, writing),
        tol=tolerance,
        pars=np.zeros((3, BATCH)),
        **({"fast_math": True, "high_accuracy": False, "compact_mode": False, "opt_level": 3} | options),
    )


def start(one, rest: np.ndarray, parameters: np.ndarray) -> None:
    """Put an integrator at the beginning of a batch."""
    one.set_time(0.0)
    one.state[:] = rest
    one.pars[:] = parameters


def written_duration(case: Case, writing: Writing) -> float:
    """The duration in the time of the writing."""
    return case.duration / writing.time_unit
