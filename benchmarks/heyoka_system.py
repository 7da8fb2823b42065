"""A model as heyoka sees it: one integrator for all runs, eight of them at a time.

heyoka: Biscani & Izzo (2021), Mon. Not. R. Astron. Soc. 504, 2614. The equations are those of the emitted module,
evaluated on heyoka's symbols, so that heyoka gets the shared subexpressions found at the derivation. What makes it
faster on this problem, each tried:

- time in units of 0.1 ms, so that stretches and rates are of one size and the norm of the state, which sets the
  step, is not that of the rate alone: 1/5 to 1/3 fewer steps than in seconds;
- the emitted form of the equations: at tight tolerances faster by 1/4 (uniaxial: by half) than the derived
  expressions taken over as they are;
- sin(2 pi f t) as two more states, s' = w c and c' = -w s: up to 5 % faster than heyoka's sine of the time;
- eight runs a batch (4, 16, 32 and 64 took longer a run) and fast_math; compact mode took twice as long, and
  force_avx512 and slp_vectorize changed nothing.
"""

from __future__ import annotations

import numpy as np

import delagrange
from benchmarks.cases import Case, Runs
from benchmarks.membrane import parameter_values

BATCH = 8
TIME_UNIT = 1e-4  # [s]


def system(model: str) -> list[tuple]:
    """Equations (symbol, derivative by the scaled time); pars are P [N], E_0 [V/m], f [Hz]."""
    import heyoka

    module = delagrange.load_model(model)
    symbols = np.array(heyoka.make_vars(*(entry.name for entry in module.STATE)), dtype=object)
    sine, cosine = heyoka.make_vars("sine", "cosine")
    scale = _state_scale(model)
    inputs = (heyoka.par[0], heyoka.par[1] * sine)
    slopes = module.rhs(list(symbols / scale), inputs, parameter_values(model))
    turn = 2 * np.pi * TIME_UNIT * heyoka.par[2]
    count = module.COORDINATE_COUNT
    equations = list(zip(symbols, [*symbols[count : 2 * count], *(slopes * scale * TIME_UNIT)[count:]]))
    return [*equations, (sine, turn * cosine), (cosine, -turn * sine)]


def _state_scale(model: str) -> np.ndarray:
    """Scaled state over state, (n_state,): rates are by the scaled time."""
    module = delagrange.load_model(model)
    count = module.COORDINATE_COUNT
    scale = np.ones(len(module.STATE))
    scale[count : 2 * count] = TIME_UNIT
    return scale


def initial_state(model: str) -> np.ndarray:
    """At rest in the reference state, (n_state + 2, BATCH)."""
    rest = delagrange.load_model(model).reference_state(parameter_values(model))
    return np.repeat(np.concatenate([rest, [0.0, 1.0]])[:, None], BATCH, axis=1)


def batches(runs: Runs) -> np.ndarray:
    """Parameters of each batch, (n_batches, 3, BATCH); the last run fills up the last batch."""
    places = np.arange(-(-len(runs) // BATCH) * BATCH).clip(max=len(runs) - 1)
    padded = runs.take(places)
    table = np.array([padded.force, padded.field_amplitude, padded.frequency])
    return np.ascontiguousarray(table.reshape(3, -1, BATCH).swapaxes(0, 1))


def integrator(model: str, tolerance: float, **options: object):
    """A compiled integrator of BATCH runs."""
    import heyoka

    return heyoka.taylor_adaptive_batch(
        system(model),
        initial_state(model),
        tol=tolerance,
        pars=np.zeros((3, BATCH)),
        **({"fast_math": True, "high_accuracy": False, "compact_mode": False, "opt_level": 3} | options),
    )


def start(one, rest: np.ndarray, parameters: np.ndarray) -> None:
    """Put an integrator at the beginning of a batch."""
    one.set_time(0.0)
    one.state[:] = rest
    one.pars[:] = parameters


def scaled_duration(case: Case) -> float:
    return case.duration / TIME_UNIT
