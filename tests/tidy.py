"""Emitted modules are tidy: no line is too long and no name is unused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def check_tidy(*paths: Path) -> None:
    """One start of ruff for all of them."""
    for path in paths:
        assert max(map(len, path.read_text(encoding="utf-8").splitlines())) <= 120, path
    command = [sys.executable, "-m", "ruff", "check", "--isolated", "--select", "F,E7,E9", *map(str, paths)]
    subprocess.run(command, check=True)
