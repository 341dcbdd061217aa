"""Many clients connect and leave, and send nonsense: nothing of it remains."""

from __future__ import annotations

import gc
import os
import random
import tracemalloc
from pathlib import Path

import pytest

from tests.extra.ros_host.peers import TALKER
from tests.extra.viewers.rosbridge.bridged import Bridged, bridged

RECONNECTS, BAD_FRAMES = 100, 3_000
BATCH = 100


def _session(run: Bridged) -> None:
    """A client that does a bit of everything, and leaves without a word."""
    client = run.client()
    client.send(op="subscribe", topic="/chatter", throttle_rate=1, queue_length=3)
    client.next()
    client.send(op="advertise", topic="/orders", type="std_msgs/String")
    client.send(op="publish", topic="/orders", msg={"data": "x"})
    client.send(op="advertise_service", service="/mine", type="std_srvs/Trigger")
    client.send(op="fragment", id="never whole", num=0, total=2, data="x" * 1000)
    client.send(op="call_service", service="/rosapi/get_time", id="last")
    while client.next().get("id") != "last":
        pass
    client.close()
    run.run_while(lambda: bool(run.server._listener.clients))


def _nonsense(run: Bridged, numbers: random.Random, count: int) -> None:
    """Frames of random octets and damaged ops, from clients that are dropped for some and told of others."""
    good = b'{"op": "publish", "topic": "/orders", "msg": {"data": "x"}}'
    client = run.client()
    for _ in range(count):
        data = bytearray(good)
        for _ in range(numbers.randrange(1, 6)):
            data[numbers.randrange(len(data))] = numbers.randrange(256 if numbers.random() < 0.02 else 128)
        if numbers.random() < 0.02:
            client.socket.setblocking(True)
            try:
                client.socket.sendall(numbers.randbytes(20))
            except ConnectionError:
                pass  # it was dropped for the frame before
            client.socket.setblocking(False)
        else:
            try:
                client.text(bytes(data))
            except ConnectionError:
                pass
        if client.look() and len(client._found) > 10:
            client._found.clear()
        if client.is_over:
            client.close()
            client = run.client()
        if numbers.random() < 0.2:
            run.step()
    client.close()
    run.run_while(lambda: bool(run.server._listener.clients))


def _held() -> tuple[int, int, int]:
    """Return open files, and bytes of memory: the server's own, and the total, in which the mission's records grow,
    too."""
    gc.collect()
    filters = [
        tracemalloc.Filter(True, f"*/{part}/*") for part in ("cfepy/extra/viewers", "cfepy/io", "websockets", "json")
    ]
    own = sum(each.size for each in tracemalloc.take_snapshot().filter_traces(filters).statistics("filename"))
    return len(os.listdir("/proc/self/fd")), own, tracemalloc.get_traced_memory()[0]


def _grown(what: str, before: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return the present resources. Assert that they have not grown."""
    held = _held()
    files, own, whole = (now - then for now, then in zip(held, before, strict=True))
    print(f"{what}: {files} files, {own:,} bytes of the server's, {whole:,} in all")
    assert files <= 0
    assert own < 20_000
    assert whole < 200_000
    return held


@pytest.mark.slow
def test_reconnects_and_malformed_messages_leave_nothing(tmp_path: Path) -> None:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        numbers = random.Random(1)
        for _ in range(5):
            _session(run)
        _nonsense(run, numbers, 200)
        tracemalloc.start()
        try:
            _session(run)
            held = _held()
            for _ in range(RECONNECTS):
                _session(run)
            held = _grown(f"{RECONNECTS} reconnects", held)
            for _ in range(BAD_FRAMES // BATCH):
                _nonsense(run, numbers, BATCH)
            _session(run)
            _grown(f"{BAD_FRAMES} bad frames", held)
        finally:
            tracemalloc.stop()
        assert not run.mission.ros.outside.subscriptions
        rows = {(row["name"], row["direction"]): row for row in run.counts.rows()}
        told, ended = rows["(connections)", "in"]["dropped"], rows["(connections)", "in"]["ended"]
        print(f"{told} were told of, {ended} connections ended")
        assert told > BAD_FRAMES // 2
        assert ended > RECONNECTS + BAD_FRAMES // 100
