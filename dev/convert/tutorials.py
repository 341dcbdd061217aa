"""The nodes of roscpp_tutorials, each flown on cfepy and on NASA's cFE, with the nodes that it needs beside it.

    python -m dev.convert.tutorials SOURCES TREE [--report]

SOURCES has a checkout of github.com/ros/ros_tutorials in ros/ros_tutorials, as `dev.convert.survey` wants it; TREE is
a mission tree of cFS 7.0.0 (`dev.convert.mission_tree`). `--report` rewrites the table in docs/how_to/convertor.md.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import cfepy
from cfepy.cli.main import main
from dev.convert.mission_tree import CI_LAB, MissionTree, said
from dev.twin.real import RealCfe

DOCUMENT = Path(__file__).parents[2] / "docs/how_to/convertor.md"
BEGIN, END = "<!-- tutorials: made by python -m dev.convert.tutorials --report -->", "<!-- end of tutorials -->"
PACKAGE = "roscpp_tutorials"
SECONDS = 8.0
LIMIT_S = 40.0
FLIES = "flies"


class Tutorial(NamedTuple):
    """How a node is flown.

    Attributes:
        shows: patterns that a working node prints.
        beside: the other nodes that it needs, which start before it.
        after: nodes that start after it.
        args: arguments of its command line.
    """

    shows: Sequence[str]
    beside: Sequence[str] = ()
    after: Sequence[str] = ()
    args: str = ""


HEARD = r"/{name}\] .*I heard: \[hello world \d+\]"
EACH = tuple(rf"/{{name}}\] .*chatter{which}: \[hello world \d+\]" for which in (1, 2, 3, 4))
TUTORIALS: Mapping[str, Tutorial] = {
    "talker": Tutorial([r"/talker\] .*hello world 3"], after=["listener"]),
    "listener": Tutorial([HEARD], ["talker"]),
    "babbler": Tutorial([r"/babbler\] .*hello world 3"]),
    "notify_connect": Tutorial([r"/notify_connect\] .*chatter connect"], after=["listener"]),
    "add_two_ints_server": Tutorial([r"request: x=3, y=4", r"Sum: 7"], after=["add_two_ints_client"]),
    "add_two_ints_server_class": Tutorial([r"request: x=3, y=4", r"Sum: 7"], after=["add_two_ints_client"]),
    "add_two_ints_client": Tutorial([r"/add_two_ints_client\] .*Sum: 7"], ["add_two_ints_server"], args="3 4"),
    "anonymous_listener": Tutorial([HEARD], ["talker"]),
    "listener_with_userdata": Tutorial([r"I heard: \[hello world \d+\] with user string \[User 3\]"], ["talker"]),
    "listener_multiple": Tutorial(EACH, ["talker"]),
    "listener_threaded_spin": Tutorial(EACH, ["talker"]),
    "listener_async_spin": Tutorial([*EACH, r"Main thread"], ["talker"]),
    "listener_with_tracked_object": Tutorial([r"Only this version should print: \[hello world \d+\]"], ["talker"]),
    "listener_unreliable": Tutorial([HEARD], ["talker"]),
    "listener_class": Tutorial([HEARD], ["talker"]),
    "node_handle_namespaces": Tutorial([r"/level1/a", r"/level1/level2/a", r"/node_handle_namespaces/a"]),
    "custom_callback_processing": Tutorial([r"I heard: \[ ?hello world"], ["talker"]),
    "timers": Tutorial([r"Callback 1 triggered", r"Callback 2 triggered"]),
    "parameters": Tutorial([r"Failed to get param 'my_param'", r"No param named 'my_param'", r"No param 'b' found"]),
    "cached_parameters": Tutorial([r"1st read: r u there\?", r"2nd read: r u there\?", r"3rd read: hey I'm here"]),
    "time_api_sleep": Tutorial([r"sleeping for one second", r"(?s)half second.*(tenth of a second.*){5}"]),
}


class Verdict(NamedTuple):
    """Result of a node: "flies", rules that refuse it, or the patterns that it did not print."""

    name: str
    here: str
    there: str


def refused(package: Path, scratch: Path) -> dict[str, str]:
    """Return rules that refuse nodes, by node.

    Args:
        package: its folder.
        scratch: a folder.
    """
    report = scratch / "check.json"
    main(["convert", "check", str(package), "--json", str(report)])
    nodes = json.loads(report.read_text(encoding="utf-8"))["nodes"]
    rules = {each["name"]: sorted({one["rule"] for one in each["found"] if one["level"] == "error"}) for each in nodes}
    return {name: f"refused: `{'`, `'.join(found)}`" for name, found in rules.items() if found}


def missing(name: str, text: str) -> list[str]:
    """Return the patterns of a node that its output does not match."""
    wanted = (each.replace("{name}", name) for each in TUTORIALS[name].shows)
    return [each for each in wanted if not re.search(each, text)]


def launch_file(names: Iterable[str], file: Path) -> Path:
    """Return a launch file with nodes."""
    lines = (f'<node pkg="{PACKAGE}" type="{each}" name="{each}" args="{TUTORIALS[each].args}"/>' for each in names)
    file.write_text("\n".join(["<launch>", *lines, "</launch>", ""]), encoding="utf-8")
    return file


def crew(name: str) -> list[str]:
    """Return a node with those that it is flown with, in their order."""
    node = TUTORIALS[name]
    return [*node.beside, name, *node.after]


def on_cfepy(name: str, scratch: Path) -> str:
    """Fly a node on cfepy."""
    run = cfepy.run(str(launch_file(crew(name), scratch / f"{name}.launch")), seconds=SECONDS)
    lacking = missing(name, "\n".join(run.console))
    return f"does not show {lacking[0]}" if lacking else FLIES


def has_started(cfe: RealCfe, name: str) -> bool:
    """Return whether the event of a node's start is on the console."""
    return f"/{name} started" in said(cfe)


