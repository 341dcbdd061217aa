"""The nodes `record` and `play` of package rosbag, on a running mission in virtual time."""

from __future__ import annotations

from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import Run, run_nodes

RECORD = "from rosbag._record import main\nmain()\n"
PLAY = "from rosbag._play import main\nmain()\n"
TALKS = """
    import rospy
    from std_msgs.msg import String
    rospy.init_node("talks")
    state = rospy.Publisher("state", String, queue_size=1, latch=True)
    state.publish("up")
    chatter = rospy.Publisher("chatter", String, queue_size=10)
    rate = rospy.Rate(10)
    for i in range(40):
        chatter.publish("m%d" % i)
        rate.sleep()
"""
HEARS = """
    import rospy
    from std_msgs.msg import String
    rospy.init_node("hears")
    def heard(message):
        print("%.2f %s %s" % (rospy.get_time() % 1000, message.data, message._connection_header["latching"]))
    for name in ("chatter", "state", "again/chatter"):
        rospy.Subscriber(name, String, heard)
    rospy.spin()
"""
LOOKS = """
    import glob, os, rosbag
    os.chdir({folder!r})
    for name in sorted(glob.glob("*.bag*")):
        bag = rosbag.Bag(name)
        print(name, [(topic, row.message_count) for topic, row in bag.get_type_and_topic_info().topics.items()])
"""


def recorded(folder: Path, *args: str, seconds: float = 3.0) -> list[str]:
    """Return the contents of the bags of a mission that was recorded."""
    flight, bags, look = folder / "flight", folder / "bags", folder / "look"
    for each in (flight, bags, look):
        each.mkdir()
    nodes = {"REC": NodeConfig("REC", args=args, cwd=bags)}
    run_nodes(flight, {"REC": RECORD, "TALKS": TALKS}, seconds=seconds, nodes=nodes)
    return run_nodes(look, {"LOOKS": LOOKS.format(folder=str(bags))}, seconds=0.7).printed["LOOKS"]


def test_all_topics_are_recorded(tmp_path: Path) -> None:
    (line,) = recorded(tmp_path, "-a", "-O", "run", "-x", "/rosout.*", seconds=3.6)
    assert line == "run.bag [('/chatter', 21), ('/state', 1)]"


def test_selected_topics_are_recorded(tmp_path: Path) -> None:
    assert recorded(tmp_path, "state", "-o", "my", "--lz4")[0].endswith(".bag [('/state', 1)]")


def test_recording_ends_at_a_limit(tmp_path: Path) -> None:
    assert recorded(tmp_path, "-l", "3", "chatter", "-O", "few.bag") == ["few.bag [('/chatter', 3)]"]


def test_several_bags(tmp_path: Path) -> None:
    args = (
        "--split",
        "--duration",
        "1",
        "--max-splits",
        "2",
        "-e",
        "/(chatter|state)",
        "-O",
        "run",
        "--repeat-latched",
    )
    lines = recorded(tmp_path, *args, seconds=5.0)
    assert [line.split(" ")[0] for line in lines] == ["run_1.bag", "run_2.bag"]
    assert all("('/state', 1)" in line for line in lines)


def played(folder: Path, *args: str, sim_time: bool = False, seconds: float = 3.0) -> Run:
    """Fly a mission that plays a bag of 11 messages in a second, and a latched one."""
    bag = folder / "in.bag"
    write = f"""
        import rosbag, rospy
        from std_msgs.msg import String
        with rosbag.Bag({str(bag)!r}, "w") as out:
            latched = dict(type=String._type, md5sum=String._md5sum, message_definition="string data", latching="1")
            out.write("/state", String("up"), rospy.Time(500), connection_header=latched)
            for i in range(11):
                out.write("/chatter", String("m%d" % i), rospy.Time.from_sec(500 + i / 10.0))
    """
    for name in ("write", "flight"):
        (folder / name).mkdir()
    run_nodes(folder / "write", {"WRITES": write}, seconds=0.7)
    nodes = {"PLAY": NodeConfig("PLAY", args=("-q", *args, str(bag)))}
    scripts = {"HEARS": HEARS, "PLAY": PLAY}
    params = {"use_sim_time": True} if sim_time else {}
    return run_nodes(folder / "flight", scripts, seconds=seconds, nodes=nodes, params=params)


def test_playback_takes_as_long_as_the_recording(tmp_path: Path) -> None:
    lines = played(tmp_path).printed["hears"]
    words = [line.split() for line in lines]
    assert ["up", "1"] in [each[1:] for each in words]
    chatter = [(float(each[0]), each[1]) for each in words if each[1] != "up"]
    assert [name for _, name in chatter] == [f"m{i}" for i in range(11)]
    assert [round(time - chatter[0][0], 2) for time, _ in chatter] == [round(i / 10, 2) for i in range(11)]


def test_rate_start_duration_topics_and_prefix(tmp_path: Path) -> None:
    args = ("-r", "2", "-s", "0.25", "-u", "0.5", "-p", "/again", "--topics", "/chatter", "--bags")
    words = [line.split() for line in played(tmp_path, *args).printed["hears"]]
    assert [each[1] for each in words] == ["m3", "m4", "m5", "m6", "m7"]
    assert round(float(words[-1][0]) - float(words[0][0]), 2) == 0.2


def test_simulated_time_comes_from_the_bag(tmp_path: Path) -> None:
    words = [line.split() for line in played(tmp_path, "--clock", "--hz", "1000", sim_time=True).printed["hears"]]
    chatter = [(each[0], each[1]) for each in words if each[1] != "up"]
    assert [name for _, name in chatter] == [f"m{i}" for i in range(11)]
    assert all(abs(float(time) - (500 + i / 10)) < 0.011 for i, (time, _) in enumerate(chatter))


def test_immediate_and_loop(tmp_path: Path) -> None:
    lines = played(tmp_path, "--loop", seconds=4.5).printed["hears"]
    assert sum("m0 " in line for line in lines) == 4


def test_two_recordings_have_equal_bytes(tmp_path: Path) -> None:
    found = []
    for number, tasks in enumerate(("thread", "greenlet")):
        folder = tmp_path / str(number)
        folder.mkdir()
        nodes = {"REC": NodeConfig("REC", args=("-a", "-O", str(folder / "out.bag")))}
        run_nodes(folder, {"REC": RECORD, "TALKS": TALKS}, seconds=3.0, nodes=nodes, tasks=tasks)
        found.append((folder / "out.bag").read_bytes().replace(str(folder).encode(), b""))
    assert len(found[0]) > 5000
    assert found[0] == found[1]
