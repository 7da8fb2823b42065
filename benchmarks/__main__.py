"""`python -m benchmarks [--quick] [--only PART] [--out FOLDER] [--record]`, from the root of the repository."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

RESULTS = Path(__file__).parent / "results"
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS")


def options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "--quick", action="store_true", help="few frequencies, few repeats: to see that it works"
    )
    parser.add_argument("--only", action="append", metavar="PART", help="one part (may be given again)")
    parser.add_argument("--engine", help="of the parts threads, ensembles and compile_time")
    parser.add_argument("--out", type=Path, default=Path("out/bench"), help="folder of the results")
    parser.add_argument(
        "--record", nargs="?", type=Path, const=RESULTS, metavar="FOLDER",
        help="put report, numbers and figure into a folder that is checked in too, benchmarks/results by itself; "
        "with --only machine, those that there are",
    )  # fmt: skip
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Run the parts, write the numbers after each, then the report and the figure.

    Raises:
        SystemExit: an option that makes no sense.
    """
    given = options(arguments)
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))  # before NumPy is imported
    from benchmarks.run import run

    try:
        return run(given.out, given.only, given.quick, given.engine, given.record)
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
