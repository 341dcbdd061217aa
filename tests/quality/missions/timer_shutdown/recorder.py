"""Records the latest sample at a fixed rate; a timer ends the recording when its time is up."""

import io

import rospy
from std_msgs.msg import Float32


class Recorder:
    def __init__(self) -> None:
        self.latest = 0.0
        self.left = 12
        self.file = io.StringIO()
        rospy.Subscriber("sample", Float32, self.on_sample)
        rospy.Timer(rospy.Duration(0.01), self.watch)

    def on_sample(self, message: Float32) -> None:
        self.latest = message.data

    def watch(self, _event: object) -> None:
        self.left -= 1
        if self.left == 0:
            self.file.close()

    def run(self) -> None:
        rate = rospy.Rate(100)
        while not self.file.closed:
            rospy.loginfo("sample %f", self.latest)
            self.file.write(f"{self.latest}\n")
            rate.sleep()


rospy.init_node("recorder")
Recorder().run()
