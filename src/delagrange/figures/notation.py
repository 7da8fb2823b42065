"""How the quantities of each model are called in the data and written on the axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Notation:
    """Names in a Dataset, and symbols in TeX, of the stretch that the paper shows of a model."""

    title: str
    stretch: str
    stretch_rate: str
    inelastic_stretch: str
    subscript: str

    @property
    def stretch_label(self) -> str:
        """λ with its unit."""
        return rf"$\lambda_\mathrm{{{self.subscript}}}$ [1]"

    @property
    def rate_label(self) -> str:
        """Rate of λ with its unit."""
        return rf"$\dot\lambda_\mathrm{{{self.subscript}}}$ [1/s]"

    @property
    def inelastic_label(self) -> str:
        """ξ with its unit."""
        return rf"$\xi_\mathrm{{{self.subscript}}}$ [1]"

    @property
    def amplitude_label(self) -> str:
        """Amplitude of λ with its unit."""
        return rf"amplitude of $\lambda_\mathrm{{{self.subscript}}}$ [1]"


FREQUENCY_LABEL = r"frequency $f$ [Hz]"
TIME_LABEL = r"time $t$ [s]"

NOTATION = {
    "equal_biaxial": Notation("Equal-biaxial force", "stretch", "stretch_rate", "inelastic_stretch", "EB"),
    "uniaxial": Notation("Uniaxial force", "stretch_1", "stretch_rate_1", "inelastic_stretch_1", "UA1"),
    "pure_shear": Notation("Pure shear", "stretch", "stretch_rate", "inelastic_stretch", "PS"),
}


def integrator_text(method: str, rtol: float, atol: float) -> str:
    """`DOP853, rtol 1e-9, atol 1e-12`."""
    relative, absolute = (np.format_float_scientific(value, trim="-", exp_digits=1) for value in (rtol, atol))
    return f"{method}, rtol {relative}, atol {absolute}"
