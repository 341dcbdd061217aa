"""rostopic: printing and publishing. test_ros_tools.py tests its information on topics."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

TALKS = """
    import rospy
    from geometry_msgs.msg import PointStamped
    rospy.init_node("talks")
    publisher = rospy.Publisher("/points", PointStamped, queue_size=10)
    rate, count = rospy.Rate(10), 0
    while not rospy.is_shutdown():
        point = PointStamped()
        point.header.stamp, point.header.frame_id = rospy.Time.now() - rospy.Duration(0.5), "map"
        point.point.x = count
        publisher.publish(point)
        count += 1
        rate.sleep()
"""


def said(folder: Path, script: str, *, seconds: float = 5) -> list[str]:
    """Return a node's output beside a node that talks."""
    run = run_nodes(folder, {"TALKS": TALKS, "TOOL": script}, seconds=seconds)
    return next(lines for name, lines in run.printed.items() if name != "talks")


def test_echo(tmp_path: Path) -> None:
    script = """
        import rospy, rostopic
        rospy.sleep(0.5)
        rostopic.rostopicmain(["rostopic", "echo", "-n", "1", "--noarr", "/points"])
        rostopic.rostopicmain(["rostopic", "echo", "-n", "2", "/points/point/x"])
        rostopic.rostopicmain(["rostopic", "echo", "-n", "1", "-p", "--nostr", "/points/point"])
        rostopic.rostopicmain(["rostopic", "echo", "-n", "1", "--nostr", "--filter", "m.point.x % 7 == 0", "/points"])
    """
    lines = said(tmp_path, script)
    assert lines[0] == "header: "
    assert lines[5:12] == [
        '  frame_id: "map"',
        "point: ",
        f"  x: {lines[7].split()[-1]}",
        "  y: 0.0",
        "  z: 0.0",
        "---",
        lines[11],
    ]
    first, second = float(lines[11]), float(lines[13])
    assert second == first + 1
    assert lines[12] == lines[14] == "---"
    assert lines[15] == "%time,field.x,field.y,field.z"
    assert lines[16].split(",")[2:] == ["0.0", "0.0"]
    assert float(lines[-4].split()[-1]) % 7 == 0
    assert '  frame_id: "<string length: 3>"' in lines[17:]


def test_statistics(tmp_path: Path) -> None:
    script = """
        import rospy, rostopic
        from geometry_msgs.msg import PointStamped
        rospy.init_node("tool")
        rates, delays, counted = rostopic.ROSTopicHz(20), rostopic.ROSTopicDelay(-1), rostopic.ROSTopicBandwidth()
        print(rates.get_hz(), delays.get_delay(), counted._get_bw())
        rospy.Subscriber("/points", PointStamped, rates.callback_hz)
        rospy.Subscriber("/points", PointStamped, rates.callback_hz, callback_args="/points")
        rospy.Subscriber("/points", PointStamped, delays.callback_delay)
        rospy.sleep(3.0)
        rate, least, most, deviation, window = rates.get_hz()
        print(round(rate, 2), round(least, 2), round(most, 2), round(deviation, 3), window, rates.get_hz())
        print(round(delays.get_delay()[0], 3))
        rates.print_hz(["/points", "/none"])
        rospy.sleep(0.1)
        rates.print_hz()
        rates.print_hz()
        from rospy import AnyMsg
        class Bytes:
            _buff = b"12345678"
        for _ in range(5):
            counted.callback(Bytes())
            rospy.sleep(0.5)
        counted.print_bw()
    """
    lines = said(tmp_path, script, seconds=8)
    assert lines[0] == "None None None"
    assert lines[1] == "10.0 0.1 0.1 0.0 20 None"
    assert lines[2] == "0.5"
    assert lines[3].split() == ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]
    assert lines[4] == "=" * len(lines[4])
    assert lines[5].split()[:2] == ["/points", "10.0"]
    assert lines[7] == "average rate: 10.000"
    assert lines[8] == "\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 20"
    assert lines[9:11] == ["no new messages", "average: 16.00B/s"]
    assert lines[11] == "\tmean: 8.00B min: 8.00B max: 8.00B window: 5"


