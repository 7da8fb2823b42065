"""From energies on paper to checked code: derive, verify, emit.

Each stage is a function from one frozen dataclass to the next; `delagrange.derive.pipeline` walks
the whole road. The derived side (`membrane` to `euler_lagrange`) never reads the printed side
(`published`, `latex`); the two meet in `verify` only.
"""
