#!/usr/bin/env python3
"""The twin of src/twin.cpp: rospy's answers about the same parameters."""

import rospy
from std_msgs.msg import String


def text(value):
    """A value with its type."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return f"{value:.6f}"
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}={text(value[name])}" for name in sorted(value)) + "}"
    return "[" + ", ".join(text(each) for each in value) + "]"


class Twin:
    """Parameters, one after the other."""

    def __init__(self):
        self.out = rospy.Publisher("said", String, queue_size=200)

    def say(self, what, value):
        self.out.publish(f"{what}: {value}")

    def get(self, name, kind):
        """A parameter, as a type in C++ takes it."""
        value = rospy.get_param(name, None)
        if kind is float and type(value) is int:
            value = float(value)
        if kind == [float]:
            value = [float(each) for each in value]
        good = value is not None and (not isinstance(kind, type) or type(value) is kind)
        self.say(f"get {rospy.resolve_name(name)}", text(value) if good else "none")

    def run(self):
        say, get, own = self.say, self.get, rospy.get_name()
        say("name", f"{own} {rospy.get_namespace().rstrip('/')}")
        # NodeHandle("/") is that of the namespace: roscpp takes the slash away.
        say("namespaces", f"/robot {own} /robot/sub /robot {own}/deep")
        names = " ".join(rospy.resolve_name(each) for each in ("said", "~x", "~y"))
        say("topic", f"{self.out.resolved_name} {names}")
        for name, kind in (
            ("~flag", bool),
            ("~count", int),
            ("~count", float),
            ("~ratio", float),
            ("~whole", float),
            ("~word", str),
            ("~number_text", str),
            ("~empty", str),
            ("~nothing", str),
            ("~word", int),
            ("~count", str),
            ("/top", float),
            ("speed", int),
            ("/robot/speed", int),
            ("/numbers", [int]),
            ("/reals", [float]),
            ("/flags", [bool]),
            ("/words", [str]),
            ("/long_text", str),
            ("/a_namespace_with_a_name/that_is_long_enough_to_need/more_than_one_row_of_the_table", str),
        ):
            get(name, kind)
        say("gains", text(rospy.get_param("/gains")))
        say("mixed", text(rospy.get_param("/mixed")))
        found = [("~ratio", 9.0), ("~missing", 9.5), ("~count", 5), ("~absent", "default"), ("/top", 1.0)]
        say("defaults", " ".join(text(rospy.get_param(name, default)) for name, default in found))
        searched = ("speed", "top", "word", "nowhere")
        say("search", " ".join(rospy.search_param(name) or "none" for name in searched))
        there = ("~flag", "~none", "/gains", "/gains/deep/er/yet")
        say("has", "".join(text(rospy.has_param(name)) for name in there))
        rospy.set_param("~made", 3)
        rospy.set_param("~made_text", "some text")
        rospy.set_param("~made_list", [1.5, 2.5])
        rospy.set_param("~made_map", {"a": 1.0, "b": 2.5})
        get("~made", int)
        get("~made_text", str)
        get("~made_list", [float])
        get("~made_map", dict)
        get("~made_map/b", float)
        rospy.set_param("~made", True)
        get("~made", bool)
        say("delete", self.delete() + text(rospy.has_param("~made")) + self.delete())
        made = {"list": [1, 2.5, "three"], "inner": {"yes": True}, "text": "t"}
        say("made", text(made))
        rospy.set_param("~made_tree", made)
        again = rospy.get_param("~made_tree")
        say("again", text(again))
        say("members", f"{text('inner' in again)}{text('outer' in again)} {len(again['list'])}")
        for number in range(3):
            rospy.set_param("~cached", number * 0.5)
            say("cached", text(rospy.get_param_cached("~cached")))

    def delete(self):
        try:
            rospy.delete_param("~made")
        except KeyError:
            return "false"
        return "true"


if __name__ == "__main__":
    rospy.init_node("another_name")
    twin = Twin()
    rospy.sleep(1)
    twin.run()
    rospy.spin()
