"""rospy in all its parts: topics to itself and others, timers, a service that is called by many, transforms, logs."""

import random
import threading

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Float64, String
from std_srvs.srv import Trigger, TriggerResponse

lock = threading.Lock()
calls = []


def served(request):
    rospy.sleep(random.random() / 100)
    with lock:
        calls.append(rospy.get_time())
    return TriggerResponse(True, str(len(calls)))


def ask(name):
    proxy = rospy.ServiceProxy("ask", Trigger)
    for _ in range(3):
        print(name, proxy().message, rospy.get_time())
        rospy.sleep(random.random() / 10)


def tick(event):
    numbers.publish(random.gauss(0, 1))
    moved = TransformStamped()
    moved.header.stamp, moved.header.frame_id, moved.child_frame_id = rospy.Time.now(), "map", "robot"
    moved.transform.translation.x, moved.transform.rotation.w = random.random(), 1.0
    frames.sendTransform(moved)


rospy.init_node("robot")
numbers = rospy.Publisher("numbers", Float64, queue_size=5)
texts = rospy.Publisher("texts", String, queue_size=5, latch=True)
rospy.Subscriber("numbers", Float64, lambda message: texts.publish(f"{message.data:.9f}"))
rospy.Subscriber("texts", String, lambda message: rospy.loginfo_throttle(0.5, "heard %s", message.data))
frames, buffer = tf2_ros.TransformBroadcaster(), tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer)
service = rospy.Service("ask", Trigger, served)
timer = rospy.Timer(rospy.Duration(0.03), tick)
askers = [threading.Thread(target=ask, args=(f"asker-{number}",)) for number in range(3)]
for asker in askers:
    asker.start()
rate = rospy.Rate(5)
for _ in range(10):
    rate.sleep()
    if buffer.can_transform("map", "robot", rospy.Time(0)):
        print(buffer.lookup_transform("map", "robot", rospy.Time(0)).transform.translation.x)
for asker in askers:
    asker.join()
rospy.on_shutdown(lambda: print("over", len(calls)))
