"""`cfepy run --check-determinism`: its findings, its output, and the exit status."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.cli.run.compared_runs import FirstDifference, show_sides
from cfepy.pilot.determinism_look import Look
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;
    CFE_APP, listener.py, __main__, LISTENER, 90, 16384, 0x0, 0;
    !
"""
TALKER = """
import rospy
from std_msgs.msg import String

rospy.init_node("talker")
pub = rospy.Publisher("chat", String, queue_size=10)
names = {{"alpha", "beta", "gamma", "delta", "epsilon", "zeta"}}
for _ in range(3):
    rospy.sleep(0.1)
    for name in {names}:
        pub.publish(String(name))
"""
LISTENER = """
import rospy
from std_msgs.msg import String

rospy.init_node("listener")
rospy.Subscriber("chat", String, lambda message: None)
rospy.spin()
"""


def check(folder: str, *options: str) -> int:
    return main(["run", folder, "--for", "1", "--check-determinism", *options])


@pytest.mark.slow
def test_a_deterministic_mission(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write_mission(tmp_path, STARTUP, talker=TALKER.format(names="sorted(names)"), listener=LISTENER)
    assert check(folder) == 0
    shown = capsys.readouterr().out.splitlines()
    assert shown[0].startswith("3 runs: PYTHONHASHSEED=0 --tasks thread; PYTHONHASHSEED=1 --tasks greenlet; ")
    assert main(["run", folder, "--for", "1", "--no-console"]) == 0
    assert shown[-1] == capsys.readouterr().out.splitlines()[-2]  # the trace equals that of an ordinary run


@pytest.mark.slow
def test_the_order_of_a_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write_mission(tmp_path, STARTUP, talker=TALKER.format(names="names"), listener=LISTENER)
    assert check(folder, "4") == 1
    shown = capsys.readouterr().out
    line = f"{tmp_path / 'talker.py'}:11"
    assert shown.count(f"  made at {line} in <module>\n      pub.publish(String(name))\n") == 2
    assert shown.count("/chat sequence 1 length") == 2
    assert "with `ordered_sets: true` in the mission file these two agree" in shown
    assert f"{tmp_path / 'talker.py'}:10: goes through a set: for name in names:" in shown


@pytest.mark.slow
def test_messages_without_a_subscriber_count(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    startup = "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!\n"
    folder = write_mission(tmp_path, startup, talker=TALKER.format(names="names"))
    assert check(folder, "4") == 1
    shown = capsys.readouterr().out
    assert shown.count("publish /chat length") == 2
    assert shown.count(f"  made at {tmp_path / 'talker.py'}:11 in <module>\n") == 2
    assert "ordered_sets: true" in shown


@pytest.mark.slow
def test_messages_without_a_subscriber_are_not_in_the_digest(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    startup = "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!\n"
    folder = write_mission(tmp_path, startup, talker=TALKER.format(names="sorted(names)"))
    assert check(folder) == 0
    compared = capsys.readouterr().out.splitlines()[-1]
    assert main(["run", folder, "--for", "1", "--no-console"]) == 0
    assert compared == capsys.readouterr().out.splitlines()[-2]


@pytest.mark.slow
@pytest.mark.parametrize(
    "mission_yaml", ["ordered_sets: true\n", "ordered_sets: false\nnodes: {TALKER: {ordered_sets: true}}\n"]
)
def test_ordered_sets_in_the_mission_file(tmp_path: Path, mission_yaml: str) -> None:
    folder = write_mission(
        tmp_path, STARTUP, talker=TALKER.format(names="names"), listener=LISTENER, mission_yaml=mission_yaml
    )
    assert check(folder, "4") == 0


@pytest.mark.parametrize(
    ("expression", "cause"),
    [
        ("id(pub)", "even two runs alike differ"),
        ("hash('text')", "it hangs on PYTHONHASHSEED, but ordered sets do not cure it"),
    ],
)
@pytest.mark.slow
def test_other_causes(tmp_path: Path, capsys: pytest.CaptureFixture[str], expression: str, cause: str) -> None:
    program = f"""
    import time
    pub = [object()]
    time.sleep(0.1)
    print({expression})
    """
    folder = write_mission(tmp_path, STARTUP, talker=program, listener=LISTENER)
    assert check(folder, "2") == 1
    shown = capsys.readouterr().out
    assert cause in shown
    assert f"{tmp_path / 'talker.py'}:5: uses " in shown


@pytest.mark.slow
@pytest.mark.parametrize(
    ("statement", "contact"),
    [
        ("ctypes.CDLL(None).getrandom(drawn, 8, 0)", "draws random numbers of this computer by getrandom of libc"),
        ("drawn = open('/proc/self/stat').read()", "reads /proc/self/stat, which is another each time"),
    ],
)
def test_difference_is_told_with_the_accesses_past_the_simulation(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], statement: str, contact: str
) -> None:
    program = f"""
    import ctypes
    import time
    drawn = ctypes.create_string_buffer(8)
    time.sleep(0.1)
    {statement}
    print(getattr(drawn, "raw", drawn))
    """
    folder = write_mission(tmp_path, STARTUP, talker=program, listener=LISTENER)
    assert check(folder, "2") == 1
    shown = capsys.readouterr().out
    assert f"  talker.py:6: {statement}: {contact}\n" in shown
    assert "even two runs alike differ" in shown


@pytest.mark.slow
def test_an_application(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = """
    def Main(cfe):
        cfe.evs.register()
        for name in {"alpha", "beta", "gamma", "delta"}:
            cfe.evs.send_info(1, name)
    """
    folder = write_mission(tmp_path, "CFE_APP, app, Main, APP, 50, 16384, 0x0, 0;\n!\n", app=program)
    assert check(folder, "4") == 1
    assert f"made at {tmp_path / 'app.py'}:5 in Main" in capsys.readouterr().out


def test_the_text_of_an_object_has_its_address() -> None:
    def shown(*records: bytes) -> str:
        stream = io.StringIO()
        one, other = (Look(record, "", ("publish",), (), ()) for record in records)
        show_sides(FirstDifference(("one", "other"), 0, (one, other)), stream)
        return stream.getvalue()

    text = shown(b"\x05<arm.Joint object at 0x7f0012345678>", b"\x05<arm.Joint object at 0x7f0012999678>")
    assert "an address in a text, <arm.Joint object at 0x7f0012345678>: give the object a __repr__" in text
    assert "address" not in shown(b"1 <arm.Joint object at 0x7f0012345678>", b"2 <arm.Joint object at 0x7f0012345678>")


@pytest.mark.slow
def test_with_a_script_a_board_and_a_schedule(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = tmp_path / "flight.txt"
    script.write_text("at 3 end\n", encoding="utf-8")
    arguments = ["run", "lab", "--check-determinism", "2", "--script", str(script), "--board", "rx64m", "--seed", "5"]
    assert main([*arguments, "--schedule", "random"]) == 0
    assert "all made the same " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--json", "x"], "--json: cannot be combined with --check-determinism"),
        (["--realtime"], "--realtime: cannot be combined with --check-determinism"),
        pytest.param(["--board", "none"], "none", marks=pytest.mark.slow),
    ],
)
def test_bad_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str) -> None:
    folder = write_mission(tmp_path, "!\n")
    assert main(["run", folder, "--check-determinism", "2", *options]) == 2
    assert said in capsys.readouterr().err


def test_ordered_sets_are_true_or_false(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write_mission(tmp_path, "!\n", mission_yaml="ordered_sets: 3\nnodes: {A: {ordered_sets: maybe}}\n")
    assert main(["check", folder]) == 1
    shown = "".join(capsys.readouterr())
    assert "mission.yaml:1: ordered_sets: must be true or false, not 3" in shown
    assert "mission.yaml:2: nodes.A.ordered_sets: must be true or false, not 'maybe'" in shown


def test_impossible_numbers_of_runs(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", "lab", "--check-determinism", "1"])
    assert "invalid number of runs '1'; expected 2 to 64" in capsys.readouterr().err


@pytest.mark.slow
def test_a_file_in_the_working_directory_is_no_module_of_the_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "random.py").write_text("open('executed', 'w').close()\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "lab", "--for", "0.01", "--check-determinism", "2"]) == 0
    assert not (tmp_path / "executed").exists()


HOST = """
import numpy, os, rospy
rospy.init_node("talker")
open("kept.txt", "w").write("the run's own")
numpy.save("kept", numpy.zeros(3))
numpy.memmap({path!r}, mode='w+', shape=3)
with open("/proc/uptime") as file:
    file.read()
today = numpy.datetime64("today")
"""


@pytest.mark.slow
def test_what_goes_past_the_simulated_computer_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(tmp_path / "raw.bin")
    folder = write_mission(tmp_path, STARTUP, talker=HOST.format(path=path), listener=LISTENER)
    assert check(folder, "2") == 0
    shown = capsys.readouterr().out.splitlines()
    assert shown[1:-2] == [
        "past the simulated computer, where cfepy cannot answer for it:",
        f"  talker.py:6: numpy.memmap({path!r}, mode='w+', shape=3): writes {path} on this computer",
        '  talker.py:7: with open("/proc/uptime") as file:: reads /proc/uptime, which is another each time',
        '  talker.py:9: today = numpy.datetime64("today"): asks the clock of this computer',
    ]


NODE = """
import sys
import rospy
rospy.init_node("node")
print("got", sys.argv[1:], rospy.get_param("~rate", None))
"""
LAUNCH = """
<launch>
  <arg name="n"/>
  <node pkg="pk" type="node.py" name="n" output="screen"><param name="rate" value="$(arg n)"/></node>
</launch>
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ["run", "node.py", "--", "a", "b"],
        ["run", "n.launch", "--arg", "n:=3"],
        ["run", "pk", "n.launch", "--arg", "n:=3"],
        ["node", "node.py", "--", "a", "b"],
        ["launch", "pk", "n.launch", "n:=3"],
    ],
)
def test_nodes_and_launch_files_are_checked_like_missions(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "package.xml").write_text(
        "<package><name>pk</name><version>1.0.0</version></package>", encoding="utf-8"
    )
    (tmp_path / "node.py").write_text(f"#!/usr/bin/env python3{NODE}", encoding="utf-8")
    (tmp_path / "node.py").chmod(0o755)
    (tmp_path / "n.launch").write_text(LAUNCH, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    command = [words[0], "--for", "1"]
    assert main([*command, "--check-determinism", "2", *words[1:]]) == 0
    assert "all made the same" in capsys.readouterr().out
    assert main([*command, *words[1:]]) == 0
    (said,) = (line for line in capsys.readouterr().out.splitlines() if "got" in line)
    assert "['a', 'b'] None" in said if "a" in words else said.endswith(" 3")
