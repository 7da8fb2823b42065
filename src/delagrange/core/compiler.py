"""The C compiler of this machine: which one it is, and what it is told."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

CHOICE = "DELAGRANGE_CC"  # variable of the environment: a command; "none" where no compiler is to be used
_USUAL = ("cc", "gcc", "clang")
_ZIG = "ziglang"
_PATIENCE = 300.0  # [s]

_FLAGS = ("-O2", "-ffp-contract=off", "-shared", "-fPIC", "-fvisibility=hidden", "-w")


class NoCompiler(RuntimeError):
    """There is no C compiler, or it does not do what it is told; the message is one line."""


@dataclass(frozen=True)
class Compiler:
    """A command that compiles C, and what tells it from others of that name."""

    command: tuple[str, ...]
    identity: str
    is_zig: bool = False

    def flags(self, level: str | None) -> tuple[str, ...]:
        """What it is told: for a level of the processor, as x86-64-v3, or for the plainest one where None."""
        if level is None:
            return _FLAGS
        return (*_FLAGS, f"-march={level.replace('-', '_') if self.is_zig else level}")


def find_compiler() -> Compiler:
    """The compiler that DELAGRANGE_CC names, else cc, gcc or clang, else that of the package ziglang.

    Raises:
        NoCompiler: there is none.
    """
    chosen = os.environ.get(CHOICE, "").strip()
    if chosen:
        return _chosen(chosen)
    for name in _USUAL:
        if path := shutil.which(name):
            return Compiler((path,), _identity(path))
    found = find_spec(_ZIG)
    if found is not None and found.origin is not None:
        return Compiler((sys.executable, "-m", _ZIG, "cc"), _identity(found.origin), is_zig=True)
    raise NoCompiler(
        f"no C compiler is there (looked for {', '.join(_USUAL)}); `pip install 'delagrange[compiler]'` brings one, "
        f"or set {CHOICE}"
    )


def _chosen(text: str) -> Compiler:
    if text == "none":
        raise NoCompiler(f"{CHOICE} is none")
    try:
        first, *others = shlex.split(text)
    except ValueError as error:
        raise NoCompiler(f"{CHOICE} = {text!r} is no command: {error}") from None
    path = shutil.which(first)
    if path is None:
        raise NoCompiler(f"{CHOICE} = {text!r}: there is no command {first!r}")
    return Compiler((path, *others), _identity(path), is_zig="zig" in text)


def _identity(path: str) -> str:
    """Which file a command is: its place, size and time, as long as it is the same one."""
    try:
        real = Path(path).resolve()
        told = real.stat()
    except OSError:
        return path
    return f"{path} {real} {told.st_size} {told.st_mtime_ns}"


def compile_shared(compiler: Compiler, arguments: tuple[str, ...], folder: Path) -> None:
    """Run the compiler in a folder.

    Raises:
        NoCompiler: it fails; the message has the command and the first line in which it says why.
    """
    command = (*compiler.command, *arguments)
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL,
            env={**os.environ, "LC_ALL": "C"}, timeout=_PATIENCE, check=False,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError) as error:
        raise NoCompiler(f"`{shlex.join(command)}` cannot be run: {_one_line(str(error))}") from error
    if done.returncode != 0:
        raise NoCompiler(f"`{shlex.join(command)}` failed: {_first_error(done.stderr, done.returncode)}")


def _first_error(said: str, status: int) -> str:
    lines = [line for line in said.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    return _one_line((errors or lines or [f"exit status {status}, and it said nothing"])[0])


def _one_line(text: str) -> str:
    return " ".join(text.split())
