"""All input from ROS passes the door of the mission, so it can be repeated without a network."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

import msgpack
import pytest

from cfepy.extra.ros_host.tcpros import frame
from cfepy.io import peer_socket
from cfepy.mission import Arrival, Mission
from cfepy.writing.console import Console
from tests.extra.ros_host.peers import CALLER, SERVER, SET_BOOL, STRING, TALKER, Joined, OutsideSpeaker, joined, text


def test_run_with_external_nodes_is_reproduced_without_them(tmp_path: Path) -> None:
    arrivals: list[tuple[int, bytes]] = []
    with joined(tmp_path, {"TALKER": TALKER, "SERVER": SERVER}) as run:
        door = run.mission.outside
        door.listener = lambda arrival: arrivals.append((door.until_ns, msgpack.packb(list(arrival))))
        _session(run)
        end_ns, lines = door.until_ns, list(run.mission.console.lines)
        digest = run.mission.finish()
    assert len(arrivals) >= 9
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        for until_ns, here in groupby(arrivals, key=lambda each: each[0]):
            mission.run_until(until_ns)
            for _, packed in here:
                kind, values = msgpack.unpackb(packed, strict_map_key=False)
                mission.outside.repeat(Arrival(kind, tuple(values)))
        mission.run_until(end_ns)
        assert mission.finish() == digest
        assert mission.console.lines == lines


def _session(run: Joined) -> None:
    run.master("setParam", "/speed", 3)
    ear = run.subscribed("/chatter")
    ear.header()
    assert ear.frame() == text("first")
    mouth = OutsideSpeaker(run, "/orders")
    mouth.connect()
    mouth.send(text("one"))
    assert ear.frame() == text("ONE")
    caller = run.connected(run.master("lookupService", "/switch"), {"service": "/switch", **SET_BOOL})
    caller.header()
    caller.frames.has_status = True
    caller.socket.sendall(frame(b"\x01"))
    assert caller.frame()[:1] == b"\x01"
    caller.socket.close()
    mouth.close()
    ear.socket.close()
    outside = run.mission.ros.outside
    run.run_while(lambda: bool(outside.links or outside.subscriptions))
    assert CALLER in outside.nodes
    assert STRING["type"] == run.mission.ros.graph.topics["/orders"].type


def test_reset_of_the_processor_keeps_external_connections(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        ear = run.subscribed("/chatter")
        ear.header()
        ear.frame()
        mouth = OutsideSpeaker(run, "/orders")
        mouth.connect()
        former = run.mission.processor
        run.mission.cfe.psp.restart(1)
        run.run_while(lambda: run.mission.processor is former or run.mission.processor.booted is None)
        ear.ended()  # as of a node that was started again
        mouth.connect()
        ear = run.subscribed("/chatter")
        ear.header()
        mouth.send(text("again"))
        found = ear.frame()
        while found != text("AGAIN"):
            found = ear.frame()
        mouth.close()
        ear.socket.close()


BURST = [f"{number}" for number in range(1, 301)]  # more than the 50 packets of a pipe, and all in one piece


def test_burst_waits_outside_if_the_queue_is_longer_than_a_pipe(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER.replace("heard)", "heard, queue_size=1000)")}) as run:
        assert _heard_of_a_burst(run) == BURST


def test_a_short_queue_keeps_the_newest_of_a_burst(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER.replace("heard)", "heard, queue_size=3)")}) as run:
        heard = _heard_of_a_burst(run)
        assert heard == [each for each in BURST if each in heard]
        assert len(heard) < len(BURST)


def _heard_of_a_burst(run: Joined) -> list[str]:
    """Return the messages that the node has received of a burst up to its last message."""
    ear = run.subscribed("/chatter")
    ear.header()
    assert ear.frame() == text("first")
    mouth = OutsideSpeaker(run, "/orders")
    mouth.connect()
    mouth.send_frames(b"".join(frame(text(each)) for each in BURST))
    heard = [ear.frame()]
    while heard[-1] != text(BURST[-1]):
        heard.append(ear.frame())
    ear.socket.close()
    mouth.close()
    return [each[4:].decode() for each in heard]


MESSAGES = 150  # 15 MB: more than sockets hold


@pytest.mark.slow
def test_slow_peer_loses_only_its_own_messages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peer_socket, "MOST_WAITING", 3)
    large = text("x" * 100_000)
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        ear = run.subscribed("/chatter")
        ear.header()
        ear.frame()
        mouth = OutsideSpeaker(run, "/orders")
        mouth.connect()
        link = run.mission.ros.graph.nodes["/talker"].links["/chatter"]
        for number in range(1, MESSAGES + 1):
            mouth.send(large)
            run.run_while(lambda: link.seq <= number)  # noqa: B023  # called before the next round
        ear.socket.close()
        mouth.close()
        run.run_while(lambda: bool(run.mission.ros.outside.subscriptions))
    rows = {row["name"]: row for row in run.host.counts.rows()}
    assert rows["/orders"]["dropped"] == 0
    assert rows["/chatter"]["dropped"] > 0
