"""The runner itself: flying, judging, fetching and reporting, with small nodes of our own."""

from __future__ import annotations

import hashlib
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.status import UsageError
from dev.corpus import report
from dev.corpus.flight import Flight
from dev.corpus.likeness import differences, digest, lines, messages
from dev.corpus.pool import run_all
from dev.corpus.scenarios import Corpus, Program, Scenario, read_corpus
from dev.corpus.sources import Sources
from dev.corpus.verdict import Outcome, Verdict, judge

ECHO = """#!/usr/bin/env python
import rospy, sys
from std_msgs.msg import String
from own_msgs.srv import Count

def main():
    rospy.init_node("echo")
    pub = rospy.Publisher("out", String, queue_size=10)
    rospy.Subscriber("in", String, lambda message: pub.publish(message.data.upper() + rospy.get_param("~mark")))
    rospy.Service("count", Count, lambda request: request.a + 1)
    rospy.on_shutdown(lambda: pub.publish("bye"))
    print("arguments", rospy.myargv()[1:])
    rospy.spin()

main()
"""
TALK = "import rospy, sys\nprint('typed', sys.stdin.readline().strip())\nsys.exit(3)\n"


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """Sources of one repository with one package, msgs and two nodes."""
    package = tmp_path / "sources" / "us+robots" / "own_msgs"
    (package / "srv").mkdir(parents=True)
    (package / "scripts").mkdir()
    (package / "package.xml").write_text("<package><name>own_msgs</name></package>", encoding="utf-8")
    (package / "srv" / "Count.srv").write_text("int32 a\n---\nint32 b\n", encoding="utf-8")
    (package / "scripts" / "echo.py").write_text(ECHO, encoding="utf-8")
    (package / "scripts" / "talk").write_text(TALK, encoding="utf-8")
    return Sources(tmp_path / "sources")


def scenario_of(sources: Sources, script: str, **fields: object) -> Scenario:
    """Return a scenario with one of the nodes."""
    node = Program("us/robots", f"own_msgs/scripts/{script}", fields.pop("argv", ()))  # type: ignore[arg-type]
    text = (sources.folder(node.repo) / node.path).read_bytes()
    basis = Scenario(id="own", node=node, sha256=hashlib.sha256(text).hexdigest(), seconds=2.0, expect=())
    return replace(basis, **fields)  # type: ignore[arg-type]


def fly(scenario: Scenario, sources: Sources, tmp_path: Path) -> Outcome:
    """Fly a scenario in a new folder."""
    folder = tmp_path / "flight"
    folder.mkdir()
    return Flight(scenario, sources, folder).run()


def test_node_is_driven_observed_and_ended(sources: Sources, tmp_path: Path) -> None:
    stimulus = 'every(10, "/ns/in", "std_msgs/String", lambda i: mc("std_msgs/String")("x%d" % i))\n'
    stimulus += 'R["heard"] = wait("/ns/out", 3)\ncall("count", "/ns/count", "own_msgs/Count", 4)'
    scenario = scenario_of(
        sources,
        "echo.py",
        argv=("_mark:=M", "more"),
        namespace="/ns",
        observe={"/ns/out": "std_msgs/String"},
        stimulus=stimulus,
        expect=("R['heard'] and R['count']=={'b':5}", "rc==0", "9<rate['/ns/out']<11", "'more' in out"),
    )
    outcome = fly(scenario, sources, tmp_path)
    assert judge(scenario, outcome).reason == ""
    assert outcome.messages["/ns/out"][0]["data"].startswith("X")
    assert outcome.messages["/ns/out"][-1] == {"data": "bye"}
    assert 20 <= outcome.counts["/ns/out"] <= 24
    assert not outcome.ended_itself


def test_node_reads_keys_and_ends_by_itself(sources: Sources, tmp_path: Path) -> None:
    scenario = scenario_of(sources, "talk", keys=("hello\n",), ends_itself=True, expect=("rc==3", "rec['self_exit']"))
    outcome = fly(scenario, sources, tmp_path)
    assert judge(scenario, outcome).passed
    assert outcome.out == "typed hello\n"


