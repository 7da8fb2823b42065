"""How the core comes to be machine code: which compiler, what is kept where, and what may go wrong."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
from core_builds import GENERATED

import delagrange as dl
from delagrange.core import build, compiler, kernel, levels, machine_code
from delagrange.core.build import PARTS, load_library, read_header
from delagrange.core.compiler import NoCompiler, find_compiler
from delagrange.core.kernel import load_core
from delagrange.core.machine_code import cache_folder, kept_or_made

HEADER = read_header(GENERATED / "equal_biaxial.py")
CODE = """
import sys
from pathlib import Path
from delagrange.core.build import load_library, read_header
load_library("trajectory", read_header(Path(sys.argv[1])))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A cache of this test's own; what is remembered of others is forgotten."""
    machine_code._warn_once.cache_clear()
    monkeypatch.setenv("DELAGRANGE_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def own_script(folder, text, name="cc"):
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def made_of(text, calls=None):
    """Makes a file of that text, and counts how often."""

    def make(aside: Path) -> Path:
        if calls is not None:
            calls.append(aside)
        (aside / "made").write_text(text)
        return aside / "made"

    return make


# --- which compiler, which level ---------------------------------------------------------------------


def test_the_usual_names_are_looked_for_in_their_order(tmp_path, monkeypatch):
    monkeypatch.delenv("DELAGRANGE_CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    for name in ("clang", "gcc", "cc"):  # the last one there is the first one taken
        own_script(tmp_path, "exit 0", name)
        assert find_compiler().command == (str(tmp_path / name),)


def test_the_environment_chooses_with_options(tmp_path, monkeypatch):
    path = own_script(tmp_path, "exit 0", "mine")
    monkeypatch.setenv("DELAGRANGE_CC", f"{path} -m64")
    assert find_compiler().command == (str(path), "-m64")


@pytest.mark.parametrize(
    ("chosen", "reason"),
    [
        ("none", "DELAGRANGE_CC is none"),
        ("/no/such/cc", "there is no command '/no/such/cc'"),
        ('"', "is no command: No closing quotation"),
    ],
)
def test_a_choice_that_is_none_is_named(chosen, reason, monkeypatch):
    monkeypatch.setenv("DELAGRANGE_CC", chosen)
    with pytest.raises(NoCompiler, match=reason):
        find_compiler()


def test_without_any_compiler_the_message_says_what_brings_one(tmp_path, monkeypatch):
    monkeypatch.delenv("DELAGRANGE_CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(compiler, "find_spec", lambda name: None)
    with pytest.raises(
        NoCompiler, match=r"cc, gcc, clang\); `pip install 'delagrange\[compiler\]'` brings one"
    ):
        find_compiler()


def test_ziglang_is_taken_where_nothing_else_is(tmp_path, monkeypatch):
    monkeypatch.delenv("DELAGRANGE_CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    (tmp_path / "ziglang").mkdir()
    (tmp_path / "ziglang" / "__init__.py").touch()
    monkeypatch.syspath_prepend(str(tmp_path))
    found = find_compiler()
    assert found.command == (sys.executable, "-m", "ziglang", "cc")
    assert found.flags("x86-64-v3")[-1] == "-march=x86_64_v3"


def test_another_compiler_of_the_same_name_is_another(tmp_path, monkeypatch):
    path = own_script(tmp_path, "exit 0", "mine")
    monkeypatch.setenv("DELAGRANGE_CC", str(path))
    first = find_compiler()
    assert find_compiler() == first
    path.write_text("#!/bin/sh\nexit 1 # newer\n")
    assert find_compiler().identity != first.identity


V4 = (
    *["avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl", "avx", "avx2", "bmi1"],
    *["bmi2", "f16c", "fma", "movbe", "cx16", "popcnt", "sse4_1", "sse4_2", "ssse3"],
)


def test_a_level_needs_all_its_instructions():
    assert levels.level_of(V4) == "x86-64-v4"
    for missing, level in (("avx512vl", "x86-64-v3"), ("fma", "x86-64-v2"), ("ssse3", "x86-64-v4")):
        assert levels.level_of(set(V4) - {missing}) == level
    assert levels.level_of({"sse2"}) is None


def test_the_level_of_numpy_is_that_of_linux(monkeypatch):
    told = levels.processor_level()
    monkeypatch.setattr(levels, "_linux_flags", frozenset)
    assert levels.processor_level() == told
    monkeypatch.setattr(levels.platform, "machine", lambda: "arm64")
    assert levels.processor_level() is None


# --- machine code on disk ----------------------------------------------------------------------------


def test_it_is_made_once_and_found_again(folder):
    calls = []
    first = kept_or_made("model-lanes", "key", made_of("code", calls))
    assert kept_or_made("model-lanes", "key", made_of("other", calls)) == first and len(calls) == 1
    assert first.read_text() == "code" and first.parent == folder
    assert kept_or_made("model-lanes", "another", made_of("code", calls)) != first and len(calls) == 2
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        {first.name, *(p.name for p in folder.glob("*.so"))}
    )


def test_a_damaged_file_is_built_again(folder):
    first = kept_or_made("model", "key", made_of("code"))
    first.write_text("damaged")
    calls = []
    again = kept_or_made("model", "key", made_of("code", calls))
    assert len(calls) == 1 and again.read_text() == "code"


def test_a_failed_build_leaves_nothing(folder):
    def fail(aside):
        (aside / "half").write_text("half")
        raise NoCompiler("no")

    with pytest.raises(NoCompiler):
        kept_or_made("model", "key", fail)
    assert list(folder.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="modes are of POSIX")
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o722])
def test_a_folder_that_others_may_write_to_is_not_used(folder, mode):
    folder.mkdir()
    folder.chmod(mode)
    with pytest.warns(
        UserWarning, match=r"machine code cannot be kept in .*cache \(it is not this user's alone"
    ):
        path = kept_or_made("model", "key", made_of("code"))
    assert path.parent != folder and path.read_text() == "code" and list(folder.iterdir()) == []
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700


@pytest.mark.skipif(os.name != "posix", reason="modes are of POSIX")
def test_a_file_that_others_may_write_to_is_not_loaded(folder):
    first = kept_or_made("model", "key", made_of("code"))
    first.chmod(0o722)
    calls = []
    again = kept_or_made("model", "key", made_of("code", calls))
    assert len(calls) == 1 and stat.S_IMODE(again.stat().st_mode) == 0o700


def test_a_link_in_place_of_a_file_is_not_followed(folder, tmp_path):
    first = kept_or_made("model", "key", made_of("code"))
    first.rename(tmp_path / "elsewhere")
    first.symlink_to(tmp_path / "elsewhere")
    calls = []
    assert not kept_or_made("model", "key", made_of("code", calls)).is_symlink() and len(calls) == 1


@pytest.mark.skipif(os.name != "posix", reason="modes are of POSIX")
def test_a_folder_that_another_can_be_put_in_the_place_of_is_not_used(folder, tmp_path, monkeypatch):
    open_to_all = tmp_path / "open"
    open_to_all.mkdir()
    open_to_all.chmod(0o777)
    monkeypatch.setenv("DELAGRANGE_CACHE_DIR", str(open_to_all / "cache"))
    with pytest.warns(UserWarning, match="others may put another in its place, in .*open"):
        kept_or_made("model", "key", made_of("code"))


@pytest.mark.parametrize("fault", ["full", "no folder"])
def test_a_full_disk_falls_back_to_a_folder_of_the_process_and_says_so_once(folder, fault, monkeypatch):
    if fault == "full":
        monkeypatch.setattr(machine_code.os, "replace", replacing_nothing_in(folder))
    else:
        folder.write_text("a file in its place")
    with pytest.warns(
        UserWarning, match="every process will compile it anew; set DELAGRANGE_CACHE_DIR"
    ) as seen:
        first = kept_or_made("model", f"key {fault}", made_of("code"))
        second = kept_or_made("model", f"other {fault}", made_of("code"))
    assert len(seen) == 1 and first.parent == second.parent != folder
    assert first.read_text() == "code"


def replacing_nothing_in(folder):
    """os.replace on a disk that is full from a folder on."""
    usual = os.replace

    def replace(source, target):
        if Path(target).parent == folder:
            raise OSError(28, "No space left on device")
        usual(source, target)

    return replace


def test_the_usual_folder_is_the_users(monkeypatch):
    monkeypatch.delenv("DELAGRANGE_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere/else")
    assert cache_folder().name == "delagrange"
    monkeypatch.setenv("DELAGRANGE_CACHE_DIR", "~/mine")
    assert cache_folder() == Path("~/mine").expanduser()


# --- the whole of it ---------------------------------------------------------------------------------


def test_two_processes_at_once_do_no_harm(folder):
    command = [sys.executable, "-c", CODE, str(GENERATED / "equal_biaxial.py")]
    children = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(3)]
    assert [child.communicate()[1] for child in children] == ["", "", ""]
    assert all(child.returncode == 0 for child in children)
    assert {path.suffix for path in folder.iterdir()} == {".so"}
    before = {path: path.stat().st_mtime_ns for path in folder.iterdir()}
    load_library("trajectory", HEADER)
    assert {path: path.stat().st_mtime_ns for path in folder.iterdir()} == before


