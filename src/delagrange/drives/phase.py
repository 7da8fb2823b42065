"""The phase of a sine as part of a period."""

from __future__ import annotations

import numpy as np

from delagrange.drives.drive import Values


def fraction_of_period(phase: Values) -> Values:
    """Part of a period, in [0, 1), that an angle [rad] is; rounding must not make it a whole one."""
    fraction = np.mod(phase / (2 * np.pi), 1.0)
    return np.where(fraction == 1.0, 0.0, fraction)[()]
