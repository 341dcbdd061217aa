"""Flights of converted nodes on NASA's cFE.

    python -m dev.convert.real_flights TREE NAME [NAME...]

TREE is a mission tree of cFS 7.0.0 (`dev.convert.mission_tree`), for `arm` with NASA's HK in apps/hk. The flights:

ping    a package with a launch file, a library and a nodelet: its nodes exchange messages (--profile host, pool)
strict  nodes in the profile strict print there the same as on cfepy; one that allocates after its start ends
lives   two nodes of one program share nothing, and one that is restarted begins anew
hostile truncated packets on MsgIds that a node subscribes to do not disturb it or the other nodes
ends    a call returns if its server ends meanwhile, and the service is then known to be gone
arm     examples/arm: two nodes close a loop at 1 kHz beside HK, which collects from them and is commanded by a third
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import cfepy
from cfepy.es.packets import RESTART_APP, STOP_APP
from dev.convert.hostile_packets import ALLSUBS, EMPTY_LIST, LAUNCH, ONESUB, SOURCES, packet_of
from dev.convert.mission_tree import CI_LAB, MissionTree, said
from dev.convert.node_flights import NODES
from dev.convert.ping import ping_package
from dev.convert.service_ends import LAUNCH as ENDING_LAUNCH
from dev.convert.service_ends import SOURCES as ENDING
from dev.convert.small_missions import write_package
from dev.convert.twin_flights import TWINS

EXAMPLES = Path(__file__).parents[2] / "examples"
HEARD = ("heard 3 plain-beat-odd!", "doubling 3")
LIMIT_S = 60.0
HK = "CFE_APP, hk, HK_AppMain, HK, 50, 16384, 0x0, 0;"
LIVES = ("/one", "/two")
LIFE = "{} global {} heard 0 starts {} made before main"
NODE_LINE = re.compile(r"^\[(/\w+)\] \[[A-Z ]+\] \[[\d.]+\]: (.*)$")
GREEDY = "GREEDY: memory was allocated after initialisation: the profile is strict"


def ping(tree: Path, scratch: Path, profile: str) -> list[str]:
    """Fly nodes of a package that exchange messages.

    Args:
        tree: the mission tree.
        scratch: an empty folder.
        profile: profile of the nodes.

    Returns:
        The log lines of the nodes.
    """
    package = ping_package(scratch)
    os.environ["ROS_PACKAGE_PATH"] = str(scratch)
    mission = MissionTree(tree, scratch)
    apps = mission.convert([str(package / "launch/nodelet.launch")], profile=profile)
    mission.build()
    with mission.booted(scratch / "run", apps) as cfe:
        cfe.wait(lambda: all(text in said(cfe) for text in HEARD), "nodes that hear each other", LIMIT_S)
        return [line for line in said(cfe).splitlines() if any(text in line for text in HEARD)]


def arm(tree: Path, scratch: Path, profile: str) -> list[str]:
    """Fly 5,000 messages each way at 1 kHz, beside HK. Returns the log lines of the nodes."""
    package = EXAMPLES / "arm"
    mission = MissionTree(tree, scratch, ["hk"])
    words = [str(package / "launch/arm.launch"), "cycles:=5000", "--ids", str(package / "mission")]
    apps = mission.convert(words, profile=profile)
    mission.build()
    table = {"/cf/hk_cpy_tbl.tbl": (package / "mission/hk_cpy_tbl.tbl").read_bytes()}
    with mission.booted(scratch / "run", apps, [HK], table) as cfe:
        cfe.wait(lambda: "commands came" in said(cfe) and "states came" in said(cfe), "end of the loops", LIMIT_S)
        cfe.wait(lambda: "arm at sample 5000" in said(cfe), "packet of HK about the end", LIMIT_S)
        return [line for line in said(cfe).splitlines() if NODE_LINE.match(line)]


def strict(tree: Path, scratch: Path, profile: str) -> list[str]:
    """Fly nodes that allocate no memory after their start. Returns their log lines, which equal those on cfepy."""
    os.environ["ROS_PACKAGE_PATH"] = f"{NODES}:{TWINS}"
    package = NODES / "strict"
    mission = MissionTree(tree, scratch)
    apps = mission.convert([str(package / "launch/all.launch"), "--ids", str(package / "mission")], profile="strict")
    mission.build()
    with mission.booted(scratch / "run", apps) as cfe:
        cfe.wait(lambda: "answer 2" in said(cfe) and GREEDY in said(cfe), "answers", LIMIT_S)
        there = spoken(said(cfe).splitlines())
        ended = [line for line in said(cfe).splitlines() if GREEDY in line]
    run = cfepy.run(str(package / "mission"), seconds=4)
    if there != spoken(run.console):
        raise SystemExit("\n".join(["other than on cfepy:", *there]))
    return [*there, *ended]


def lives(tree: Path, scratch: Path, profile: str) -> list[str]:
    """Fly two nodes of one program and restart one of them. Returns their log lines."""
    os.environ["ROS_PACKAGE_PATH"] = f"{NODES}:{TWINS}"
    mission = MissionTree(tree, scratch)
    apps = mission.convert([str(NODES / "lives/launch/all.launch")], profile=profile)
    mission.build()
    with mission.booted(scratch / "run", apps, [CI_LAB]) as cfe:
        cfe.wait(lambda: said(cfe).count("/one count 3 ") == 1 and "/two count 3 " in said(cfe), "two nodes", LIMIT_S)
        cfe.send(RESTART_APP.packet(Application="ONE"))
        cfe.wait(lambda: said(cfe).count("/one count 3 ") == 2, "new start of a node", LIMIT_S)
        found = spoken(said(cfe).splitlines())
    one, two = ([line.partition(f"{name} count ")[2] for line in found if f"{name} count " in line] for name in LIVES)
    again = one.index(LIFE.format(1, 5, 1), 1)
    for texts, starts in ((one[:again], 1), (one[again:], 1), (two, 100)):
        if texts != [LIFE.format(number, number + 4, starts) for number in range(1, len(texts) + 1)]:
            raise SystemExit("\n".join(["old state:", *texts]))
    return [f"/one: {again} texts, then {len(one) - again} anew; /two: {len(two)} texts", *one[again - 1 : again + 1]]


def hostile(tree: Path, scratch: Path, profile: str) -> list[str]:
    """Send truncated packets from a foreign sender to a node, which must keep working. Returns its log lines."""
    write_package(scratch, SOURCES)
    (scratch / "all.launch").write_text(f"<launch>{LAUNCH}</launch>\n", encoding="utf-8")
    os.environ["ROS_PACKAGE_PATH"] = str(scratch)
    mission = MissionTree(tree, scratch)
    apps = mission.convert([str(scratch / "all.launch")], profile=profile)
    mission.build()
    with mission.booted(scratch / "run", apps, [CI_LAB]) as cfe:
        cfe.wait(lambda: "alive 2," in said(cfe), "nodes", LIMIT_S)
        for packet in (EMPTY_LIST, packet_of(ONESUB, b"\xff" * 4), packet_of(ALLSUBS, b"\xff" * 30)):
            cfe.send(packet)
        cfe.wait(lambda: "ignored 28 bytes on 0x080D" in said(cfe), "event", LIMIT_S)
        cfe.wait(lambda: "alive 6," in said(cfe), "nodes that work on", LIMIT_S)
        found = said(cfe)
    if "process ended" in found or cfe.boots() != 1:
        raise SystemExit(found[-3000:])
    return [line for line in found.splitlines() if "alive 6," in line or "ignored" in line]


def ends(tree: Path, scratch: Path, profile: str) -> list[str]:
    """End the server during a call. Returns the log lines of the caller."""
    write_package(scratch, ENDING)
    (scratch / "all.launch").write_text(f"<launch>{ENDING_LAUNCH}</launch>\n", encoding="utf-8")
    os.environ["ROS_PACKAGE_PATH"] = str(scratch)
    mission = MissionTree(tree, scratch)
    apps = mission.convert([str(scratch / "all.launch")], profile=profile)
    mission.build()
    with mission.booted(scratch / "run", apps, [CI_LAB]) as cfe:
        cfe.wait(lambda: "calls" in said(cfe), "call", LIMIT_S)
        cfe.send(STOP_APP.packet(Application="SERVER"))
        cfe.wait(lambda: "service there 0" in said(cfe), "end of the call", LIMIT_S)
        return [line for line in said(cfe).splitlines() if NODE_LINE.match(line)]


def spoken(lines: Iterable[str]) -> list[str]:
    """Return the log lines of the nodes, with their names and without times, grouped by node."""
    found = (NODE_LINE.match(line) for line in lines)
    return sorted((f"{each[1]} {each[2]}" for each in found if each), key=lambda line: line.split()[0])


FLIGHTS: Mapping[str, Callable[[Path, Path, str], list[str]]] = {
    "ping": ping,
    "strict": strict,
    "lives": lives,
    "hostile": hostile,
    "ends": ends,
    "arm": arm,
}


def run(arguments: list[str]) -> None:
    """Fly and print the results."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.real_flights", description=__doc__)
    parser.add_argument("tree", type=Path)
    parser.add_argument("names", nargs="+", choices=[*FLIGHTS])
    parser.add_argument("--profile", default="host")
    given = parser.parse_args(arguments)
    for name in given.names:
        with tempfile.TemporaryDirectory(prefix="cfepy-tree-") as scratch:
            print(f"-- {name}", *FLIGHTS[name](given.tree, Path(scratch), given.profile), sep="\n", flush=True)


if __name__ == "__main__":
    run(sys.argv[1:])
