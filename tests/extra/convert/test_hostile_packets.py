"""Packets from a foreign sender to the topics of a node in C++: it ignores invalid ones and continues."""

from __future__ import annotations

import random
import re
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.mission import Mission
from dev.convert.hostile_packets import ALLSUBS, EMPTY_LIST, LAUNCH, MASTER, ONESUB, SOURCES, TARGET, packet_of
from dev.convert.small_missions import said_by, small_mission
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

WITHOUT_PARAMETER = TARGET.replace('nh.getParamCached("/value", value)', "value = 7.0")
"""In the profile strict: to ask for a kept parameter again, after a notice, takes memory."""

CAPACITIES = {"tf2_msgs/TFMessage": {"transforms": 8}}
"""What the profile strict must know: the node subscribes to transforms."""


@pytest.fixture(params=["host", "pool", "strict"])
def mission(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Mission]:
    is_strict = request.param == "strict"
    sources = {**SOURCES, "target.cpp": WITHOUT_PARAMETER} if is_strict else SOURCES
    with small_mission(tmp_path, sources, LAUNCH, request.param, CAPACITIES if is_strict else {}) as flown:
        flown.run_for(3)
        assert said_by(flown, "target")[-1].startswith("alive ")
        yield flown


def send(mission: Mission, packet: bytes) -> None:
    """Send a packet unchanged."""
    mission.cfe.sb.transmit_msg(packet, False)


def one_subscription(msg_id: int, pipe: int, kind: int = 0, priority: int = 0) -> bytes:
    """Return a report as the Software Bus makes one."""
    return packet_of(ONESUB, bytes(10) + struct.pack("<B3xIBBxxI", kind, msg_id, priority, 0, pipe))


def works(mission: Mission) -> None:
    """The nodes go on, and messages and calls get through."""
    before = {name: len(said_by(mission, name)) for name in ("target", "helper")}
    mission.run_for(5)
    target, helper = said_by(mission, "target")[before["target"] :], said_by(mission, "helper")[before["helper"] :]
    assert len(target) >= 3
    assert all(line.endswith("calls worked 1, value 7") for line in target), target
    counts = [int(line.split()[-1]) for line in helper]
    assert counts[-1] - counts[0] >= 10
    assert not any("ended" in line or "was allocated" in line for line in mission.console.lines if "TARGET" in line)


def ignored(mission: Mission) -> list[str]:
    """Return the events about ignored packets."""
    return [line for line in mission.console.lines if "/target: ignored " in line]


def test_list_shorter_than_its_count_is_ignored(mission: Mission) -> None:
    for _ in range(3):
        send(mission, EMPTY_LIST)
        mission.run_for(0.5)
    works(mission)
    (line,) = ignored(mission)
    assert "/target: ignored 28 bytes on 0x080D: no report of subscriptions; told once" in line


def test_truncated_reports_are_ignored(mission: Mission) -> None:
    for size in range(1, 30):
        send(mission, packet_of(ONESUB, b"\xff" * size))
        send(mission, packet_of(ALLSUBS, b"\xff" * size))
    for entries in (0, 1, 2, 20, 21, 255, 0xFFFF, 0x80000000):
        send(mission, packet_of(ALLSUBS, bytes(10) + struct.pack("<III", 1, 1, entries) + b"\xff" * 12))
        mission.run_for(0.1)
    works(mission)
    assert len(ignored(mission)) == 1


def test_forged_subscriptions_take_no_memory(mission: Mission) -> None:
    route = next(each for each in mission.processor.cfe.sb.routes.values() if each.active)
    pipe = route.active[0].pipe.pipe_id
    for number in range(2500):
        send(mission, one_subscription(0x1A00 + number, pipe))
        send(mission, one_subscription(0x1A00 + number, 0xFF000000 + number))
        if number % 20 == 0:
            mission.run_for(0.02)
    works(mission)
    told = [line for line in mission.console.lines if re.search(r"/target: more than \d+ subscriptions; others", line)]
    assert len(told) == 1


def test_truncated_requests_and_answers_are_ignored(mission: Mission) -> None:
    ros = mission.ros
    assert ros is not None
    ids = {name: ros.graph.ids.of_service(name) for name in ("/set", "/other")}
    for size in range(1, 24):
        for msg_id in (ids["/set"] | 0x1000, ids["/other"], MASTER):
            for flags in (0xC0, 0x40, 0x00, 0x80):
                send(mission, packet_of(msg_id, bytes(size), flags))
        mission.run_for(0.3)
    works(mission)
    assert 1 <= len(ignored(mission)) <= 2


def test_notice_of_a_long_parameter_takes_no_memory(mission: Mission) -> None:
    """A notice is an answer of the ROS application with the number 0, and the name of a parameter."""
    send(mission, packet_of(MASTER, bytes(10) + bytes(5) + b"/value/" + b"x" * 2000))
    send(mission, packet_of(MASTER, bytes(10) + bytes(5)))
    works(mission)


def test_random_packets_do_not_change_the_node(mission: Mission) -> None:
    ros = mission.ros
    assert ros is not None
    draw = random.Random(7)
    topics = [ros.graph.topics[name].msg_id for name in ("/in", "/tf", "/tf_static")]
    services = [ros.graph.ids.of_service("/set") | 0x1000, ros.graph.ids.of_service("/other"), MASTER]
    forged = [packet_of(ALLSUBS, bytes(10) + struct.pack("<III", segment, 1, 20) + bytes(256)) for segment in (1, 2, 9)]
    for _ in range(400):
        msg_id = draw.choice([ALLSUBS, *topics, *services])
        size = draw.choice([1, 2, 6, 9, 10, 11, 15, 22, 30, 100, 1000, 2000])
        payload = bytearray(draw.randbytes(size))
        if draw.random() < 0.5:
            payload[:10] = bytes(min(size, 10))  # with an unused address
        send(mission, packet_of(msg_id, bytes(payload), draw.choice((0xC0, 0x40, 0x00, 0x80)), draw.randrange(256)))
        if draw.random() < 0.1:
            send(mission, draw.choice(forged))
        if draw.random() < 0.2:
            mission.run_for(0.05)
    works(mission)
