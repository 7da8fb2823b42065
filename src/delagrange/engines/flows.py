"""The flows of a model, and which one "auto" stands for."""

from __future__ import annotations

import warnings
from types import ModuleType

from delagrange.common import checks
from delagrange.engines.core_flow import flow_by_core
from delagrange.engines.engines import why_no_core
from delagrange.engines.flow import Flow
from delagrange.engines.flow_compiled import flow_compiled
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.model.kernels import VARIATIONAL, kernel_name, load_kernel, why_not_compiled
from delagrange.problem.problem import Problem

FLOWS = ("auto", "compiled", "core", "scipy")


def resolve_flow(problem: Problem, engine: str = "auto") -> Flow:
    """The flow by its name; "auto" is the compiled one where the model has a kernel for it, else SciPy's.

    The first use of a kernel on a machine compiles it, which takes seconds. Warns where there is a kernel and
    compiled code cannot run on this machine.

    Raises:
        ValueError: an unknown name, or a compiled flow is asked for by name and cannot run.
    """
    checks.choice("engine", engine, FLOWS)
    if engine == "scipy":
        return flow_by_scipy
    model = problem.model
    if engine == "core":
        if reason := why_no_core(model, "tangents"):
            raise ValueError(f"engine 'core' cannot run this: {reason}; use 'scipy', or 'auto'")
        return flow_by_core
    missing = kernel_name(model, VARIATIONAL) is None
    broken = None if missing else _why_not_compiled(model)
    if not (missing or broken):
        return flow_compiled
    if engine == "compiled":
        reason = broken or f"no variational kernel stands beside the module of the model {model.MODEL}"
        raise ValueError(f"engine 'compiled' cannot run this: {reason}; use 'scipy', or 'auto'")
    if broken:
        warnings.warn(f"{broken}; the motion is followed by engine 'scipy', much more slowly", stacklevel=3)
    return flow_by_scipy


def _why_not_compiled(model: ModuleType) -> str | None:
    """Why compiled code does not run on this machine."""
    reason = why_not_compiled()
    if reason is not None:
        return f"compiled code cannot run here ({reason})"
    try:
        load_kernel(kernel_name(model, VARIATIONAL))
    except RuntimeError as error:
        return f"compiled code cannot run here ({error})"
    return None
