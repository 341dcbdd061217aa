"""Names and texts of files, missions and peers reach a terminal as text, without escape or reversing sequences.

Each case has a name or a text with control characters in another place, and the command that shows it.
"""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from cfepy.cli.main import main
from cfepy.cli.text_table import Table, show_tables
from cfepy.ground.bag import storage
from dev.house.tree import ROOT
from rospy_shim.types.msgs import message_class

NASTY = "x\x1b]0;title\a\x1b[31m\x9b2J\u202e\x7f\ry"
FORBIDDEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
TOLD = r"\x1b]0;title"
SYSLOG = ROOT / "tests" / "data" / "cfe_es_syslog.log"
EVENTS = ROOT / "tests" / "data" / "cfe_evs.log"

APP = f"""
NASTY = {NASTY!r}

def Nasty(cfe):
    cfe.evs.register()
    cfe.evs.send_err(5, NASTY)
    cfe.evs.send_info(6, NASTY)
    cfe.es.write_to_sys_log(NASTY)
    cfe.os.printf(NASTY)
    print(NASTY)
    pipe = cfe.sb.create_pipe(10, NASTY[:15])
    cfe.sb.subscribe(0x0890, pipe)
    while cfe.es.run_loop(1):
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))
        cfe.os.task_delay(100)
"""
DIES = f"def Nasty(cfe):\n    cfe.os.task_delay(10)\n    raise ValueError({NASTY!r})\n"
NODE = f"""
import sys, rospy
from std_msgs.msg import String
NASTY = {NASTY!r}
rospy.init_node("n")
print("\\x1b[32mgreen\\x1b[0m", NASTY)
rospy.logerr(NASTY)
rospy.set_param("p", {{"\x9b31m": "\u202e"}})
publisher = rospy.Publisher("t", String, queue_size=10)
while not rospy.is_shutdown():
    publisher.publish(NASTY)
    rospy.sleep(0.1)
"""


