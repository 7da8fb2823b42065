"""What a target is: a kind of file that every model is emitted as, in a language of its own."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from delagrange.derive.kernel.spec import KernelSpec
from delagrange.derive.notation.printer import ExpressionPrinter


@dataclass(frozen=True)
class Target:
    """A kind of file, how expressions are written in it, and the names that its code keeps for itself."""

    suffix: str  # of the file's name, after that of the model
    printer: ExpressionPrinter
    render: Callable[[KernelSpec], str]
    reserved: frozenset[str] = frozenset()  # names that the code is written with
    numbered: frozenset[str] = frozenset()  # and those that it counts: constant_1, slope_1_2

    def reserves(self, name: str) -> bool:
        """Whether the code gives a name to something of its own."""
        counted = re.fullmatch("(.+?)(_[0-9]+)*", name)
        return name in self.reserved or (counted is not None and counted[1] in self.numbered)
