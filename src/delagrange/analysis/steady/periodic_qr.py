"""Eigenvalues of a long product of matrices, the smallest as accurate, relatively, as the largest.

Multiplied out, a product loses what is smaller than its largest eigenvalue by as much as double precision has
digits. So it is not multiplied out: an orthonormal frame is carried through the factors, M_k Q_k = Q_(k+1) R_k, and
again from where it arrived, until it comes back with the same flag of subspaces. Diagonal blocks of R_k then hold the
eigenvalues. Bojanczyk, Golub & Van Dooren (1992), Proc. SPIE 1770, 31, have the product's Schur form; Dieci & Van
Vleck (1995), Appl. Numer. Math. 17, 275, the frame carried along.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

_MOST_SWEEPS = 40  # after them moduli that differ by a factor of 2 are apart
_SAME = 1e-11  # largest sine of an angle by which a subspace misses itself
_NARROW = np.log(1e4)  # spread within a block whose eigenvalues are found at once, of their logarithms


def product_logarithms(factors: np.ndarray) -> np.ndarray:
    """(n,) complex natural logarithms of the eigenvalues of factors[-1] @ ... @ factors[0], (n_factors, n, n).

    Their imaginary parts are angles in (-pi, pi]. In falling order of the real parts; of conjugates the one with
    positive angle first. A singular factor gives a real part -inf.
    """
    with np.errstate(divide="ignore"):
        closing, triangles = _schur(np.asarray(factors, dtype=float))
        parts = [_block_logarithms(closing, triangles, block) for block in _blocks(closing)]
    values = np.concatenate(parts)
    return values[np.lexsort([-values.imag, -np.cos(values.imag), -np.round(values.real, 9)])]


def _schur(factors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What turns the frame that arrives into the one that started, (n, n), and the R_k, (n_factors, n, n)."""
    frame, _ = np.linalg.qr(_scaled_product(factors)[0])  # where a first sweep arrives, but for what is lost
    for _ in range(_MOST_SWEEPS):
        arrived, triangles = _sweep(factors, frame)
        closing = frame.T @ arrived
        if _narrow(closing, triangles):
            break
        frame = arrived
    return closing, triangles


def _sweep(factors: np.ndarray, frame: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The frame carried through all factors, and the triangles on its way."""
    triangles = np.empty_like(factors)
    for place, factor in enumerate(factors):
        frame, triangles[place] = np.linalg.qr(factor @ frame)
    return frame, triangles


def _narrow(closing: np.ndarray, triangles: np.ndarray) -> bool:
    """Whether every block is so narrow that its eigenvalues can be found at once."""
    growth = np.log(np.abs(np.diagonal(triangles, axis1=1, axis2=2))).sum(axis=0)
    return all(np.ptp(growth[block]) <= _NARROW for block in _blocks(closing) if _size(block) > 1)


def _blocks(closing: np.ndarray) -> Iterator[slice]:
    """Between the places where the frame's leading subspace has come back to itself."""
    size = len(closing)
    inner = [place for place in range(1, size) if np.linalg.norm(closing[place:, :place]) <= _SAME]
    return (slice(*ends) for ends in pairwise([0, *inner, size]))


def _size(block: slice) -> int:
    return block.stop - block.start


def _block_logarithms(closing: np.ndarray, triangles: np.ndarray, block: slice) -> np.ndarray:
    """Of the eigenvalues of one diagonal block of the product."""
    product, scale = _scaled_product(triangles[:, block, block])
    return np.log(np.linalg.eigvals(closing[block, block] @ product).astype(complex)) + scale


def _scaled_product(factors: np.ndarray) -> tuple[np.ndarray, float]:
    """factors[-1] @ ... @ factors[0] over exp(scale), and scale: multiplied in pairs, so that nothing underflows."""
    scale = 0.0
    while True:
        sizes = np.maximum(np.max(np.abs(factors), axis=(1, 2)), np.finfo(float).tiny)
        factors, scale = factors / sizes[:, None, None], scale + float(np.log(sizes).sum())
        if len(factors) == 1:
            return factors[0], scale
        last = factors[len(factors) & ~1 :]  # one without a partner, or none
        factors = np.concatenate([factors[1::2] @ factors[: len(factors) - 1 : 2], last])
