"""`python -m delagrange.derive`: derive, check against the print, write the generated modules.

Nothing is written where a verdict departs from its record; `--record` makes the verdicts found the
recorded ones. With `--check` nothing is written at all: the modules are regenerated aside and
compared byte for byte.
"""

from __future__ import annotations

import argparse
import sys
from importlib import resources
from pathlib import Path

from delagrange.derive import pipeline
from delagrange.derive.check import record
from delagrange.derive.check.report import as_text, summary
from delagrange.derive.emit.folder import stale, surplus
from delagrange.derive.emit.write_together import write_together
from delagrange.derive.pipeline import Derivation


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m delagrange.derive", description=__doc__)
    one = parser.add_mutually_exclusive_group()
    one.add_argument("--check", action="store_true", help="compare with what is checked in, write nothing")
    one.add_argument("--record", action="store_true", help="record the verdicts found as the expected ones")
    generated = Path(str(resources.files("delagrange.generated")))
    parser.add_argument("--out", type=Path, default=generated, help="folder of the modules")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Derive and check, then compare, record or write.

    Returns:
        The exit status: 0; 1 where a verdict departs from its record or the folder is not what the
        derivation emits; 2, with one line on standard error, where something cannot be read,
        derived, proved or written.
    """
    options = _options(arguments)
    try:
        return _run(options)
    except ValueError as error:
        _complain(" ".join(str(error).split()))
        return 2


def _run(options: argparse.Namespace) -> int:
    walked = pipeline.walk()
    print(as_text(walked.verdicts))
    print(f"\n{summary(walked.verdicts)}")
    departed = walked.departures
    if options.check:
        return _checked(walked, departed, options.out)
    if departed and not options.record:
        _complain_of(departed)
        _complain("no module is written: the verdicts are not as recorded; `--record` records them")
        return 1
    write_together(walked.modules, options.out)
    print(f"{len(walked.modules)} modules in {options.out}")
    if options.record:
        _record(walked, departed)
    return 0


def _checked(walked: Derivation, departed: tuple[str, ...], folder: Path) -> int:
    """Name each verdict and each file that is not as it should be."""
    old, other = stale(walked.modules, folder), surplus(walked.modules, folder)
    _complain_of(departed)
    for name in old:
        _complain(f"stale: {folder / name} is not what the derivation emits; run `delagrange derive`")
    for name in other:
        _complain(f"surplus: {folder / name} holds what the derivation does not emit")
    return 1 if departed or old or other else 0


def _record(walked: Derivation, departed: tuple[str, ...]) -> None:
    """Make the verdicts found the recorded ones, and say what that changes."""
    for each in walked.checked:
        path = record.record_path(each.paper)
        write_together(((path.name, record.to_json(each.verdicts)),), path.parent)
    for line in departed:
        print(f"changed in the record: {line}")
    print(f"{len(walked.verdicts)} verdicts recorded, changes: {len(departed)}")


def _complain_of(departed: tuple[str, ...]) -> None:
    for line in departed:
        _complain(f"not as recorded: {line}")


def _complain(line: str) -> None:
    print(line, file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
