"""Small missions with bugs that only some schedules show."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

LOST_UPDATE = """
    import threading
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("bank")
    total = rospy.Publisher("total", Int32, queue_size=10)
    balance = 0


    def pay(times):
        global balance
        for _ in range(times):
            before = balance
            rospy.get_time()
            balance = before + 1


    threads = [threading.Thread(target=pay, args=(3,)) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    total.publish(balance)
    rospy.spin()
"""

LOCK_ORDER = """
    import threading
    import rospy

    rospy.init_node("locks")
    left, right = threading.Lock(), threading.Lock()


    def work(first, second):
        for _ in range(2):
            with first:
                with second:
                    rospy.get_time()


    threads = [threading.Thread(target=work, args=pair, name=name) for pair, name in
               (((left, right), "one"), ((right, left), "two"))]
    for each in threads:
        each.start()
    rospy.spin()
"""

CHECK_THEN_ACT = """
    import threading
    import rospy

    rospy.init_node("stock")
    items = ["last"]


    def take():
        if items:
            rospy.get_time()
            items.pop()


    threads = [threading.Thread(target=take, name=name) for name in ("first", "second")]
    for each in threads:
        each.start()
    rospy.spin()
"""

LOST_WAKE_UP = """
    import threading
    import rospy

    rospy.init_node("pair")
    something = threading.Condition()
    ready = False


    def look_at_the_clock():
        for _ in range(20):
            rospy.get_time()


    def consume():
        if not ready:
            look_at_the_clock()
            with something:
                something.wait()


    def produce():
        global ready
        rospy.get_time()
        ready = True
        with something:
            something.notify()


    for each in (consume, produce):
        threading.Thread(target=each).start()
    rospy.spin()
"""
"""Whether something is ready is looked at without the lock."""

LATE = """
    def Listener(cfe):
        cfe.evs.register()
        pipe = cfe.sb.create_pipe(4, "LISTENER")
        cfe.sb.subscribe(0x0890, pipe)
        if cfe.sb.receive_buffer(pipe, 100) is None:
            cfe.evs.send_err(1, "nothing came in %d ms" % 100)
        while cfe.es.run_loop(1):
            cfe.os.task_delay(1000)


    def Talker(cfe):
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))
        while cfe.es.run_loop(1):
            cfe.os.task_delay(1000)
"""
"""Two applications; the listener may subscribe too late."""


def write_late(folder: Path) -> Path:
    """Write the mission of LATE."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "apps.py").write_text(textwrap.dedent(LATE).lstrip(), encoding="utf-8")
    entries = ("Listener", "Talker")
    lines = [f"CFE_APP, apps, {name}, {name.upper()}, 50, 8192, 0, 0;\n" for name in entries]
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    return folder


def write(folder: Path, nodes: Mapping[str, str], yaml: str = "") -> Path:
    """Write a mission.

    Args:
        folder: its folder.
        nodes: the sources of its nodes by cFE name.
        yaml: its mission file; none when empty.
    """
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, source in nodes.items():
        (folder / f"{name.lower()}.py").write_text(textwrap.dedent(source).lstrip(), encoding="utf-8")
        lines.append(f"CFE_APP, {name.lower()}.py, __main__, {name}, 100, 16384, 0x0, 0;\n")
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    if yaml:
        (folder / "mission.yaml").write_text(textwrap.dedent(yaml).lstrip(), encoding="utf-8")
    return folder