def on_cfe(name: str, mission: MissionTree, apps: Mapping[str, str], folder: Path) -> str:
    """Fly a node on NASA's cFE."""
    first, *others = crew(name)
    with mission.booted(folder, [apps[first]], [CI_LAB]) as cfe:
        for before, each in pairwise([first, *others]):  # start each when the one before is up, as a user would by hand
            cfe.wait(partial(has_started, cfe, before), f"start of {before}", LIMIT_S)
            mission.start(cfe, apps[each])
        try:
            cfe.wait(lambda: not missing(name, said(cfe)), "sign of the node", LIMIT_S)
        except TimeoutError:
            return f"does not show {missing(name, said(cfe))[0]}"
    return FLIES


def fly(sources: Path, tree: Path, scratch: Path) -> list[Verdict]:
    """Fly all nodes.

    Args:
        sources: with the checkout.
        tree: the mission tree.
        scratch: an empty folder.
    """
    package = sources / "ros/ros_tutorials" / PACKAGE
    os.environ["ROS_PACKAGE_PATH"] = str(package.parent)
    rules = refused(package, scratch)
    flown = [each for each in TUTORIALS if each not in rules]
    mission = MissionTree(tree, scratch)
    names = mission.convert([str(launch_file(flown, scratch / "all.launch"))])
    apps = dict(zip(flown, names, strict=True))
    mission.build()
    found = []
    for name in TUTORIALS:
        if name in rules:
            found.append(Verdict(name, rules[name], rules[name]))
        else:
            found.append(Verdict(name, on_cfepy(name, scratch), on_cfe(name, mission, apps, scratch / f"run_{name}")))
        print(*found[-1], sep=": ", flush=True)
    return found


def table(found: Sequence[Verdict]) -> str:
    """Return the table for the document: the nodes that do not fly on both."""
    both = sum(each.here == each.there == FLIES for each in found)
    if both == len(found):
        return f"All {both} nodes of {PACKAGE} fly on both."
    lines = [f"{both} of the {len(found)} nodes of {PACKAGE} fly on both. The others:", ""]
    lines += ["| node | beside | cfepy | NASA's cFE 7.0.0 |", "|---|---|---|---|"]
    for each in found:
        if each.here == each.there == FLIES:
            continue
        beside = ", ".join(other for other in crew(each.name) if other != each.name)
        lines.append(f"| {each.name} | {beside} | {each.here} | {each.there} |")
    return "\n".join(lines)


def run(arguments: list[str]) -> None:
    """Fly and print the results."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.tutorials", description=__doc__)
    parser.add_argument("sources", type=Path)
    parser.add_argument("tree", type=Path)
    parser.add_argument("--report", action="store_true", help="write the table into docs/how_to/convertor.md")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="cfepy-tutorials-") as scratch:
        made = table(fly(given.sources, given.tree, Path(scratch)))
    if given.report:
        text = DOCUMENT.read_text(encoding="utf-8")
        before, after = text.partition(BEGIN)[0], text.partition(END)[2]
        DOCUMENT.write_text(f"{before}{BEGIN}\n\n{made}\n\n{END}{after}", encoding="utf-8")
    else:
        print(made)


if __name__ == "__main__":
    run(sys.argv[1:])
