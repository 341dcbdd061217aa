"""Long messages and a slow callback: messages that wait in the sockets are handled late, as on ROS.

The numbers of the parametrized flights were also printed on ROS Noetic by the same nodes, give or take one message.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.rtos import Kernel
from cfepy.sb import Destination, Pipe, Waiting
from rospy_shim.client.socket_buffers import LENGTH_BYTES, SOCKET_BYTES, SocketBuffers, is_full
from rospy_shim.types.transport import HEADER_BYTES, segments
from tests.mission.flights import write_mission
from tests.rospy_shim.missions import Run, run_nodes

NODE = """
import time

import rospy
from sensor_msgs.msg import Image

rospy.init_node("lag")
got = []
def slow(message):
    got.append((message.height, rospy.get_time() - message.header.stamp.to_sec()))
    time.sleep({callback})
publisher = rospy.Publisher("/camera", Image, queue_size={publisher_queue})
rospy.Subscriber("/camera", Image, slow, queue_size={queue}, buff_size={buff})
rospy.sleep(0.7)
image, rate, begun = Image(data=bytes({size})), rospy.Rate({hz}), rospy.get_time()
for number in range({count}):
    image.height, image.header.stamp = number, rospy.Time.now()
    publisher.publish(image)
    rate.sleep()
took = rospy.get_time() - begun
rospy.sleep(0.2)
print("took %.1f" % took, "lag %.1f" % got[-1][1], [number for number, _ in got])
"""
USUAL = {"size": 300_000, "buff": 65536, "publisher_queue": None, "queue": 1, "count": 80, "hz": 20, "callback": 0.25}
EVERY_FIFTH = [*range(0, 80, 5), 79]


def flown(folder: Path, tasks: str = "greenlet", **changed: Any) -> Run:
    source = NODE.format(**{**USUAL, **changed})
    return run_nodes(folder, {"LAG": source}, seconds=25, tasks=tasks)


def results(run: Run) -> tuple[str, list[int]]:
    """Return the times that a node printed, and the numbers of its messages."""
    head, _, numbers = run.printed["lag"][-1].partition(" [")
    return head, [int(each) for each in numbers.rstrip("]").split(",")]


def test_small_messages_give_the_newest(tmp_path: Path) -> None:
    assert results(flown(tmp_path, size=100)) == ("took 4.0 lag 0.1", EVERY_FIFTH)


def test_messages_beyond_the_buffer_are_all_handled_and_the_publisher_waits(tmp_path: Path) -> None:
    head, numbers = results(flown(tmp_path))
    assert numbers == list(range(66))
    assert head == "took 16.3 lag 3.5"


def test_large_buffer_gives_the_newest(tmp_path: Path) -> None:
    assert results(flown(tmp_path, buff=2**24)) == ("took 4.0 lag 0.1", EVERY_FIFTH)


def test_buffer_of_some_messages_skips_as_many(tmp_path: Path) -> None:
    _, numbers = results(flown(tmp_path, buff=2**20))
    assert numbers[:6] == [0, 3, 6, 10, 13, 17]


def test_messages_of_half_a_buffer_are_dropped_within_a_read_only(tmp_path: Path) -> None:
    _, numbers = results(flown(tmp_path, size=40_000, hz=50, count=100, callback=0.1, publisher_queue=1))
    assert numbers[:8] == [0, 1, 3, 4, 6, 8, 9, 11]


def test_short_messages_wait_as_well_if_one_read_does_not_bring_them_all(tmp_path: Path) -> None:
    """Twelve laser scans come during each callback, 96 kB; the first eight of them fit in a read."""
    _, numbers = results(flown(tmp_path, size=8000, hz=40, count=160, callback=0.3, publisher_queue=1))
    assert numbers == [0, 8, 16, 24, 32, 40, 48, 57, 65, 73, 81, 89, 97, 105]


def test_short_messages_hold_up_a_publisher_without_a_queue(tmp_path: Path) -> None:
    head, numbers = results(flown(tmp_path, size=30_000, hz=200, count=300, callback=0.1))
    assert head.startswith("took 7.")
    assert numbers[:6] == [0, 2, 4, 6, 8, 10]


def test_several_short_messages_within_a_read(tmp_path: Path) -> None:
    _, numbers = results(flown(tmp_path, size=8000, hz=40, count=160, callback=0.3, publisher_queue=1, queue=3))
    assert numbers == sorted(numbers)
    assert numbers[:4] == [0, 6, 7, 8]


@pytest.mark.parametrize("publisher_queue", [1, 10])
def test_publisher_with_a_queue_drops_its_oldest_messages(tmp_path: Path, publisher_queue: int) -> None:
    """Messages that are in the sockets, or in the hands of the writing thread, are not dropped."""
    head, numbers = results(flown(tmp_path, publisher_queue=publisher_queue, count=160))
    assert head.startswith("took 8.0")
    assert numbers == sorted(numbers)
    assert numbers[:18] == list(range(18))
    assert (numbers[-1] > 80) is (publisher_queue == 1)


def test_subscriber_without_a_queue_size_handles_all(tmp_path: Path) -> None:
    head, numbers = results(flown(tmp_path, queue=None, callback=0.1, count=120))
    assert numbers == list(range(108))
    assert head == "took 10.5 lag 1.5"


@pytest.mark.parametrize("size", [30_000, 300_000])
def test_both_kinds_of_tasks_give_one_trace(tmp_path: Path, size: int) -> None:
    assert len({flown(tmp_path, tasks, size=size, count=30).digest for tasks in ("thread", "greenlet")}) == 1


FAST = """
import rospy
from sensor_msgs.msg import Image

