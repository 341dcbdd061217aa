"""Other readers of cfepy's bags: ROS's own rosbag, if it is installed, and the package rosbags."""

from __future__ import annotations

import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

PYTHON = "/usr/bin/python3"  # Debian's packages of ROS are installed for it
WRITES = """
    import rosbag, rospy
    from nav_msgs.msg import Odometry
    from std_msgs.msg import String
    with rosbag.Bag({file!r}, "w", compression={kind!r}, chunk_threshold=2000) as out:
        for i in range(100):
            message = Odometry()
            message.header.stamp = rospy.Time(i)
            message.pose.pose.position.x = i / 2
            out.write("/odom", message, rospy.Time(1000 + i))
            out.write("/chatter", String("m%d" % i), rospy.Time(1000 + i, 5))
"""
READS = """
import os, sys, rosbag, rospy
at = rospy.Time.from_sec
os.chdir(os.path.dirname(sys.argv[1]))
bag = rosbag.Bag(os.path.basename(sys.argv[1]))
print(bag)
print(bag._get_yaml_info())
print(bag.get_message_count(), bag.get_start_time(), bag.get_end_time(), tuple(bag.get_compression_info()))
print([(topic, tuple(row)) for topic, row in bag.get_type_and_topic_info().topics.items()])
for topic, message, stamp in bag.read_messages(start_time=at(1010), end_time=at(1050.5)):
    print(topic, stamp, str(message)[:300])
for topic, raw, stamp in bag.read_messages("/odom", raw=True):
    print(raw[0], len(raw[1]), raw[2], raw[3], stamp)
for found in bag.read_messages("chatter", return_connection_header=True):
    print(found.connection_header["type"], found.message.data)
print(bag._get_entry(at(1020.5)).time, bag._get_entry_after(at(1020.5)).position)
"""


@cache
def has_rosbag() -> bool:
    """Return whether ROS's own rosbag is on this computer."""
    if shutil.which(PYTHON) is None:
        return False
    return subprocess.run([PYTHON, "-c", "import rosbag"], capture_output=True, check=False).returncode == 0


def written(folder: Path, kind: str) -> Path:
    """Return a bag that a node wrote."""
    file = folder / "out.bag"
    (folder / "write").mkdir()
    run_nodes(folder / "write", {"WRITES": WRITES.format(file=str(file), kind=kind)}, seconds=0.7)
    return file


@pytest.mark.parametrize("kind", ["bz2", *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("none", "lz4"))])
def test_rosbag_reports_the_same_about_a_bag(tmp_path: Path, kind: str) -> None:
    if not has_rosbag():
        pytest.skip("ROS's own rosbag is not installed (Debian: python3-rosbag), so it cannot read what was written")
    file = written(tmp_path, kind)
    (tmp_path / "reads.py").write_text(READS, encoding="utf-8")
    real = subprocess.run(
        [PYTHON, str(tmp_path / "reads.py"), str(file)],
        capture_output=True,
        text=True,
        check=True,
        env={"PATH": "/usr/bin:/bin", "TZ": "UTC"},
    )
    (tmp_path / "read").mkdir()
    script = READS.replace("sys.argv[1]", repr(str(file)))
    own = run_nodes(tmp_path / "read", {"READS": script}, seconds=0.7).printed["READS"]
    expected = real.stdout.rstrip("\n").split("\n")
    assert len(expected) > 200
    assert [line.rstrip() for line in own if not _is_date(line)] == [
        line.rstrip() for line in expected if not _is_date(line)
    ]


def _is_date(line: str) -> bool:
    """Return whether a line has a date in the local time of the computer."""
    return line.startswith(("start:  ", "end:  "))


@pytest.mark.parametrize("kind", ["none", "bz2", "lz4"])
def test_rosbags_package_reads_a_bag(tmp_path: Path, kind: str) -> None:
    from rosbags.rosbag1 import Reader

    with Reader(written(tmp_path, kind)) as reader:
        assert reader.message_count == 200
        assert {topic: info.msgcount for topic, info in reader.topics.items()} == {"/odom": 100, "/chatter": 100}
        found = [(connection.topic, time) for connection, time, _ in reader.messages()]
    assert [time for _, time in found] == sorted(time for _, time in found)
    assert found[-1][1] == 1_099_000_000_005


@pytest.mark.slow
def test_original_source_next_to_a_node_is_preferred(tmp_path: Path) -> None:
    if not has_rosbag():
        pytest.skip("ROS's own rosbag is not installed (Debian: python3-rosbag), so there is no source to bring along")
    code = "import rosbag; print(rosbag.__path__[0])"
    source = subprocess.run([PYTHON, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    (tmp_path / "flight").mkdir()
    shutil.copytree(source, tmp_path / "flight" / "rosbag")
    bags = Path(__file__).parents[1] / "data" / "bags"
    script = f"""
        import rosbag
        with rosbag.Bag("out.bag", "w", compression="bz2", chunk_threshold=4096) as out:
            for topic, message, stamp in rosbag.Bag({str(bags / "golden_api_lz4.bag")!r}):
                out.write(topic, message, stamp)
        print(rosbag.bag._BagReader200.__name__)
    """
    assert run_nodes(tmp_path / "flight", {"READS": script}, seconds=0.7).printed["READS"][-1] == "_BagReader200"
    assert (tmp_path / "flight" / "out.bag").read_bytes() == (bags / "golden_api_bz2.bag").read_bytes()
