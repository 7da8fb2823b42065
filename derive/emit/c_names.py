"""Names and texts of a model in C: nothing that a user writes can become more than a name or a comment."""

from __future__ import annotations

import re

_NAME = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_PLAIN = re.compile("[a-z][a-z0-9_]*")

_KEYWORDS = frozenset(  # of C up to C23, and what compilers define for themselves
    {"auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else", "enum", "extern"}
    | {"float", "for", "goto", "if", "inline", "int", "long", "register", "restrict", "return", "short", "signed"}
    | {"sizeof", "static", "struct", "switch", "typedef", "union", "unsigned", "void", "volatile", "while", "asm"}
    | {"typeof", "bool", "true", "false", "nullptr", "constexpr", "static_assert", "thread_local", "alignas"}
    | {"alignof", "linux", "unix", "i386"}
)
_CORE = frozenset(  # what the functions of a header are written with, and what they stand beside
    {"vec", "mask", "bits", "as_bits", "as_vec", "all", "first", "any", "holds", "pick", "below", "upto", "negative"}
    | {"madd", "maddc", "smaller", "larger", "smaller_known", "magnitude", "whole", "v", "rates", "motion"}
    | {"stretches", "validity", "energies", "energy", "constants", "reference", "state", "input", "constant"}
    | {"parameter", "rate", "tangent", "push", "groups", "group", "moved", "trace", "room", "least", "most"}
    | {"pow", "sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", "fma"}
)
_OWN = "_of_model"


def c_name(name: str) -> str:
    """The name itself, or, where C or the core has another use for it, with an ending.

    Raises:
        ValueError: it is no name.
    """
    if not _NAME.fullmatch(name):
        raise ValueError(f"{name!a} cannot be a name in C; allowed are letters, digits and _")
    plain = _PLAIN.fullmatch(name) and not name.startswith("vec_") and not name.endswith(_OWN)
    return name if plain and name not in _KEYWORDS | _CORE else f"{name.lstrip('_') or 'x'}{_OWN}"


def comment_text(text: str) -> str:
    """A text as it may stand in a comment.

    Raises:
        ValueError: it could end the comment, or is not of printable characters in one line.
    """
    if not text.isprintable() or set(text) & set('\\"') or "*/" in text or "/*" in text or "??" in text:
        raise ValueError(
            f"the text {text!a} cannot stand in a comment of C; allowed are printable characters in one line, "
            'without ", \\, ??, /* and */'
        )
    return text
