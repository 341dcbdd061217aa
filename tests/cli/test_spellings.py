"""Consistent spelling: the name and meaning of each option, in every subcommand that has it.

A new subcommand uses the existing options for their meanings. A new option gets a row here once a second command has
it; until then its own help defines it. Options passed on to ROS's own tools, such as `cfepy rosbag`, keep ROS's names.
"""

from __future__ import annotations

import argparse
import re
from argparse import Action

import pytest

from tests.cli.parsers import options, parsers

MEANINGS: dict[str, tuple[str | None, str]] = {
    "--arg": ("NAME:=VALUE", "set an argument of the launch file"),
    "--at": ("SECONDS", "virtual time of the (run|action)"),
    "--bag": ("FILE", "record the ROS topics of the run into a bag"),
    "--bag-topics": ("TOPIC", "record only these"),
    "--board": ("NAME|FILE", "(this board instead of the mission's own|boards, with commas between)"),
    "--cfe": ("RELEASE", "the sources are for cFE 6.5, 6.7 or 6.8"),
    "--cmake": (None, "ask CMake for the sources"),
    "--cluster": ("ADDRESS", "dask cluster"),
    "--console": (None, "show the flight computer's console"),
    "-n --count": ("N", "end after so many"),
    "--cpp-nodes": ("PROFILE|MISSION", "section cpp_nodes of"),
    "--csv": ("FILE|-", "write (a row for each topic of each run|the requirement matrix)"),
    "--dot": ("FILE|-", "for graphviz"),
    "--enable": ("HOST[:PORT]", "ask TO_LAB there to begin to send"),
    "--faults": ("FILE|seed:N", "fault"),
    "--for": ("SECONDS", "seconds"),
    "--from": ("SECONDS", "(begin at this virtual time|vary the order from here on)"),
    "--from-disk": (None, "use the mission's files on this computer, not those in the journal"),
    "--guard": (
        None,
        (
            "report writes of compiled applications past a buffer, uses of freed buffers, and resources that "
            "applications do not give back"
        ),
    ),
    "--jobs": ("N", "processes on this computer"),
    "--json": ("FILE|-", "as JSON; - writes to standard output"),
    "--layout": ("FILE.yaml", "take a table's layout from a YAML file"),
    "--longest": ("SECONDS", "wall time limit of one run"),
    "--mission": ("MISSION", "(names|tables)"),
    "-o --output": ("PATH", "where to write (default: "),
    "--perfetto": ("FILE", "write a trace in the Trace Event Format"),
    "--play": ("BAG", "play the topics of a bag or an MCAP file into the mission"),
    "--play-options": ("TEXT", "options and remappings of rosbag play"),
    "--points": ("KIND", "lines, attributes or calls"),
    "--port": ("PORT=HERE", "open the mission's port PORT"),
    "--profile": ("FILE", "where wall time goes"),
    "--quiet": (None, "(print only the|show no progress)"),
    "--quote-formulas": (None, "put ' before a text that a spreadsheet takes for a formula"),
    "--races": (None, "report unordered accesses of Python code"),
    "-r --rate": ("HZ", "(how often|VALUES in Hz)"),
    "--spacecraft-id": ("N", "number of the spacecraft"),
    "--processor-id": ("N", "number of the processor"),
    "--raw": (None, "raw numbers instead of values with units and limits"),
    "--realtime": ("FACTOR", "pace virtual time to the wall clock"),
    "--record": ("FILE", "write a journal"),
    "--record-no-files": (None, "leave the mission's files out of the journal"),
    "--results": ("FILE", "(write all results|another name of)"),
    "--junit": ("FILE|-", "as JUnit XML"),
    "--sarif": ("FILE|-", "as SARIF 2.1.0"),
    "--github": (None, "as annotations of GitHub"),
    "--no-console": (None, "print only the report, no console and no status line"),
    "--save-files": ("DIR", "write the mission's files, such as /ram/x.log, to this folder at the end"),
    "--check-determinism": ("N", "run it N times side by side"),
    "--ros-master": ("URI", "join ROS on this computer"),
    "--schedule": ("TEXT", "order of tasks where several could run"),
    "--script": ("FILE", "(send commands and check their effects|translate this mission script)"),
    "--seed": ("N", "(seed of all random values|seeds|plan of this seed)"),
    "--set": ("/PARAM=VALUE", "a ROS parameter"),
    "--stall": ("SECONDS", "fail if a task computes for so many seconds of CPU time"),
    "--stop-on-failure": (None, "end the run with the script's first failed step"),
    "--tasks": (None, "kind of tasks"),
    "--trace": ("FILE", "write all records of the run to a file"),
    "--until": ("SECONDS", "ends at this virtual time"),
    "--foxglove": ("[HOST:]PORT", "serve Foxglove"),
    "--rosbridge": ("[HOST:]PORT", "serve clients of rosbridge"),
    "--viewer-origin": ("ORIGIN", "let pages of a web site"),
    "--viewer-token": ("TOKEN", "the token that a program must send to connect"),
    "--with": ("MISSION[@SECONDS]", "run another processor in the same virtual time and network"),
    "-w --window": ("N", "the newest N messages count"),
}
"""Of each option that more than one command has: the name of its value, and what its help says everywhere."""

