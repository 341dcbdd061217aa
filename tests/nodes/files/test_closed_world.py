"""Files that nodes write belong to the run: each run finds the host unchanged, and leaves nothing there."""

from __future__ import annotations

import glob
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.exploration.fork_server import ForkingJudge
from cfepy.extra.exploration.trial import Trial
from cfepy.journal import read_journal, record
from cfepy.nodes import PREFIX, Overlay
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import NODE, RunPlan
from cfepy.reading.resources import import_path
from cfepy.schedules.schedule import Schedule
from tests.journal.replays import assert_same_again

COUNTER = """
import logging, os, rospy, sqlite3, tempfile
rospy.init_node("counter")
with open("starts", "a+") as file:
    file.seek(0)
    print("start", len(file.read()), os.fstat(file.fileno()))
    file.write("x")
scratch = tempfile.mkdtemp()
with tempfile.NamedTemporaryFile(delete=False) as named:
    named.write(b"kept")
print(scratch, named.name, os.path.getmtime(named.name), os.stat(named.name).st_ino)
base = sqlite3.connect(os.path.join(scratch, "base.db"))
base.execute("create table starts (at)")
rospy.sleep(0.25)
base.execute("insert into starts values (1)")
base.commit()
base.close()
print(os.listdir(scratch), [os.stat(os.path.join(scratch, name)) for name in os.listdir(scratch)])
logging.basicConfig(filename=os.path.join(scratch, "log"), force=True)
logging.warning("logged")
print(open(os.path.join(scratch, "log")).read(), os.path.getmtime(os.path.join(scratch, "log")), rospy.get_time())
"""


@pytest.fixture
def node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    folder.mkdir()
    (folder / "starts").write_text("xx", encoding="utf-8")
    script = folder / "counter.py"
    script.write_text(COUNTER, encoding="utf-8")
    monkeypatch.chdir(folder)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # where runs have their own files
    monkeypatch.delenv("TMPDIR", raising=False)  # a node of `cfepy node` has the user's, as with rosrun
    return script


def plan_of(script: Path, tasks: str = "thread", seconds: float = 1.0) -> RunPlan:
    return RunPlan((str(script),), seconds=seconds, command=NODE, tasks=tasks)


def left(folder: Path) -> list[str]:
    """Return the content of the test's folder, except for files of pytest and of a journal."""
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.suffix != ".cfepy")


def printed(lines: Sequence[str]) -> list[str]:
    return [line.removeprefix("[counter] ") for line in lines if line.startswith("[counter] ")]


def test_node_that_counts_its_starts_has_one_digest(node: Path, tmp_path: Path) -> None:
    runs = [fly(plan_of(node, tasks)) for tasks in ("thread", "greenlet", "thread")]
    assert len({run.trace for run in runs}) == 1
    lines = printed(runs[0].mission.console.lines)
    assert lines[0].startswith("start 2 os.stat_result(st_mode=33188, st_ino=")
    assert (node.parent / "starts").read_text(encoding="utf-8") == "xx"
    assert left(tmp_path) == ["home", "home/counter.py", "home/starts"]
    name = lines[1].split()[1]
    assert name.startswith("/tmp/tmp")
    assert not os.path.exists(name)


def test_journal_has_the_read_files_and_reproduces_the_run(node: Path, tmp_path: Path) -> None:
    flown = record(plan_of(node), tmp_path / "run.cfepy")
    journal = read_journal(tmp_path / "run.cfepy")
    assert {os.path.basename(path) for path in journal.files} == {"counter.py", "starts"}
    (node.parent / "starts").write_text("another computer", encoding="utf-8")
    assert_same_again(journal, flown.trace)


def test_written_files_can_be_saved(node: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["node", str(node), "--for", "1", "--save-files", str(out)]) == 0
    said = capsys.readouterr().out
    assert f"saved to {out}: 4 files" in said
    assert (out / str(node.parent).lstrip("/") / "starts").read_text(encoding="utf-8") == "xxx"
    (log,) = glob.glob(f"{out}/tmp/tmp*/log")
    assert Path(log).read_text(encoding="utf-8") == "WARNING:root:logged\n"


WRITER = """
import rospy
rospy.init_node("writer")
with open("note", "w") as file:
    file.write("kept")
while not rospy.is_shutdown():
    rospy.sleep(0.01)
"""


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize(
    "words",
    [
        ["node", "--for", "100000"],
        ["node", "--for", "100000", "--tasks", "greenlet"],
        ["run", "--for", "100000", "--check-determinism", "2"],
        ["explore", "--for", "3", "--seeds", "100000", "--jobs", "2"],
        ["explore", "--for", "3", "--seeds", "100000", "--from", "1s"],
    ],
)
def test_signal_removes_the_files_of_a_run(words: list[str], how: signal.Signals, node: Path, tmp_path: Path) -> None:
    node.write_text(WRITER, encoding="utf-8")
    folder = tmp_path / "scratch"
    folder.mkdir()
    process = subprocess.Popen(
        [sys.executable, "-m", "cfepy", words[0], str(node), *words[1:]],
        stdout=subprocess.DEVNULL,
        env={**os.environ, "TMPDIR": str(folder), "PYTHONPATH": import_path()},
    )
    while not glob.glob(f"{folder}/**/{PREFIX}*/**/note", recursive=True):
        assert process.poll() is None
    process.send_signal(how)
    assert process.wait() == 130
    assert list(folder.iterdir()) == []


