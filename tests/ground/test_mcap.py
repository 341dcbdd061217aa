"""A run recorded into an MCAP file: other readers find the same content as in the bag of the same run."""

from __future__ import annotations

import base64
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from mcap.reader import make_reader

from cfepy.ground.bag import BagReader, is_bag
from cfepy.ground.mcap_recorder import McapRecorder
from cfepy.status import UsageError
from tests.disk import room_for
from tests.ground.test_bag import CLOCK, HEARS, TALKS, fly

SCRIPTS = {"HEARS": HEARS, "TALKS": TALKS}
SECOND = 1_000_000_000


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the same run as run.bag, run.mcap and, on greenlets, again.mcap."""
    folder = tmp_path_factory.mktemp("mcap")
    digests = {
        fly(folder, SCRIPTS, str(folder / name), tasks=tasks)
        for name, tasks in (("run.bag", "thread"), ("run.mcap", "thread"), ("again.mcap", "greenlet"))
    }
    assert len(digests) == 1
    return folder


def peer(file: Path) -> Iterator[tuple[Any, Any, Any]]:
    """Yield the messages that the library mcap reads, with all checksums."""
    with file.open("rb") as stream:
        yield from make_reader(stream, validate_crcs=True).iter_messages(log_time_order=False)


def test_topics_equal_the_topics_of_the_bag(runs: Path) -> None:
    assert is_bag(str(runs / "run.mcap"))
    both = []
    for name in ("run.bag", "run.mcap"):
        with BagReader(str(runs / name)) as reader:
            headers = [each.header for each in reader.connections]
            assert all(header["md5sum"] != "*" for header in headers)
            both.append([(each.topic, each.header, each.data, each.stamp_ns) for each in reader.messages()])
    assert both[0] == both[1]
    assert len(both[0]) > 10


def test_mcap_library_reads_the_same_messages(runs: Path) -> None:
    found = [
        (channel.topic, message.data, message.log_time)
        for _, channel, message in peer(runs / "run.mcap")
        if channel.message_encoding == "ros1"
    ]
    with BagReader(str(runs / "run.bag")) as reader:
        assert sorted(found) == sorted((each.topic, each.data, each.stamp_ns) for each in reader.messages())


def test_equal_runs_give_equal_files(runs: Path) -> None:
    assert (runs / "run.mcap").read_bytes() == (runs / "again.mcap").read_bytes()


def test_packets_are_json_that_matches_their_schema(runs: Path) -> None:
    seen = set()
    for schema, channel, message in peer(runs / "run.mcap"):
        if channel.message_encoding == "json":
            values, described = json.loads(message.data), json.loads(schema.data)
            assert schema.encoding == "jsonschema"
            assert set(values) <= set(described["properties"])
            Draft202012Validator(described).validate(values)
            seen.add(channel.topic)
            if "_packet" in values:
                packet = base64.b64decode(values["_packet"])
                assert int(channel.metadata["msg_id"], 16) == values["_header"]["msg_id"] == packet[0] << 8 | packet[1]
                assert len(packet) == values["_header"]["length"]
    assert {"/cfe/CFE_EVS_LONG_EVENT_MSG", "/cfe/CFE_TIME_TONE_CMD", "/cfe/events"} <= seen


def test_events_have_the_schema_of_a_foxglove_log(runs: Path) -> None:
    logs = [json.loads(message.data) for schema, _, message in peer(runs / "run.mcap") if schema.name == "foxglove.Log"]
    assert logs[0]["name"] == "CFE_ES"
    assert logs[0]["line"] == 1
    assert logs[0]["level"] == 2
    assert logs[0]["message"].startswith("cFE ES Initialized")
    assert logs[0]["timestamp"]["nsec"] < SECOND


def test_selected_channels_are_recorded(tmp_path: Path) -> None:
    file = tmp_path / "run.mcap"
    fly(tmp_path, SCRIPTS, str(file), patterns=["/alone", "/cfe/CFE_TIME_*"])
    topics = {channel.topic for _, channel, _ in peer(file)}
    assert "/alone" in topics
    assert all(topic == "/alone" or topic.startswith("/cfe/CFE_TIME_") for topic in topics)
    assert len(topics) > 1


def test_nothing_is_recorded_before_the_first_time(tmp_path: Path) -> None:
    file = tmp_path / "run.mcap"
    fly(tmp_path, {"CLOCK": CLOCK}, str(file), params={"use_sim_time": True})
    times = [message.log_time for _, _, message in peer(file)]
    assert min(times) == 700 * SECOND


def test_flushed_messages_are_in_the_file_of_a_killed_run(tmp_path: Path) -> None:
    """A killed process leaves everything that was written before the digest was taken."""
    file = tmp_path / "run.mcap"
    left: list[bytes] = []
    fly(tmp_path, SCRIPTS, str(file), ended=lambda _: left.append(file.read_bytes()))
    (tmp_path / "killed.mcap").write_bytes(left[0])
    assert len(left[0]) > 1000
    with pytest.raises(UsageError, match=r"the recording was not finished.*cfepy rosbag recover"):
        BagReader(str(tmp_path / "killed.mcap"))


def test_full_disk_is_reported_at_the_end(tmp_path: Path) -> None:
    with room_for(20_000), pytest.raises(UsageError, match="--bag: could not be written: "):
        fly(tmp_path, SCRIPTS, str(tmp_path / "run.mcap"))


def test_missing_mcap_library_is_reported_before_the_file_is_touched(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mcap", None)
    (tmp_path / "old.mcap").write_bytes(b"an old recording")
    for name in ("old.mcap", "new.mcap"):
        with pytest.raises(UsageError, match="pip install 'cfepy\\[mcap\\]'"):
            McapRecorder(str(tmp_path / name))
    assert [each.name for each in tmp_path.iterdir()] == ["old.mcap"]
    assert (tmp_path / "old.mcap").read_bytes() == b"an old recording"
