"""Writes `pair.h`: the Runge-Kutta pair DOP853 as sums, from the coefficients that SciPy publishes with its solver.

Run as `python -m delagrange.core.write_pair`. A test compares the file with `pair_text()`, byte for byte.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from numpy.polynomial.legendre import leggauss
from scipy.integrate import DOP853

_QUADRATURE_POINTS = 8  # exact for the square of the interpolant, of degree 14

_HEAD = """\
/* The explicit pair DOP853 of order 8 as sums over the rates at its stages, each one chain of multiply-adds.
 *
 * Written by `python -m delagrange.core.write_pair` from the coefficients that SciPy publishes; do not edit.
 * Hairer, Norsett & Wanner (1993), Solving Ordinary Differential Equations I, Sec. II.5, II.6 and II.10.
 *
 * RATE(s) is the rate at stage s; who uses a sum says what that is. Stage s is at NODE_s of the step, and its state
 * that at the start of the step and step * SUM_s. Stage STAGES is at the end: its sum is the solution. ERROR_5 and
 * ERROR_3, times the step, are estimates of the error. Stages 13 to 15 and DENSE_3 to DENSE_6 are of the interpolant.
 * WEIGHT_s is the share of stage s in an integral over the step.
 */
#ifndef DELAGRANGE_PAIR_H
#define DELAGRANGE_PAIR_H
"""


def pair_text() -> str:
    """The text of `pair.h`."""
    return "\n".join([_HEAD, *_lines(), "", *_quadrature_lines(), "", "#endif", ""])


def _lines() -> Iterator[str]:
    last, extra = len(DOP853.B), len(DOP853.C_EXTRA)
    yield f"#define STAGES {last}"
    yield f"#define ALL_STAGES {last + 1 + extra}"
    nodes = [*DOP853.C[1:], 1.0, *DOP853.C_EXTRA]
    sums = [*DOP853.A[1:], DOP853.B, *DOP853.A_EXTRA]
    stages = [*range(1, last + 1), *range(last + 1, last + 1 + extra)]
    for stage, node, coefficients in zip(stages, nodes, sums, strict=True):
        yield f"#define NODE_{stage} {float(node)!r}"
        yield f"#define SUM_{stage} {_chain(coefficients)}"
    yield f"#define ERROR_5 {_chain(DOP853.E5)}"
    yield f"#define ERROR_3 {_chain(DOP853.E3)}"
    for term, coefficients in enumerate(DOP853.D, start=3):
        yield f"#define DENSE_{term} {_chain(coefficients)}"
    for stage in range(last + 1 + extra):
        yield f"#define WEIGHT_{stage} {float(DOP853.B[stage]) if stage < last else 0.0!r}"


def _chain(coefficients: Iterable[float]) -> str:
    (stage, first), *others = ((s, float(c)) for s, c in enumerate(coefficients) if c != 0)
    chain = f"all({first!r}) * RATE({stage})"
    for stage, coefficient in others:
        chain = f"maddc({coefficient!r}, RATE({stage}), {chain})"
    return chain


def _quadrature_lines() -> Iterator[str]:
    """Gauss and Legendre's nodes and weights on 0 .. 1, to fifteen digits, which are the same on every machine."""
    yield f"#define QUADRATURE_POINTS {_QUADRATURE_POINTS}"
    yield "/* Nodes and weights of Gauss and Legendre on 0 .. 1. */"
    yield "static const double QUADRATURE[QUADRATURE_POINTS][2] = {"
    for node, weight in zip(*leggauss(_QUADRATURE_POINTS)):
        yield f"    {{{float(1 + node) / 2:.15g}, {float(weight) / 2:.15g}}},"
    yield "};"


if __name__ == "__main__":
    (Path(__file__).parent / "c" / "pair.h").write_text(pair_text(), encoding="ascii", newline="\n")
