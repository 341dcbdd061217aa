#!/usr/bin/env python3
"""Parameters that a node in C++ has set, and those that it reads."""

import datetime
import xmlrpc.client

import rospy


def shown(value):
    """A value as text; base64 and dates as what they hold."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name!r}: {shown(each)}" for name, each in sorted(value.items())) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(shown(each) for each in value) + "]"
    if isinstance(value, xmlrpc.client.Binary):
        return f"base64 {value.data!r}"
    return f"date {value.value}" if isinstance(value, xmlrpc.client.DateTime) else ascii(value)


def wait_for(name, value):
    """Until a parameter has a value."""
    while not rospy.is_shutdown() and rospy.get_param(name, None) != value:
        rospy.sleep(0.05)


rospy.init_node("partner")
wait_for("/done_cpp", True)
for name, value in sorted(rospy.get_param("/probes/probe").items()):
    print("P| py", name, type(value).__name__, shown(value), flush=True)
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
    "bytes": xmlrpc.client.Binary(bytes(range(250, 256)) + b"\0a"),
    "none": xmlrpc.client.Binary(b""),
    "date": xmlrpc.client.DateTime(datetime.datetime(2026, 11, 23, 17, 6, 59)),
    "like": {"!!binary": "AAEC"},
    "held": [xmlrpc.client.Binary(b"x"), {"at": xmlrpc.client.DateTime("20010203T04:05:06")}, {"!!map": {"!!map": 1}}],
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