def test_helpers_run_beside_the_node(sources: Sources, tmp_path: Path) -> None:
    helper = Program("us/robots", "own_msgs/scripts/echo.py", ("_mark:=Q",))
    stimulus = 'pub("/in", "std_msgs/String")\nwaitsub("/in")\npubs["/in"].publish("a")'
    scenario = scenario_of(sources, "talk", helpers=(helper,), stimulus=stimulus, observe={"/out": "std_msgs/String"})
    outcome = fly(scenario, sources, tmp_path)
    assert outcome.messages["/out"][0] == {"data": "AQ"}
    assert outcome.out == "typed \n"


def test_failed_stimulus_is_reported(sources: Sources, tmp_path: Path) -> None:
    scenario = scenario_of(sources, "echo.py", stimulus="nowhere()", expect=("N['/x']>0",))
    reason = judge(scenario, fly(scenario, sources, tmp_path)).reason
    assert reason == "N['/x']>0; stimulus: NameError: name 'nowhere' is not defined"


def test_scenarios_run_in_processes_of_their_own(tmp_path: Path) -> None:
    scenario = read_corpus().scenarios["rt_talker"]
    script = Sources(tmp_path).folder(scenario.node.repo) / scenario.node.path
    script.parent.mkdir(parents=True)
    script.write_text("print('not the talker')", encoding="utf-8")
    verdict = run_all([scenario], Sources(tmp_path), 1, "thread")["rt_talker"]
    assert "'hello world' in out" in verdict.reason
    assert verdict.wall_s > 0


def test_missing_sources_are_named(sources: Sources) -> None:
    scenario = scenario_of(sources, "talk")
    assert sources.missing(scenario) == ""
    assert "no sources of us/more" in sources.missing(replace(scenario, needs=("us/more",)))
    assert "its SHA-256 is another one" in sources.missing(replace(scenario, sha256="0"))
    assert "is not there" in sources.missing(replace(scenario, node=Program("us/robots", "none.py")))


def test_fetching_a_commit(tmp_path: Path) -> None:
    origin = tmp_path / "mirrors" / "us+robots" / "repo"
    origin.mkdir(parents=True)

    def git(*arguments: str) -> str:
        identity = ("-c", "user.name=x", "-c", "user.email=x@example.org")
        done = subprocess.run(["git", *identity, "-C", str(origin), *arguments], capture_output=True, check=True)
        return done.stdout.decode().strip()

    git("init", "--quiet")
    (origin / "nodes").mkdir()
    (origin / "nodes" / "talk").write_text(TALK, encoding="utf-8")
    (origin / "mesh.STL").write_text("large", encoding="utf-8")
    git("add", ".")
    git("commit", "--quiet", "-m", "one")
    commit = git("rev-parse", "HEAD")
    (origin / "nodes" / "talk").write_text("later", encoding="utf-8")
    git("commit", "--quiet", "-am", "two")
    sources = Sources(tmp_path / "sources")
    assert sources.fetch_all({"us/robots": commit}, tmp_path / "mirrors") == ["us/robots"]
    assert [path.name for path in sources.folder("us/robots").rglob("*") if path.is_file()] == ["talk"]
    assert (sources.folder("us/robots") / "nodes" / "talk").read_text(encoding="utf-8") == TALK
    assert sources.fetch_all({"us/robots": commit}, tmp_path / "mirrors") == []
    with pytest.raises(UsageError, match="git ls-tree"):
        sources.fetch("us/none", commit, tmp_path / "mirrors")


def test_expectations_about_missing_values_fail() -> None:
    scenario = Scenario("x", Program("a/b", "c"), "", 1.0, ("T['/none'][0]==1", "approx(1.0, 1.1, 0.2)", "rc+1"))
    verdict = judge(scenario, Outcome(out="Traceback (most recent call last):\n  x\nKeyError: 'k'\n"))
    assert verdict.reason == "T['/none'][0]==1; rc+1; KeyError: 'k'"


