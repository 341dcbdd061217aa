"""A bag or an MCAP file played into a mission with the options of `rosbag play`, and the same run twice."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from cfepy.cli.main import main, parser_for
from cfepy.cli.options import plan_of
from cfepy.ground.bag import BagReader, storage
from cfepy.ground.mcap_writer import McapWriter
from cfepy.pilot import NODE, RunPlan, fly
from cfepy.status import UsageError
from cfepy.writing.console import Console
from rospy_shim.types.msgs import message_class

HEARS = """
import rospy
from std_msgs.msg import String

rospy.init_node("hears")


def take(message, topic):
    print("heard %s %s at %.1f" % (topic, message.data, rospy.get_time() % 1000))


for topic in ("/said", "/there", "/other"):
    rospy.Subscriber(topic, String, take, topic)
rospy.spin()
"""
SECOND = 1_000_000_000


def recording(folder: Path, suffix: str) -> Path:
    """Ten messages a second on /said for 2 s, and one a second on /other."""
    file = folder / f"drive{suffix}"
    kind = message_class("std_msgs/String")
    about = {"type": "std_msgs/String", "md5sum": kind._md5sum, "message_definition": kind._full_text}
    messages = [("/said", (100 + tenth / 10), b"%d" % tenth) for tenth in range(21)]
    messages += [("/other", 100.05 + second, b"o%d" % second) for second in range(2)]
    headers = {topic: {"callerid": "/robot", "latching": "0", "topic": topic, **about} for topic in ("/said", "/other")}
    with file.open("w+b") as stream:
        bag = storage().BagFile(stream)
        connections = {topic: storage().Connection(0, topic, header) for topic, header in headers.items()}
        if suffix == ".bag":
            bag.create()
            numbers = {topic: bag.connect(topic, header) for topic, header in headers.items()}
            out = bag
        else:
            out = McapWriter(stream, "zstd")
            numbers = {topic: out.channel(storage().channel_of_connection(each)) for topic, each in connections.items()}
        for topic, at, text in sorted(messages, key=lambda message: message[1]):
            out.write(numbers[topic], round(at * SECOND), len(text).to_bytes(4, "little") + text)
        out.finish()
    return file


def played(node: Path, bag: str, options: str | None = None, tasks: str = "thread") -> tuple[list[str], str]:
    """Return the lines of the console of a run into which a recording is played, and the digest."""
    node.write_text(HEARS, encoding="utf-8")
    lines: list[str] = []
    plan = RunPlan((str(node),), NODE, seconds=4, tasks=tasks, play=bag, play_options=options)
    flown = fly(plan, console=Console(sink=lines.append))
    return [line.rstrip() for line in lines], flown.mission.trace.digest()


def heard(folder: Path, options: str | None, *, suffix: str = ".mcap", tasks: str = "thread") -> tuple[list[str], str]:
    """Return the messages that a node received from a played recording, and the digest of the run."""
    lines, digest = played(folder / "hears.py", str(recording(folder, suffix)), options, tasks)
    return [line.split("heard ")[1] for line in lines if "heard " in line], digest


@pytest.mark.parametrize("suffix", [".bag", ".mcap"])
def test_play_options_match_rosbag_play(suffix: str, tmp_path: Path) -> None:
    found, _ = heard(tmp_path, "--rate 2 --start 0.5 --duration 1 --topics /said /said:=/there", suffix=suffix)
    words = [line.split() for line in found]
    assert [(topic, text) for topic, text, *_ in words] == [("/there", str(each)) for each in range(5, 16)]
    times = [float(at) for *_, at in words]
    assert 0.4 <= times[-1] - times[0] <= 0.6


def test_all_messages_are_played_without_options(tmp_path: Path) -> None:
    found, _ = heard(tmp_path, None)
    assert [line.split()[1] for line in found if line.startswith("/other")] == ["o0", "o1"]
    assert len(found) == 23


def test_played_run_is_the_same_on_threads_and_greenlets(tmp_path: Path) -> None:
    runs = [heard(tmp_path, "--rate 3", tasks=tasks) for tasks in ("thread", "thread", "greenlet")]
    assert runs[0] == runs[1] == runs[2]


@pytest.mark.parametrize("suffix", [".bag", ".mcap"])
def test_played_run_does_not_depend_on_the_folder_of_the_recording(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    near, far = tmp_path / "a", tmp_path / "another" / "folder"
    for folder in (near, far):
        folder.mkdir(parents=True)
        recording(folder, suffix)
    node = tmp_path / "hears.py"
    runs = [played(node, str(folder / f"drive{suffix}")) for folder in (near, far)]
    monkeypatch.chdir(far)
    runs.append(played(node, f"drive{suffix}"))
    assert runs[0] == runs[1] == runs[2]
    assert any(line.endswith(f"Opening drive{suffix}") for line in runs[0][0])
    assert any("heard /said" in line for line in runs[0][0])


def test_recording_named_like_an_option_is_played(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    recording(tmp_path, ".bag").rename("--loop")
    lines, _ = played(tmp_path / "hears.py", "--loop")
    assert len([line for line in lines if "heard " in line]) == 23


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("--rate 0", "must be more than 0"),
        ("--rate", "expected one argument"),
        ("--no-such", "unrecognized arguments: --no-such"),
        ("more.bag", "unexpected more.bag; name the bag with --play"),
        ("--topics '/a", "No closing quotation"),
    ],
)
def test_invalid_play_options_are_refused(options: str, why: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=f"--play-options: .*{why}"):
        heard(tmp_path, options)


@pytest.mark.slow
def test_packets_of_a_raw_topic_are_played_unchanged(tmp_path: Path) -> None:
    bag, topic = tmp_path / "packets.bag", "/cfe/hk/combined_pkt1"
    assert main(["run", "capture", "--for", "4", "--quiet", "--bag", str(bag), "--bag-topics", topic]) == 0
    with BagReader(str(bag)) as reader:
        recorded = sum(1 for _ in reader.messages())
    assert recorded
    sent = []
    for play in (None, str(bag)):
        results = fly(RunPlan(("capture",), seconds=5, play=play), console=Console(sink=lambda line: None)).results
        assert not any(app.deaths for app in results.apps)
        sent.append(next(each.sent for each in results.topics if each.name == topic))
    assert sent[1] == sent[0] + recorded


def test_play_options_require_a_bag(tmp_path: Path) -> None:
    (tmp_path / "hears.py").write_text(HEARS, encoding="utf-8")
    with pytest.raises(UsageError, match="requires --play FILE"):
        RunPlan((str(tmp_path / "hears.py"),), NODE, play_options="--rate 2").spec()


def test_command_line_has_the_play_options() -> None:
    plan = RunPlan(("capture",), play="my drive.bag", play_options="--rate 2 /a:=/b")
    words = shlex.split(plan.command_line())[1:]
    said = parser_for(words).parse_args(words)
    assert plan_of(said, ["capture"]) == plan
    assert RunPlan.from_dict(plan.to_dict()) == plan
