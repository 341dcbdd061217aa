"""The command line itself: help in groups and on narrow terminals, hints, and a mission in two words."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import pytest

from cfepy.cli.main import ORDER, ROOMS, TITLES, main, parser_for
from cfepy.cli.parser import LAUNCH_FILES
from cfepy.mission import LAUNCH_FILES as KNOWN_LAUNCH_FILES
from cfepy.plugins import OWN
from tests.cli.parsers import parsers
from tests.cli.ros_packages import Launch, demo, write_launch

__all__ = ["demo", "write_launch"]  # fixtures

TALKER = '<arg name="count" default="3"/><node pkg="demo" type="talker.py" name="talker"><param name="count" '
TALKER += 'value="$(arg count)"/></node>'
WIDTH = 60


def said(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """Return the answer to a command line on standard error."""
    with contextlib.suppress(SystemExit):
        main(words)
    return capsys.readouterr().err


def test_commands_are_in_groups(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--help"])
    shown = capsys.readouterr().out
    places = [shown.index(f"\n{title}:\n") for title in ORDER]
    assert places == sorted(places)
    commands = {name: title for room, title in TITLES.items() for name in ROOMS[room]}
    commands |= {name: plugin.title for plugin in OWN for name in plugin.commands}
    for title, begins in zip(ORDER, places, strict=True):
        group = shown[begins + 1 :].split("\n\n")[0]
        shown_here = re.findall("^  ([a-z]+)", group, re.MULTILINE)
        assert shown_here
        assert {commands.pop(name) for name in shown_here} == {title}
    assert not commands, "each command stands in one group"


def test_every_help_fits_a_narrow_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    helps = {"": parser_for([]), **parsers()}
    examples = {f"  {example}" for parser in helps.values() for example in parser.examples}  # as they are to be copied
    lines = {line for parser in helps.values() for line in parser.format_help().splitlines()} - examples
    assert [line for line in lines if len(line) > WIDTH] == []


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        ("rnu lab", "argument COMMAND: invalid choice: 'rnu'; did you mean run?"),
        ("topic list lab", "argument COMMAND: invalid choice: 'topic'; did you mean rostopic?"),
        ("boards", "argument COMMAND: invalid choice: 'boards'; did you mean board list?"),
        ("rqt_graph", "argument COMMAND: invalid choice: 'rqt_graph'; did you mean graph?"),
        ("rostopic ecko lab /x", "argument ACTION: invalid choice: 'ecko'; did you mean echo?"),
        ("run lab --sed 7", "unrecognized arguments: --sed 7; did you mean --seed?"),
        ("run lab --tasks greenlt", "argument --tasks: invalid choice: 'greenlt'; did you mean greenlet?"),
        ("run captrue", "or a shipped mission; did you mean capture?"),
        ("launch robt.launch", "launch file not found; did you mean robot.launch?"),
        ("run robt.launch", "did you mean robot.launch?"),
        ("run demo robt.launch", "package 'demo' has no file 'robt.launch'; did you mean robot.launch?"),
        ("run dem robot.launch", "unknown package 'dem'; did you mean demo?"),
        ("node scripts/talkr.py", "script not found; did you mean scripts/talker.py?"),
        ("node demo talkr.py", "did you mean talker.py?"),
        ("launch demo robot.launch cuont:=4", "did you mean count?"),
        ("run demo robot.launch --arg cuont:=4", "did you mean count?"),
        ("rostopic echo demo robot.launch /chater", "did you mean /chatter?"),
        ("rostopic hz demo robot.launch /chater", "did you mean /chatter?"),
        ("rostopic info demo robot.launch /chater", "did you mean /chatter?"),
        ("rosservice info demo robot.launch /talker/get_logers --arg count:=999", "did you mean /talker/get_loggers?"),
        ("rosparam get demo robot.launch /talker/cuont", "did you mean /talker/count?"),
        ("cmd lab CFE_ES_NOP", "did you mean CFE_ES_NOOP"),
        ("tlm lab CFE_ES_HK_TML", "did you mean CFE_ES_HK_TLM"),
        ("run lab --board linxu", "did you mean linux?"),
    ],
)
def test_did_you_mean(
    words: str,
    hint: str,
    demo: Path,
    write_launch: Launch,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path(write_launch(TALKER)).rename(demo / "robot.launch")
    monkeypatch.chdir(demo)
    assert hint in said(words.split(), capsys)


def test_an_option_has_no_short_forms_that_nobody_chose(capsys: pytest.CaptureFixture[str]) -> None:
    assert "unrecognized arguments: --quie; did you mean --quiet?" in said(["run", "lab", "--quie"], capsys)


# -- a mission in two words --------------------------------------------------------------------------------------------


def test_launch_files_are_known_by_the_same_names() -> None:
    assert LAUNCH_FILES == KNOWN_LAUNCH_FILES


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("run demo robot.launch", {"mission": "demo robot.launch"}),
        ("run --for 2 demo --seed 3 robot.launch", {"mission": "demo", "node_args": ["robot.launch"]}),
        ("check demo --board b robot.launch", None),  # not side by side
        ("run --board demo robot.launch", {"board": "demo", "mission": "robot.launch"}),
        ("run --quiet demo robot.launch", {"quiet": True, "mission": "demo robot.launch"}),
        ("rostopic echo demo robot.launch /odom -n 1", {"source": "demo robot.launch", "topic": "/odom"}),
        ("cmd demo robot.launch CFE_ES_NOOP", {"target": "demo robot.launch", "name": "CFE_ES_NOOP"}),
        ("tlm --mission demo robot.launch CFE_ES_HK_TLM", {"mission": "demo robot.launch", "words": ["CFE_ES_HK_TLM"]}),
        ("explore talker.py x.launch", {"mission": "talker.py", "node_args": ["x.launch"]}),
        ("node demo talker.py x.launch", {"words": ["demo", "talker.py", "x.launch"]}),
        ("log a b.xml", {"files": ["a", "b.xml"]}),
        ("trace ./run robot.test", None),  # a path is not a package
    ],
)
def test_a_package_and_a_file_are_one_mission(words: str, expected: dict[str, object] | None) -> None:
    if expected is None:
        with pytest.raises(SystemExit):
            parser_for(words.split()).parse_args(words.split())
        return
    chosen = vars(parser_for(words.split()).parse_args(words.split()))
    assert {name: chosen[name] for name in expected} == expected


@pytest.mark.parametrize(
    "words",
    [
        *(
            ["run"],
            ["graph", "--mids"],
            ["check"],
            ["trace"],
            ["rosparam", "list"],
            ["rostopic", "list"],
            ["rosnode", "list"],
        ),
        *(["new", "faults"], ["export", "xtce"], ["launch"], ["launch", "--nodes"], ["report", "-o", "/dev/null"]),
    ],
)
def test_every_command_takes_a_package_and_a_file(
    words: list[str],
    demo: Path,
    write_launch: Launch,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path(write_launch(TALKER)).rename(demo / "robot.launch")
    monkeypatch.chdir(demo)
    assert main([*words, "demo", "robot.launch"]) == 0
    names_topics = words in (["run"], ["graph", "--mids"], ["launch"])  # these fly the talker, which has no listener
    assert capsys.readouterr().err == (
        "cfepy: published without a subscriber: /chatter of /talker\n" if names_topics else ""
    )


def test_a_node_is_flown_where_a_mission_is(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph", "--mids", str(demo / "scripts/talker.py"), "--for", "1"]) == 0
    assert "/chatter" in capsys.readouterr().out
