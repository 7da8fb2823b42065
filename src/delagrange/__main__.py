"""`python -m delagrange` is the command line `delagrange`."""

from __future__ import annotations

import sys

from delagrange.cli import main

if __name__ == "__main__":
    sys.exit(main())
