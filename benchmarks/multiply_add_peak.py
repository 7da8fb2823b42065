"""One core's peak of fused multiply-adds in double precision, with vectors of several widths.

The kernel is written in LLVM's own terms: chains of `llvm.fma` on vectors that stay in registers, as many chains as
the latency of the unit asks for. What the processor runs is read off the assembly.

Such explicit vectors of eight doubles become zmm instructions wherever there is AVX-512. Ordinary loops take what LLVM
is tuned to for the processor: zmm on Zen 4, ymm on Intel's (tried with NUMBA_CPU_NAME=skylake-avx512), where zmm has
to be asked for by NUMBA_CPU_NAME and NUMBA_CPU_FEATURES together, the latter with all features that are to be used
(+avx512f,+avx512vl,+avx512dq,+fma,+avx2,+avx) and -prefer-256-bit. On Zen 4 both widths have the same peak.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

REGISTERS = {2: "xmm", 4: "ymm", 8: "zmm"}  # by doubles in a vector
_CHAINS = 12  # latency of 4 or 5 cycles times two units, rounded up; 14 registers in all, so that 16 suffice
_FACTOR, _TERM = 0.999999, 1e-6  # the fixed point is 1: nothing overflows, nothing becomes subnormal


@dataclass(frozen=True)
class Peak:
    """What one width of vectors gave."""

    doubles: int  # in a vector, as asked for
    registers: str  # what the multiply-adds of the assembly work on
    multiply_adds: int  # of them in the loop's assembly
    rate: float  # [10^9 floating-point operations a second], a multiply-add counted as two


def chains(doubles: int) -> Callable[[int], float]:
    """Compiled function of the number of turns: `_CHAINS` multiply-adds of vectors a turn, and their sum."""
    builder = _intrinsic(doubles)

    @njit
    def kernel(turns):
        return builder(turns)

    kernel.compile((types.int64,))
    return kernel


def _intrinsic(doubles: int):
    @intrinsic
    def multiply_add_chains(typing_context, turns):
        def generate(context, builder, signature, arguments):
            return _loop(builder, arguments[0], doubles)

        return types.float64(types.int64), generate

    return multiply_add_chains


def _loop(builder: ir.IRBuilder, turns: ir.Value, doubles: int) -> ir.Value:
    """The loop's text: one phi a chain, one call of `llvm.fma` on each."""
    vector = ir.VectorType(ir.DoubleType(), doubles)
    factor, term = (ir.Constant(vector, [value] * doubles) for value in (_FACTOR, _TERM))
    function = ir.FunctionType(vector, [vector] * 3)
    fma = cgutils.get_or_insert_function(builder.module, function, f"llvm.fma.v{doubles}f64")
    before, body = builder.block, builder.append_basic_block("chains")
    after = builder.append_basic_block("sum")
    builder.branch(body)
    builder.position_at_end(body)
    count = builder.phi(ir.IntType(64))
    states = [builder.phi(vector) for _ in range(_CHAINS)]
    moved = [builder.call(fma, [state, factor, term]) for state in states]
    following = builder.add(count, ir.Constant(ir.IntType(64), 1))
    count.add_incoming(ir.Constant(ir.IntType(64), 0), before)
    count.add_incoming(following, body)
    for place, (state, new) in enumerate(zip(states, moved)):
        state.add_incoming(ir.Constant(vector, [1.0 + place / 8] * doubles), before)
        state.add_incoming(new, body)
    builder.cbranch(builder.icmp_signed("<", following, turns), body, after)
    builder.position_at_end(after)
    return _sum(builder, moved, doubles)


def _sum(builder: ir.IRBuilder, vectors: list[ir.Value], doubles: int) -> ir.Value:
    total = vectors[0]
    for vector in vectors[1:]:
        total = builder.fadd(total, vector)
    entries = [builder.extract_element(total, ir.IntType(32)(place)) for place in range(doubles)]
    result = entries[0]
    for entry in entries[1:]:
        result = builder.fadd(result, entry)
    return result


def fused_instructions(assembly: str) -> dict[str, int]:
    """How many packed multiply-adds of doubles there are on each kind of register."""
    lines = re.findall(r"^\s*vfm(?:add|sub)\d+pd\s.*$", assembly, flags=re.MULTILINE)
    counts = {name: sum(f"%{name}" in line for line in lines) for name in REGISTERS.values()}
    return {name: count for name, count in counts.items() if count}


def peak(doubles: int, seconds: float = 0.05, repeats: int = 7) -> Peak:
    """The best of several rates, each over about so many seconds."""
    kernel = chains(doubles)
    counts = fused_instructions("\n".join(kernel.inspect_asm().values()))
    turns = _turns_for(kernel, seconds)
    best = min(_time(kernel, turns) for _ in range(repeats))
    rate = 2 * _CHAINS * doubles * turns / best / 1e9
    return Peak(doubles, " and ".join(counts) or "none", sum(counts.values()), rate)


def _turns_for(kernel: Callable[[int], float], seconds: float) -> int:
    turns = 1000
    while _time(kernel, turns) < seconds / 4:
        turns *= 2
    return int(turns * seconds / _time(kernel, turns)) + 1


def _time(kernel: Callable[[int], float], turns: int) -> float:
    begin = perf_counter()
    kernel(turns)
    return perf_counter() - begin


@njit(fastmath=True)
def _plain_loop(x, y):
    for i in range(len(x)):
        y[i] = y[i] * 0.5 + x[i] * 0.25 + 1.0


def plain_loop_registers() -> dict[str, int]:
    """Packed multiply-adds of an ordinary Numba loop over arrays: which width the compiler takes by itself."""
    _plain_loop(np.ones(8), np.ones(8))
    return fused_instructions("\n".join(_plain_loop.inspect_asm().values()))


def measured() -> dict[str, object]:
    """Peaks for all widths, and what an ordinary loop uses; JSON."""
    peaks = [peak(doubles) for doubles in REGISTERS]
    return {
        "widths": [vars(one) for one in peaks],
        "best_gigaflops": max(one.rate for one in peaks),
        "plain_loop": plain_loop_registers(),
    }
