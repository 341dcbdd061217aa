"""A node's view of its own stack: its own lines, on threads and on greenlets."""

from __future__ import annotations

from pathlib import Path

import pytest

import cfepy
from tests.own_paths import own_files

NODE = """
import traceback
import rospy

def show(event=None):
    print("".join(traceback.format_stack()).replace("\\n", "|"))
    names = [frame.name for frame in traceback.StackSummary.extract(traceback.walk_stack(None))]
    print(len(traceback.extract_stack()), names)

rospy.init_node("node")
show()
rospy.Timer(rospy.Duration(0.1), show, oneshot=True)
rospy.sleep(0.2)
"""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_stack_shows_only_lines_of_the_node(tasks: str, tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text(NODE, encoding="utf-8")
    run = cfepy.run(script, seconds=1, tasks=tasks)
    told = [line.partition("] ")[2] for line in run.console if line.startswith("[node]")]
    first, count, second, _ = told
    assert first.count("File") == 2
    assert first.startswith(f'  File "{script}", line 11, in <module>|    show()|  File "{script}", line 6, in show|')
    assert count.startswith("2 ['show', '<module>']")
    assert second.rstrip("|").splitlines()[-1].endswith('.replace("\\n", "|"))')
    assert own_files(second.replace("|", "\n")) == []
