"""The C of the core: no compiler complains, no sanitizer finds a fault, and a C program can use it without Python."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from core_builds import CORE, GENERATED, MODELS, PLAIN, compiled, compilers, march

import delagrange as dl
from delagrange.core.build import PARTS
from delagrange.core.write_pair import pair_text

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-ffp-contract=off", "-c")
FOUND = compilers()


def test_the_pair_is_that_of_scipy():
    assert (CORE / "pair.h").read_bytes() == pair_text().encode("ascii")


@pytest.mark.parametrize("compiler", FOUND)
@pytest.mark.parametrize("part", PARTS)
def test_plain_c99_gives_no_warning(compiler, part, tmp_path):
    for model in ("equal_biaxial", "uniaxial"):
        header = GENERATED / f"{model}.h"
        plain = () if part == "trajectory" else ("-DWIDTH=1",)
        said = compiled(
            CORE / f"{part}.c", tmp_path / "x.o", *STRICT, *plain, header=header, command=FOUND[compiler]
        )
        assert said == ""


@pytest.mark.parametrize("compiler", FOUND)
@pytest.mark.parametrize("part", PARTS)
def test_vectors_give_no_warning(compiler, part, tmp_path):
    header = GENERATED / "pure_shear_consistent_free.h"
    options = (*PLAIN, "-Wall", "-Wextra", "-Werror", march(compiler))
    assert (
        compiled(CORE / f"{part}.c", tmp_path / "x.so", *options, header=header, command=FOUND[compiler])
        == ""
    )


def test_every_public_function_is_said_in_the_public_header():
    public = (CORE / "delagrange.h").read_text(encoding="utf-8")
    declared = set(re.findall(r"^DELAGRANGE_API [a-z_ *]+?(delagrange_\w+)\(", public, re.M))
    defined = set()
    for part in PARTS:
        defined |= set(re.findall(r"^[a-z_]+ (delagrange_\w+)\(", (CORE / f"{part}.c").read_text(), re.M))
    assert declared == defined and len(declared) == 9


def test_no_state_is_kept_between_calls():
    """No variable at the top of a file but constants."""
    for source in (*CORE.glob("*.c"), *CORE.glob("*.h")):
        for line in source.read_text(encoding="utf-8").splitlines():
            assert not re.match(r"(static )?(double|int|int64_t|vec|char|void \*)\b[^()]*[;=]", line), (
                source.name,
                line,
            )


PROGRAM = CORE.parents[3] / "examples" / "one_run.c"


def test_a_short_program_in_c_finds_what_python_finds(tmp_path):
    header = GENERATED / "equal_biaxial.h"
    options = ("-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-ffp-contract=off")
    compiled(PROGRAM, tmp_path / "program", *options, str(CORE / "trajectory.c"), header=header)
    said = subprocess.run([tmp_path / "program"], capture_output=True, text=True, check=True).stdout
    found = np.array([line.split() for line in said.splitlines()], dtype=float)
    exact = dl.simulate(
        "equal_biaxial",
        force=0.2,
        field=dl.Sine(1e6, 300.0),
        duration=0.01,
        time=found[:, 0],
        rtol=1e-12,
        atol=1e-14,
    )
    np.testing.assert_allclose(found[:, 1], exact["stretch"], rtol=1e-8)


SANITIZED = Path(__file__).with_name("sanitized.c")


@pytest.mark.parametrize("width", [1, 2, 8])
@pytest.mark.parametrize("model", ["uniaxial", "pure_shear_consistent"])
def test_sanitizers_find_nothing(model, width, tmp_path):
    """Every array of its exact size, lanes that are lost or no numbers among others, small budgets."""
    assert model in MODELS
    sanitize = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    options = (
        "-std=gnu99",
        "-g",
        "-O0",
        "-DDELAGRANGE_SMALL",
        *sanitize,
        "-ffp-contract=off",
        "-w",
        f"-DWIDTH={width}",
    )
    header = GENERATED / f"{model}.h"
    for part in PARTS:  # trajectory.c has a width of its own
        own = [option for option in options if part != "trajectory" or "WIDTH" not in option]
        compiled(CORE / f"{part}.c", tmp_path / f"{part}.o", "-c", *own, march("gcc"), header=header)
    objects = [str(tmp_path / f"{part}.o") for part in PARTS]
    compiled(SANITIZED, tmp_path / "program", *options, march("gcc"), *objects, header=header)
    done = subprocess.run([tmp_path / "program"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "0 0 0" and done.stderr == ""
