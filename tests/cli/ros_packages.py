"""A ROS package on disk for the tests of launch, node and rostest."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

TALKER = """
    #!/usr/bin/env python
    import os, sys
    import rospy
    from std_msgs.msg import String
    rospy.init_node("talker")
    print("argv", sys.argv[1:], "cwd", os.path.basename(os.getcwd()), "namespace", os.environ.get("ROS_NAMESPACE"))
    publisher = rospy.Publisher("chatter", String, queue_size=10)
    rate = rospy.Rate(rospy.get_param("~rate", 10))
    for number in range(rospy.get_param("~count", 1000)):
        publisher.publish(f"hello {number}")
        rate.sleep()
    """
LISTENER = """
    #!/usr/bin/env python
    import rospy
    from std_msgs.msg import String
    rospy.init_node("listener")
    rospy.Subscriber("chatter", String, lambda message: rospy.loginfo("heard %s", message.data))
    rospy.spin()
    """
CHECK = """
    #!/usr/bin/env python
    import sys, unittest
    import rospy, rostest
    from std_msgs.msg import String

    class TestTalker(unittest.TestCase):
        def test_hears(self):
            rospy.init_node("check")
            self.assertEqual(rospy.wait_for_message("chatter", String, 5).data[:5], rospy.get_param("~begins"))

        def test_waits(self):
            rospy.sleep(rospy.get_param("~sleeps", 0))

    if __name__ == "__main__":
        rostest.rosrun("demo", "check", TestTalker, sys.argv)
    """

Launch = Callable[[str], str]


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    """The folder of a package `demo` with the nodes talker.py, listener.py and check.py."""
    folder = tmp_path / "demo"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>demo</name></package>", encoding="utf-8")
    for name, source in (("talker.py", TALKER), ("listener.py", LISTENER), ("check.py", CHECK)):
        (folder / "scripts" / name).write_text(textwrap.dedent(source).lstrip(), encoding="utf-8")
    return folder


@pytest.fixture
def write_launch(demo: Path) -> Launch:
    """Writes a launch file into the package and returns its path."""

    def write(body: str) -> str:
        file = demo / "demo.launch"
        file.write_text(f"<launch>{body}</launch>", encoding="utf-8")
        return str(file)

    return write