def test_every_repository_of_the_corpus_has_a_commit() -> None:
    corpus = read_corpus()
    used = {repo for scenario in corpus.scenarios.values() for repo in scenario.repos}
    assert used == set(corpus.commits)
    with pytest.raises(UsageError, match="unknown scenario nope"):
        corpus.chosen(["nope"])


def test_the_page_has_a_row_for_each_scenario() -> None:
    corpus = read_corpus()
    verdicts = [Verdict("rt_talker", "", 0.4), Verdict("rt_listener", "a|b", 0.5)]
    text = report.page(corpus, verdicts)
    assert "1 of 2 scenarios pass all checks" in text
    assert "| does not | 0.5 s | a\\|b |" in text
    assert isinstance(corpus, Corpus)


def test_the_page_in_docs_is_about_these_scenarios() -> None:
    rows = [
        line.split("|")[1].strip()
        for line in report.PAGE.read_text(encoding="utf-8").splitlines()
        if line.startswith("| ")
    ][1:]
    assert rows == list(read_corpus().scenarios)


def test_unread_node_is_driven_by_its_own_topics_and_services(sources: Sources, tmp_path: Path) -> None:
    scenario = scenario_of(sources, "echo.py", stimulus="drive(rounds=2)", params={"/echo/mark": "!"})
    outcome = fly(scenario, sources, tmp_path)
    assert outcome.remarks["kinds"] == {"> /out": "std_msgs/String", "< /in": "std_msgs/String"}
    assert outcome.remarks["services"] == {"/count": "own_msgs/Count"}
    assert outcome.remarks["answers"] == {"/count": {"b": 2}}
    assert outcome.remarks["params"] == {"/echo/mark": "!"}
    assert [each["data"] for each in outcome.messages["/out"]] == ["DATA 0!", "DATA 1!", "bye"]
    assert differences(outcome, outcome) == {}
    expected = (f"like('/out') == '{digest(messages(outcome.messages['/out']))}'", "about('answers') == 'other'")
    assert judge(replace(scenario, expect=expected), outcome).reason == expected[1]


def test_times_addresses_frames_and_folders_are_not_compared() -> None:
    printed = (
        'Traceback (most recent call last):\n  File "/a/b.py", line 3, in go\n    go()\n\nValueError: at 0x7f001122\n'
    )
    assert lines(f"[INFO] [1700000000.123456]: x\n[INFO] [1700000009.5, 12.25]: x\n{printed}") == [
        "[INFO] [t]: x",
        "Traceback: ValueError: at 0x0",
    ]
    assert lines("/home/me/n/b.py:3: Warning: no") == lines("/tmp/x/b.py:3: Warning: no") == ["b.py:3: Warning: no"]
    stamped = [{"header": {"seq": number, "stamp": {"secs": 2_000_000 + number, "nsecs": 0}}} for number in range(3)]
    assert messages(stamped) == [{"header": {"stamp": "time"}}]


def test_differences_of_two_outcomes_are_listed() -> None:
    one = Outcome({"/a": 100}, {"/a": [{"data": 1.0000001}]}, status=0, out="x\n")
    other = Outcome({"/a": 80}, {"/a": [{"data": 1.0}]}, status=1, out="y\n")
    assert differences(one, other) == {"status": (0, 1), "printed": (["x"], ["y"]), "/a count": (100, 80)}


def test_output_of_a_node_that_never_ends_is_kept(sources: Sources, tmp_path: Path) -> None:
    script = sources.script(Program("us/robots", "own_msgs/scripts/echo.py", ()))
    stubborn = script[0] / Path(script[1]).with_name("stubborn.py")
    stubborn.write_text(
        "import rospy, time\nprint('first')\nrospy.init_node('mule')\nprint('then')\nwhile True:\n    time.sleep(1)\n",
        encoding="utf-8",
    )
    outcome = fly(scenario_of(sources, "stubborn.py"), sources, tmp_path)
    assert (outcome.out, outcome.status, outcome.ended_itself) == ("first\nthen\n", None, False)