OTHER_NAMES = {
    "--count": ("--number", "--num", "--limit", "--max", "--messages", "--packets"),
    "--for": ("--duration", "--seconds", "--time", "--length"),
    "--from": ("--start", "--since", "--begin", "--after"),
    "--json": ("--as-json", "--format", "--json-file"),
    "--output": ("--out", "--file", "--to-file", "--out-file", "--save"),
    "--quiet": ("--silent", "-q"),
    "--results": ("--results-file", "--result"),
    "--seeds": ("--schedules", "--runs"),
    "--until": ("--to", "--end", "--stop", "--before"),
    "--arg": ("--args", "--launch-arg", "--define"),
    "--jobs": ("--processes", "--workers", "--parallel", "-j"),
}
"""Other names that tools have for what an option here means; no command has them."""


def key(action: Action) -> str:
    return " ".join(action.option_strings)


def pattern(core: str) -> str:
    """Return the core of a help text as a regular expression: `(a|b)` is a choice, all else is literal."""
    parts = re.split(r"(\([\w', ]+(?:\|[\w', ]+)+\))", core)
    return "".join(part if number % 2 else re.escape(part) for number, part in enumerate(parts))


OTHER_MEANINGS = {("new mission", "--from")}
"""Options with a meaning of their own: a new mission has no time to begin at, but a source to come from."""
AS_ROS_HAS_THEM = ("rosbag ", "rosmsg ", "rossrv ", "rosnode ", "roslaunch", "rosrun")
"""Commands whose options are those of ROS's tools, which get them unchanged, and other names of commands."""


def own_parsers() -> dict[str, argparse.ArgumentParser]:
    return {words: parser for words, parser in parsers().items() if not words.startswith(AS_ROS_HAS_THEM)}


@pytest.mark.parametrize("words", own_parsers())
def test_an_option_means_one_thing(words: str) -> None:
    for action in options(parsers()[words]):
        if key(action) not in MEANINGS or (words, key(action)) in OTHER_MEANINGS:
            continue
        metavar, core = MEANINGS[key(action)]
        assert action.metavar == metavar, key(action)
        assert re.search(pattern(core), action.help or ""), f"{key(action)}: {action.help}"


def test_an_option_of_two_commands_has_a_row_here() -> None:
    users: dict[str, set[str]] = {}
    for words, parser in own_parsers().items():
        for action in options(parser):
            for name in action.option_strings:
                users.setdefault(name, set()).add(words)
    known = {name for row in MEANINGS for name in row.split()}
    assert {name for name, commands in users.items() if len(commands) > 1} == known


def test_an_option_has_the_same_short_form_everywhere() -> None:
    forms: dict[str, set[str]] = {}
    for parser in own_parsers().values():
        for action in options(parser):
            for name in action.option_strings:
                forms.setdefault(name, set()).add(key(action))
    assert {name: keys for name, keys in forms.items() if len(keys) > 1} == {}


@pytest.mark.parametrize("words", own_parsers())
def test_one_thing_has_one_name(words: str) -> None:
    wrong = {other: name for name, others in OTHER_NAMES.items() for other in others}
    named = {name for action in options(parsers()[words]) for name in action.option_strings}
    assert {f"{name} is {wrong[name]} elsewhere" for name in named & wrong.keys()} == set()
