"""Small missions whose events a journal must contain, each by its name."""

from __future__ import annotations

from pathlib import Path

from dev.fuzz.sample_journal import paths
from tests.mission.flights import write_mission

NODE = "CFE_APP, {name}.py, __main__, {app}, 100, 16384, 0x0, 0;\n"
TYPIST = """
    import sys, tty
    import rospy
    from std_msgs.msg import String

    rospy.init_node("typist")
    typed = rospy.Publisher("typed", String, queue_size=3)
    rospy.Subscriber("typed", String, lambda message: print("heard", message.data))
    tty.setcbreak(sys.stdin)
    while not rospy.is_shutdown():
        typed.publish(sys.stdin.read(1))
"""
CRASHER = """
    def crasher_main(cfe):
        cfe.evs.register()
        area = cfe.psp.get_user_reserved_area()
        area[0] += 1
        cfe.es.run_loop()
        cfe.os.task_delay(700)
        if area[0] < 3:
            raise ZeroDivisionError("once more")
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
"""
RACE = """
    import random, threading
    import rospy

    rospy.init_node("race", anonymous=True)
    order = []
    threads = [threading.Thread(target=order.append, args=(number,)) for number in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    print(order, random.random(), hash("a") == hash("b"))
    rospy.sleep(0.5)
"""


def keyboard(folder: Path) -> str:
    """Return a node that reads its terminal."""
    keys = 'nodes:\n  TYPIST: {keys: ["a", 0.3, "bc", "\\x03"]}\n'
    return write_mission(folder, NODE.format(name="typist", app="TYPIST") + "!", typist=TYPIST, mission_yaml=keys)


def resets(folder: Path) -> str:
    """Write an application that dies, and whose exception resets the processor twice."""
    return write_mission(folder, "CFE_APP, crasher, crasher_main, CRASHER, 50, 16384, 0x0, 1;\n!", crasher=CRASHER)


def restarts(folder: Path) -> str:
    """Return the same, except that it is only started again."""
    return write_mission(folder, "CFE_APP, crasher, crasher_main, CRASHER, 50, 16384, 0x0, 0;\n!", crasher=CRASHER)


def race(folder: Path) -> str:
    """Write two nodes, whose threads and random numbers show the order of tasks."""
    lines = NODE.format(name="race", app="RACE_A") + NODE.format(name="race", app="RACE_B")
    return write_mission(folder, lines + "!", race=RACE)


SMALL = {each.__name__: each for each in (keyboard, resets, restarts, race, paths)}
SHIPPED = ("capture", "lab", "sched", "rx64m_pubsub")
