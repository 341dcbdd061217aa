"""Whether a run succeeded: every command, the page, the JSON and Python agree on each mission."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest

import cfepy
from cfepy.cli.main import main
from tests.mission.flights import write_mission

APP = "CFE_APP, prog, Main, PROG, 50, 16384, 0x0, 0;\n!"
NODE = "CFE_APP, prog.py, __main__, PROG, 100, 16384, 0x0, 0;\n!"
QUIET = """
    def Main(cfe):
        cfe.evs.register()
        while cfe.es.run_loop(1):
            cfe.os.task_delay(100)
"""
ROS = """
    import threading
    import rospy
    from std_msgs.msg import Float64

    rospy.init_node("prog")
"""


@dataclass(frozen=True)
class Case:
    """A mission, the files beside it, and words of its one problem; no words for a successful mission."""

    source: str
    problem: str = ""
    startup: str = APP
    mission: str = ""
    script: str = ""
    faults: str = ""


def app(body: str, ends: bool = False) -> str:
    """Return an application that does something 0.7 s after its start."""
    loop = "" if ends else QUIET.partition("register()\n")[2]
    lines = "".join(f"        {line}\n" for line in body.splitlines())
    return f"\n    def Main(cfe):\n        cfe.evs.register()\n        cfe.os.task_delay(100)\n{lines}{loop}"


CASES = {
    "quiet": Case(QUIET),
    "callback": Case(
        ROS
        + """
    rospy.Subscriber("x", Float64, lambda message: 1 / message.data)
    talker = rospy.Publisher("x", Float64, queue_size=1)
    rospy.sleep(0.1)
    talker.publish(0.0)
    rospy.spin()
