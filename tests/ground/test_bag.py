"""Recording a run into a bag: every published message at its time, and without an effect on the run."""

from __future__ import annotations

import contextlib
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.ground.bag import BagReader, BagRecorder, is_bag
from cfepy.ground.mcap_recorder import recorder_of
from cfepy.mission import Mission, MissionSpec
from cfepy.status import UsageError
from cfepy.writing.console import Console
from rospy_shim.types.config import RosConfig, TopicConfig
from rospy_shim.types.msgs import message_class
from tests.disk import room_for

TALKS = """
    import rospy
    from std_msgs.msg import ByteMultiArray, Header, String
    rospy.init_node("talks")
    alone = rospy.Publisher("alone", String, queue_size=1)
    heard = rospy.Publisher("heard", Header, queue_size=1)
    rospy.sleep(0.5)
    rate = rospy.Rate(10)
    for i in range(5):
        alone.publish("m%d" % i)
        heard.publish(frame_id="x" * 100_000 if i == 3 else "short")
        rate.sleep()
    rospy.spin()
"""
HEARS = """
    import rospy
    from std_msgs.msg import Header, String
    rospy.init_node("hears")
    latched = rospy.Publisher("latched", String, queue_size=1, latch=True)
    latched.publish("once")
    rospy.Subscriber("heard", Header, lambda message: None)
    rospy.Subscriber("late", String, lambda message: None)
    rospy.spin()
"""
CLOCK = """
    import rospy
    from rosgraph_msgs.msg import Clock
    from std_msgs.msg import String
    rospy.init_node("clock")
    clock, said = rospy.Publisher("/clock", Clock, queue_size=1), rospy.Publisher("/said", String, queue_size=1)
    import time
    said.publish("too early")
    for i in range(5):
        clock.publish(rospy.Time(700 + i))
        said.publish("at %d" % i)
        time.sleep(0.1)
    rospy.spin()
"""
SENDS = """
    from cfepy.app import Cfe

    def SENDS_Main(cfe: Cfe) -> None:
        cfe.es.wait_for_startup_sync(10_000)
        cfe.es.run_loop()
        header = bytes.fromhex("0950 c000 0000 0000 0000 0000 0000 0000")
        cfe.sb.transmit_msg(header + (2).to_bytes(4, "little") + b"up")
        cfe.sb.transmit_msg(bytes.fromhex("0951 c000 0000 0000 0000 0000 0000 0000 0102"))
"""
RAW = """
    import rospy
    from std_msgs.msg import String, UInt8MultiArray
    rospy.init_node("raw")
    rospy.Subscriber("/app", String, lambda message: None)
    rospy.Subscriber("/raw", UInt8MultiArray, lambda message: None)
    rospy.spin()
"""


def fly(
    folder: Path,
    scripts: Mapping[str, str],
    bag: str | None,
    *,
    patterns: Sequence[str] = (),
    tasks: str = "thread",
    seconds: float = 2.0,
    topics: Mapping[str, TopicConfig] | None = None,
    params: Mapping[str, Any] | None = None,
    ended: Callable[[str], object] = lambda digest: None,
) -> str:
    """Fly a mission of nodes, and record it if a bag is given.

    Returns the digest of the trace, which `ended` gets before.
    """
    lines = []
    for name, code in scripts.items():
        (folder / f"{name.lower()}.py").write_text(textwrap.dedent(code), encoding="utf-8")
        symbol = f"{name}_Main" if "_Main(" in code else "__main__"
        lines.append(f"CFE_APP, {name.lower()}.py, {symbol}, {name}, 100, 16384, 0x0, 0;\n")
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    ros = RosConfig({}, topics or {}, params or {})
    spec = MissionSpec("test", folder, folder / "startup.scr", None, "linux", ros)
    console = Console(quiet=True)
    if bag is None:
        with Mission(spec, tasks=tasks, console=console) as mission:
            mission.run_for(seconds)
            return mission.trace.digest()
    with (
        recorder_of(bag, patterns) as recorder,
        Mission(spec, tasks=tasks, console=console, attachments=[recorder]) as mission,
    ):
        mission.run_for(seconds)
        ended(mission.trace.digest())
        return mission.trace.digest()


