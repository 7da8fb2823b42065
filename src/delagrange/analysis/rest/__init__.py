"""A membrane at rest: equilibria, the limits of its loads, natural vibrations."""
