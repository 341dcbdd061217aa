"""A small mission with much to see: latencies, overruns, a full pipe, events, a node that prints a script."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.extra.reports.perfetto import PerfettoTrace
from cfepy.pilot import pilot
from cfepy.pilot.pilot import Flown
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule
from tests.mission.flights import write_mission

NASTY = "</script><img src=x onerror=document.title='owned'>\\x00&quot;'"

STARTUP = """\
CFE_APP, /cf/slow.so, SLOW_AppMain, SLOW, 50, 16384, 0x0, 0;
CFE_APP, /cf/flood.so, FLOOD_AppMain, FLOOD, 40, 16384, 0x0, 0;
CFE_APP, /cf/talk, __main__, TALK, 60, 16384, 0x0, 0;
CFE_APP, /cf/hear, __main__, HEAR, 61, 16384, 0x0, 0;
!
"""

SLOW = """\
def SLOW_AppMain(cfe):
    cfe.evs.register()
    cfe.evs.send_event(7, 3, "an error <b>of its own</b>")
    pipe = cfe.sb.create_pipe(2, "SLOW_PIPE")
    cfe.sb.subscribe(0x0A00, pipe)
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
        while cfe.sb.receive_buffer(pipe, 0) is not None:
            pass
"""

FLOOD = """\
from cfepy.msg import init

def FLOOD_AppMain(cfe):
    cfe.es.wait_for_startup_sync(1000)
    while cfe.es.run_loop():
        for _ in range(3):
            cfe.sb.transmit_msg(bytes(init(0x0A00, 20)))
        cfe.os.task_delay(200)
"""

TALK = f"""\
import rospy
from std_msgs.msg import String

rospy.init_node("talk")
publisher = rospy.Publisher("/chat", String, queue_size=5)
rate = rospy.Rate(20)
print({NASTY!r})
while not rospy.is_shutdown():
    publisher.publish(String("hello"))
    rate.sleep()
"""

HEAR = """\
import rospy
from std_msgs.msg import String

count = 0

def hear(message):
    global count
    count += 1
    if count % 10 == 0:
        rospy.sleep(0.12)

rospy.init_node("hear")
rospy.Subscriber("/chat", String, hear)
rospy.spin()
"""

DEADLINES = """\
board: rx64m
deadlines:
  apps:
    SLOW: {response: 2 ms, period: 100 ms, jitter: 25 ms}
  topics:
    /chat: {latency: 50 ms, at_least_every: 200 ms}
"""


def busy_mission(folder: Path, mission_file: str = DEADLINES) -> str:
    """Write the mission. Returns the argument for `Mission`."""
    return write_mission(folder, STARTUP, slow=SLOW, flood=FLOOD, talk=TALK, hear=HEAR, mission_yaml=mission_file)


def fly(mission: str, *attachments: Attachment, seconds: float = 3.0, schedule: str = "fifo", **options: Any) -> Flown:
    """Fly it."""
    plan = RunPlan((mission,), seconds=seconds, schedule=Schedule.parse(schedule), **options)
    return pilot.fly(plan, attachments=attachments)


def perfetto(mission: str, seconds: float = 3.0) -> tuple[Flown, list[dict[str, Any]]]:
    """Fly it, and the events of its trace in the Trace Event Format."""
    file = io.StringIO()
    flown = fly(mission, PerfettoTrace(file), seconds=seconds)
    events: list[dict[str, Any]] = json.loads(file.getvalue())["traceEvents"]
    return flown, events
