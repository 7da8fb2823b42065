"""The kind of a motion, with its evidence."""