def read(bag: Path) -> list[tuple[str, bytes, int]]:
    """Topic, bytes, and ms since the first message."""
    with BagReader(str(bag)) as reader:
        return [(each.topic, each.data, each.at_ns // 1_000_000) for each in reader.messages()]


def test_all_published_messages_are_recorded(tmp_path: Path) -> None:
    bag = tmp_path / "run.bag"
    fly(tmp_path, {"HEARS": HEARS, "TALKS": TALKS}, str(bag))
    found = read(bag)
    assert is_bag(str(bag))
    assert [data[4:] for topic, data, _ in found if topic == "/alone"] == [b"m0", b"m1", b"m2", b"m3", b"m4"]
    assert [data[4:] for topic, data, _ in found if topic == "/latched"] == [b"once"]
    heard = [(len(data), at) for topic, data, at in found if topic == "/heard"]
    assert [size for size, _ in heard] == [21, 21, 21, 100_016, 21]
    times = [at for topic, _, at in found if topic == "/alone"]
    assert [at - times[0] for at in times] == [0, 100, 200, 300, 400]
    with BagReader(str(bag)) as reader:
        headers = {each.topic: each.header for each in reader.connections}
    assert headers["/latched"]["latching"] == b"1"
    assert headers["/alone"]["callerid"] == b"/talks"
    assert headers["/alone"]["type"] == b"std_msgs/String"


def test_recording_does_not_change_the_run_and_bags_are_equal(tmp_path: Path) -> None:
    scripts = {"HEARS": HEARS, "TALKS": TALKS}
    bags = [tmp_path / f"{number}.bag" for number in range(3)]
    digests = [
        fly(tmp_path, scripts, str(bag), tasks=tasks)
        for bag, tasks in zip(bags, ("thread", "thread", "greenlet"), strict=True)
    ]
    assert {*digests, fly(tmp_path, scripts, None)} == {digests[0]}
    assert len({bag.read_bytes() for bag in bags}) == 1


@pytest.mark.parametrize("chunk", [1000, 1_000_000], ids=["on the way", "at the end"])
def test_full_disk_is_reported_at_the_end_and_does_not_change_the_run(
    chunk: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cfepy.ground.bag.CHUNK_BYTES", chunk)
    without = fly(tmp_path, {"HEARS": HEARS, "TALKS": TALKS}, None)
    bag, flown = tmp_path / "run.bag", []
    with room_for(20_000), pytest.raises(UsageError, match="--bag: could not be written: "):
        fly(tmp_path, {"HEARS": HEARS, "TALKS": TALKS}, str(bag), ended=flown.append)
    assert flown == [without]


def test_selected_topics_are_recorded(tmp_path: Path) -> None:
    bag = tmp_path / "run.bag"
    fly(tmp_path, {"HEARS": HEARS, "TALKS": TALKS}, str(bag), patterns=["/alo*", "/latched"])
    assert {topic for topic, _, _ in read(bag)} == {"/alone", "/latched"}


def test_simulated_time_is_the_time_of_the_bag(tmp_path: Path) -> None:
    bag = tmp_path / "run.bag"
    fly(tmp_path, {"CLOCK": CLOCK}, str(bag), patterns=["/said"], params={"use_sim_time": True})
    with BagReader(str(bag)) as reader:
        found = [(each.data[4:], each.stamp_ns) for each in reader.messages()]
    assert found == [(b"at %d" % i, (700 + i) * 1_000_000_000) for i in range(5)]


def test_packets_of_applications_are_recorded(tmp_path: Path) -> None:
    bag = tmp_path / "run.bag"
    topics = {"/app": TopicConfig("/app", 0x0950), "/raw": TopicConfig("/raw", 0x0951, raw=True)}
    fly(tmp_path, {"RAW": RAW, "SENDS": SENDS}, str(bag), topics=topics, patterns=["/app", "/raw"])
    found = {topic: data for topic, data, _ in read(bag)}
    assert found["/app"] == b"\x02\0\0\0up"
    assert found["/raw"][-18:][:2] == b"\x09\x51"  # the whole packet is the data
    assert found["/raw"].endswith(b"\x01\x02")
    with BagReader(str(bag)) as reader:
        headers = {each.topic: each.header for each in reader.connections}
    assert headers["/app"]["callerid"] == b"/SENDS"
    assert headers["/raw"]["type"] == b"std_msgs/UInt8MultiArray"


def test_unusable_bag_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="could not be written"):
        BagRecorder(str(tmp_path / "no" / "such.bag"))
    with pytest.raises(UsageError, match="could not be read"):
        BagReader(str(tmp_path / "none.bag"))
    (tmp_path / "text.bag").write_text("hello\n", encoding="utf-8")
    with pytest.raises(UsageError, match="does not appear to be a bag"):
        BagReader(str(tmp_path / "text.bag"))
    assert not is_bag(str(tmp_path / "text.bag"))
    assert not is_bag(str(tmp_path / "none.bag"))
    with BagRecorder(str(tmp_path / "cut.bag")):
        pass
    with (tmp_path / "cut.bag").open("r+b") as file:
        file.seek(13 + 4 + 8 + 4 + 10)
        file.write(bytes(8))
    with pytest.raises(UsageError, match="Unindexed bag; rosbag reindex makes an index"):
        BagReader(str(tmp_path / "cut.bag"))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small bag."""
    folder = tmp_path_factory.mktemp("bag")
    fly(folder, {"HEARS": HEARS, "TALKS": TALKS}, str(folder / "run.bag"), patterns=["/alone", "/latched"])
    return folder / "run.bag"


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 255)), min_size=1, max_size=5))
def test_a_broken_bag_is_read_or_named(whole: Path, changes: list[tuple[float, int]]) -> None:
    data = bytearray(whole.read_bytes())
    for where, byte in changes:
        data[int(where * len(data))] = byte
    broken = whole.with_name("broken.bag")
    broken.write_bytes(data)
    with contextlib.suppress(UsageError):  # anything else is a fault of ours
        read(broken)


def test_messages_of_external_nodes_are_recorded_with_their_names(tmp_path: Path) -> None:
    """Two publishers outside of one topic: each message has the header of its own."""
    (tmp_path / "hears.py").write_text(textwrap.dedent(HEARS), encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, hears.py, __main__, HEARS, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    spec = MissionSpec("test", tmp_path, tmp_path / "startup.scr", None, "linux", RosConfig({}, {}, {}))
    string, bag = message_class("std_msgs/String"), tmp_path / "run.bag"
    with (
        recorder_of(str(bag)) as recorder,
        Mission(spec, console=Console(quiet=True), attachments=[recorder]) as mission,
    ):
        mission.run_for(1)
        act = mission.outside.act
        for name in ("/one", "/two"):
            act("ros", "publish", "/late", name, "", string._type, string._md5sum, string._full_text, False)
        mission.run_for(1)
        for name in ("/two", "/one"):
            assert act("ros", "message", "/late", name, string(name).__pack__())
            mission.run_for(0.1)
    with BagReader(str(bag)) as reader:
        found = [(each.header["callerid"], each.data[4:].decode()) for each in reader.messages(["/late"])]
    assert found == [("/two", "/two"), ("/one", "/one")]
