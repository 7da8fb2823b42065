"""What of an expression does not move: computed once a trajectory, and loaded as one number."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from delagrange.derive.kernel.spec import Assignment


@dataclass
class Constants:
    """Collects the constant parts of expressions under names `constant_1`, `constant_2`, ...

    It grows while expressions are folded, in their order; `values` is what comes of it.
    """

    still: frozenset[sp.Symbol]  # symbols that do not move
    values: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)

    def assignments(self) -> tuple[Assignment, ...]:
        """What the names stand for, in the order in which they were given."""
        return tuple(Assignment(name.name, value) for value, name in self.values.items())

    def fold(self, expression: sp.Expr) -> sp.Expr:
        """The expression with its constant parts replaced by names."""
        if expression.is_Atom and expression not in self.still:
            return expression
        if self._is_still(expression):
            return self._named(expression)
        if expression.is_Mul:
            return self._folded_product(expression)
        if expression.is_Add:
            return self._folded_sum(expression)
        return expression.func(*(self.fold(argument) for argument in expression.args))

    def _is_still(self, expression: sp.Expr) -> bool:
        return bool(expression.free_symbols) and expression.free_symbols <= self.still

    def _named(self, value: sp.Expr) -> sp.Expr:
        """A name for a constant; its sign stays outside, so that a constant and its negative share it."""
        negative = value.could_extract_minus_sign()
        size = -value if negative else value
        name = self.values.setdefault(size, sp.Symbol(f"constant_{len(self.values) + 1}"))
        return -name if negative else name

    def _folded_product(self, expression: sp.Expr) -> sp.Expr:
        still, moving = expression.as_independent(*self._moving(expression), as_Add=False)
        if not still.free_symbols:
            return still * self.fold(moving) if still != 1 else self._folded_factors(moving)
        if moving.is_Add and _takes_a_factor(moving, self.still):
            return self._folded_sum(sp.Add(*(still * term for term in moving.args)))
        return self._named(still) * self.fold(moving)

    def _folded_factors(self, product: sp.Expr) -> sp.Expr:
        return product.func(*(self.fold(factor) for factor in product.args))

    def _folded_sum(self, expression: sp.Expr) -> sp.Expr:
        still, moving = expression.as_independent(*self._moving(expression), as_Add=True)
        folded = sp.Add(*(self.fold(term) for term in sp.Add.make_args(moving)))
        return folded + (self._named(still) if still.free_symbols else still)

    def _moving(self, expression: sp.Expr) -> list[sp.Symbol]:
        return sorted(expression.free_symbols - self.still, key=str)


def _takes_a_factor(total: sp.Expr, still: frozenset[sp.Symbol]) -> bool:
    """Whether every term of a sum has a constant already: a factor then vanishes in them."""
    return all(term.free_symbols & still for term in total.args)
