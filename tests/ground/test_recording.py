"""Recordings as a whole: their content, the recovery of damaged ones, and conversion between formats."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from rosbags.rosbag1 import Reader

from cfepy.ground.bag import BagReader, storage
from cfepy.ground.mcap_writer import McapWriter
from cfepy.ground.recording import KINDS, rewrite, summary_of
from cfepy.status import UsageError
from dev.fuzz.bit_flips import flips_of
from dev.fuzz.recordings import COUNT, FORMATS, SECOND, converted, ends, placed_chunks, read, written
from rospy_shim.types.msgs import message_class

DATA = Path(__file__).parents[1] / "data" / "bags"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recordings")


def headers(file: Path) -> list[tuple[str, dict[str, Any]]]:
    with BagReader(str(file)) as reader:
        return [(each.topic, dict(each.header)) for each in reader.connections]


def as_bytes(found: list[tuple[str, dict[str, Any]]]) -> list[tuple[str, dict[str, bytes]]]:
    def plain(value: Any) -> bytes:
        return value.encode() if isinstance(value, str) else bytes(value)

    return [
        (topic, {name: plain(value) for name, value in sorted(header.items()) if name != "topic"})
        for topic, header in found
    ]


# -- conversions -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("suffix", "kind"), FORMATS)
def test_conversion_is_lossless(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    there = written(folder, suffix, kind)
    back = converted(there, tmp_path / "back.bag", "none")
    made = folder / "made.bag"
    assert read(made) == read(there) == read(back)
    assert as_bytes(headers(made)) == as_bytes(headers(there)) == as_bytes(headers(back))
    found = summary_of(str(there))
    assert found.is_whole
    assert found.messages == 2 * COUNT
    assert set(found.chunks) == {kind}
    assert sum(found.chunks.values()) > 3


@pytest.mark.parametrize("name", ["golden.bag", "golden_api_bz2.bag", "golden_api_lz4.bag", "golden_api_none.bag"])
def test_ros_bags_survive_conversion_to_mcap_and_back(name: str, tmp_path: Path) -> None:
    rewrite(str(DATA / name), str(tmp_path / "there.mcap"), "zstd", strict=True)
    rewrite(str(tmp_path / "there.mcap"), str(tmp_path / "back.bag"), strict=True)
    assert read(tmp_path / "there.mcap") == read(tmp_path / "back.bag") == read(DATA / name)
    heads = [as_bytes(headers(file)) for file in (DATA / name, tmp_path / "there.mcap", tmp_path / "back.bag")]
    assert heads[0] == heads[1] == heads[2]


@pytest.mark.parametrize("kind", KINDS[".mcap"])
def test_mcap_library_reads_written_files(kind: str, folder: Path) -> None:
    file = written(folder, ".mcap", kind)
    with file.open("rb") as stream:
        found = [
            (channel.topic, message.data, message.log_time)
            for _, channel, message in make_reader(stream, validate_crcs=True).iter_messages()
        ]
    assert found == read(file)


def test_rosbags_library_reads_converted_files(folder: Path, tmp_path: Path) -> None:
    back = converted(written(folder, ".mcap", "lz4"), tmp_path / "back.bag", "lz4")
    with Reader(back) as reader:
        found = [(connection.topic, bytes(data), time) for connection, time, data in reader.messages()]
    assert found == read(folder / "made.bag")


def test_data_without_a_ros_topic_is_dropped_in_a_bag_and_kept_in_an_mcap_file(tmp_path: Path) -> None:
    library = storage()
    source = tmp_path / "run.mcap"
    with source.open("wb") as stream:
        out = McapWriter(stream)
        out.metadata("cfepy", {"command": "cfepy run lab"})
        out.attachment(7, 8, "notes.txt", "text/plain", b"hello")
        schema = library.McapSchema("cfe.HK", "jsonschema", b"{}")
        number = out.channel(library.RecordedChannel(0, "/cfe/HK", "json", schema, {"msg_id": "0x0883"}))
        for at in range(3):
            out.write(number, at, b'{"a":%d}' % at, at + 1, at + 2)
        out.finish()
    found = rewrite(str(source), str(tmp_path / "run.bag"), strict=True)
    assert [(each.topic, each.left_out) for each in found.topics] == [("/cfe/HK", 3)]
    assert read(tmp_path / "run.bag") == []
    rewrite(str(source), str(tmp_path / "other.mcap"), "zstd", strict=True)
    with (tmp_path / "other.mcap").open("rb") as stream:
        reader = make_reader(stream)
        assert [each.metadata for each in reader.iter_metadata()] == [{"command": "cfepy run lab"}]
        assert [(each.name, each.data) for each in reader.iter_attachments()] == [("notes.txt", b"hello")]
        messages = [(m.log_time, m.publish_time, m.sequence, m.data) for _, _, m in reader.iter_messages()]
    assert messages == [(at, at + 1, at + 2, b'{"a":%d}' % at) for at in range(3)]


def test_file_can_be_rewritten_in_place(folder: Path, tmp_path: Path) -> None:
    file = tmp_path / "run.mcap"
    file.write_bytes(written(folder, ".mcap", "zstd").read_bytes())
    before = read(file)
    rewrite(str(file), str(file), "none", strict=True)
    assert read(file) == before
    assert list(tmp_path.iterdir()) == [file]


def test_missing_md5sum_is_computed_from_the_definition(tmp_path: Path) -> None:
    library, file = storage(), tmp_path / "other.mcap"
    names = (
        "std_msgs/String",
        "sensor_msgs/JointState",
        "rosgraph_msgs/Log",
        "nav_msgs/Odometry",
        "tf2_msgs/TFMessage",
    )
    about = {name: message_class(name) for name in names}
    with file.open("wb") as stream:
        out = McapWriter(stream)
        for at, (name, kind) in enumerate(about.items()):
            schema = library.McapSchema(name, "ros1msg", kind._full_text.encode())
            out.write(out.channel(library.RecordedChannel(0, f"/t{at}", "ros1", schema)), at, b"")
        broken = library.McapSchema("a/B", "ros1msg", b"B b\nC c")
        out.write(out.channel(library.RecordedChannel(0, "/broken", "ros1", broken)), 9, b"")
        out.finish()
    with BagReader(str(file)) as reader:
        found = [each.md5sum for each in reader.connections]
    assert found == [*(kind._md5sum for kind in about.values()), "*"]


# -- damage ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("suffix", "kind"), FORMATS)
def test_truncated_file_keeps_earlier_messages(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, kind)
    whole, cut = file.read_bytes(), tmp_path / f"cut{suffix}"
    before = 0
    for share in (0.4, 0.6, 0.8, 0.95):
        cut.write_bytes(whole[: int(len(whole) * share)])
        with pytest.raises(UsageError):
            rewrite(str(cut), str(tmp_path / "no.bag"), strict=True)
        assert not (tmp_path / "no.bag").exists()
        found = rewrite(str(cut), str(tmp_path / f"left{suffix}"))
        assert not found.finished
        left = read(tmp_path / f"left{suffix}")
        assert left == read(file)[: len(left)]
        assert len(left) == found.messages >= before
        before = found.messages
    assert before > COUNT


def left_of(data: bytes, copy: Path) -> int:
    """Return how many messages are left of damaged data."""
    copy.write_bytes(data)
    found: int = summary_of(str(copy)).to_dict()["messages"]
    return found


NOT_PACKED = pytest.mark.parametrize("suffix", [".bag", ".mcap"])


@NOT_PACKED
def test_complete_message_before_the_cut_is_kept(suffix: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, "none")
    whole, places = file.read_bytes(), ends(file)
    for cut in range(places[150], places[151] + 1):
        before = sum(end <= cut for end in places)
        assert left_of(whole[:cut], tmp_path / f"cut{suffix}") == before, cut - places[150]


@pytest.mark.slow
@NOT_PACKED
def test_truncated_file_keeps_all_complete_messages(suffix: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, "none")
    whole, places = file.read_bytes(), ends(file)
    cut_off, left = tmp_path / f"cut{suffix}", tmp_path / f"left{suffix}"
    for cut in range(64, len(whole), 64):
        before = sum(end <= cut for end in places)
        assert left_of(whole[:cut], cut_off) == before, cut
        if before:
            rewrite(str(cut_off), str(left))
            assert read(left) == read(file)[:before]


PACKED = pytest.mark.parametrize(("suffix", "kind"), [each for each in FORMATS if each[1] != "none"])


def look_at_cuts(suffix: str, kind: str, folder: Path, tmp_path: Path, step: int) -> None:
    """Of a packed file that is cut off, at least the chunks that are whole are left, and nothing that never was."""
    file = written(folder, suffix, kind)
    whole, chunks, said = file.read_bytes(), placed_chunks(file), read(file)
    assert chunks[-1].messages == len(said) == 2 * COUNT
    cut_off, left = tmp_path / f"cut{suffix}", tmp_path / f"left{suffix}"
    for cut in range(chunks[0].end, len(whole), step):
        before = max(each.messages for each in chunks if each.end <= cut)
        cut_off.write_bytes(whole[:cut])
        rewrite(str(cut_off), str(left))
        found = read(left)
        assert before <= len(found), cut
        assert found == said[: len(found)], cut


@PACKED
def test_truncated_compressed_file_keeps_complete_chunks(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    look_at_cuts(suffix, kind, folder, tmp_path, 997)


@pytest.mark.slow
@PACKED
def test_compressed_file_truncated_anywhere_keeps_complete_chunks(
    suffix: str, kind: str, folder: Path, tmp_path: Path
) -> None:
    look_at_cuts(suffix, kind, folder, tmp_path, 16)


@pytest.mark.parametrize(
    ("suffix", "kind", "block"),
    [(".bag", "lz4", 0), (".mcap", "lz4", 0), (".mcap", "zstd", 128 << 10), (".bag", "bz2", 900_000)],
)
def test_truncated_large_chunk_keeps_its_beginning(
    suffix: str, kind: str, block: int, folder: Path, tmp_path: Path
) -> None:
    """All that is there, but for the last block of a kind that is unpacked by blocks."""
    large, size, draw = tmp_path / "large.bag", 1000, random.Random(5)
    with large.open("w+b") as stream, BagReader(str(written(folder, ".bag", "none"))) as reader:
        out = storage().BagFile(stream)
        out.create()
        said = out.connect("/a", dict(next(iter(reader.connections)).header))
        for number in range(700):
            text = bytes(draw.choices(b"abcdefgh", k=size))
            out.write(said, SECOND * (100 + number), size.to_bytes(4, "little") + text)
        out.finish()
    packed = tmp_path / f"packed{suffix}"
    rewrite(str(large), str(packed), kind, strict=True)
    ((end, count),) = placed_chunks(packed)
    assert count == 700
    for share in (0.3, 0.6, 0.9):
        cut = tmp_path / f"cut{suffix}"
        cut.write_bytes(packed.read_bytes()[: int(end * share)])
        found = summary_of(str(cut))
        assert found.messages >= int((share - 0.05) * 700 - block / size)
        assert found.messages <= share * 700 + 1
        assert not found.doubtful
        if found.messages:
            rewrite(str(cut), str(tmp_path / "left.bag"))
            assert read(tmp_path / "left.bag") == read(large)[: found.messages]


@NOT_PACKED
def test_damaged_bit_in_a_message_loses_no_other_message(suffix: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, "none")
    places, draw = ends(file), random.Random(3)
    spots = range(places[150], places[151])
    for spot in draw.sample(spots, 25):
        damaged = bytearray(file.read_bytes())
        damaged[spot] ^= 1 << draw.randrange(8)
        assert left_of(bytes(damaged), tmp_path / f"damaged{suffix}") >= 2 * COUNT - 1, spot - places[150]


@pytest.mark.slow
@NOT_PACKED
def test_bit_flip_in_a_message_does_not_affect_others(suffix: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, "none")
    places = ends(file)
    for spot in range(places[150], places[151]):
        for bit in range(8):
            damaged = bytearray(file.read_bytes())
            damaged[spot] ^= 1 << bit
            assert left_of(bytes(damaged), tmp_path / f"damaged{suffix}") >= 2 * COUNT - 1, (spot - places[150], bit)


@pytest.mark.parametrize("suffix", [".bag", ".mcap"])
@pytest.mark.parametrize("part", ["a message", "its length", "the length of a chunk"])
def test_damaged_part_is_lost_and_reported_and_all_else_kept(
    part: str, suffix: str, folder: Path, tmp_path: Path
) -> None:
    file = written(folder, suffix, "none")
    data = bytearray(file.read_bytes())
    text = data.index(b"/a 77 ")
    if part == "a message":
        data[text] ^= 0x20
    elif part == "its length":
        if suffix == ".bag":
            data[text - 7] ^= 0x40
        else:
            data[text - 4 - 22 - 7] ^= 0x40
    elif suffix == ".bag":
        chunk = data.rindex(b"op=\x05", 0, text)
        end = data.index(b"size=", chunk) + 9
        data[end + 1] ^= 0x02
    else:
        chunk = max(each.chunk_start_offset for each in chunks_of(file) if each.chunk_start_offset < text)
        data[chunk + 2] ^= 0x02
    (tmp_path / f"bad{suffix}").write_bytes(data)
    found = rewrite(str(tmp_path / f"bad{suffix}"), str(tmp_path / f"left{suffix}"))
    left = read(tmp_path / f"left{suffix}")
    missing = Counter(read(file)) - Counter(left)
    assert sum(missing.values()) <= 1, part
    assert sum(each.lost or 0 for each in found.topics) == 2 * COUNT - len(left)
    if suffix == ".mcap" or part != "a message":  # a bag has no checksum
        assert not found.is_whole
        assert any("at byte " in line for line in found.damage())


def chunks_of(file: Path) -> list[Any]:
    """Return the chunks of an MCAP file, as the library mcap knows them."""
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
        assert summary is not None
        return list(summary.chunk_indexes)


def damages(data: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Damaged copies of a file."""
    draw = random.Random(seed)

    def flip(found: bytearray) -> None:
        for _ in range(draw.choice((1, 1, 2, 20))):
            found[draw.randrange(len(found))] ^= 1 << draw.randrange(8)

    def cut(found: bytearray) -> None:
        del found[draw.randrange(len(found)) :]

    def span(found: bytearray) -> slice:
        at = draw.randrange(len(found))
        return slice(at, at + draw.choice((1, 4, 8, 100, 5000)))

    def drop(found: bytearray) -> None:
        del found[span(found)]

    def blank(found: bytearray) -> None:
        where = span(found)
        found[where] = bytes([draw.choice((0, 255))]) * len(found[where])

    def twice(found: bytearray) -> None:
        where = span(found)
        found[where.stop : where.stop] = found[where]

    def noise(found: bytearray) -> None:
        where = span(found)
        found[where] = draw.randbytes(len(found[where]))

    kinds: tuple[Callable[[bytearray], None], ...] = (flip, flip, cut, drop, blank, twice, noise)
    for _ in range(count):
        found = bytearray(data)
        for _ in range(draw.choice((1, 1, 1, 2, 4))):
            if found:
                draw.choice(kinds)(found)
        yield bytes(found)


