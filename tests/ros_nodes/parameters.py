#!/usr/bin/env python3
"""Test node: parameters in every namespace, names and remappings."""

from __future__ import annotations

import json

import rospy


def main() -> None:
    rospy.init_node("parameters")
    rospy.set_param("~limits", {"low": -1, "high": 2.5})
    rospy.set_param("shared", [1, "two", 3.0, True])
    seen = {
        "name": rospy.get_name(),
        "namespace": rospy.get_namespace(),
        "from the command line": rospy.get_param("~gain"),
        "nested": rospy.get_param("~limits/high"),
        "relative": rospy.get_param("shared"),
        "absolute": rospy.get_param(rospy.get_namespace() + "shared"),
        "default": rospy.get_param("~missing", "nothing"),
        "has": [rospy.has_param("~gain"), rospy.has_param("~missing")],
        "search": rospy.search_param("shared"),
        "resolved": [rospy.resolve_name(name) for name in ("image", "~image", "/image", "remapped")],
    }
    rospy.delete_param("~limits/low")
    seen["after delete"] = rospy.get_param("~limits")
    try:
        rospy.get_param("~missing")
    except KeyError as error:
        seen["missing raises"] = type(error).__name__
    print("result: " + json.dumps(seen))


if __name__ == "__main__":
    main()
