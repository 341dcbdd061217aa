"""A client's queue in rosbridge is finished while messages come. Later messages must not be sent."""

import sys

import rospy
from rosbridge_library.internal.subscription_modifiers import MessageHandler
from std_msgs.msg import Int32

rospy.init_node("bridge")
late = []
sent = []
finished = []


def take(message):
    if finished:
        late.append(message.data)
    handler.handle_message(message.data)


handler = MessageHandler(None, sent.append).set_queue_length(5)
rospy.Subscriber("numbers", Int32, take)
rospy.sleep(0.2)
handler.finish(block=False)
finished.append(True)
rospy.sleep(0.1)
if set(late) & set(sent):
    sys.exit("a message that came after the end is sent")
