"""A state that waits for a message. It must end when the message comes."""

import os
import sys
import threading

sys.path.append(os.path.join(os.path.dirname(__file__), "smach_ros"))  # Python 2 imports a package's modules like this

import rospy
import smach_ros
from std_msgs.msg import Empty

rospy.init_node("machine")
ended = threading.Event()


def watch():
    if not ended.wait(1):
        rospy.logerr("the state does not end")
        os._exit(1)


threading.Thread(target=watch, daemon=True).start()
smach_ros.MonitorState("/go", Empty, lambda userdata, message: False).execute({})
ended.set()
