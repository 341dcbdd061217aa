#!/usr/bin/env python3
"""Requests changes, and prints their results; it also runs beside roscpp."""

import rospy
from dynamic_reconfigure.msg import (
    BoolParameter,
    Config,
    ConfigDescription,
    DoubleParameter,
    GroupState,
    IntParameter,
    StrParameter,
)
from dynamic_reconfigure.srv import Reconfigure


def text(config):
    values = [(each.name, each.value) for each in (*config.bools, *config.ints, *config.strs, *config.doubles)]
    return f"{values} {[(each.name, each.state, each.id, each.parent) for each in config.groups]}"


def described(message):
    for group in message.groups:
        parameters = [(each.name, each.type, each.level) for each in group.parameters]
        print("GROUP", group.name, group.type, parameters, group.parent, group.id)
    for name in ("max", "min", "dflt"):
        print(name.upper(), text(getattr(message, name)))


REQUESTS = (
    Config(ints=[IntParameter("count", 200)], doubles=[DoubleParameter("gain", -1.0)]),
    Config(ints=[IntParameter("count", 1), IntParameter("count", 2)]),
    Config(ints=[IntParameter("count", 3), IntParameter("none", 4)], strs=[StrParameter("on", "a text")]),
    Config(bools=[BoolParameter("on", False), BoolParameter("last", True)], doubles=[DoubleParameter("more", 1.0)]),
    Config(groups=[GroupState("Default", False, 0, 0), GroupState("Outer", True, 0, 0), GroupState("Other", 0, 0, 0)]),
    Config(groups=[GroupState(name, True, 0, 0) for name in ("Inner", "Outer", "Default", "Other")]),
    Config(groups=[GroupState("Inner", False, 0, 0), GroupState("Outer", False, 0, 0)]),
    Config(ints=[IntParameter("count", 13)]),
    Config(ints=[IntParameter("count", 14)], strs=[StrParameter("title", "bye")]),
)

if __name__ == "__main__":
    rospy.init_node("tuner")
    rospy.wait_for_service("tuned/set_parameters")
    described(rospy.wait_for_message("tuned/parameter_descriptions", ConfigDescription))
    print("UPDATE", text(rospy.wait_for_message("tuned/parameter_updates", Config)))
    change = rospy.ServiceProxy("tuned/set_parameters", Reconfigure)
    for request in REQUESTS:
        print("ANSWER", text(change(request).config))
