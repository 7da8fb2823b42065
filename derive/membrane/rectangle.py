"""A flat rectangle in homogeneous deformation, as in Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384."""

from __future__ import annotations

from types import MappingProxyType

import sympy as sp

from delagrange.derive.membrane.body import Body, Domain, Extent, Face
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity

_MATERIAL = sp.symbols("X Y Z", real=True)  # Cartesian, from the middle of the membrane [m]


def rectangle(
    half_length_1: Quantity = s.HALF_LENGTH,
    half_length_2: Quantity = s.HALF_LENGTH,
    half_thickness: Quantity = s.HALF_THICKNESS,
    density: Quantity = s.DENSITY,
) -> Body:
    """A membrane of sides 2 L_1, 2 L_2 and thickness 2 H; a square one has one quantity for both half lengths."""
    coordinates = (s.STRETCH_1, s.STRETCH_2)
    in_plane = [coordinate.value.symbol for coordinate in coordinates]
    stretches = (in_plane[0], in_plane[1], 1 / (in_plane[0] * in_plane[1]))
    place = tuple(
        stretch * material for stretch, material in zip(stretches, _MATERIAL, strict=True)
    )  # Eq. (1)
    sizes = (half_length_1, half_length_2, half_thickness)
    extents = tuple(
        Extent(material, -half.symbol, half.symbol) for material, half in zip(_MATERIAL, sizes, strict=True)
    )
    edges = {axis: _ends(place[axis - 1], extents[axis - 1]) for axis in (1, 2)}
    alike = half_length_1 == half_length_2
    return Body(
        text=_text(half_length_1, half_length_2, half_thickness),
        sizes=tuple(dict.fromkeys(sizes)),
        density=density,
        coordinates=coordinates,
        principal_stretches=stretches,
        place=place,
        domain=Domain(extents),
        forces=(s.FORCE_1, s.FORCE_2),
        conjugates=tuple(far - near for far, near in edges.values()),  # two forces pull opposite edges apart
        on_edges="each edge normal to axes 1 and 2",
        faces=(
            Face(
                tuple(x.subs(_MATERIAL[2], half_thickness.symbol) for x in place),
                Domain(extents[:2]),
                count=2,
            ),
        ),
        edges=MappingProxyType(edges),
        unlike="" if alike else "sides are different quantities",
    )


def _ends(place: sp.Expr, extent: Extent) -> tuple[sp.Expr, sp.Expr]:
    return place.subs(extent.coordinate, extent.end), place.subs(extent.coordinate, extent.start)


def _text(half_length_1: Quantity, half_length_2: Quantity, half_thickness: Quantity) -> str:
    sides = f"A square membrane of sides 2 {half_length_1.text}"
    if half_length_1 != half_length_2:
        sides = f"A rectangular membrane of sides 2 {half_length_1.text} and 2 {half_length_2.text}"
    return f"{sides} and thickness 2 {half_thickness.text} in the reference state"
