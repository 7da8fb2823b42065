"""Whether the header of a model and its module are of one text: the header states a digest of both."""

from __future__ import annotations

import re
from hashlib import sha256

_DIGITS = 32
_STATED = re.compile(rb'(?m)^#define MODEL_DIGEST "([0-9a-f]{%d})"$' % _DIGITS)
UNSTATED = "0" * _DIGITS  # where the digest is to stand, while it is computed


def header_digest(module: bytes, header: bytes) -> str:
    """Digest of the text of a module and of that of its header but for what it states."""
    rest = _STATED.sub(f'#define MODEL_DIGEST "{UNSTATED}"'.encode(), header)
    return sha256(sha256(module).digest() + sha256(rest).digest()).hexdigest()[:_DIGITS]


def stated_digest(header: bytes) -> str | None:
    """The digest that a header states, or None."""
    found = _STATED.findall(header)
    return found[0].decode() if len(found) == 1 else None


def belongs(module: bytes, header: bytes) -> bool:
    """Whether both are as they were emitted together."""
    return stated_digest(header) == header_digest(module, header)
