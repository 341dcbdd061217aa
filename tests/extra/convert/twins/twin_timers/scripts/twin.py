#!/usr/bin/env python3
"""The twin of src/twin.cpp: timers of one's own in one loop, after roscpp's rules."""

import rospy
from std_msgs.msg import Header

MS = 1000000


class Timer:
    """A timer as roscpp has it: when it is due, and what it says of its times.

    Args:
        twin: the node.
        period: in milliseconds.
        act: called with the text of its times.
        once: whether it is called once.
    """

    def __init__(self, twin, period, act, once=False, starts=True):
        self.twin, self.period, self.act, self.once = twin, period * MS, act, once
        self.runs = False
        twin.timers.append(self)
        if starts:
            self.start()

    def start(self):
        self.runs, self.last_expected, self.last_real = True, self.twin.now(), 0
        self.due = self.last_expected + self.period

    def set_period(self, period):
        self.period = period * MS
        self.due = self.twin.now() + self.period

    def call(self):
        """Call it; afterwards it is due a period later, but not a whole period late."""
        now = self.twin.now()
        since = [f"{(b - a) // MS}" if a else "-" for a, b in ((self.last_expected, self.due), (self.last_real, now))]
        self.runs = not self.once
        due = self.due
        self.act(f"{since[0]} {since[1]} {(now - due) // MS}")
        self.last_expected, self.last_real = due, now
        if self.runs and self.due == due:
            self.due += self.period
            ended = self.twin.now()
            if self.due + self.period < ended:
                self.due = ended


class Twin:
    """The node."""

    def __init__(self):
        self.out = rospy.Publisher("out", Header, queue_size=100)
        self.timers = []
        self.slow_calls = 0

    @staticmethod
    def now():
        return rospy.Time.now().to_nsec()

    def say(self, what):
        self.out.publish(Header(stamp=rospy.Time.now(), frame_id=what))

    def spin_once(self):
        """Call the timers that are due, in the order of their times, each once."""
        now = self.now()
        for timer in sorted((each for each in self.timers if each.runs and each.due <= now), key=lambda each: each.due):
            timer.call()

    def loop(self, seconds):
        end = rospy.Time.now() + rospy.Duration(seconds)
        while rospy.Time.now() < end:
            self.spin_once()
            rospy.sleep(0.05)

    def slow(self, times):
        self.slow_calls += 1
        self.say(f"slow {self.slow_calls} {times}")
        rospy.sleep(1.3 if self.slow_calls == 3 else 0.2)

    def run(self):
        say = self.say
        periodic = Timer(self, 400, lambda times: say(f"periodic {times}"))
        once = Timer(self, 550, lambda times: say(f"once {times}"), once=True)
        wall = Timer(self, 700, lambda times: say(f"wall {times}"))
        late = Timer(self, 300, lambda _times: say("late"), starts=False)
        rated = Timer(self, 800, lambda times: say(f"rated {times}"))
        self.loop(2.05)
        periodic.runs = wall.runs = False
        rated.set_period(500)
        late.start()
        say("changed")
        self.loop(2.05)
        rated.runs = late.runs = False
        once.start()
        Timer(self, 500, self.slow)
        say("slow begins")
        while not rospy.is_shutdown():
            due = min((each.due for each in self.timers if each.runs), default=self.now() + 500 * MS)
            rospy.sleep(max(due - self.now(), 0) / 1e9)
            self.spin_once()


if __name__ == "__main__":
    rospy.init_node("twin")
    twin = Twin()
    rospy.sleep(1)
    twin.run()
