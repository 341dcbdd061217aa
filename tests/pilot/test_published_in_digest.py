"""Everything that a program publishes is in the digest of its run, with or without a subscriber."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.attachment import Attachment
from cfepy.mission import Processor, TopicWatch
from cfepy.mission.call_points import with_call_points
from cfepy.pilot import RunPlan, fly
from cfepy.rtos import GREENLET, THREAD, has_greenlets
from cfepy.sb import SoftwareBus
from cfepy.schedules import Schedule
from cfepy.trace import Trace
from tests.mission.flights import write_mission

NODE = "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!"
APP = "CFE_APP, apps, talker_main, TALKER, 100, 16384, 0x0, 0;\n!"
HEAD = """
    import rospy
    from geometry_msgs.msg import PointStamped
    from std_msgs.msg import Float64, String

    rospy.init_node("talker")
"""
IN_ROS = {
    "a message": """
    rospy.Publisher("x", Float64, queue_size=1).publish(NUMBER)
""",
    "a latched message": """
    rospy.Publisher("x", Float64, queue_size=1, latch=True).publish(NUMBER)
""",
    "a long message": """
    rospy.Publisher("x", String, queue_size=1).publish("NUMBER" * 100000)
""",
    "a message without a frame": """
    message = PointStamped()
    message.header.frame_id, message.header.seq = None, NUMBER
    rospy.Publisher("x", PointStamped, queue_size=1).publish(message)
""",
    "a message for one subscriber": """
    class Listener(rospy.SubscribeListener):
        def peer_subscribe(self, name, publish, peer_publish):
            peer_publish(Float64(NUMBER))

    talker = rospy.Publisher("x", Float64, subscriber_listener=Listener(), queue_size=1)
    listener = rospy.Subscriber("x", Float64, lambda message: None)
    rospy.sleep(0.1)
""",
}
IN_CFE = {
    "a packet": """
    from cfepy.status import CfeError

    def talker_main(cfe):
        cfe.evs.register()
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, bytes([NUMBER])))
        while cfe.es.run_loop(1):
            cfe.os.task_delay(100)
""",
    "a packet that is too long": """
    from cfepy.status import CfeError

    def talker_main(cfe):
        cfe.evs.register()
        try:
            cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, bytes([NUMBER]) * 40000))
        except CfeError:
            pass
        while cfe.es.run_loop(1):
            cfe.os.task_delay(100)
""",
    "a packet that the pool has no room for": """
    from cfepy.status import CfeError

    def talker_main(cfe):
        cfe.evs.register()
        pipe = cfe.sb.create_pipe(50, "LONG")
        cfe.sb.subscribe_ex(0x0895, pipe, 0, 50)
        try:
            for number in range(100):
                cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, bytes([number // 17 * NUMBER]) * 30000))
        except CfeError:
            pass
        while cfe.es.run_loop(1):
            cfe.os.task_delay(100)
""",
}


def digest(folder: Path, tasks: str = "auto", attachments: tuple[Attachment, ...] = ()) -> str:
    return fly(RunPlan((str(folder),), seconds=1, tasks=tasks), attachments=attachments).trace


def mission(folder: Path, what: str, number: int) -> Path:
    folder.mkdir(exist_ok=True)
    if what in IN_ROS:
        write_mission(folder, NODE, talker=HEAD + IN_ROS[what].replace("NUMBER", str(number)))
    else:
        write_mission(folder, APP, apps=IN_CFE[what].replace("NUMBER", str(number)))
    return folder


@pytest.mark.parametrize("what", [*IN_ROS, *IN_CFE])
def test_digest_differs_when_published_content_differs(tmp_path: Path, what: str) -> None:
    one, other = (digest(mission(tmp_path / "mission", what, number)) for number in (1, 2))
    assert one != other
    assert digest(mission(tmp_path / "mission", what, 1)) == one


@pytest.mark.parametrize("what", [*IN_ROS, "a packet"])
def test_digest_of_unsent_messages_does_not_depend_on_observers(tmp_path: Path, what: str) -> None:
    folder = mission(tmp_path / "mission", what, 1)
    seen: list[object] = []
    kinds = [THREAD, GREENLET] if has_greenlets() else [THREAD]
    assert len({digest(folder, kind, looks) for kind in kinds for looks in ((), (TopicWatch(seen.append),))}) == 1
    assert bool(seen) == (what in ("a message", "a latched message", "a long message"))


def test_large_unsent_messages_are_hashed_at_once(tmp_path: Path) -> None:
    code = 'rospy.Publisher("x", String, queue_size=1)\n    for _ in range(50): talker.publish("a" * 70000)'
    write_mission(tmp_path, NODE, talker=f"{HEAD}    talker = {code}\n")
    waiting: list[int] = []

    class Look(Attachment):
        def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
            def unsent(self: SoftwareBus, record: bytes) -> None:
                base.unsent(self, record)
                if len(record) > 70000:
                    waiting.append(sum(map(len, trace.records)))

            return type("Looked", (base,), {"unsent": unsent})

    trace = Trace()
    fly(RunPlan((str(tmp_path),), seconds=1), attachments=[Look()], trace=trace)
    assert len(waiting) == 50
    assert max(waiting) < 70000


def test_unsent_message_is_not_a_scheduling_point(tmp_path: Path) -> None:
    write_mission(tmp_path, NODE, talker=HEAD)
    found: list[tuple[bool, bool]] = []

    class Look(Attachment):
        def power_up(self, processor: Processor) -> None:
            bus = processor.cfe.sb
            handle = with_call_points(processor.cfe, processor.machine.kernel).sb
            found.append((handle.unsent == bus.unsent, handle.transmit_msg == bus.transmit_msg))

    plan = RunPlan((str(tmp_path),), seconds=1, schedule=Schedule.parse("random:1"))
    fly(plan, attachments=[Look()])
    assert found == [(True, False)]
