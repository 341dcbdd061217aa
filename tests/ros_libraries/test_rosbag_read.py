"""Bags that ROS's own rosbag wrote, read in a node: counts, times, values, and the output of `rosbag info`."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

BAGS = Path(__file__).parents[1] / "data" / "bags"
BEGIN = """
    import os, rosbag, rospy
    os.chdir({folder!r})
"""


def printed(folder: Path, code: str) -> list[str]:
    """Return the output of a node in the folder of the recorded bags."""
    begin = textwrap.dedent(BEGIN).format(folder=str(BAGS))
    run = run_nodes(folder, {"READS": begin + textwrap.dedent(code)}, seconds=1.0)
    return run.printed.get("READS", [])


@pytest.mark.parametrize("kind", ["none", "bz2", "lz4"])
def test_messages_are_ordered_by_time_for_each_compression(tmp_path: Path, kind: str) -> None:
    code = f"""
        with rosbag.Bag("golden_api_{kind}.bag") as bag:
            found = list(bag)
        print(len(found), all(a.timestamp <= b.timestamp for a, b in zip(found, found[1:])))
        first = found[0]
        print(first.topic, first.message.data, first.timestamp.secs, type(first.timestamp) is rospy.Time)
        print([each.message.data for each in found if each.topic == "/count"] == list(range(200)))
        print(found[0].message._type, first[0], first[1].data, first[2])
    """
    assert printed(tmp_path, code) == [
        "440 True",
        "/chatter m0 1000 True",
        "True",
        "std_msgs/String /chatter m0 1000000000000",
    ]


def test_bag_reports_counts_times_and_types(tmp_path: Path) -> None:
    code = """
        bag = rosbag.Bag("golden.bag")
        print(bag.get_message_count(), bag.get_message_count("/chatter"), bag.get_message_count(["/tf", "/none"]))
        print("%.6f %.6f" % (bag.get_start_time(), bag.get_end_time()))
        types, topics = bag.get_type_and_topic_info()
        print(types["std_msgs/String"], list(types) == sorted(types), topics["/map_name"])
        print("%.3f" % topics["/odom"].frequency, list(bag.get_type_and_topic_info("/odom").topics))
        print(tuple(bag.get_compression_info()), bag.version, bag.mode, bag.size, bag.filename)
        bag.close()
        bag.close()
        try:
            bag.size
        except ValueError as error:
            print(error)
    """
    assert printed(tmp_path, code) == [
        "361 60 60",
        "1795253846.983536 1795253850.702383",
        "992ce8a1687cec8c8bd883ec73ca41d1 True "
        "TopicTuple(msg_type='std_msgs/String', message_count=1, connections=1, frequency=None)",
        "20.010 ['/odom']",
        "('none', 91719, 91719) 200 r 109758 golden.bag",
        "I/O operation on closed bag",
    ]


@pytest.mark.parametrize("name", ["golden", "golden_api_none"])
def test_text_equals_rosbag_info(tmp_path: Path, name: str) -> None:
    expected = (BAGS / f"{name}.bag.info.txt").read_text(encoding="utf-8").rstrip("\n").split("\n")
    found = printed(tmp_path, f'print(rosbag.Bag("{name}.bag", skip_index=True))')
    times = [line for line in expected if line.startswith(("start:", "end:"))]
    assert [line.rstrip() for line in found if not line.startswith(("start:", "end:"))] == [
        line.rstrip() for line in expected if line not in times
    ]
    stamps = [line.split("(")[1] for line in found if line.startswith(("start:", "end:"))]
    assert stamps == [line.split("(")[1] for line in times]  # before it is a date, in the local time of the computer


def test_yaml_of_a_bag(tmp_path: Path) -> None:
    code = """
        import yaml
        bag = rosbag.Bag("golden_api_bz2.bag")
        found = yaml.safe_load(bag._get_yaml_info())
        print(found["messages"], found["compression"], found["uncompressed"], found["compressed"], found["duration"])
        print(found["topics"][2])
        print(bag._get_yaml_info("topics[0].type"), bag._get_yaml_info("nothing"))
    """
    assert printed(tmp_path, code) == [
        "440 bz2 54448 5746 19.9",
        "{'topic': '/odom', 'type': 'nav_msgs/Odometry', 'messages': 40, 'frequency': 2.0}",
        'Error getting key "nothing"',
        "std_msgs/String None",
    ]


def test_filters(tmp_path: Path) -> None:
    code = """
        bag = rosbag.Bag("golden_api_none.bag", skip_index=True)
        at = rospy.Time.from_sec
        print(len(list(bag.read_messages("/odom"))), len(list(bag.read_messages(topics=["/odom", "/count"]))))
        print(len(list(bag.read_messages(topics=[]))), len(list(bag.read_messages("odom/"))))
        print([m.data for _, m, _ in bag.read_messages("/count", start_time=at(1000.5), end_time=at(1000.85))])
        asked = []
        def wanted(topic, datatype, md5sum, msg_def, header):
            asked.append((topic, datatype, md5sum[:4], msg_def[:6], header["type"]))
            return datatype == "std_msgs/String"
        print({m.topic for m in bag.read_messages(connection_filter=wanted)}, asked[0])
        topic, raw, t = next(bag.read_messages("/count", raw=True))
        print(raw[:2], raw[2][:4], raw[3], raw[4]._type, bag._read_message(raw[3]).message.data)
        whole = next(bag.read_messages("/count", return_connection_header=True))
        print(whole.connection_header["topic"], len(whole))
    """
    assert printed(tmp_path, code) == [
        "40 240",
        "440 0",
        "[5, 6, 7, 8]",
        "{'/chatter'} ('/chatter', 'std_msgs/String', '992c', 'string', b'std_msgs/String')",
        "('std_msgs/UInt32', b'\\x00\\x00\\x00\\x00') 304a (4117, 381) std_msgs/UInt32 0",
        "b'/count' 4",
    ]


def test_invalid_bag_is_refused(tmp_path: Path) -> None:
    code = f"""
        import io
        folder = {str(tmp_path)!r}
        def attempt(*args, **options):
            try:
                rosbag.Bag(*args, **options)
            except Exception as error:
                print(type(error).__name__, str(error).partition(": ")[0] if isinstance(error, OSError) else error)
        open(folder + "/empty.bag", "w").close()
        with open(folder + "/text.bag", "w") as file:
            file.write("hello\\n")
        with open(folder + "/old.bag", "w") as file:
            file.write("#ROSBAG V1.2\\n")
        for name in ("empty", "text", "old"):
            attempt(folder + "/" + name + ".bag")
        attempt("")
        attempt(None)
        attempt("golden.bag", "z")
        attempt("golden.bag", compression="zip")
        attempt("golden.bag", chunk_threshold=-1)
        attempt("golden.bag", options=[])
        attempt("there/is/none.bag")
        with open("golden.bag", "rb") as file:
            print(len(list(rosbag.Bag(file))))
        attempt(io.BytesIO(open("golden.bag", "rb").read()))
    """
    assert printed(tmp_path, code) == [
        "ROSBagException empty file",
        "ROSBagException This does not appear to be a bag file",
        "ROSBagException unsupported bag version 102. Please convert bag to newer format.",
        "ValueError filename (or stream) is invalid",
        "ValueError filename (or stream) is invalid",
        'ValueError mode "z" is invalid',
        "ValueError compression must be one of: none, bz2, lz4",
        "ValueError chunk_threshold must be greater than or equal to zero",
        "ValueError options must be of type dict",
        "FileNotFoundError [Errno 2] No such file or directory",
        "361",
        "AttributeError '_io.BytesIO' object has no attribute 'mode'",
    ]


def test_messages_have_the_definition_of_the_bag(tmp_path: Path) -> None:
    """As with ROS, their class differs from the imported one, but can be published in its place."""
    code = """
        from std_msgs.msg import String
        message = next(rosbag.Bag("golden.bag").read_messages("/chatter")).message
        print(isinstance(message, String), message._type, message._md5sum == String._md5sum)
        again = next(rosbag.Bag("golden_api_none.bag").read_messages("/chatter")).message
        print(type(message) is type(again), isinstance(message, rospy.Message))
    """
    assert printed(tmp_path, code) == ["False std_msgs/String True", "True True"]


def test_index_for_tools(tmp_path: Path) -> None:
    code = """
        bag = rosbag.Bag("golden_api_none.bag")
        at = rospy.Time.from_sec
        print(len(bag._connections), len(bag._chunks), bag._chunks[0].start_time.to_sec())
        print(sum(map(len, bag._connection_indexes.values())), bag._has_compressed_chunks, bag._uncompressed_size)
        connections = list(bag._get_connections("/odom"))
        print(bag._get_entry(at(1000.9), connections).time, bag._get_entry_after(at(1000.5), connections).time)
        print(bag._get_entry(at(1), connections), bag._get_entry_after(at(1e6), connections))
        entry = next(bag._get_entries_reverse(connections))
        print(entry.time, bag._read_message(entry.position).message.pose.pose.position.x)
    """
    lines = printed(tmp_path, code)
    assert lines[:4] == ["3 13 1000.0", "440 False 54448", "1000500000000 1001000000000", "None None"]
    assert lines[4].startswith("1019500000000 ")
