"""A task of `benchmarks.tasks` in a process of its own.

A fresh process has no compiled code, no memory used before, and as many threads as it is asked for.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parents[1]


def in_child(task: str, options: Mapping[str, object], environment: Mapping[str, str] | None = None) -> dict:
    """Run a task in a fresh process.

    Raises:
        RuntimeError: it failed; the message is the last line of what it wrote.
    """
    command = [sys.executable, "-m", "benchmarks.tasks", task, json.dumps(options)]
    variables = os.environ | dict(environment or {})
    done = subprocess.run(command, cwd=ROOT, env=variables, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise RuntimeError(f"{task} {dict(options)} failed: {last}")
    return json.loads(done.stdout)
