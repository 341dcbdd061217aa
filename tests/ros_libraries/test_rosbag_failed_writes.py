"""A message that cannot be serialized leaves its entry in the index of a bag, recorded from rosbag 1.15.15."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

SCRIPT = """
import rosbag, rospy
from std_msgs.msg import String
for case in CASES:
    bag = rosbag.Bag("FILE", "w", compression="COMPRESSION")
    for word in case.split():
        try:
            topic, second, mark = word
            bag.write("/" + topic, String(3) if mark == "x" else String(word), rospy.Time(int(second)))
        except Exception as error:
            print("write:", error)
    bag.close()
    bag = rosbag.Bag("FILE")
    print(bag.get_message_count(), bag.get_start_time(), bag.get_end_time())
    try:
        for topic, message, time in bag.read_messages():
            print(topic, message.data, time.to_sec())
    except rosbag.ROSBagException as error:
        print("read:", error)
"""
WRITE = "write: field data must be of type bytes or an ascii string"
READ = "read: Error reading header: error unpacking uint32: unpack requires a buffer of 4 bytes"
CASES = {
    "a1- a2x": [WRITE, "2 1.0 2.0", "/a a1- 1.0", READ],
    "a1x": [WRITE, "1 1.0 1.0", READ],
    "a1- a2x b3-": [WRITE, "3 1.0 3.0", "/a a1- 1.0", "/b b3- 3.0", "/b b3- 3.0"],
    "a1x b2x": [WRITE, WRITE, "2 1.0 2.0", READ],
    "a3x a1- a5- a2x": [WRITE, WRITE, "4 1.0 5.0", "/a a1- 1.0", READ],
    "a1- b2x a3-": [WRITE, "3 1.0 3.0", "/a a1- 1.0", "/a a3- 3.0", "/a a3- 3.0"],
}
NOTE = "cfepy: a message on /{} could not be serialized. As on ROS, the index of the bag counts it nevertheless:"


@pytest.mark.parametrize("compression", ["none", "bz2"])
def test_failed_write_leaves_an_entry(tmp_path: Path, compression: str) -> None:
    script = SCRIPT.replace("CASES", repr(list(CASES))).replace("FILE", str(tmp_path / "made.bag"))
    printed = run_nodes(tmp_path, {"N": script.replace("COMPRESSION", compression)}).printed["N"]
    assert [line for line in printed if not line.startswith("cfepy:")] == [
        line for each in CASES.values() for line in each
    ]
    notes = [line for line in printed if line.startswith("cfepy:")]
    assert [line[: len(NOTE) - 1] for line in notes] == [
        NOTE.format(word[0]) for case in CASES for word in case.split() if word.endswith("x")
    ]