def look_at_damage(file: Path, folder: Path, count: int, seed: int) -> list[int]:
    """Return how many messages remain of each damaged copy of a file. Only cfepy's own errors may occur."""
    bad, out, left = folder / f"bad{file.suffix}", folder / f"left{file.suffix}", []
    for number, data in enumerate(damages(file.read_bytes(), count, seed)):
        bad.write_bytes(data)
        errors: list[UsageError] = []
        try:
            read(bad)
        except UsageError as error:
            errors.append(error)
        try:
            found = rewrite(str(bad), str(out))
        except UsageError as error:
            errors.append(error)
            left.append(0)
            continue
        finally:
            assert all(str(bad) in str(each) for each in errors), (number, errors)
        assert summary_of(str(bad)).to_dict()["messages"] == found.messages
        assert list(found.damage()) or found.is_whole
        again = summary_of(str(out))
        assert again.is_whole, (number, list(again.damage()))
        left.append(again.messages)
        read(out)
    return left


@pytest.mark.parametrize(("suffix", "kind"), [(".bag", "none"), (".mcap", "zstd")])
def test_damage_is_reported_and_the_rest_is_read(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    look_at_damage(written(folder, suffix, kind), tmp_path, 1, seed=1)


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "kind"), FORMATS)
def test_heavy_damage_is_reported_and_the_rest_is_read(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    left = look_at_damage(written(folder, suffix, kind), tmp_path, 250, seed=7)
    assert sum(left) > 0.5 * len(left) * 2 * COUNT


@pytest.mark.parametrize(("suffix", "kind"), FORMATS)
def test_damaged_index_renames_no_topic(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    file = written(folder, suffix, kind)
    data, end = bytearray(file.read_bytes()), placed_chunks(file)[-1].end
    at = data.index(b"/a", data.index(b"topic=", end) if suffix == ".bag" else end)
    data[at + 1] ^= 2  # /c
    bad, left = tmp_path / f"bad{suffix}", tmp_path / f"left{suffix}"
    bad.write_bytes(data)
    rewrite(str(bad), str(left))
    assert read(left) == read(file)


@pytest.mark.slow
@NOT_PACKED
def test_damaged_record_after_a_message_does_not_lose_the_message(suffix: str, folder: Path, tmp_path: Path) -> None:
    """The message before the last one of a chunk, and the last one, which an index follows."""
    file = written(folder, suffix, "none")
    whole, places, last = file.read_bytes(), ends(file), placed_chunks(file)[1].messages - 1
    for spot in (*range(places[last - 1], places[last - 1] + 12), *range(places[last], places[last] + 12)):
        for bit in range(8):
            data = bytearray(whole)
            data[spot] ^= 1 << bit
            bad, left = tmp_path / f"bad{suffix}", tmp_path / f"left{suffix}"
            bad.write_bytes(data)
            rewrite(str(bad), str(left))
            before = Counter(read(file)[: sum(end <= spot for end in places)])
            assert not before - Counter(read(left)), (spot - places[last], bit)


@pytest.mark.parametrize("suffix", [".bag", ".mcap"])
def test_messages_of_an_lz4_chunk_with_a_wrong_checksum_are_kept_and_counted(
    suffix: str, folder: Path, tmp_path: Path
) -> None:
    file = written(folder, suffix, "lz4")
    first, second = placed_chunks(file)[:2]
    bad, whole, doubtful = tmp_path / f"bad{suffix}", file.read_bytes(), []
    for spot in range(second.end - 400, second.end - 100, 20):
        data = bytearray(whole)
        data[spot] ^= 4
        bad.write_bytes(data)
        found = summary_of(str(bad))
        assert found.doubtful <= second.messages - first.messages
        assert not found.is_whole
        doubtful.append(found.doubtful)
    assert max(doubtful) > 0.7 * (second.messages - first.messages)


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "kind"), FORMATS)
def test_flipped_bit_loses_nothing_before_it(suffix: str, kind: str, folder: Path, tmp_path: Path) -> None:
    found = flips_of(written(folder, suffix, kind), tmp_path, 300, seed=5)
    assert not found.failures
    assert found.messages > found.lost


def test_invalid_recording_is_refused(tmp_path: Path) -> None:
    (tmp_path / "text.txt").write_text("hello", encoding="utf-8")
    (tmp_path / "empty.bag").write_bytes(b"")
    (tmp_path / "noise.mcap").write_bytes(b"\x06" * 500)
    with pytest.raises(UsageError, match="is not a bag or an MCAP file"):
        summary_of(str(tmp_path / "text.txt"))
    with pytest.raises(UsageError, match="is empty"):
        summary_of(str(tmp_path / "empty.bag"))
    with pytest.raises(UsageError, match="could not be read"):
        summary_of(str(tmp_path / "none.bag"))
    with pytest.raises(UsageError, match="has no readable message"):
        rewrite(str(tmp_path / "noise.mcap"), str(tmp_path / "out.mcap"))
    with pytest.raises(UsageError, match="--output"):
        rewrite(str(tmp_path / "noise.mcap"), str(tmp_path / "out.zip"))
    with pytest.raises(UsageError, match=r"unknown compression zstd for a file \.bag; expected none, bz2 or lz4"):
        rewrite(str(tmp_path / "noise.mcap"), str(tmp_path / "out.bag"), "zstd")