def test_publishing(tmp_path: Path) -> None:
    hears = """
        import rospy
        from geometry_msgs.msg import Twist
        rospy.init_node("hears")
        rospy.Subscriber("/cmd", Twist, lambda m: print(m.linear.x, m.angular.z))
        rospy.spin()
    """
    tool = """
        import rospy, rostopic
        rospy.sleep(0.3)
        rostopic.rostopicmain(["rostopic", "pub", "-1", "/cmd", "geometry_msgs/Twist", "[1, 0, 0]", "{z: 2}"])
        publisher, kind = rostopic.create_publisher("/cmd", "geometry_msgs/Twist", False)
        for values in ([{"linear": {"x": 3}}], [1, 2, 3], [{"nothing": 1}]):
            try:
                rostopic.publish_message(publisher, kind, values, once=True)
            except rostopic.ROSTopicException as error:
                print(str(error).splitlines()[0], str(error).splitlines()[-1])
        for kind in ("nowhere/Nothing", "Nothing"):
            try:
                rostopic.create_publisher("/cmd", kind, False)
            except rostopic.ROSTopicException as error:
                print(str(error).splitlines()[0])
    """
    run = run_nodes(tmp_path, {"HEARS": hears, "TOOL": tool}, seconds=6)
    assert run.printed["hears"] == ["1.0 2.0", "3.0 0.0"]
    lines = next(lines for name, lines in run.printed.items() if name.startswith("rostopic"))
    assert lines[0] == lines[1] == "publishing and latching message for 3.0 seconds"
    assert lines[-2:] == ["invalid message type: nowhere/Nothing.", "invalid topic type: Nothing"]
    assert [line.split()[-1] for line in lines[-4:-2]] == ["angular.z]", "angular.z]"]


def test_values_of_files_and_parameters(tmp_path: Path) -> None:
    (tmp_path / "values.yaml").write_text("data: one\n---\ndata: two\n", encoding="utf-8")
    hears = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("hears")
        rospy.Subscriber("/words", String, lambda m: print(m.data))
        rospy.spin()
    """
    tool = """
        import rospy, rostopic
        rospy.set_param("/word", {"data": "three"})
        rospy.sleep(0.3)
        publisher, kind = rostopic.create_publisher("/words", "std_msgs/String", False)
        rostopic.stdin_publish(publisher, kind, 10.0, False, "values.yaml", False)
        rostopic.param_publish_once(publisher, kind, "/word", False)
        for name in ("/none", "/words"):
            rospy.set_param("/words", 1)
            try:
                rostopic.param_publish_once(publisher, kind, name, False)
            except rostopic.ROSTopicException as error:
                print(error)
        try:
            rostopic.file_yaml_arg("none.yaml")
        except rostopic.ROSTopicException as error:
            print(error)
    """
    run = run_nodes(tmp_path, {"HEARS": hears, "TOOL": tool}, seconds=8)
    assert run.printed["hears"] == ["one", "two", "three"]
    lines = next(lines for name, lines in run.printed.items() if name.startswith("rostopic"))
    assert lines[-3:] == [
        "parameter does not exist: /none",
        "Parameter [/words] in not a valid type",
        "file does not exist: none.yaml",
    ]


def test_times_are_one_value_and_texts_of_bytes_are_numbers(tmp_path: Path) -> None:
    script = """
        import rospy, rostopic
        from std_msgs.msg import Header, UInt8MultiArray
        header = Header(3, rospy.Time(123, 456), "map")
        print(rostopic._str_plot_fields(header, "field", None))
        print(rostopic._str_plot(header, current_time=rospy.Time(1)))
        numbers = UInt8MultiArray(data=chr(2) + chr(200))
        print(rostopic._str_plot_fields(numbers, "field", None))
        print(rostopic._str_plot(numbers, current_time=rospy.Time(1)))
        print(str(numbers).splitlines()[-1])
    """
    assert said(tmp_path, script)[:5] == [
        "time,field.seq,field.stamp,field.frame_id",
        "1000000000,3,123000000456,map",
        "time,field.layout.data_offset,field.data0,field.data1",
        "1000000000,0,2,200",
        "data: [2, 200]",
    ]
