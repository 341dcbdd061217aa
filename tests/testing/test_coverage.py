"""coverage.py and pytest-cov count the lines of applications and nodes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.reading.resources import import_path

pytestmark = pytest.mark.slow

FILES = {
    "m/startup.scr": "CFE_APP, one, Main, ONE, 50, 8192, 0, 0;\nCFE_APP, two, __main__, TWO, 60, 8192, 0, 0;\n!\n",
    "m/one.py": "def helper():\n    return 1\n\n\ndef Main(cfe):\n    while cfe.es.run_loop():\n        helper()\n"
    "        cfe.os.task_delay(100)\n\n\ndef never():\n    return 1\n",
    "m/two.py": "import rospy\n\n\ndef tick(event):\n    print(event)\n\n\ndef never():\n    return 2\n\n\n"
    "rospy.init_node('two')\nrospy.Timer(rospy.Duration(0.1), tick)\nrospy.spin()\n",
    "test_m.py": "def test_it(mission):\n    mission('m').run_for(1)\n",
}
MISSED = {"m/one.py": [12], "m/two.py": [9]}
RUN = ["-m", "coverage", "run", "-m", "cfepy", "run", "m", "--for", "1", "--quiet", "--tasks"]
TEST = ["-m", "pytest", "-q", "-p", "no:randomly", "-p", "cfepy.testing.plugin", "--cov", "--cov-report="]


@pytest.mark.parametrize("tasks", ["auto", "thread", "greenlet"])
@pytest.mark.parametrize("command", [RUN, [*TEST, "--cfepy-tasks"], [*TEST, "-n2", "--cfepy-tasks"]])
def test_every_executed_line_is_counted(command: list[str], tasks: str, tmp_path: Path) -> None:
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    concurrency = "thread, greenlet" if tasks == "greenlet" else "thread"
    (tmp_path / ".coveragerc").write_text(f"[run]\nsource = m\nconcurrency = {concurrency}\n", encoding="utf-8")
    unasked = {name: value for name, value in os.environ.items() if not name.startswith(("COV_", "COVERAGE_"))}
    environ = {**unasked, "PYTHONPATH": import_path()}

    def python(*arguments: str) -> None:
        ended = subprocess.run(
            [sys.executable, *arguments], cwd=tmp_path, env=environ, capture_output=True, text=True, check=False
        )
        assert ended.returncode == 0, ended.stdout + ended.stderr

    python(*command, tasks)
    python("-m", "coverage", "json", "-o", "told.json")
    told = json.loads((tmp_path / "told.json").read_text(encoding="utf-8"))["files"]
    assert {name: each["missing_lines"] for name, each in told.items()} == MISSED
