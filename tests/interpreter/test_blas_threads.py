"""Linear algebra in a run uses one thread, so its results do not depend on the number of CPUs."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from cfepy.interpreter import blas_threads
from cfepy.interpreter.blas_threads import use_one_blas_thread
from cfepy.interpreter.host_system import BLAS_VARIABLES as VARIABLES
from tests.rospy_shim.missions import run_nodes

limit = use_one_blas_thread.__wrapped__


@pytest.fixture
def environment(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """The process's environment, in which a user wants four threads."""
    changed = {**os.environ, "OPENBLAS_NUM_THREADS": "4"}
    monkeypatch.setattr(os, "environ", changed)
    return changed


def test_environment_says_so_before_numpy_is_imported(
    monkeypatch: pytest.MonkeyPatch, environment: dict[str, str]
) -> None:
    monkeypatch.delitem(sys.modules, "numpy", raising=False)
    assert limit() == ""
    assert {environment[name] for name in VARIABLES} == {"1"}


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux lists the libraries of a process")
@pytest.mark.usefixtures("environment")
def test_loaded_libraries_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numpy")
    monkeypatch.setitem(sys.modules, "threadpoolctl", None)
    assert limit() == ""


@pytest.mark.usefixtures("environment")
def test_libraries_that_are_not_known_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "numpy", os)
    monkeypatch.setitem(sys.modules, "threadpoolctl", None)
    why = (
        "numpy was imported before the run, and its linear algebra may use several threads; "
        "set OPENBLAS_NUM_THREADS=1, or install threadpoolctl"
    )
    monkeypatch.setattr(blas_threads, "MAPS", str(tmp_path / "none"))
    assert limit() == why
    maps = tmp_path / "maps"
    maps.write_text(f"7f00-7f01 r-xp 0000 00:1 7   {tmp_path}/libopenblas.so.0\n7f02-7f03 rw-p 0\n", encoding="utf-8")
    monkeypatch.setattr(blas_threads, "MAPS", str(maps))
    assert limit() == why


NODE = """
import hashlib

import numpy
import rospy

rospy.init_node("algebra")
generator = numpy.random.default_rng(1)
matrix, vector = generator.normal(size=(300, 300)), generator.normal(size=300)
for made in (numpy.linalg.solve(matrix, vector), *numpy.linalg.eig(matrix), matrix @ matrix):
    print(hashlib.sha256(made.tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_both_kinds_of_tasks_compute_the_same_bits(tmp_path: Path) -> None:
    pytest.importorskip("numpy")
    thread, greenlet = (run_nodes(tmp_path, {"LA": NODE}, tasks=tasks) for tasks in ("thread", "greenlet"))
    assert len(thread.printed["algebra"]) == 4
    assert thread.printed == greenlet.printed
    assert thread.digest == greenlet.digest