LIBRARY = """
import cProfile, mimetypes, netrc, os, pstats, rospy, tempfile, tokenize, zipapp
from xml.dom import minidom
from xml.etree import ElementInclude, ElementTree
rospy.init_node("counter")
scratch = tempfile.mkdtemp()
path = lambda name: os.path.join(scratch, name)
tree = ElementTree.ElementTree(ElementTree.fromstring("<a><b/></a>"))
tree.getroot().append(ElementTree.Comment("said"))
tree.write(path("tree.xml"))
commented = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
again = ElementTree.parse(path("tree.xml"), commented).getroot()
assert again[1].tag is ElementTree.Comment and ElementTree.tostring(again) == b"<a><b /><!--said--></a>"
assert minidom.parse(path("tree.xml")).documentElement.tagName == "a"
assert ElementInclude.default_loader(path("tree.xml"), "xml").tag == "a"
profile = cProfile.Profile()
profile.runcall(len, "")
profile.dump_stats(path("profile"))
pstats.Stats(path("profile")).dump_stats(path("again"))
os.mkdir(path("program"))
with open(path("program/__main__.py"), "w") as file:
    file.write("# nothing")
with tokenize.open(path("program/__main__.py")) as file:
    assert file.read() == "# nothing"
zipapp.create_archive(path("program"))
with open(path("netrc"), "w") as file:
    file.write("machine arm login me password x")
assert netrc.netrc(path("netrc")).hosts["arm"][0] == "me"
with open(path("types"), "w") as file:
    file.write("text/arm arm")
assert mimetypes.read_mime_types(path("types"))[".arm"] == "text/arm"
print(sorted(os.listdir(scratch)))
"""


def test_standard_library_finds_files_written_in_the_run(node: Path, tmp_path: Path) -> None:
    node.write_text(LIBRARY, encoding="utf-8")
    flown = fly(plan_of(node))
    assert printed(flown.mission.console.lines) == [
        "['again', 'netrc', 'profile', 'program', 'program.pyz', 'tree.xml', 'types']"
    ]
    assert left(tmp_path) == ["home", "home/counter.py", "home/starts"]


FORKED = """
import os, rospy
rospy.init_node("counter")
file = open("starts", "a+")
lines = open("lines")
lines.readline()
file.write("y")
file.flush()
rospy.sleep(0.4)
file.write("z")
file.flush()
assert (open("starts").read(), lines.read()) == ("xxyz", "two\\n"), os.listdir(".")
"""


AT_ODDS = """
import os, rospy, threading
rospy.init_node("counter")
file = open("starts", "a+")
def write(text):
    for _ in range(9):
        rospy.sleep(0.1)
        file.write(text)
        file.flush()
threading.Thread(target=write, args=["y"]).start()
write("z")
rospy.sleep(0.01)
print(os.stat("starts").st_size)
"""


def test_process_that_waits_for_schedules_leaves_no_files(node: Path, tmp_path: Path) -> None:
    node.write_text(AT_ODDS, encoding="utf-8")
    judge = ForkingJudge(Trial(replace(plan_of(node, "greenlet"), schedule=Schedule.parse("random:0:from=700ms"))))
    try:
        verdicts = [judge.judge(Schedule.parse(f"random:{seed}:from=700ms")) for seed in (1, 2, 3)]
    finally:
        judge.close()
    assert len({verdict.trace for verdict in verdicts}) > 1  # so each was flown in a process of its own
    assert left(tmp_path) == ["home", "home/counter.py", "home/starts"]


def test_forked_processes_have_separate_files(node: Path, tmp_path: Path) -> None:
    node.write_text(FORKED, encoding="utf-8")
    (node.parent / "lines").write_text("one\ntwo\n", encoding="utf-8")
    another = Overlay()  # of a mission that lives on in this process while others are forked from it
    os.close(another.open(f"{tmp_path}/home/lines", os.O_WRONLY))
    trial = Trial(replace(plan_of(node, "greenlet"), schedule=Schedule.parse("random:0:from=700ms")))
    judge = ForkingJudge(trial)
    try:
        verdicts = [judge.judge(Schedule.parse(f"random:{seed}:from=700ms")) for seed in (1, 2, 1)]
    finally:
        judge.close()
    assert not any(verdict.failures for verdict in verdicts)
    alone = trial.run(Schedule.parse("random:1:from=700ms"))
    assert verdicts[0].trace == verdicts[2].trace == alone.trace
    another.close()
    assert left(tmp_path) == ["home", "home/counter.py", "home/lines", "home/starts"]