rospy.init_node("fast")
seen = []
rospy.Subscriber("/camera", Image, lambda message: seen.append(message.height), queue_size=1)
rospy.on_shutdown(lambda: print(seen))
rospy.spin()
"""


def test_fast_subscriber_beside_a_slow_one_gets_all(tmp_path: Path) -> None:
    source = NODE.format(**{**USUAL, "count": 30, "publisher_queue": 1})
    run = run_nodes(tmp_path, {"FAST": FAST, "LAG": source}, seconds=10)
    assert run.printed["fast"] == [str(list(range(30)))]
    assert results(run)[1][:5] == [0, 1, 2, 3, 4]


def traps(folder: Path, **changed: Any) -> list[str]:
    startup = "CFE_APP, lag.py, __main__, LAG, 100, 16384, 0x0, 0;\n!\n"
    mission = write_mission(folder, startup, lag=NODE.format(**{**USUAL, "count": 30, **changed}))
    return pilot.fly(RunPlan((mission,), seconds=12.0)).results.traps


def test_report_names_the_trap_once(tmp_path: Path) -> None:
    assert traps(tmp_path) == [
        "/camera: /lag handles messages up to 3.0 s late although newer ones wait; publish() of /lag waits for it: "
        "queue_size=1 drops only among the 65,536 bytes (buff_size) of one read, and a message has 300,037 bytes; "
        "subscribe with buff_size=2**24, as ROS needs it"
    ]


@pytest.mark.parametrize("changed", [{"buff": 2**24}, {"size": 1000}, {"queue": None}, {"callback": 0.01}])
def test_report_is_silent_without_the_trap(tmp_path: Path, changed: dict[str, Any]) -> None:
    assert traps(tmp_path, **changed) == []


# -- the buffers alone -------------------------------------------------------------------------------------------------


def packets_of(number: int, size: int, destination: Destination) -> list[Waiting]:
    payload = number.to_bytes(4, "big") + bytes(size - 4)
    return [(packet, destination) for packet in segments(0x800, payload, 30_000)]


def number_of(packets: list[Waiting]) -> int:
    return int.from_bytes(packets[0][0][HEADER_BYTES : HEADER_BYTES + 4], "big")


@pytest.fixture
def destination() -> Destination:
    return Destination(Pipe(Kernel(), 10, "pipe", None), 0xFFFF, 0)


def test_one_read_brings_whole_messages(destination: Destination) -> None:
    buffers = SocketBuffers(Kernel(), "a")
    for number in range(8):
        buffers.add(packets_of(number, 40_000 - LENGTH_BYTES, destination))
    taken = []
    while buffers:
        dropped = buffers.read(100_000, 1)
        packets, _ = buffers.take()
        destination.gets += len(packets)
        taken.append((number_of(packets), len(dropped) // 2))
    # after reads of 100, 200, 300 and 320 kB
    assert taken == [(1, 1), (4, 2), (6, 1), (7, 0)]


def test_queue_of_the_publisher_drops_its_oldest(destination: Destination) -> None:
    buffers = SocketBuffers(Kernel(), "a")
    dropped = []
    for number in range(10):
        packets = buffers.add(packets_of(number, 1 << 20, destination), 2)
        dropped += [number_of(packets)] if packets else []
    assert dropped == [4, 5, 6, 7]
    left = []
    while buffers:
        buffers.read(1 << 20, None)
        packets, _ = buffers.take()
        destination.gets += len(packets)
        left.append(number_of(packets))
    assert left == [number for number in range(10) if number not in dropped]


def test_part_of_a_message_is_handed_on(destination: Destination) -> None:
    buffers = SocketBuffers(Kernel(), "a")
    packets = packets_of(1, 100_000, destination)
    buffers.add(packets[:2])
    assert buffers.read(1000, 1) == []
    assert buffers.take() == (packets[:2], 0)
    assert (buffers.loose, bool(buffers)) == (2, False)
    destination.gets += 2
    assert buffers.loose == 0


def test_sockets_are_full_by_bytes(destination: Destination) -> None:
    packets = packets_of(1, SOCKET_BYTES, destination)
    assert not is_full(packets, 0)
    assert is_full(packets, 1)
    assert not is_full(packets[:3], SOCKET_BYTES)
