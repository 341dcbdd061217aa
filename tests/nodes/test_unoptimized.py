"""A run is the same if Python was started with -O or -OO: the asserts of a mission's programs stay active."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.interpreter.syntax_trees import compiled

NODE = """
'''A node.'''
import rospy
from sensor_msgs import point_cloud2

print(__doc__, __debug__)
try:
    assert False, "kept"
except AssertionError as error:
    print(error)
try:
    list(point_cloud2.read_points("no cloud"))
except AssertionError as error:
    print(error)
"""


def test_compiled_source_keeps_asserts_and_docstrings() -> None:
    with pytest.raises(AssertionError):
        exec(compiled("'doc'\nassert False", "m.py"), {})


@pytest.mark.slow
@pytest.mark.parametrize("option", ["-O", "-OO"])
def test_node_is_the_same_under_an_optimizing_python(tmp_path: Path, option: str) -> None:
    (tmp_path / "node.py").write_text(NODE, encoding="utf-8")
    shown = [
        subprocess.run(
            [sys.executable, *options, "-m", "cfepy", "run", str(tmp_path / "node.py"), "--for", "1"],
            capture_output=True,
            text=True,
            check=False,
        )
        for options in ([], [option])
    ]
    traces = [each.stdout.rpartition("trace: ")[2].partition("\n")[0] for each in shown]
    assert "A node. True" in shown[1].stdout, shown[1].stdout + shown[1].stderr
    assert traces[0] == traces[1]
    assert len(traces[0]) == 32
