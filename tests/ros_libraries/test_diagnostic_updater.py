"""diagnostic_updater: statuses, tasks and an updater's messages."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def printed(folder: Path, script: str) -> list[str]:
    """Return the output of a node that begins with the usual imports."""
    head = "import rospy\nfrom diagnostic_updater import *\nrospy.init_node('n')\n"
    return run_nodes(folder, {"N": head + script}, seconds=6.0).printed.get("n", [])


def test_status_wrapper(tmp_path: Path) -> None:
    script = """
status = DiagnosticStatusWrapper(level=0, message="ok")
status.mergeSummary(1, "warm")
print(status.level, status.message)
status.mergeSummary(DiagnosticStatus(level=2, message="hot"))
print(status.level, status.message)
status.mergeSummary(0, "fine")
print(status.level, status.message)
status.clearSummary()
status.mergeSummary(0, "a")
status.mergeSummary(0, "b")
status.add("key", 1.5)
print(status.level, status.message, status.values[0].key, status.values[0].value)
"""
    assert printed(tmp_path, script) == ["1 warm", "2 warm; hot", "2 warm; hot", "0 a; b key 1.5"]


def test_updater_publishes_once_a_period(tmp_path: Path) -> None:
    script = """
rospy.set_param("~diagnostic_period", 0.5)
rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: print(
    [(each.name, each.level, each.message, each.hardware_id) for each in array.status]))
rospy.sleep(0.1)
updater = Updater()
updater.setHardwareID("none")
updater.add("task", lambda stat: (stat.summary(WARN, "hm"), stat)[1])
for _ in range(12):
    rospy.sleep(0.1)
    updater.update()
updater.broadcast(2, "bye")
rospy.sleep(0.1)
print(updater.removeByName("task"), updater.removeByName("task"))
"""
    task = "('n: task', 1, 'hm', 'none')"
    assert printed(tmp_path, script) == [
        "[('n: task', 0, 'Node starting up', '')]",
        f"[{task}]",
        f"[{task}]",
        "[('n: task', 2, 'bye', '')]",
        "True False",
    ]


def test_missing_hardware_id_is_reported_once(tmp_path: Path) -> None:
    script = """
updater = Updater()
updater.add(Heartbeat())
updater.force_update()
updater.force_update()
"""
    (line,) = printed(tmp_path, script)
    assert "No HW_ID was set" in line


def test_composite_task_merges(tmp_path: Path) -> None:
    script = """
task = CompositeDiagnosticTask("both")
def low(stat):
    stat.summary(1, "low")
    stat.add("x", 1)
    return stat
task.addTask(FunctionDiagnosticTask("low", low))
task.addTask(Heartbeat())
stat = task.run(DiagnosticStatusWrapper())
print(stat.level, stat.message, len(stat.values), task.getName())
"""
    assert printed(tmp_path, script) == ["1 low 1 both"]


def test_frequency(tmp_path: Path) -> None:
    script = """
status = FrequencyStatus(FrequencyStatusParam({"min": 10, "max": 20}, 0.5, 2))
def after(seconds):
    rospy.sleep(seconds)
    status.tick()
    stat = status.run(DiagnosticStatusWrapper())
    print(stat.level, stat.message, round(float(stat.values[3].value)))
after(0.02)
after(0.05)
after(0.3)
after(0.15)
status.clear()
stat = status.run(DiagnosticStatusWrapper())
print(stat.level, stat.message, [each.key for each in stat.values][4:])
"""
    assert printed(tmp_path, script) == [
        "1 Frequency too high. 50",
        "0 Desired frequency met 29",
        "0 Desired frequency met 6",
        "1 Frequency too low. 4",
        "2 No events recorded. ['Minimum acceptable frequency (Hz)', 'Maximum acceptable frequency (Hz)']",
    ]


def test_stamps(tmp_path: Path) -> None:
    script = """
status = TimeStampStatus()
def run(*ages):
    for age in ages:
        status.tick(rospy.Time.now().to_sec() - age if age is not None else rospy.Time(0))
    stat = status.run(DiagnosticStatusWrapper())
    print(stat.level, stat.message, [each.value for each in stat.values][4:])
rospy.sleep(1)
run()
run(-2.0)
run(4.0)
run(6.0)
run(0.0, None)
"""
    assert printed(tmp_path, script) == [
        "1 No data since last update. ['0', '0', '0']",
        "2 Timestamps too far in future seen. ['0', '1', '0']",
        "0 Timestamps are reasonable. ['0', '1', '0']",
        "2 Timestamps too far in past seen. ['1', '1', '0']",
        "2 Zero timestamp seen. ['1', '1', '1']",
    ]


def test_diagnosed_publisher(tmp_path: Path) -> None:
    script = """
from geometry_msgs.msg import PointStamped
updater = Updater()
publisher = DiagnosedPublisher(rospy.Publisher("p", PointStamped, queue_size=1), updater,
    FrequencyStatusParam({"min": 1}), TimeStampStatusParam())
message = PointStamped()
message.header.stamp = rospy.Time.now()
publisher.publish(message)
rospy.sleep(0.1)
stat = publisher.run(DiagnosticStatusWrapper())
print(stat.message, publisher.name, len(stat.values))
publisher.clear_window()
"""
    assert printed(tmp_path, script) == ["Desired frequency met; Timestamps are reasonable. /p topic status 12"]
