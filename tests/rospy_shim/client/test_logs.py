"""loginfo and its kin: format, levels, once, throttle, loggers, /rosout."""

from __future__ import annotations

import re
from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def run(tmp_path: Path, body: str) -> list[str]:
    """Return a node's log and output, without the time."""
    result = run_nodes(tmp_path, {"PROBE": "import rospy, logging\n" + body})
    lines = [line for lines in result.printed.values() for line in lines] or result.lines
    return [re.sub(r" \[\d+\.\d{6}\]", "", line) for line in lines]


def test_format_and_levels(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.init_node("probe")
rospy.logdebug("not shown")
rospy.loginfo("hello %s %d", "you", 5)
rospy.loginfo("100%")
rospy.loginfo(7)
rospy.logwarn("w"); rospy.logerr("e"); rospy.logfatal("f"); rospy.core.logerror("old name")
rospy.loginfo("named", logger_name="part")
logging.getLogger("rosout").info("direct")
logging.getLogger("rosout.part").setLevel(logging.DEBUG)
rospy.logdebug("shown", logger_name="part")
""",
    )
    assert lines == [
        "[INFO]: hello you 5",
        "[INFO]: 100%",
        "[INFO]: 7",
        "[WARN]: w",
        "[ERROR]: e",
        "[FATAL]: f",
        "[ERROR]: old name",
        "[INFO]: named",
        "[INFO]: direct",
        "[DEBUG]: shown",
    ]


def test_once_throttle_identical(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.init_node("probe")
for n in range(6):
    rospy.loginfo_once("once %d", n)
    rospy.loginfo_throttle(1.0, "throttle %d" % n)
    rospy.logwarn_throttle_identical(10, "half %d" % (n // 3))
    rospy.sleep(0.4)
""",
    )
    assert lines == [
        "[INFO]: once 0",
        "[INFO]: throttle 0",
        "[WARN]: half 0",
        "[INFO]: throttle 3",
        "[WARN]: half 1",
    ]


def test_log_level_of_init_node(tmp_path: Path) -> None:
    lines = run(tmp_path, 'rospy.init_node("probe", log_level=rospy.ERROR)\nrospy.logwarn("w")\nrospy.logerr("e")\n')
    assert lines == ["[ERROR]: e"]


def test_rosout_is_published_when_a_subscriber_exists(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
from rosgraph_msgs.msg import Log
rospy.init_node("probe")
rospy.Subscriber("/rosout", Log, lambda m: print(m.name, m.level, m.msg, m.file, m.topics))
rospy.sleep(0.2)
rospy.logwarn("heard %d", 1)
rospy.sleep(0.1)
""",
    )
    assert lines == ["[WARN]: heard 1", "/probe 4 heard 1 probe.py ['/rosout']"]


def test_console_format(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import os
os.environ["ROSCONSOLE_FORMAT"] = "${severity}|${message}|${node}|${logger}|${function}|${line}|${time:%Y}|${other}"
rospy.init_node("probe")
class Arm:
    def move(self):
        rospy.logwarn("slow", logger_name="arm")
Arm().move()
""",
    )
    assert lines == ["WARN|slow|/probe|rosout.arm|Arm.move|8|1980|${other}"]


def test_root_logger_belongs_to_the_log_file(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        f"""
import os
logging.basicConfig(level=logging.DEBUG)
os.environ["ROS_LOG_DIR"] = {str(tmp_path / "log")!r}
rospy.init_node("probe")
logging.getLogger("mine").warning("not on the console")
try:
    1 / 0
except ZeroDivisionError:
    rospy.logerr("caught", exc_info=True)
print(open({str(tmp_path / "log" / "probe.log")!r}).read().count("ZeroDivisionError"))
""",
    )
    assert lines[0] == "[ERROR]: caught"
    assert lines[-2:] == ["ZeroDivisionError: division by zero", "1"]
    assert not any("not on the console" in line for line in lines)
    assert "[mine][WARNING] " in (tmp_path / "log" / "probe.log").read_text(encoding="utf-8")


def test_logger_services_cost_nothing_before_they_are_called(tmp_path: Path) -> None:
    other = """
import rospy
from rospy.logger_level_service_caller import LoggerLevelServiceCaller
rospy.init_node("other")
rospy.sleep(0.5)
caller = LoggerLevelServiceCaller()
print(caller.get_node_names(), "rosout" in caller.get_loggers("probe"))
print(caller.send_logger_change_message("probe", "rosout", "debug"), caller.get_levels()[0])
"""
    node = """
import rospy
rospy.init_node("probe")
rospy.logdebug("hidden")
rospy.sleep(1.0)
rospy.logdebug("shown")
"""
    result = run_nodes(tmp_path, {"PROBE": node, "OTHER": other})
    assert result.printed["other"] == ["['/other', '/probe'] True", "True debug"]
    assert [line.partition("]: ")[2] for line in result.printed["probe"]] == ["shown"]
