"""The energy argument of dynamic pull-in: a conservative membrane, let go at rest, cannot climb above its energy."""

from __future__ import annotations

import numpy as np

from delagrange.equilibrium.continuation import Point
from delagrange.equilibrium.pieces import Piece, locate_on
from delagrange.equilibrium.statics import Statics


def barrier_at_start_energy(statics: Statics, pieces: list[Piece], start: np.ndarray) -> Point | None:
    """The unstable equilibrium whose energy is that of the start at the same field or charge; None: there is none.

    With one coordinate the membrane reaches exactly this barrier, at exactly this field: Pi(q_u) = Pi(q_0),
    dPi/dq(q_u) = 0; the argument of Joglekar (2014), J. Appl. Mech. 81, 091010. Where the start is itself beyond
    the place of static pull-in, as under a pressing force that is applied with the field, the barrier comes
    down to the start, q_u = q_0, and the membrane stands until then.

    Args:
        statics: with frozen dashpots and the electrical input varied.
        pieces: of the curve from the unloaded membrane, the stable one first.
        start: (n_state,), at rest.
    """
    for piece in pieces[1:]:
        crossings = locate_on(statics, piece, lambda x: height_above_start(statics, start, x))
        if crossings:
            return crossings[-1]
    return _barrier_at_start(statics, pieces, start) if statics.problem.model.COORDINATE_COUNT == 1 else None


def _barrier_at_start(statics: Statics, pieces: list[Piece], start: np.ndarray) -> Point | None:
    """Where the unstable equilibrium passes the start."""
    place = float(statics.x_of(start, 0.0)[0])
    crossings = [
        point for piece in pieces[1:2] for point in locate_on(statics, piece, lambda x: x[0] - place)
    ]
    return crossings[0] if crossings else None


def height_above_start(statics: Statics, start: np.ndarray, x: np.ndarray) -> float:
    """Potential energy of an equilibrium above that of the start under the same force and field [J]."""
    model = statics.problem.model
    state, inputs, parameters = statics.arguments(x)
    there, here = (model.potential_energy(place, inputs, parameters) for place in (state, start))
    return float(there - here)
