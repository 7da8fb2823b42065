"""What the arrays of an ensemble kernel hold, row by row."""

from __future__ import annotations

from delagrange.derive.emit.compiled import Rows, placed
from delagrange.derive.kernel.compiled_spec import CompiledSpec


def work_rows(spec: CompiledSpec, stages: int) -> tuple[Rows, ...]:
    """Rows of the work array of a kernel whose interpolant needs `stages` stages."""
    n, q, inputs = len(spec.model.state), spec.model.coordinate_count, len(spec.model.inputs)
    return placed(
        [
            ("FIFTH", 1, "sum of squares of the error estimate of order 5"),
            ("THIRD", 1, "of that of order 3"),
            ("FLAG", 1, "whether the step must be looked into"),
            ("POINT", n, "state at a stage, at last at the end of the step"),
            ("INPUT", inputs, "inputs at a stage"),
            ("TURNS", inputs, "argument of the sine of each input at the start of the step, over 2 pi"),
            ("TURNS_STEP", inputs, "its change over the step"),
            ("LINE", inputs, "the line under that sine at the start of the step"),
            ("LINE_STEP", inputs, "its change over the step"),
            ("CONSTANT", len(spec.constants), "what of the equations does not move"),
            ("DRIVE", 5 * inputs, "the piece of the drives, as below"),
            ("TIME", 1, "[s], at the start of the step"),
            ("END", 1, "[s], at its end"),
            ("START", 1, "[s], of the piece of the drives"),
            ("STEP", 1, "[s]"),
            ("MEASURED", 1, "1 in the window of extrema and averages, else 0"),
            ("MEASURED_TIME", 1, "[s], in the window, of the pieces before"),
            ("SAMPLE", 1, "number of the next sample"),
            ("SAMPLE_TIME", 1, "[s], of it"),
            ("RUN", 1, "the trajectory"),
            ("KIND", 1, "what a queued step is looked into for, as FLAG"),
            ("STEPS", 1, "accepted"),
            ("REJECTIONS", 1, "steps tried in vain"),
            ("HIGHEST", q, "of each coordinate at the ends of steps"),
            ("LOWEST", q, "of each coordinate at the ends of steps"),
            ("SUM", q, "integral of each coordinate over time [s]"),
            ("SQUARE_SUM", q, "of its square"),
            ("STATE", n, "at the start of the step"),
            ("RATE_0", n, "of the state, at the start of the step; those of the other stages follow"),
            *((f"RATE_{stage}", n, "") for stage in range(1, stages)),
            ("STOP", 1, "[s], of the piece of the drives"),
            ("WISH", 1, "[s], the step that the error asks for, were there no STOP"),
            ("LENGTH", 1, "[s], of the step just tried"),
            ("ERROR", 1, "squared, in units of the tolerance"),
            ("OLD_ERROR", 1, "its binary logarithm at the last accepted step"),
            ("ACCEPTED", 1, "1 or 0"),
            ("LEAVES", 1, "1 at the end of a piece, 2 where the step is no longer resolved, else 0"),
            ("FRESH", 1, "1 where the rate at the start of the step is still to be computed"),
            ("STEP_SUM", q, "mean of each coordinate over the step"),
            ("STEP_SQUARE", q, "of its square"),
            ("TOP", q, "value of each coordinate where it turns in the step"),
            ("NEARBY", q, "how far that may be off"),
            ("RECORD", 2 * q, "highest and lowest TOP of each coordinate so far"),
            ("RECORD_NEARBY", 2 * q, "how far that may be off"),
            ("RECORD_TIME", 2 * q, "[s], at the start of the step that holds it"),
            ("RECORD_STEP", 2 * q, "[s], of that step; 0 where there is none"),
            ("RECORD_STATE", 2 * q * n, "at the start of that step"),
            ("END_SLOPE", q, "rate of each coordinate at the end of a queued step"),
            ("LEAST", 1, "least principal stretch at the end of a queued step [1]"),
            ("MOST", 1, "largest in-plane stretch there [1]"),
            *((f"DENSE_{term}", n, "" if term else "terms of the interpolant") for term in range(7)),
        ]
    )  # fmt: skip


def table_rows(spec: CompiledSpec) -> tuple[Rows, ...]:
    """Rows of what a trajectory is made of."""
    return placed(
        [
            ("FIRST_CONSTANT", len(spec.constants), "what `constants` returns"),
            ("FIRST_STATE", len(spec.model.state), "at t = 0"),
            ("FIRST_SAMPLE", 1, "[s]"),
            ("SAMPLE_SPACING", 1, "[s]"),
        ]
    )


def result_rows(spec: CompiledSpec) -> tuple[Rows, ...]:
    """Rows of what is kept of a trajectory."""
    n, q = len(spec.model.state), spec.model.coordinate_count
    return placed(
        [
            ("MAXIMUM", q, "of each coordinate in the window [1]"),
            ("MINIMUM", q, ""),
            ("MEAN", q, "in the window [1]"),
            ("MEAN_SQUARE", q, ""),
            ("LAST_STATE", n, "at the end or at the loss"),
            ("STATUS", 1, "one of the four below"),
            ("STATUS_TIME", 1, "[s], when the run ended"),
            ("STEPS_TAKEN", 1, ""),
            ("STEPS_REJECTED", 1, ""),
        ]
    )
