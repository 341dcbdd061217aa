"""Code that spins ends by `--stall`, SIGTERM and one Ctrl-C, in each command that flies it."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import FOUND_PROBLEMS, INTERRUPTED, main

BEGIN = '#!/usr/bin/env python3\nimport rospy\nfrom std_msgs.msg import String\nrospy.init_node("probe")\n'
SPINS = {
    "node": 'print("ready")\nwhile True:\n    pass\n',
    "callback": """
def on(message):
    print("ready")
    while True:
        pass
rospy.Subscriber("/a", String, on)
publisher = rospy.Publisher("/a", String, queue_size=1)
rospy.sleep(0.1)
publisher.publish("x")
rospy.spin()
""",
    "finalizer": """
class Spinning:
    def __del__(self):
        print("ready")
        while True:
            pass
Spinning()
rospy.spin()
""",
    "swallow": """
print("ready")
while True:
    try:
        sum(n for n in range(1000))
    except:
        pass
""",
}
POLL = 'print("ready")\nwhile rospy.get_time() > 0:\n    pass\n'
APP = 'def main(cfe):\n    cfe.es.write_to_sys_log("ready")\n    while True:\n        cfe.time.get_time()\n'


def node(folder: Path, body: str) -> str:
    file = folder / "probe.py"
    file.write_text(BEGIN + body, encoding="utf-8")
    return str(file)


def app(folder: Path) -> str:
    (folder / "startup.scr").write_text("CFE_APP, app, main, SPIN, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (folder / "app.py").write_text(APP, encoding="utf-8")
    return str(folder)


@pytest.mark.slow
def test_a_run_and_its_replay_end_as_failed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    journal = str(tmp_path / "run.cfepy")
    words = [app(tmp_path), "--for", "2", "--stall", "0.2"]
    assert main(["run", *words, "--record", journal]) == FOUND_PROBLEMS
    said = capsys.readouterr()
    assert said.out.splitlines()[-2] == "trace: none, since the run was broken off"
    assert said.err.count("task SPIN has not given up the CPU") == 1
    assert "app.py:3 in main: while True:" in said.err
    assert main(["replay", journal]) == FOUND_PROBLEMS
    said = capsys.readouterr()
    assert said.err.count("task SPIN has not given up the CPU") == 1
    assert "the same run as" in said.err


@pytest.mark.parametrize("command", ["graph", "trace", "tlm"])
def test_commands_that_look_at_a_run_end_as_failed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    assert main([command, app(tmp_path), "--stall", "0.2"]) == FOUND_PROBLEMS
    assert "app.py:3 in main: while True:" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
@pytest.mark.parametrize("what", ["node", "callback", "finalizer"])  # code that swallows may kill its process
def test_a_node_that_spins_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str], what: str, tasks: str) -> None:
    words = ["--for", "2", "--stall", "0.5", "--tasks", tasks]
    assert main(["node", node(tmp_path, SPINS[what]), *words]) == FOUND_PROBLEMS
    assert capsys.readouterr().err.count("has not given up the CPU") == 1


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
@pytest.mark.parametrize("what", [*SPINS, "poll", "app"])
def test_one_signal_ends_a_run(tmp_path: Path, what: str, tasks: str, how: signal.Signals) -> None:
    words = ["run", app(tmp_path)] if what == "app" else ["node", node(tmp_path, SPINS.get(what, POLL))]
    words += ["--for", "100000", "--stall", "0", "--tasks", tasks]
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "cfepy", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert any("ready" in line for line in process.stdout), process.communicate()[1]
    process.send_signal(how)
    _, err = process.communicate()
    assert process.returncode == INTERRUPTED
    assert err.count("has not given up the CPU") == (what != "poll")
    assert "Traceback" not in err


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_one_signal_ends_an_exploration(tmp_path: Path, how: signal.Signals) -> None:
    words = ["explore", app(tmp_path), "--for", "2", "--stall", "0.5", "--seeds", "100000"]
    words += ["--results", str(tmp_path / "results.jsonl")]
    process = subprocess.Popen([sys.executable, "-u", "-m", "cfepy", *words], stdout=subprocess.PIPE, text=True)
    results = tmp_path / "results.jsonl"
    while not (results.exists() and results.read_text(encoding="utf-8").count("stalled")):
        assert process.poll() is None
    process.send_signal(how)
    out, _ = process.communicate()
    assert process.returncode == INTERRUPTED
    assert "failure 1: stalled: SPIN: SPIN does not give up the CPU (app.py:3)" in out
    assert "ended by Ctrl-C" in out
