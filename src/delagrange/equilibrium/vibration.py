"""The linearised motion about an equilibrium: stiffness, vibrations, and whether it is stable."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from delagrange.equilibrium.statics import Statics
from delagrange.problem.dashpots import coordinate_places, dashpot_places, rate_places

STABLE, SADDLE, UNSTABLE, MARGINAL = "stable", "saddle", "unstable", "limit point"
STABILITY_MEANING = (
    "stable: every small disturbance stays small; saddle: it grows in some directions of motion and not in "
    "others; unstable: it grows in all; limit point: exactly where a stable and an unstable equilibrium meet"
)
_GROWS = 1e-10  # of the largest eigenvalue; below, a real part is round-off


@dataclass(frozen=True)
class Vibration:
    """Modes q(t) = shape exp(rate t) of the coordinates about an equilibrium."""

    rates: np.ndarray  # (n_modes,) of complex [1/s], imaginary part not negative
    shapes: np.ndarray  # (n_coordinates, n_modes), of unit length; the largest entry is positive


@dataclass(frozen=True)
class Spectrum:
    """What is known of the vibrations about one equilibrium; NaN where there is none."""

    status: str
    state: np.ndarray  # (n_state,)
    rates: np.ndarray  # (n_coordinates,) of complex [1/s]
    shapes: np.ndarray  # (n_coordinates, n_coordinates), of each mode in a column
    relaxation: np.ndarray  # (n_state,), real rates [1/s]


def stiffness_and_mass(statics: Statics, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """K = -dF/dq [J] and M [kg m^2] at rest, (n_coordinates, n_coordinates), with the dashpots held."""
    model, arguments = statics.problem.model, statics.arguments(x)
    mass = model.mass_matrix(*arguments)
    slopes = model.jacobian(*arguments)[rate_places(model), coordinate_places(model)]
    stiffness = -mass @ slopes
    return (stiffness + stiffness.T) / 2, mass


def growing_directions(statics: Statics, x: np.ndarray) -> int:
    """In how many directions a small disturbance grows."""
    if not statics.flowing.size:
        return int(np.sum(eigh(*stiffness_and_mass(statics, x), eigvals_only=True) < 0))
    eigenvalues = _quick_eigenvalues(statics, x)
    return int(np.sum(eigenvalues.real > _GROWS * np.max(np.abs(eigenvalues))))


def stability_margin(statics: Statics, x: np.ndarray) -> float:
    """Positive where an equilibrium is stable, negative where it is not; only the sign has a meaning."""
    if not statics.flowing.size:
        return float(eigh(*stiffness_and_mass(statics, x), eigvals_only=True)[0])
    return -float(np.max(_quick_eigenvalues(statics, x).real))


def _quick_eigenvalues(statics: Statics, x: np.ndarray) -> np.ndarray:
    return np.linalg.eigvals(_of_moving(statics, _with_quick_dashpots(statics, statics_jacobian(statics, x))))


def stability_name(statics: Statics, growing: int) -> str:
    """STABLE, SADDLE or UNSTABLE."""
    if growing == 0:
        return STABLE
    return UNSTABLE if growing >= statics.problem.model.COORDINATE_COUNT else SADDLE


def vibration(statics: Statics, x: np.ndarray) -> Vibration:
    """The modes with frozen dashpots, by increasing frequency; what grows comes first.

    Generalised symmetric problem K a = ω^2 M a, as of any conservative system about an equilibrium.
    """
    squares, shapes = eigh(*stiffness_and_mass(statics, x))
    return Vibration(1j * np.sqrt(squares.astype(complex)), _normalised(shapes))


def relaxing_vibration(statics: Statics, x: np.ndarray) -> tuple[Vibration, np.ndarray]:
    """The modes that vibrate while dashpots and charge flow, by increasing frequency; the real rates of all else [1/s].

    From the eigenvalues of the full Jacobian.
    """
    jacobian = _of_moving(statics, statics_jacobian(statics, x))
    values, vectors = np.linalg.eig(jacobian)
    round_off = _GROWS * np.max(np.abs(values))  # by which equal real rates, as of equal branches, come apart
    vibrating = np.flatnonzero(values.imag > round_off)
    vibrating = vibrating[np.argsort(values.imag[vibrating])]
    shapes = vectors[coordinate_places(statics.problem.model)][:, vibrating]
    turned = [_turned_real(shape) for shape in shapes.T]
    shapes = np.array(turned).T if turned else np.zeros((len(shapes), 0))
    return Vibration(values[vibrating], _normalised(shapes)), np.sort(
        values[np.abs(values.imag) <= round_off].real
    )


def statics_jacobian(statics: Statics, x: np.ndarray) -> np.ndarray:
    """(n_state, n_state), emitted with the model."""
    return statics.problem.model.jacobian(*statics.arguments(x))


def _of_moving(statics: Statics, jacobian: np.ndarray) -> np.ndarray:
    """The rows and columns of what moves about an equilibrium: without frozen dashpots."""
    return jacobian[np.ix_(statics.moving, statics.moving)]


def _with_quick_dashpots(statics: Statics, jacobian: np.ndarray) -> np.ndarray:
    """The Jacobian with dashpots that flow about as fast as the membrane vibrates.

    A dashpot only dissipates, so that no viscosity makes an equilibrium stable or unstable (Kelvin and Tait);
    but where relaxation is far slower than vibration, its rates drown in the round-off of the others.
    """
    model = statics.problem.model
    flows, rates = dashpot_places(model), rate_places(model)
    vibrating = np.sqrt(np.max(np.abs(jacobian[rates, coordinate_places(model)])))
    quick = np.array(jacobian)
    flowing = np.max(np.abs(jacobian[flows]), initial=0.0)
    if flowing > 0:
        quick[flows] *= vibrating / flowing
    return quick


def _turned_real(shape: np.ndarray) -> np.ndarray:
    """The shape with the phase at which its largest entry is real; the parts out of phase with it are left out."""
    largest = shape[np.argmax(np.abs(shape))]
    return (shape * np.conj(largest) / np.abs(largest)).real


def _normalised(shapes: np.ndarray) -> np.ndarray:
    if not shapes.size:
        return shapes
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    sizes = np.round(np.abs(shapes), 9)  # of two that are equal but for round-off, the first
    largest = shapes[np.argmax(sizes, axis=0), np.arange(shapes.shape[1])]
    return shapes * np.sign(largest)
