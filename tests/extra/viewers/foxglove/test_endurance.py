"""Viewers that connect and leave, that send nonsense, that do not read: the run continues, and nothing of them
remains."""

from __future__ import annotations

import gc
import os
import random
import socket
import struct
import threading
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from tests.extra.viewers.foxglove.client import FoxgloveClient
from tests.extra.viewers.foxglove.runs import TALKER, ShownRun, shown, spec_of

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory and handles are counted by /proc"),
]
MOST_GROWTH = 4 << 20  # bytes of memory


def memory() -> int:
    """Return bytes in use."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]) * os.sysconf("SC_PAGE_SIZE")


def handles() -> tuple[int, int]:
    """Open files, and threads."""
    return len(os.listdir("/proc/self/fd")), threading.active_count()


def visit(run: ShownRun, number: int) -> None:
    """Connect a viewer, use every function, and leave in one of three ways."""
    client = run.client()
    client.subscribe("/latched", "/chatter", "/cfe/events")
    client.advertise(1, "/orders", "std_msgs/String")
    client.publish(1, b"\x02\x00\x00\x00hi")
    client.send(op="getParameters", parameterNames=[], id=str(number))
    client.send(op="subscribeParameterUpdates", parameterNames=["/speed"])
    client.send(op="setParameters", parameters=[{"name": "/speed", "value": number}], id="set")
    client.send(op="subscribeConnectionGraph")
    client.call("/switch", number, b"\x01")
    client.wait_for(lambda: client.of("/latched") and client.answers and client.told("parameterValues"))
    if number % 3 == 0:
        client.socket.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        client.socket.socket.close()  # resets the connection, as a process that is killed may
    elif number % 3 == 1:
        client.socket.socket.shutdown(socket.SHUT_RDWR)
    client.close()
    while run.viewer._server.viewers or publications(run):
        run.go_on()


def publications(run: ShownRun) -> int:
    """Return the viewers' current publications."""
    assert run.viewer._incoming is not None
    return len(run.viewer._incoming._publications)


def connections(run: ShownRun) -> tuple[int, int, int]:
    """Viewers that came, that left again, and that were refused."""
    row = run.rows()["(connections)", "out"]
    return row["connections"], row["ended"], row["refused"]


def test_200_reconnects_leave_nothing_behind(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {"talker": TALKER}, {"speed": 0})) as run:
        for number in range(30):
            visit(run, number)
        before, were = memory(), handles()
        for number in range(200):
            visit(run, number)
        grown = memory() - before
        print("memory", before >> 10, "KiB, grown by", grown >> 10, "KiB; handles", were, handles())
        assert handles() == were
        assert grown < MOST_GROWTH
        assert run.mission.ros is not None
        outside = run.mission.ros.outside
        assert (len(outside.nodes), len(outside.links), outside._calls["/switch"]) == (1, 0, {})
        assert connections(run) == (230, 230, 0)


NONSENSE: tuple[str | bytes, ...] = (
    "",
    "nonsense",
    "[]",
    "null",
    '{"op": "none"}',
    '{"op": "subscribe"}',
    '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4000000000}]}',
    '{"op": "unsubscribe", "subscriptionIds": [17, -1]}',
    '{"op": "advertise", "channels": [{"id": 1, "topic": "", "encoding": "ros1", "schemaName": ""}]}',
    '{"op": "advertise", "channels": [{"id": 2, "topic": "/x", "encoding": "ros1", "schemaName": "a/B"}]}',
    '{"op": "advertise", "channels": [{"id": 3, "topic": "/o", "encoding": "json", "schemaName": "std_msgs/String"}]}',
    '{"op": "unadvertise", "channelIds": [99]}',
    '{"op": "setParameters", "parameters": [{"name": "", "value": {}}]}',
    '{"op": "setParameters", "parameters": [{"name": "/a//b c", "value": [1, "2", {}]}]}',
    '{"op": "setParameters", "parameters": 5}',
    '{"op": "getParameters"}',
    b"",
    b"\x00",
    b"\x01",
    b"\x01\x63\x00\x00\x00no such channel",
    b"\x01\x03\x00\x00\x00no JSON",
    b"\x02\x00",
    b"\x02\xff\xff\xff\xff\x00\x00\x00\x00\xff\xff\xff\xffros1",
    b"\xff" * 1000,
)


