"""Ctrl-C: one line that says what was lost and what was kept."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class Interrupted(Exception):
    """The user stopped a command; the message says what became of its work."""


@contextmanager
def interruptible(consequence: str) -> Iterator[None]:
    """Turn Ctrl-C inside of the block into `Interrupted` with its consequence."""
    try:
        yield
    except KeyboardInterrupt:
        raise Interrupted(consequence) from None
