"""Records samples; a timer ends the recording after its time."""

import io
import queue

import rospy
from std_msgs.msg import Float32


class Recorder:
    def __init__(self) -> None:
        self.samples = queue.Queue()
        self.file = io.StringIO()
        rospy.Subscriber("sample", Float32, lambda message: self.samples.put(message.data))
        rospy.Timer(rospy.Duration(0.13), self.finish, oneshot=True)

    def finish(self, _event: object) -> None:
        self.file.close()

    def run(self) -> None:
        while not self.file.closed:
            try:
                sample = self.samples.get(timeout=0.05)
            except queue.Empty:
                continue
            if not self.file.closed:
                rospy.loginfo("sample %f", sample)
                self.file.write(f"{sample}\n")


rospy.init_node("recorder")
Recorder().run()
