"""What a description, its quantities and its texts must be."""

from __future__ import annotations

from itertools import combinations
from keyword import iskeyword

from delagrange.derive.membrane.body import check_body
from delagrange.derive.membrane.description import CHARGE, VOLTAGE, Description
from delagrange.derive.notation.symbols import Quantity


def check_description(description: Description) -> None:
    """That what is described can be one membrane.

    Raises:
        ValueError: a name that code cannot use, or choices that do not go together.
    """
    name = description.name
    if not name.isidentifier() or not name.isascii() or iskeyword(name):
        raise ValueError(
            f"model name {name!r}; allowed is a name of letters, digits and _ that Python can import"
        )
    if description.dielectric.control not in (VOLTAGE, CHARGE):
        control = description.dielectric.control
        raise ValueError(
            f"model {name}: electrodes under {control!r} control; allowed are {VOLTAGE}, {CHARGE}"
        )
    if description.dielectric.leakage is not None and description.dielectric.control != CHARGE:
        raise ValueError(
            f"model {name}: leakage under voltage control changes no motion, since the source holds the field; "
            f"allowed is leakage under {CHARGE} control"
        )
    axes = description.body.edges
    for attachment in description.attachments:
        if attachment.axis not in axes:
            allowed = f"allowed are {' and '.join(map(str, axes))}" if axes else "the body has no edges"
            raise ValueError(f"model {name}: something is attached to axis {attachment.axis}; {allowed}")
    if description.medium_damping is not None and not description.body.faces:
        raise ValueError(
            f"model {name}: a medium damps a body that has no faces; allowed is one without damping"
        )
    check_body(description.body)


def check_names(model: str, quantities: tuple[Quantity, ...]) -> None:
    """No two quantities may share a symbol or a name in code.

    Raises:
        ValueError: two do.
    """
    for one, other in combinations(quantities, 2):
        if one.name == other.name or one.symbol == other.symbol:
            raise ValueError(
                f"model {model}: {one.name} ({one.meaning}) and {other.name} ({other.meaning}) share a name or "
                "symbol; allowed are names of their own"
            )


def check_texts(description: Description, sources: tuple[str, ...], quantities: tuple[Quantity, ...]) -> None:
    """What stands between quotation marks in emitted code must not end there.

    Raises:
        ValueError: a title, a source, or what a quantity says of itself is not such a text.
    """
    said = [text for each in quantities for text in (each.text, each.unit, each.meaning)]
    own = (description.title, description.remark, description.notation.source, description.body.text)
    for text in (*own, *sources, *said):
        if not text.isprintable() or set(text) & set('"\\'):
            raise ValueError(
                f"model {description.name}: the text {text!a}; allowed are printable characters in one line, "
                'without " and \\'
            )
