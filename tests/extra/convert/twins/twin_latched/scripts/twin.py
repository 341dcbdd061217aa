#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import rospy
from std_msgs.msg import Int32, String


class Watch(rospy.SubscribeListener):
    """Arrivals and departures of subscribers, printed when the node spins, as in roscpp."""

    def __init__(self, waiting, comes):
        self.peer_subscribe = lambda _name, _publish, to_one: waiting.append(lambda: comes(to_one))


class Twin:
    """The node."""

    def __init__(self):
        self.waiting = []  # callbacks, in their order
        self.out = rospy.Publisher("out", String, queue_size=100)
        self.state = rospy.Publisher("state", Int32, queue_size=1, latch=True)
        say = self.out.publish
        watch = Watch(self.waiting, lambda _: say("comes"))
        self.watched = rospy.Publisher("watched", Int32, watch, queue_size=5)
        self.greeting = rospy.Publisher(
            "greeting", Int32, Watch(self.waiting, lambda to_one: to_one(Int32(77))), queue_size=5
        )
        for number in (1, 2, 3):
            self.state.publish(number)

    def goal(self):
        return rospy.Subscriber("goal", Int32, self.heard, queue_size=10)

    def heard(self, message):
        self.waiting.append(lambda: self.out.publish(f"heard {message.data}"))

    def run(self):
        say = self.out.publish
        rospy.sleep(2)
        first = self.goal()
        rospy.sleep(0.08)
        rate = rospy.Rate(10)
        cycle = 0
        while not rospy.is_shutdown():
            if cycle == 30:
                first.unregister()
                self.state.publish(4)
            if cycle == 40:
                first = self.goal()
                rospy.sleep(0.08)
                counts = (self.state.get_num_connections(), self.watched.get_num_connections())
                say(f"{counts[0]} hear state, {counts[1]} watch")
            if cycle == 60:
                self.wait("other", 1.0, "waited for {}", "waited in vain")
                rospy.sleep(0.5)
                self.wait("silent", 0.4, "came", "nothing came")
            for callback in self.waiting[:]:
                self.waiting.pop(0)
                callback()
            cycle += 1
            rate.sleep()

    def wait(self, topic, seconds, good, bad):
        begun = rospy.Time.now()
        try:
            text = good.format(rospy.wait_for_message(topic, Int32, seconds).data)
        except rospy.ROSException:
            text = bad
        rospy.sleep(begun + rospy.Duration(0.2) - rospy.Time.now())
        self.out.publish(text)


if __name__ == "__main__":
    rospy.init_node("twin")
    Twin().run()
