"""`python -m delagrange.derive`: derive, check against the print, write the generated modules.

With `--check` nothing is written: the modules are regenerated aside and compared byte for byte.
"""

from __future__ import annotations

import argparse
import sys
from importlib import resources
from pathlib import Path

from delagrange.derive import pipeline
from delagrange.derive.record import RECORD, departures, recorded, to_json
from delagrange.derive.report import as_text, summary


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m delagrange.derive", description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare with what is checked in, write nothing")
    parser.add_argument(
        "--record", action="store_true", help="record the verdicts found as the expected ones"
    )
    parser.add_argument(
        "--out", type=Path, default=_package("delagrange.generated"), help="folder of the modules"
    )
    return parser.parse_args(arguments)


def _package(name: str) -> Path:
    return Path(str(resources.files(name)))


def main(arguments: list[str] | None = None) -> int:
    """Exit status 0, or 1 where a verdict departs from its record or a module is stale."""
    options = _options(arguments)
    walked = pipeline.walk()
    print(as_text(walked.verdicts))
    print(f"\n{summary(walked.verdicts)}")
    if options.record:
        record = _package("delagrange.derive.published") / RECORD
        record.write_text(to_json(walked.verdicts), encoding="utf-8")
    departed = departures(walked.verdicts, recorded())
    for line in departed:
        print(f"not as recorded: {line}", file=sys.stderr)
    if options.check:
        old = pipeline.stale(walked.modules, options.out)
        for name in old:
            print(
                f"stale: {options.out / name} is not what the derivation emits; run `make derive`",
                file=sys.stderr,
            )
        return 1 if departed or old else 0
    pipeline.write(walked.modules, options.out)
    print(f"{len(walked.modules)} modules in {options.out}")
    return 1 if departed else 0


if __name__ == "__main__":
    sys.exit(main())
