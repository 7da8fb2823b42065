"""Periodic motions under a periodic drive, stable and unstable."""