def send_nonsense(run: ShownRun, client: FoxgloveClient, choose: random.Random) -> bool:
    """Send a meaningless frame. Returns whether the connection is still open."""
    frame = choose.choice(NONSENSE)
    if choose.random() < 0.5:
        changed = bytearray(frame.encode() if isinstance(frame, str) else frame)
        for _ in range(choose.randint(1, 4)):
            changed.insert(choose.randint(0, len(changed)), choose.randrange(256))
        frame = bytes(changed) if choose.random() < 0.5 else changed.decode("latin-1")
    try:
        client.socket.send(frame)
        run.go_on()
        while True:
            client._take(client.socket.recv(timeout=0))
    except TimeoutError:
        return True
    except ConnectionClosed:
        return False


def settled(run: ShownRun, client: FoxgloveClient) -> FoxgloveClient:
    """Wait until the server has read everything and the run has processed it.

    Returns a new viewer if it was disconnected.
    """
    try:
        client.send(op="getParameters", parameterNames=[], id="last")
        client.wait_for(lambda: any(each.get("id") == "last" for each in client.told("parameterValues")))
        client.texts.clear()
    except ConnectionClosed:
        client.close()
        return settled(run, run.client())
    return client


def test_10_000_bad_frames_do_no_harm(tmp_path: Path) -> None:
    choose = random.Random(1)
    with shown(spec_of(tmp_path, {"talker": TALKER})) as run:
        run.until(1)
        client = run.client()
        before, were = 0, (0, 0)
        for number in range(12_000):
            if number == 2_000:
                before, were = memory(), handles()
            if not send_nonsense(run, client, choose) or number % 100 == 99:
                client = settled(run, client)
        grown = memory() - before
        print("memory", before >> 10, "KiB, grown by", grown >> 10, "KiB; handles", were, handles())
        assert handles() == were
        assert grown < MOST_GROWTH
        client.close()
        visit(run, 0)
        assert run.mission.record.deaths() == []


def test_frames_other_than_websocket_end_their_connection(tmp_path: Path) -> None:
    choose = random.Random(2)
    with shown(spec_of(tmp_path, {"talker": TALKER})) as run:
        run.until(1)
        for _ in range(200):
            with socket.create_connection(tuple(run.viewer.place)) as peer:
                run.shake_hands(peer)
                peer.sendall(b"\xf3" + choose.randbytes(choose.randint(1, 2_000)))  # no such kind of frame
                run.until_it_ends(peer)
            run.go_on()
        visit(run, 0)
        assert connections(run) == (201, 201, 0)


def test_slow_viewer_loses_messages_and_another_gets_all(tmp_path: Path) -> None:
    """One viewer reads nothing while 64 MB are sent: it loses messages, which are counted, and another gets all."""
    sender = """
        import rospy
        from std_msgs.msg import UInt8MultiArray
        rospy.init_node("sender")
        images = rospy.Publisher("/images", UInt8MultiArray, queue_size=1)
        rate = rospy.Rate(100)
        while not rospy.is_shutdown():
            images.publish(data=bytes(20_000))
            rate.sleep()
    """
    with shown(spec_of(tmp_path, {"sender": sender})) as run:
        run.until(0.7)
        with run.client() as good, socket.socket() as idle:
            idle.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            idle.connect(tuple(run.viewer.place))
            slow = run.client(sock=idle)
            slow.subscribe("/images")
            slow.socket.recv_bufsize = 1
            good.subscribe("/images")
            begun_ns = run.mission.kernel.now
            good.wait_for(lambda: run.mission.kernel.now - begun_ns > 32_000_000_000)
            assert len(good.of("/images")) > 3_000
            slow.socket.socket.close()
        run.viewer.close()
        row = run.rows()["/images", "out"]
        assert row["dropped"] > 100
        assert row["why"].startswith("lost on the way")
