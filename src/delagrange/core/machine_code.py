"""Machine code kept on disk: whole or not at all, and loaded only where nobody else can have written it.

A file's name says what it was made of and has a checksum of what it holds, so that two processes that build the same at
once do no harm, and a damaged file is not loaded.
"""

from __future__ import annotations

import atexit
import os
import shutil
import stat
import sys
import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path

import platformdirs

FOLDER = "DELAGRANGE_CACHE_DIR"  # variable of the environment
_DIGITS = 20
_ENDING = ".dll" if sys.platform == "win32" else ".so"


class Unfit(OSError):
    """A folder that cannot be used to keep machine code; the message says why."""


def kept_or_made(name: str, key: str, make: Callable[[Path], Path]) -> Path:
    """The file of machine code of that name and key, made if it is not there.

    make: compiles within an empty folder and returns the file made.

    Warns where it cannot be kept for the next process.
    """
    folder = cache_folder()
    try:
        _check_folder(folder)
        return _found(folder, name, key) or _made(folder, name, key, make)
    except OSError as error:
        _warn_once(str(folder), " ".join(str(error).split()))
    folder = _passing_folder()
    return _found(folder, name, key) or _made(folder, name, key, make)


def made_aside(name: str, key: str, make: Callable[[Path], Path]) -> Path:
    """As `kept_or_made`, in a folder of this process alone: for what the system does not load from the usual one."""
    folder = _passing_folder()
    return _found(folder, name, key) or _made(folder, name, key, make)


def cache_folder() -> Path:
    """Where machine code is kept: DELAGRANGE_CACHE_DIR, else the user's folder for such things."""
    given = os.environ.get(FOLDER)
    return Path(given).expanduser().absolute() if given else Path(platformdirs.user_cache_dir("delagrange"))


def key_of(*parts: bytes) -> str:
    """Digest of everything that machine code is made of."""
    return sha256(b"".join(sha256(part).digest() for part in parts)).hexdigest()[:_DIGITS]


def _found(folder: Path, name: str, key: str) -> Path | None:
    """The file, where it is there, whole, and nobody else's."""
    start = f"{name}-{key}-"
    candidates = sorted(
        each for each in os.listdir(folder) if each.startswith(start) and each.endswith(_ENDING)
    )
    for each in candidates:
        path = folder / each
        checksum = each.removeprefix(start).removesuffix(_ENDING)
        try:
            if _is_own(path.lstat(), stat.S_ISREG) and _checksum(path.read_bytes()) == checksum:
                return path
        except OSError:
            continue  # another process took it away, or it cannot be read
    return None


def _made(folder: Path, name: str, key: str, make: Callable[[Path], Path]) -> Path:
    with tempfile.TemporaryDirectory(dir=folder, prefix=".unfinished-") as aside:
        made = make(Path(aside))
        made.chmod(0o700)
        path = folder / f"{name}-{key}-{_checksum(made.read_bytes())}{_ENDING}"
        with made.open("rb") as file:
            os.fsync(file.fileno())
        os.replace(made, path)
    return path


def _checksum(content: bytes) -> str:
    return sha256(content).hexdigest()[:_DIGITS]


def _check_folder(folder: Path) -> None:
    """Make the folder if it is missing; nobody but this user, and whoever may do anything, may write to it.

    Raises:
        OSError: it cannot be made, or read, or others may write to it or put another in its place.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    real = folder.resolve()
    if not _is_own(real.stat(), stat.S_ISDIR):
        raise Unfit("it is not this user's alone: others own it or may write to it")
    for above in real.parents:
        told = above.stat()
        trusted = not hasattr(os, "geteuid") or told.st_uid in (0, os.geteuid())
        if not trusted or (told.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not told.st_mode & stat.S_ISVTX):
            raise Unfit(f"others may put another in its place, in {above}")


def _is_own(told: os.stat_result, is_kind: Callable[[int], bool]) -> bool:
    if not is_kind(told.st_mode):
        return False
    if not hasattr(os, "geteuid"):
        return True
    return told.st_uid == os.geteuid() and not told.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


@cache
def _passing_folder() -> Path:
    """A folder of this process alone."""
    folder = Path(tempfile.mkdtemp(prefix="delagrange-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def _warn_once(folder: str, reason: str) -> None:
    warnings.warn(
        f"machine code cannot be kept in {folder} ({reason}), and every process will compile it anew; set {FOLDER} to "
        "a folder of yours that can be written",
        stacklevel=6,
    )
