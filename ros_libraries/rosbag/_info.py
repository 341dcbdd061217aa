"""Information about a bag: numbers, and the texts of `rosbag info`. Imports rosbag_storage and yaml."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from rosbag_storage import Chunk, Connection, ROSBagException, compression

from ._views import CompressionTuple, TopicTuple, TypesAndTopicsTuple

if TYPE_CHECKING:
    from .bag import Bag

NS_PER_S = 1_000_000_000


class Compression:
    """The compressions of chunks. LZ4 needs the package lz4."""

    NONE = compression.NONE
    BZ2 = compression.BZ2
    LZ4 = compression.LZ4


def check_options(kind: Any, chunk_threshold: int) -> None:
    """Check the options for writing a bag.

    Raises:
        ValueError: an option is invalid.
    """
    allowed, hint = [Compression.NONE, Compression.BZ2, Compression.LZ4], ""
    if kind == Compression.LZ4:
        try:
            import roslz4  # noqa: F401
        except ImportError as error:
            allowed, hint = allowed[:-1], f" ({error})"
    if kind not in allowed:
        raise ValueError(f"compression must be one of: {', '.join(allowed)}{hint}")
    if chunk_threshold < 0:
        raise ValueError("chunk_threshold must be greater than or equal to zero")


# -- numbers -----------------------------------------------------------------------------------------------------------


def seconds(ns: int) -> float:
    """Return a time in s, with the rounding of `Time.to_sec`."""
    return ns // NS_PER_S + (ns % NS_PER_S) / 1e9


def times_of(chunks: list[Chunk]) -> tuple[float, float]:
    """Return the start of the first chunk and the end of the last one in s, which need not be the earliest and latest.

    Raises:
        ROSBagException: there is no message.
    """
    if not chunks:
        raise ROSBagException("Bag contains no message")
    return seconds(chunks[0].start), seconds(chunks[-1].end)


def count(chunks: list[Chunk], connections: Iterable[Connection]) -> int:
    """Return how many messages connections have."""
    return sum(chunk.connection_counts.get(each.id, 0) for each in connections for chunk in chunks)


def compression_of(chunks: list[Chunk], default: str) -> CompressionTuple:
    """Return the compression of most chunks, or `default` without chunks."""
    uses = _uses(chunks)
    main = uses[0][1] if uses else default
    return CompressionTuple(main, sum(each.size for each in chunks), sum(each.stored_size for each in chunks))


def _uses(chunks: list[Chunk]) -> list[tuple[int, str]]:
    """Return how many chunks are compressed how, the most first."""
    kinds = [chunk.compression for chunk in chunks]
    return sorted(((kinds.count(kind), kind) for kind in dict.fromkeys(kinds)), reverse=True)


def types_and_topics(bag: Bag, topic_filters: str | list[str] | None = None) -> TypesAndTopicsTuple:
    """Return the result of `Bag.get_type_and_topic_info`. The types include all topics."""
    return _described(bag, bag.__storage__.contents.chunks, topic_filters)


def _described(bag: Bag, chunks: list[Chunk], topic_filters: str | list[str] | None = None) -> TypesAndTopicsTuple:
    """Return the same, with the messages of some chunks."""
    md5sums: dict[str, str] = {}
    for connection in bag._connections.values():
        md5sums.setdefault(connection.datatype, connection.md5sum)
    if topic_filters is None:
        wanted = [connection.topic for connection in bag._connections.values()]
    else:
        wanted = topic_filters if isinstance(topic_filters, list) else [topic_filters]
    rows = {topic: list(bag._get_connections(topic)) for topic in sorted(dict.fromkeys(wanted))}
    topics = {topic: _topic(bag, chunks, found) for topic, found in rows.items() if found}
    return TypesAndTopicsTuple(dict(sorted(md5sums.items())), topics)


def _topic(bag: Bag, chunks: list[Chunk], connections: list[Connection]) -> TopicTuple:
    messages = count(chunks, connections)
    return TopicTuple(connections[0].datatype, messages, len(connections), _frequency(bag, connections))


def _frequency(bag: Bag, connections: list[Connection]) -> float | None:
    """Return the frequency in Hz from the median period; None without the index, or with less than two messages."""
    if not bag._connection_indexes_read:
        return None
    stamps = [seconds(entry.time) for entry in bag.__storage__.contents.entries(connections)]
    periods = sorted(later - earlier for earlier, later in pairwise(stamps))
    if not periods:
        return None
    middle = len(periods) // 2
    median = periods[middle] if len(periods) % 2 else (periods[middle - 1] + periods[middle]) / 2
    return 1.0 / median if median > 0 else None


# -- texts -------------------------------------------------------------------------------------------------------------


def text_of(bag: Bag) -> str:
    """Return the output of `rosbag info`."""
    rows: list[tuple[str, str]] = [("path", str(bag.filename))] if bag.filename else []
    rows.append(("version", _version(bag)))
    chunks = bag.__all_chunks__()
    if chunks:
        rows += _time_rows(chunks)
    rows.append(("size", human_size(bag.size)))
    if chunks:
        rows.append(("messages", str(bag.get_message_count())))
        rows += _compression_rows(bag.__storage__.contents.chunks, *times_of(chunks))
        rows += _type_rows(bag)
    width = max(len(name) for name, _ in rows) + 1
    lines = (f"{name + ':' if name else '':<{width}} {value}" for name, value in rows)
    return "\n".join(lines).rstrip()


def _version(bag: Bag) -> str:
    return f"{bag.version // 100}.{bag.version % 100}"


def _time_rows(chunks: list[Chunk]) -> list[tuple[str, str]]:
    start, end = times_of(chunks)
    return [("duration", _duration(end - start)), ("start", _time_text(start)), ("end", _time_text(end))]


def _duration(length: float) -> str:
    minutes = int(length / 60)
    hours = minutes // 60
    if hours > 0:
        return f"{hours}hr {minutes % 60}:{int(length % 60):02d}s ({int(length)}s)"
    if minutes > 0:
        return f"{minutes}:{int(length % 60):02d}s ({int(length)}s)"
    return f"{length:.1f}s"


def _time_text(at: float) -> str:
    fraction = f"{at - int(at):.2f}"[1:]
    return f"{time.strftime('%b %d %Y %H:%M:%S', time.localtime(at))}{fraction} ({at:.2f})"


def _compression_rows(chunks: list[Chunk], start: float, end: float) -> list[tuple[str, str]]:
    if not chunks:
        return [("compression", "none")]
    uses = _uses(chunks)
    texts = []
    for uses_count, kind in uses:
        mine = [chunk for chunk in chunks if chunk.compression == kind]
        share = "" if kind == Compression.NONE else f"; {_percent(mine):.2f}%"
        texts.append(f"{kind} [{uses_count}/{len(chunks)} chunks{share}]")
    rows = [("compression", ", ".join(texts))]
    return rows if [kind for _, kind in uses] == [Compression.NONE] else [*rows, *_size_rows(chunks, end - start)]


def _percent(chunks: list[Chunk]) -> float:
    return 100.0 * sum(chunk.stored_size for chunk in chunks) / sum(chunk.size for chunk in chunks)


def _size_rows(chunks: list[Chunk], duration: float) -> list[tuple[str, str]]:
    sizes = [sum(chunk.size for chunk in chunks), sum(chunk.stored_size for chunk in chunks)]
    texts = _aligned([human_size(size) for size in sizes])
    if duration > 0:
        rates = _aligned([human_size(size / duration) for size in sizes])
        texts = [f"{text} @ {rate}/s" for text, rate in zip(texts, rates, strict=True)]
        texts[1] += f" ({_percent(chunks):.2f}%)"
    return [("uncompressed", texts[0]), ("compressed", texts[1])]


def _aligned(texts: list[str]) -> list[str]:
    width = max(len(text) for text in texts)
    return [text.rjust(width) for text in texts]


def _type_rows(bag: Bag) -> list[tuple[str, str]]:
    types, topics = _described(bag, bag.__all_chunks__())
    width = max(len(name) for name in types)
    rows = [("", f"{name:<{width}} [{md5sum}]") for name, md5sum in types.items()]
    rows[0] = ("types", rows[0][1])
    topic_rows = [("", text) for text in _topic_texts(topics, width)]
    topic_rows[0] = ("topics", topic_rows[0][1])
    return rows + topic_rows


def _topic_texts(topics: dict[str, TopicTuple], type_width: int) -> list[str]:
    name_width = max(len(name) for name in topics)
    count_width = max(len(str(topic.message_count)) for topic in topics.values())
    frequencies = {name: human_frequency(each.frequency) for name, each in topics.items() if each.frequency}
    frequency_width = max((len(text) for text in frequencies.values()), default=0)
    texts = []
    for name, topic in topics.items():
        unit = "msgs" if topic.message_count > 1 else "msg "
        sign = "@" if name in frequencies else " "
        text = f"{name:<{name_width}}   {topic.message_count:>{count_width}} {unit} {sign} "
        text += f"{frequencies.get(name, ''):>{frequency_width}} : {topic.msg_type:<{type_width}}"
        texts.append(text + (f" ({topic.connections} connections)" if topic.connections > 1 else ""))
    return texts


def human_size(size: float) -> str:
    """Return bytes as KB, MB, ..."""
    for unit in ("KB", "MB", "GB", "TB", "PB", "EB", "ZB", "YB"):
        size /= 1024.0
        if size < 1024.0:
            return f"{size:.1f} {unit}"
    return "-"


def human_frequency(frequency: float) -> str:
    """Hz as Hz, kHz, ..."""
    for unit in ("Hz", "kHz", "MHz", "GHz", "THz", "PHz", "EHz", "ZHz", "YHz"):
        if frequency < 1000.0:
            return f"{frequency:.1f} {unit}"
        frequency /= 1000.0
    return "-"


# -- as YAML -----------------------------------------------------------------------------------------------------------


def yaml_of(bag: Bag, key: str | None) -> Any:
    """Return the output of `rosbag info --yaml`.

    With a key such as "topics[0].type", return only that value or None.
    """
    text = _yaml(bag)
    if not key:
        return text
    import yaml

    value = yaml.safe_load(text)
    try:
        for part in key.replace("[", ".[").split("."):
            value = value[int(part.strip("[]"))] if part.startswith("[") else value[part]
    except (KeyError, IndexError, TypeError, ValueError):
        print(f'Error getting key "{key}"', file=sys.stderr)
        return None
    return _shown(value)


def _yaml(bag: Bag) -> str:
    lines = [f"path: {bag.filename}"] if bag.filename else []
    lines.append(f"version: {_version(bag)}")
    chunks = bag.__all_chunks__()
    if not chunks:
        return "\n".join([*lines, f"size: {bag.size}", "indexed: False", ""])
    start, end = times_of(chunks)
    lines += [f"duration: {end - start:.6f}", f"start: {start:.6f}", f"end: {end:.6f}", f"size: {bag.size}"]
    lines += [f"messages: {bag.get_message_count()}", "indexed: True"]
    found = bag.get_compression_info()
    lines.append(f"compression: {found.compression if bag.__storage__.contents.chunks else Compression.NONE}")
    if any(chunk.compression != Compression.NONE for chunk in bag.__storage__.contents.chunks):
        lines += [f"uncompressed: {found.uncompressed}", f"compressed: {found.compressed}"]
    types, topics = types_and_topics(bag)
    lines.append("types:")
    for name, md5sum in types.items():
        lines += [f"    - type: {name}", f"      md5: {md5sum}"]
    lines.append("topics:")
    for name, topic in topics.items():
        lines += [f"    - topic: {name}", f"      type: {topic.msg_type}", f"      messages: {topic.message_count}"]
        if topic.connections > 1:
            lines.append(f"      connections: {topic.connections}")
        if topic.frequency:
            lines.append(f"      frequency: {topic.frequency:.4f}")
    return "\n".join([*lines, ""])


def _shown(value: Any, indent: int = 0) -> str:
    margin = "  " * indent
    if isinstance(value, list):
        return "".join(f"{margin}- {_shown(item, indent + 1)}\n" for item in value)
    if isinstance(value, dict):
        return f"\n{margin}".join(f"{name}: {item}" for name, item in value.items())
    return f"{margin}{value}"
