"""The node behind `cfepy rostopic pub`: publishes a message once, latched, or at a rate.

Its argument is a JSON list: topic, type, the message as YAML values, the rate in Hz or null, and the virtual second at
which to begin, or null. It is executed in a node's universe, with the node's own rospy.
"""

from __future__ import annotations

import json
import sys
import time

import genpy.message
import rospy
import yaml
from std_msgs.msg import Header


def main() -> None:
    """Publish the message."""
    topic, type_name, words, rate_hz, at_s = json.loads(sys.argv[1])
    rospy.init_node("rostopic", anonymous=True)
    kind = genpy.message.get_message_class(type_name)
    if kind is None:
        print(json.dumps({"error": f"unknown message type {type_name}"}))
        sys.exit(1)
    publisher = rospy.Publisher(topic, kind, queue_size=100, latch=rate_hz is None)
    if at_s is not None:
        time.sleep(max(0.0, at_s - time.monotonic()))
    while not rospy.is_shutdown():
        message, now = kind(), rospy.get_rostime()
        try:
            keys = {"now": now, "auto": Header(stamp=now)}
            genpy.message.fill_message_args(message, [yaml.safe_load(word) for word in words], keys=keys)
            publisher.publish(message)
        except Exception as error:  # report any error to the caller
            print(json.dumps({"error": f"{topic}: {error}"}))
            sys.exit(1)
        if rate_hz is None:
            rospy.spin()
            return
        time.sleep(1.0 / rate_hz)


main()