""",
        "ZeroDivisionError",
        NODE,
    ),
    "thread": Case(ROS + "    threading.Thread(target=lambda: {}['x']).start()\n    rospy.spin()\n", "KeyError", NODE),
    "timer": Case(
        ROS + "    rospy.Timer(rospy.Duration(0.1), lambda event: {}['x'])\n    rospy.spin()\n", "KeyError", NODE
    ),
    "node's exit status": Case(ROS + "    raise SystemExit(3)\n", "exit status 3", NODE),
    "death": Case(app("raise ValueError('x')"), "PROG died"),
    "death and a reset": Case(
        app("if cfe.es.get_reset_type()[0] == 2: raise ValueError('x')"), "the processor was reset"
    ),
    "end": Case(app("cfe.es.exit_app(3)", ends=True), "PROG ended with"),
    "event": Case(app("cfe.evs.send_event(7, 3, 'bad')"), "PROG sent 1 ERROR or CRITICAL event"),
    "event, and a script that does well": Case(
        app("cfe.evs.send_event(7, 3, 'bad')"), "PROG sent 1 ERROR or CRITICAL event", script="at 1 send CFE_ES_NOOP\n"
    ),
    "event that the script expects": Case(
        app("cfe.evs.send_event(7, 3, 'bad')"), script="expect event PROG 7 ERROR within 1\n"
    ),
    "step": Case(QUIET, "no event of PROG was sent", script="expect event PROG 7 within 0.5\n"),
    "step that is not reached": Case(QUIET, "the run ended earlier", script="at 20 send CFE_ES_NOOP\n"),
    "wait that never ends": Case(ROS + "    threading.Event().wait()\n", startup=NODE),
    "wait that nobody can end": Case(app("cfe.os.bin_sem_take(cfe.os.bin_sem_create('NEVER', 0))"), "waits forever"),
    "not there": Case(
        QUIET, "OTHER could not be started", APP.replace("!", "CFE_APP, other, M, OTHER, 50, 8192, 0, 0;\n!")
    ),
    "library": Case(QUIET, "library LOST could not be loaded", "CFE_LIB, lost, Init, LOST, 0, 0, 0x0, 0;\n" + APP),
    "line of the startup script": Case(QUIET, "startup.scr:1", "CFE_APP, prog, Main;\n" + APP),
    "invariant": Case(
        app("cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, b'1234'))"),
        "invariant 'few'",
        mission="invariants:\n      few: {packet: 0x0895, holds: count < 1}\n",
    ),
    "deadline": Case(
        app("for _ in range(4): cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, b'1234')), cfe.os.task_delay(200)"),
        "missed its deadline",
        mission='deadlines:\n      topics: {"0x0895": {at_least_every: 10 ms}}\n',
    ),
    "crash that was asked for": Case(QUIET, faults="faults: [{crash: PROG, at: 0.9}]\n", startup=APP),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_every_command_has_the_same_verdict(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "m"
    folder.mkdir()
    extra = {"mission_yaml": case.mission} if case.mission else {}
    write_mission(folder, case.startup, prog=case.source, **extra)
    words = ["m", "--for", "2"]
    options: dict[str, str] = {}
    for option, text in (("script", case.script), ("faults", case.faults)):
        if text:
            Path(f"{option}.txt").write_text(text, encoding="utf-8")
            words += [f"--{option}", f"{option}.txt"]
            options[option] = f"{option}.txt"
    status = 1 if case.problem else 0

    assert main(["run", *words, "--quiet", "--record", "j", "--json", "n.json"]) == status
    told = capsys.readouterr()
    assert case.problem in told.out + told.err
    problems = json.loads(Path("n.json").read_text(encoding="utf-8"))["problems"]
    assert bool(problems) == bool(case.problem)
    assert any(case.problem in each for each in problems) == bool(case.problem)
    assert main(["replay", "j", "--quiet"]) == status
    assert "the same run" in capsys.readouterr().err
    assert main(["explore", *words, "--seeds", "1", "--jobs", "1", "--quiet"]) == status
    assert main(["run", *words, "--check-determinism", "2"]) == status
    capsys.readouterr()
    assert main(["report", *words, "-o", "p.html"]) == 0
    assert ("No problems" in Path("p.html").read_text(encoding="utf-8")) == (not case.problem)
    assert main(["sweep", *words, "--board", "linux", "--jobs", "1", "--quiet", "--json", "s.json"]) == 0
    (point,) = json.loads(Path("s.json").read_text(encoding="utf-8"))["rows"]
    assert (point["problem"] not in ("", "no message came")) == bool(case.problem)
    assert cfepy.run("m", seconds=2, **options).problems == problems


@pytest.mark.slow
def test_mission_beside_counts_as_the_mission_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, source in (("a", QUIET), ("b", app("cfe.evs.send_event(7, 3, 'bad')"))):
        Path(name).mkdir()
        write_mission(tmp_path / name, APP, prog=source)
    words = ["a", "--with", "b", "--for", "2"]
    line = "b: PROG sent 1 ERROR or CRITICAL event"
    assert main(["run", *words, "--quiet", "--record", "j", "--json", "n.json"]) == 1
    assert line in capsys.readouterr().err
    assert json.loads(Path("n.json").read_text(encoding="utf-8"))["problems"] == [line]
    assert main(["replay", "j", "--quiet"]) == 1
    said = capsys.readouterr().err
    assert line in said
    assert "the same run as j" in said
    assert main(["explore", *words, "--seeds", "1", "--jobs", "1", "--quiet"]) == 1
    assert main(["report", *words, "-o", "p.html"]) == 0
    assert line in Path("p.html").read_text(encoding="utf-8")


def test_node_and_launch_end_with_status_1_after_an_exception_in_a_callback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_mission(tmp_path, CASES["callback"].startup, prog=CASES["callback"].source)
    assert main(["node", "prog.py", "--for", "1", "--quiet"]) == 1
    assert "ZeroDivisionError" in capsys.readouterr().err
    Path("p.launch").write_text('<launch><node pkg="p" type="prog.py" name="prog"/></launch>', encoding="utf-8")
    Path("package.xml").write_text("<package><name>p</name></package>", encoding="utf-8")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert main(["launch", "p.launch", "--for", "1", "--quiet"]) == 1
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_rostest_fails_after_an_exception_in_a_callback_of_another_node(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    test = """
        import unittest
        import rospy, rostest

        class Waits(unittest.TestCase):
            def test_waits(self):
                rospy.init_node("waits")
                rospy.sleep(0.5)

        rostest.rosrun("p", "waits", Waits)
    """
    write_mission(tmp_path, CASES["callback"].startup, prog=CASES["callback"].source, waits=test)
    Path("package.xml").write_text("<package><name>p</name></package>", encoding="utf-8")
    node, own = '<node pkg="p" type="prog.py" name="prog"/>', '<test test-name="waits" pkg="p" type="waits.py"/>'
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    Path("p.test").write_text(f"<launch>{own}</launch>", encoding="utf-8")
    assert main(["rostest", "p.test"]) == 0
    Path("p.test").write_text(f"<launch>{node}{own}</launch>", encoding="utf-8")
    capsys.readouterr()
    assert main(["rostest", "p.test"]) == 1
    out = capsys.readouterr().out
    assert "RESULT: FAIL" in out
    assert "ZeroDivisionError" in out
