"""A body is a motion: where its points are by a few stretches, how it is strained there, and what works on it.

The derivation asks a body for what stands here and knows nothing else of its shape; each shape has a file of its
own (`rectangle`), and only that file knows it. A new one comes in as a `Body` that is filled in. What is integrated
over it, its volume and its kinetic energy, is computed here and never written down.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import sympy as sp

from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.notation.time_derivative import time_derivative

Place = tuple[sp.Expr, ...]  # Cartesian components [m]


@dataclass(frozen=True)
class Extent:
    """A material coordinate, and between which values of it the body lies in the reference state."""

    coordinate: sp.Symbol
    start: sp.Expr
    end: sp.Expr


@dataclass(frozen=True)
class Domain:
    """What an integral over the reference state goes over; its element is the integrand of volume or area."""

    extents: tuple[Extent, ...]
    element: sp.Expr = sp.S.One  # 1 for Cartesian material coordinates, R for cylindrical ones, ...

    def integral(self, density: sp.Expr) -> sp.Expr:
        """The integral of a density, exactly."""
        integral = density * self.element
        for extent in self.extents:
            integral = sp.integrate(integral, (extent.coordinate, extent.start, extent.end))
        return integral


@dataclass(frozen=True)
class Face:
    """A face that a medium touches: the places of its points, and its domain in the reference state."""

    place: Place
    domain: Domain
    count: int = 1  # of faces that move alike but for their direction


@dataclass(frozen=True)
class Body:
    """An incompressible body that is strained alike everywhere.

    Its coordinates are its first principal stretches, one or two; the others follow from them. The third is the
    one through the thickness, along which the electric field points. Each force works on the conjugate of its
    coordinate: on a length [m] if it is one, on a volume [m^3] if it is a pressure.
    """

    text: str  # what it is, a sentence without its full stop
    sizes: tuple[Quantity, ...]  # in the reference state [m]
    density: Quantity
    coordinates: tuple[TimeDependent, ...]
    principal_stretches: Stretches  # by the coordinates [1]
    place: Place  # of each material point [m]
    domain: Domain
    forces: tuple[Quantity, ...]  # one a coordinate
    conjugates: tuple[sp.Expr, ...]  # what each force works on
    on_edges: str  # where the forces pull, for people
    faces: tuple[Face, ...] = ()
    edges: Mapping[int, tuple[sp.Expr, ...]] = field(default_factory=lambda: MappingProxyType({}))
    # ^ by axis, from 1, where along it the edges are that something can sit on [m]
    unlike: str = ""  # why its two axes cannot be exchanged, "" where they can

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        return (*self.sizes, self.density)

    def stretches_of(self, others: tuple[TimeDependent, ...]) -> Stretches:
        """Principal stretches with `others` in place of the coordinates, such as the inelastic ones of a dashpot."""
        values = {
            own.value.symbol: other.value.symbol for own, other in zip(self.coordinates, others, strict=True)
        }
        first, second, third = (
            stretch.subs(values, simultaneous=True) for stretch in self.principal_stretches
        )
        return first, second, third

    def velocity(self, place: Place) -> Place:
        """Rate of change of a place [m/s]."""
        return tuple(time_derivative(component, self.coordinates) for component in place)


def square(vector: Place) -> sp.Expr:
    """Its length squared."""
    return sum((component**2 for component in vector), sp.Integer(0))


def volume_of(body: Body) -> sp.Expr:
    """Volume [m^3], in the reference state and ever after."""
    return sp.expand(body.domain.integral(sp.Integer(1)))


def kinetic_energy(body: Body) -> sp.Expr:
    """Kinetic energy T [J], the integral of rho v^2 / 2 over the body, Eq. (3) of Sheng et al. (2015)."""
    density = body.density.symbol / 2 * square(body.velocity(body.place))
    return sp.expand(body.domain.integral(sp.expand(density)))


def potential_of_forces(body: Body) -> sp.Expr:
    """Potential [J] of the dead loads: minus each force times what it works on."""
    pairs = zip(body.forces, body.conjugates, strict=True)
    return -sum((force.symbol * conjugate for force, conjugate in pairs), sp.Integer(0))


def check_body(body: Body) -> None:
    """That a body keeps its volume, and that its coordinates are its first principal stretches.

    Raises:
        ValueError: it does not, or they are not.
    """
    ratio = sp.simplify(sp.Mul(*body.principal_stretches))
    if ratio != 1:
        raise ValueError(f"{body.text}: its volume changes by {ratio}; allowed is an incompressible body")
    own = tuple(coordinate.value.symbol for coordinate in body.coordinates)
    if not 1 <= len(own) <= 2 or own != body.principal_stretches[: len(own)]:
        found = ", ".join(map(str, body.principal_stretches))
        raise ValueError(
            f"{body.text}: its principal stretches are {found}; allowed is one coordinate or two that are the "
            f"first of them, got {', '.join(map(str, own))}"
        )
    if not len(own) == len(body.forces) == len(body.conjugates):
        raise ValueError(f"{body.text}: {len(body.forces)} forces; allowed is one for each coordinate")
