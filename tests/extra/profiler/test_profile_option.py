"""`cfepy run --profile`: its tables and files, with the same trace as without it, on threads and greenlets."""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.mission.flights import write_mission

NODE = """
import rospy
from std_msgs.msg import Int32

def on_tick(event):
    publisher.publish(event.current_real.nsecs // 1000)

def on_number(message):
    for _ in range(50):
        sum(range(20))

rospy.init_node("ticker")
publisher = rospy.Publisher("ticks", Int32, queue_size=1)
rospy.Subscriber("ticks", Int32, on_number)
rospy.Timer(rospy.Duration(0.005), on_tick)
rospy.spin()
"""
STARTUP = "CFE_APP, ticker.py, __main__, TICKER, 50, 16384, 0, 0;\n!\n"


@pytest.fixture
def folder(tmp_path: Path) -> str:
    return write_mission(tmp_path, STARTUP, ticker=NODE)


def flown(capsys: pytest.CaptureFixture[str], folder: str, *options: str) -> str:
    assert main(["run", folder, "--for", "1", "--no-console", *options]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_profile_has_the_parts_of_a_run_and_its_trace(
    folder: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], tasks: str
) -> None:
    usual_s = sys.getswitchinterval()
    file = tmp_path / "flame.json"
    plain = flown(capsys, folder, "--tasks", tasks).splitlines()
    shown = flown(capsys, folder, "--tasks", tasks, "--profile", str(file)).splitlines()
    assert shown[-1] == plain[-1]
    assert not [line for line in plain if "Wall time" in line]
    titles = [line for line in shown if line.startswith("Wall time of ")]
    assert titles[0] == "Wall time of applications"
    assert titles[-1] == "Wall time of services and libraries"
    rows = [line.split() for line in shown]
    assert ["TICKER", "/ticker"] in [row[:2] for row in rows]
    assert any(row[:2] == ["(task", "switches)"] for row in rows)
    note = next(line for line in shown if "task switches took" in line)
    assert ("Tasks were greenlets." in note) == (tasks == "greenlet")
    assert ("With --tasks greenlet" in note) == (tasks == "thread")
    assert (sys.getswitchinterval(), sys.getprofile()) == (usual_s, None)
    assert "cfepy profiler" not in [each.name for each in threading.enumerate()]
    document = json.loads(file.read_text(encoding="utf-8"))
    names = [each["name"] for each in document["shared"]["frames"]]
    assert {"TICKER", "(task switches)", "(display, ports, pace)"} <= {*names}


def test_profile_on_threads_names_callbacks_of_the_mission(
    folder: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "flame.txt"
    shown = flown(capsys, folder, "--tasks", "thread", "--profile", str(file))
    callbacks = [line.split()[:3] for line in shown.partition("callbacks and main functions\n")[2].splitlines()]
    assert ["TICKER", "on_number", "ticker.py:8"] in callbacks
    assert ["TICKER", "on_tick", "ticker.py:5"] in callbacks
    lines = file.read_text(encoding="utf-8").splitlines()
    assert any(line.startswith("TICKER;TICKER.ticks") and "on_number (ticker.py:8)" in line for line in lines)
    assert all(line.rpartition(" ")[2].isdecimal() for line in lines)


def test_profile_without_a_file_prints_the_tables_only(
    folder: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = {*tmp_path.iterdir()}
    assert "Wall time of applications" in flown(capsys, folder, "--profile")
    assert {*tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    ("file", "said"),
    [("lab", "invalid file 'lab'; expected a name that ends with .json"), ("x/y/z.json", "--profile")],
)
def test_profile_refuses_a_file_before_the_run(
    folder: str, capsys: pytest.CaptureFixture[str], file: str, said: str
) -> None:
    try:
        status = main(["run", folder, "--profile", file])
    except SystemExit as ended:
        status = int(ended.code or 0)
    shown = capsys.readouterr()
    assert (status, shown.out) == (2, "")
    assert said in shown.err


def test_console_prints_the_profile_at_its_end(
    folder: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with open(Path(folder) / "typed.txt", "w+", encoding="utf-8") as typed:
        typed.write("run 1\nquit\n")
        typed.seek(0)
        monkeypatch.setattr("sys.stdin", typed)
        assert main(["console", folder, "--plain", "--profile"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "Wall time of applications" in lines
    assert lines[-1].startswith("trace: ")