def mission(folder: Path, code: str = APP, yaml: str = "", app: str = "NASTY") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "startup.scr").write_text(f"CFE_APP, nasty, Nasty, {app}, 90, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (folder / "nasty.py").write_text(code, encoding="utf-8")
    (folder / "mission.yaml").write_text(yaml, encoding="utf-8")
    return folder


def bag(folder: Path, topics: Sequence[str] = (f"/{NASTY}", "/good\n/forged")) -> Path:
    """Return a bag whose topic, node and texts are nasty; of std_msgs/Header, for its frame."""
    about = message_class("std_msgs/Header")
    header = {"type": "std_msgs/Header", "md5sum": about._md5sum, "message_definition": about._full_text}
    frame = NASTY.encode()
    path = folder / "nasty.bag"
    with path.open("w+b") as stream:
        out = storage().BagFile(stream)
        out.create()
        for topic in topics:
            said = out.connect(topic, {"callerid": f"/{NASTY}", "latching": NASTY, **header})
            for number in range(3):
                data = bytes(4) + bytes(8) + len(frame).to_bytes(4, "little") + frame
                out.write(said, (100 + number) * 10**9, data)
        out.finish()
    return path


def dumped(folder: Path, source: Path, at: int) -> Path:
    """Return a file of cFE with a nasty text from a byte on."""
    data = bytearray(source.read_bytes())
    nasty = b"x\x1b]0;title\a\x1b[31m\x9b"
    data[at : at + len(nasty)] = nasty
    path = folder / "dump.log"
    path.write_bytes(data)
    return path


def launch(folder: Path, body: str) -> Path:
    path = folder / "x.launch"
    path.write_text(f"<launch>{body}</launch>", encoding="utf-8")
    return path


def named(folder: Path, make: Callable[[Path], object]) -> Path:
    """Return a folder with a nasty name, and make its content."""
    made = folder / os.fsdecode(NASTY.encode())  # which each file system can have, whatever the locale
    made.mkdir()
    make(made)
    return made


class Case(NamedTuple):
    """A case: its subject, the command with `{}` for the made file, and the expected text."""

    name: str
    words: str
    make: Callable[[Path], Path]
    told: str = TOLD


def yaml_key(folder: Path) -> Path:
    return mission(folder / "m", yaml=json.dumps({NASTY: 1}))


def node_file(folder: Path) -> Path:
    path = folder / "n.py"
    path.write_text(NODE, encoding="utf-8")
    return path


CASES = [
    Case("a key of a mission file", "check {}", yaml_key),
    Case("a key of a mission file that is to run", "run {}", yaml_key),
    Case("a folder that is no mission", "check {}", lambda at: named(at, lambda folder: None)),
    Case("a file that is not there", "rosbag verify {}", lambda at: at / NASTY),
    Case("a file that is none of cFE", "log {}", lambda at: at / NASTY),
    Case("a file that is no table", "tbl show {}", lambda at: at / NASTY),
    Case("a file that is no journal", "replay {}", lambda at: at / NASTY),
    Case("an option that is none", "run lab --{}", lambda at: Path(NASTY)),
    Case("a word for a number", "run lab --for {}", lambda at: Path(NASTY)),
    Case("a board", "run lab --board {}", lambda at: Path(NASTY)),
    Case("a schedule", "run lab --schedule {}", lambda at: Path(NASTY)),
    Case("a name of a command", "{}", lambda at: Path(NASTY)),
    Case("an app of a startup script", "check {}", lambda at: mission(at / "m", app=NASTY.replace("\r", "")), ""),
    Case("syntax of an app", "check {}", lambda at: mission(at / "m", f"def {NASTY}:"), ""),
    Case("events, log, printf", "run {} --for 1", lambda at: mission(at / "m")),
    Case("a mission's name", "graph --mids {}", lambda at: named(at, mission)),
    Case("an error of an app", "run {} --for 1", lambda at: mission(at / "m", DIES)),
    Case("pipes", "graph {} --for 1", lambda at: mission(at / "m"), ""),
    Case("telemetry", "tlm {} CFE_EVS_LONG_EVENT_MSG --for 1", lambda at: mission(at / "m")),
    Case("what a command brings", "cmd {} CFE_ES_NOOP", lambda at: mission(at / "m")),
    Case("a trace", "trace {} --for 1", lambda at: mission(at / "m")),
    Case("schedules", "explore {} --for 1 --seeds 2 --jobs 1", lambda at: mission(at / "m", DIES), ""),
    Case("topics of a bag", "rostopic list {}", bag),
    Case("topics of a bag with their nodes", "rostopic list {} -v", bag),
    Case("topics of a type", "rostopic find {} std_msgs/Header", bag),
    Case("messages of a bag", "rostopic echo {} /*", bag, ""),
    Case("a summary of a bag", "rosbag verify {}", bag),
    Case("a summary by ROS", "rosbag info {}", lambda at: bag(at, [f"/{NASTY}"])),
    Case("a bag whose name is nasty", "rosbag verify {}", lambda at: bag(named(at, lambda folder: None))),
    Case("a log of the system", "log {}", lambda at: dumped(at, SYSLOG, 80)),
    Case("the description of a file", "log {}", lambda at: dumped(at, SYSLOG, 32)),
    Case("events in a file", "log {}", lambda at: dumped(at, EVENTS, 64 + 40), ""),
    Case(
        "a tag of a launch file",
        "check {}",
        lambda at: launch(at, '<param name="&#x9b;31m" value="&#x202e;"/><node/>'),
        "",
    ),
    Case(
        "nodes of a launch file",
        "launch {} --nodes",
        lambda at: launch(at, '<node name="&#x9b;2J" pkg="p" type="t"/>'),
        "",
    ),
    Case("what a node prints", "node {} --for 1", node_file),
    Case("all of a run with a node", "run {} --for 1", node_file),
    Case("topics of a node", "rostopic echo {} /t -n 1 --for 1", node_file, r"\e]0;title"),
    Case("columns of topics", "rostopic echo {} /t -n 1 -p --for 1", node_file),
    Case("parameters of a node", "rosparam list {} --for 1", node_file, r"/p/\x9b31m"),
    Case("values of a node's parameters", "rosparam get {} /p --for 1", node_file, r"\u202e"),
    Case("what is told of a node", "rosnode info {} /n", node_file, ""),
]


def said(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    try:
        main(words)
    except SystemExit:  # of argparse
        pass
    out, err = capsys.readouterr()
    return out + err


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_no_control_characters_are_printed(
    case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    made = str(case.make(tmp_path))
    text = said([word.replace("{}", made) for word in case.words.split(" ")], capsys)
    assert FORBIDDEN.findall(text) == []
    assert case.told in text
    assert "\n/forged" not in text


# -- journals, and input of other programs -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def journal(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("journal")
    main(["run", str(mission(folder / "m")), "--for", "1", "--quiet", "--record", str(folder / "run.cfepy")])
    return folder / "run.cfepy"


@pytest.mark.parametrize("words", ["replay {}", "replay --info {}", "trace {}", "diff {} {}", "diff {} {}.text"])
def test_a_journal_prints_no_control_characters(words: str, journal: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path(f"{journal}.text").write_text(f"1.0 {NASTY}\n", encoding="utf-8")
    assert FORBIDDEN.findall(said(words.replace("{}", str(journal)).split(), capsys)) == []


def test_differing_traces_print_no_control_characters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [tmp_path / name for name in "ab"]
    for number, file in enumerate(files):
        file.write_text(f"0.1 HOST {NASTY}\n0.2 HOST {NASTY} {number}\n", encoding="utf-8")
    text = said(["diff", *map(str, files)], capsys)
    assert TOLD in text
    assert FORBIDDEN.findall(text) == []


def test_json_output_keeps_control_characters_escaped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(bag(tmp_path))
    assert main(["rostopic", "list", file, "--json", "-"]) == 0
    text = capsys.readouterr().out
    assert FORBIDDEN.findall(text) == []
    assert {row["name"] for row in json.loads(text)} == {f"/{NASTY}", "/good\n/forged"}
    assert main(["rostopic", "echo", str(bag(tmp_path, ["/t"])), "/t", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out.splitlines()[0])["message"]["frame_id"] == NASTY


def test_csv_output_to_a_pipe_is_unchanged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(bag(tmp_path, ["/t"]))
    assert main(["export", "csv", file, "/t.frame_id"]) == 0
    assert NASTY in capsys.readouterr().out


# -- on a terminal -----------------------------------------------------------------------------------------------------


def on_a_terminal(words: list[str]) -> str:
    """Return a command's output on a terminal."""
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "200"}
    command = [sys.executable, "-m", "cfepy", *words]
    shown = b""
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment) as process:
        os.close(theirs)
        try:
            while piece := os.read(ours, 1 << 16):
                shown += piece
        except OSError:  # the end, on Linux
            pass
        process.wait()
    os.close(ours)
    return shown.decode()


DANGEROUS = re.compile("\x1b[^\\[]|\x1b\\[31m\x9b|[\x80-\x9f\u202a-\u202e\x07\x7f]")
"""Not among what rich writes: other sequences than colours and movements."""


def test_run_on_a_terminal_prints_only_colours_of_nodes(tmp_path: Path) -> None:
    text = on_a_terminal(["run", str(node_file(tmp_path)), "--for", "1"])
    assert "\x1b[32mgreen\x1b[0m" in text
    assert DANGEROUS.findall(text) == []
    assert TOLD in text


def test_tables_on_a_terminal_are_safe(tmp_path: Path) -> None:
    text = on_a_terminal(["rosbag", "verify", str(bag(tmp_path))])
    assert DANGEROUS.findall(text) == []
    assert TOLD in text
    assert "\x1b[" in text  # rich's own


def test_table_ignores_rich_markup_of_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    table = Table("run[/x].bag", ["[red]topic"])
    table.add("[link=http://x]a")
    table.note = "[/]"
    stream = Terminal()
    show_tables([table], stream)
    for text in ("run[/x].bag", "[red]topic", "[link=http://x]a", "[/]"):
        assert text in stream.getvalue()
