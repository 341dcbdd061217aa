#!/usr/bin/env python3
"""Parameters that a node in C++ has set, and those that it reads."""

import rospy


def wait_for(name, value):
    """Until a parameter has a value."""
    while not rospy.is_shutdown() and rospy.get_param(name, None) != value:
        rospy.sleep(0.05)


rospy.init_node("partner")
wait_for("/done_cpp", True)
for name, value in sorted(rospy.get_param("/probes/probe").items()):
    print("P| py", name, type(value).__name__, ascii(value), flush=True)
rospy.delete_param("/from_cpp")
for name, value in {
    "int": 7,
    "least": -(2**31),
    "double": 0.1,
    "whole": 3.0,
    "bool": False,
    "text": "two words",
    "digits": "007",
    "marks": "<a> & \"b\" 'c' \\ {x} [y]",
    "empty": "",
    "lines": "one\ntwo\tthree",
    "unicode": "gr\xfc\xdf \u20ac \U0001f680",
    "list": [1, 2.5, "three", True],
    "texts": ["a", "1", "true"],
    "nothing": [],
    "tree": {"leaf": 1, "branch": {"leaf": "x"}},
    "tuple": (1, 2),
}.items():
    rospy.set_param(f"/py/{name}", value)
for value in (2**31, -(2**31) - 1, 2**40):
    try:
        rospy.set_param("/py/big", value)
        print("P| py took", value, flush=True)
    except OverflowError as error:
        print("P| py refused", value, error, flush=True)
rospy.set_param("/probes/shared", 1)
rospy.set_param("/done_py", True)
rospy.set_param("/late", 1)
wait_for("/seen", 1)
rospy.set_param("/late", 2)
wait_for("/seen", 2)
rospy.set_param("/tree", {"in": {"it": 3}})
wait_for("/seen", 3)
print("P| py late", rospy.get_param("/late"), rospy.has_param("/py/int"), flush=True)
rospy.set_param("/end", 1)
