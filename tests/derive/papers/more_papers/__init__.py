"""Papers of the tests: each a folder, as in `delagrange.derive.papers`."""