def test_a_compiler_that_fails_is_reported_with_its_command_and_first_error(folder, tmp_path, monkeypatch):
    path = own_script(
        tmp_path / "bin", 'echo "a note" >&2; echo "lanes.c:3: fatal error: no such thing" >&2; exit 1'
    )
    monkeypatch.setenv("DELAGRANGE_CC", str(path))
    with pytest.raises(NoCompiler) as raised:
        load_library("lanes", HEADER)
    text = str(raised.value)
    assert text.startswith(f"`{path} -O2 -ffp-contract=off") and "lanes.c -o made -lm` failed: " in text
    assert text.endswith("lanes.c:3: fatal error: no such thing") and "\n" not in text


@pytest.mark.parametrize(
    ("script", "reason"),
    [("exit 7", "exit status 7, and it said nothing"), ("echo nonsense > made", "cannot be loaded")],
)
def test_a_compiler_that_makes_nothing_of_use_is_reported(folder, tmp_path, monkeypatch, script, reason):
    monkeypatch.setenv("DELAGRANGE_CC", str(own_script(tmp_path / "bin", script)))
    with pytest.raises(NoCompiler, match=reason):
        load_library("lanes", HEADER)


def test_a_compiler_that_does_not_know_the_processor_is_asked_for_the_plainest_code(
    folder, tmp_path, monkeypatch
):
    script = 'case "$*" in *-march*) echo "error: bad value for -march" >&2; exit 1;; esac; exec gcc "$@"'
    monkeypatch.setenv("DELAGRANGE_CC", str(own_script(tmp_path / "bin", script)))
    assert load_library("trajectory", HEADER) is not None


