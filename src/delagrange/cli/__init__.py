"""The command line `delagrange`. Nothing heavy is imported before a command needs it."""

from __future__ import annotations

from delagrange.cli.app import main

__all__ = ["main"]
