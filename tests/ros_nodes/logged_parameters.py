#!/usr/bin/env python3
"""Test node: the parameter that rospy itself caches with the first log message, so that the root has only this one."""

from __future__ import annotations

import time
from typing import Any

import rospy

TOPICS = "/rosout_disable_topics_generation"


def show(what: str, value: Any) -> None:
    print(f"result: {what}: {value!r}")


def main() -> None:
    rospy.set_param("/speed", 1)
    rospy.init_node("logged_parameters")
    rospy.logdebug("below the level")
    show("root before the log", "speed" in rospy.get_param("/"))
    rospy.loginfo("a message")
    show("root", rospy.get_param("/"))
    show("speed", rospy.get_param("/speed"))
    rospy.set_param(TOPICS, True)
    time.sleep(0.2)
    show("root with the parameter", rospy.get_param("/"))
    rospy.delete_param(TOPICS)
    time.sleep(0.2)
    show("root after its deletion", rospy.get_param("/"))
    rospy.loginfo("another message")
    show("root", rospy.get_param("/"))


if __name__ == "__main__":
    main()
