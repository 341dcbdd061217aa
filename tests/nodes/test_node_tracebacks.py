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


@pytest.mark.parametrize("word", ["if", "while"])
def test_syntax_error_of_a_program_has_no_heading_and_no_frame(word: str, tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text(f"{word} True:\n\tx = 1\n        y = 2\n", encoding="utf-8")
    told = [line.partition("] ")[2] for line in cfepy.run(script, seconds=1).console if line.startswith("[NODE]")]
    assert told == [
        f'  File "{script}", line 3',
        "    y = 2",
        "TabError: inconsistent use of tabs and spaces in indentation",
    ]


def test_syntax_error_of_a_module_shows_its_import_only(tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text("import wrong\n", encoding="utf-8")
    (tmp_path / "wrong.py").write_text("x = (\n", encoding="utf-8")
    told = [line.partition("] ")[2] for line in cfepy.run(script, seconds=1).console if line.startswith("[NODE]")]
    assert [line for line in told if "File" in line or "Trace" in line] == [
        "Traceback (most recent call last):",
        f'  File "{script}", line 1, in <module>',
        f'  File "{tmp_path / "wrong.py"}", line 1',
    ]


@pytest.mark.parametrize(
    ("error", "status"), [("KeyboardInterrupt", 130), ("rospy.ROSInterruptException", 1), ("ValueError", 1)]
)
def test_exit_status_of_an_interrupt_is_not_that_of_its_subclasses(error: str, status: int, tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text(f"import rospy\nrospy.init_node('node')\nraise {error}\n", encoding="utf-8")
    assert any(f"ended with exit status {status};" in line for line in cfepy.run(script, seconds=1).console)
