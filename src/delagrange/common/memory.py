"""How much memory the result of a sweep takes, and how much it may."""

from __future__ import annotations

from types import ModuleType

MOST_MEMORY = 8 * 2**30  # [B]
MOST_CHUNK = 2**30  # [B], of the samples of the lanes that are integrated at a time
_VALUE = 8  # [B]
_OF_A_COORDINATE = 9  # extrema and averages as the engine and as the Dataset have them, and the amplitude
_OF_A_RUN = 5  # status in two forms, its time, steps and rejections


def check_memory(model: ModuleType, runs: int, samples: int) -> None:
    """Refuse a sweep of so many `runs`, with so many `samples` of the state each, whose result is too large.

    Raises:
        ValueError: more than `MOST_MEMORY`; it says what takes how much.
    """
    parts = run_memory(model, samples)
    total = runs * sum(parts.values())
    if total > MOST_MEMORY:
        shares = " and ".join(f"{_gib(runs * size)} for {what}" for what, size in parts.items() if size)
        raise ValueError(
            f"the result of {runs} runs would take {_gib(total)} of memory ({shares} of every run); "
            f"at most {_gib(MOST_MEMORY)} are allowed"
        )


def run_memory(model: ModuleType, samples: int) -> dict[str, int]:
    """Memory [B] that the result of one run takes, by what takes it."""
    others = _OF_A_COORDINATE * model.COORDINATE_COUNT + len(model.STATE) + _OF_A_RUN
    return {
        f"{samples} samples of {len(model.STATE)} state variables": samples * sample_memory(model),
        "extrema, averages, final state and status": _VALUE * others,
    }


def sample_memory(model: ModuleType) -> int:
    """Memory [B] of one sample of the state."""
    return _VALUE * len(model.STATE)


def lanes_at_a_time(model: ModuleType, chunk: int, samples: int) -> int:
    """At most `chunk`, fewer where the `samples` of so many lanes would take more than `MOST_CHUNK`."""
    return max(1, min(chunk, MOST_CHUNK // max(1, samples * sample_memory(model))))


def _gib(size: float) -> str:
    return f"{size / 2**30:.2f} GiB"