def test_code_for_another_level_is_another_file(folder, monkeypatch):
    load_library("trajectory", HEADER)
    monkeypatch.setattr(build, "processor_level", lambda: None)
    load_library("trajectory", HEADER)
    assert len(list(folder.iterdir())) == 2


@pytest.mark.parametrize("changed", ["module", "header", "digest"])
def test_a_header_that_does_not_belong_to_its_module_is_refused(changed, tmp_path):
    module, header = tmp_path / "own.py", tmp_path / "own.h"
    module.write_bytes((GENERATED / "uniaxial.py").read_bytes())
    header.write_bytes((GENERATED / "uniaxial.h").read_bytes())
    assert read_header(module).model == "own"
    if changed == "module":
        module.write_bytes(module.read_bytes() + b"# a remark\n")
    elif changed == "header":
        header.write_bytes(header.read_bytes().replace(b"4.0 / 3.0", b"4.0 / 3.1"))
    else:
        header.write_bytes(
            b"".join(line for line in header.read_bytes().splitlines(True) if b'MODEL_DIGEST "' not in line)
        )
    with pytest.raises(
        ValueError, match=r"own\.h is not the header of .*own\.py: one of the two has been changed"
    ):
        read_header(module)
    header.unlink()
    assert read_header(module) is None


def test_every_generated_model_has_its_header():
    for name in dl.model_names():
        core = load_core(dl.load_model(name))
        assert core is load_core(dl.load_model(name)) and core.states == len(dl.load_model(name).STATE)


def test_a_library_says_what_it_is_of():
    core = load_core(dl.load_model("equal_biaxial"))
    for part in PARTS:
        told = core.described(part)
        assert (told.model, told.states, told.inputs, told.parameters) == (b"equal_biaxial", 3, 2, 7)
        assert told.digest.decode() in core.header.text.decode()


def test_machine_code_of_another_model_is_not_called(monkeypatch):
    core = load_core(dl.load_model("equal_biaxial"))
    other = kernel.Core(core.header, core.states + 1, core.coordinates, core.inputs, core.parameters)
    with pytest.raises(NoCompiler, match="is not of this module"):
        other.part("trajectory")


def test_a_cached_library_warns_of_nothing(folder):
    load_library("trajectory", HEADER)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_library("trajectory", HEADER)
