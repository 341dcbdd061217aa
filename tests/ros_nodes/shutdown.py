#!/usr/bin/env python3
"""Test node: shutdown hooks, their order, one that fails, and what a node sees after its end."""

from __future__ import annotations

import rospy
from std_msgs.msg import String


def main() -> None:
    rospy.init_node("shutdown")
    seen: list[str] = []
    publisher = rospy.Publisher("late", String, queue_size=1)

    def failing() -> None:
        seen.append("failing")
        raise RuntimeError("a hook that fails")

    rospy.on_shutdown(lambda: seen.append(f"first, is_shutdown {rospy.is_shutdown()}"))
    rospy.on_shutdown(failing)
    rospy.on_shutdown(lambda: seen.append("last"))
    rospy.Timer(rospy.Duration(0.1), lambda _event: rospy.signal_shutdown("enough"), oneshot=True)
    rospy.spin()
    publisher.publish("nobody hears this")
    print(f"result: hooks {seen}, then is_shutdown {rospy.is_shutdown()}")


if __name__ == "__main__":
    main()
