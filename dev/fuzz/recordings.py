"""Recordings to damage: the same messages in each format and compression, and their positions in the file."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from mcap.records import Chunk
from mcap.records import Message as McapMessage
from mcap.stream_reader import StreamReader, breakup_chunk
from rosbags.rosbag1 import Reader

from cfepy.ground.bag import BagReader, storage
from cfepy.ground.recording import KINDS, rewrite
from rospy_shim.types.msgs import message_class

SECOND = 1_000_000_000
COUNT = 200
FORMATS = [(suffix, kind) for suffix, kinds in KINDS.items() for kind in kinds]
Message = tuple[str, bytes, int]


@cache
def written(folder: Path, suffix: str, kind: str) -> Path:
    """Return a recording in five chunks or so: COUNT messages on each of two topics."""
    bag = folder / "made.bag"
    about = message_class("std_msgs/String")
    header = {"type": "std_msgs/String", "md5sum": about._md5sum, "message_definition": about._full_text}
    with bag.open("w+b") as stream:
        out = storage().BagFile(stream)
        out.create()
        said = [out.connect(f"/{name}", {"callerid": f"/{name}er", "latching": "1", **header}) for name in "ab"]
        for number in range(COUNT):
            for each in said:
                text = b"%s %d %s" % (each.topic.encode(), number, bytes([65 + number % 26]) * 20)
                size = out.write(each, SECOND * (100 + number), len(text).to_bytes(4, "little") + text)
            if size > 6000:
                out.flush()
        out.finish()
    return converted(bag, folder / f"{kind}{suffix}", kind)


def converted(source: Path, target: Path, kind: str) -> Path:
    """Convert a recording with small chunks, so that damage affects some of them and not all. Returns the new file."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("cfepy.ground.recording.CHUNK_BYTES", 6000)
        patch.setattr("cfepy.ground.mcap_writer.CHUNK_BYTES", 6000)
        rewrite(str(source), str(target), kind, strict=True)
    return target


def read(file: Path) -> list[Message]:
    """Return the messages, by time."""
    with BagReader(str(file)) as reader:
        return [(each.topic, each.data, each.stamp_ns or 0) for each in reader.messages()]


def ends(file: Path) -> list[int]:
    """Return where the messages of a file end that is not packed."""
    whole, at, found = file.read_bytes(), 0, []
    for message in read(file):
        at = whole.index(message[1], at) + len(message[1])
        found.append(at)
    return found


class PlacedChunk(NamedTuple):
    """Where a chunk ends in a file, and how many messages it and those before it have."""

    end: int
    messages: int


def placed_chunks(file: Path) -> list[PlacedChunk]:
    """Return the chunks of a recording, as the libraries rosbags and mcap know them."""
    data, counts = file.read_bytes(), []
    if file.suffix == ".mcap":
        with file.open("rb") as stream:
            for each in StreamReader(stream, emit_chunks=True).records:
                if isinstance(each, Chunk):
                    end = data.index(each.data) + len(each.data)
                    counts.append((end, sum(isinstance(inner, McapMessage) for inner in breakup_chunk(each))))
    else:
        with Reader(file) as reader:
            for at, chunk in sorted((each.pos, each) for each in reader.chunk_infos):
                data_at = at + 4 + int.from_bytes(data[at : at + 4], "little")
                end = data_at + 4 + int.from_bytes(data[data_at : data_at + 4], "little")
                counts.append((end, sum(chunk.connection_counts.values())))
    return [PlacedChunk(end, sum(count for _, count in counts[: number + 1])) for number, (end, _) in enumerate(counts)]


def placed_messages(file: Path) -> list[tuple[int, Message]]:
    """Return the messages of a recording, each with the end position of its bytes or of its compressed chunk."""
    said, chunks = read(file), placed_chunks(file)
    if file.name.startswith("none."):
        return list(zip(ends(file), said, strict=True))
    places = (next(each.end for each in chunks if each.messages > number) for number in range(len(said)))
    return list(zip(places, said, strict=True))
