"""Bags that a node writes: the bytes are those of ROS's rosbag; appending, reindexing, raw messages, options."""

from __future__ import annotations

import hashlib
import textwrap
from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

BAGS = Path(__file__).parents[1] / "data" / "bags"
BEGIN = """
    import os, rosbag, rospy
    from rosbag import Bag
    from std_msgs.msg import Int32, String
    BAGS = {bags!r}
    os.chdir({folder!r})
    at = rospy.Time.from_sec
"""


def printed(folder: Path, code: str) -> list[str]:
    """Return the output of a node in an empty folder."""
    begin = textwrap.dedent(BEGIN).format(bags=str(BAGS), folder=str(folder))
    return run_nodes(folder, {"WRITES": begin + textwrap.dedent(code)}, seconds=1.0).printed.get("WRITES", [])


@pytest.mark.parametrize("kind", ["none", "bz2", "lz4"])
@pytest.mark.parametrize("raw", [False, True])
def test_written_bags_equal_bags_of_ros_byte_for_byte(tmp_path: Path, kind: str, raw: bool) -> None:
    code = f"""
        with Bag("out.bag", "w", compression={kind!r}, chunk_threshold=4096) as out:
            for topic, message, stamp in Bag(BAGS + "/golden_api_none.bag").read_messages(raw={raw}):
                out.write(topic, message, stamp, raw={raw})
    """
    printed(tmp_path, code)
    expected = (BAGS / f"golden_api_{kind}.bag").read_bytes()
    assert hashlib.sha256((tmp_path / "out.bag").read_bytes()).hexdigest() == hashlib.sha256(expected).hexdigest()


def test_messages_out_of_order_are_read_chunk_by_chunk(tmp_path: Path) -> None:
    code = """
        with Bag("out.bag", "w", chunk_threshold=150) as out:
            for i in (5, 3, 4, 1, 2, 0):
                out.write("/a", Int32(i), at(i))
            print(out.get_message_count(), out.get_start_time(), out.get_end_time())
        bag = Bag("out.bag")
        print([m.message.data for m in bag], len(bag._chunks), bag.get_start_time(), bag.get_end_time())
    """
    assert printed(tmp_path, code) == ["5 5.0 4.0", "[5, 1, 2, 3, 4, 0] 3 5.0 0.0"]


def test_numbers_while_a_chunk_is_open(tmp_path: Path) -> None:
    code = """
        out = Bag("out.bag", "w")
        try:
            out.get_start_time()
        except rosbag.ROSBagException as error:
            print(error)
        print(str(out).split()[-2:])
        out.write("/a", Int32(7), at(3))
        before = out.size
        print(out.get_message_count(), out.get_end_time(), out.get_message_count("/a"), len(out._chunks))
        out.flush()
        print(before < out.size, len(out._chunks))
        out.close()
    """
    assert printed(tmp_path, code) == ["Bag contains no message", "['4.0', 'KB']", "1 3.0 0 0", "True 1"]


def test_append_adds_a_connection(tmp_path: Path) -> None:
    code = """
        with Bag("out.bag", "w") as out:
            out.write("/a", Int32(1), at(1))
        with Bag("out.bag", "a") as out:
            out.write("/a", Int32(2), at(2))
            out.write("/b", String("x"), at(0.5))
            print([m.message.data for m in out])
            out.write("/b", String("y"), at(3))
        bag = Bag("out.bag")
        print([m.message.data for m in bag], bag.get_type_and_topic_info().topics["/a"].connections)
        print([line for line in str(bag).splitlines() if "connections" in line])
    """
    assert printed(tmp_path, code) == [
        "['x', 1, 2]",
        "['x', 1, 2, 'y'] 2",
        "['topics:      /a   2 msgs @ 1.0 Hz : std_msgs/Int32  (2 connections)']",
    ]


def test_unclosed_bag_is_reindexed(tmp_path: Path) -> None:
    code = """
        out = Bag("whole.bag", "w", chunk_threshold=300)
        for i in range(60):
            out.write("/a", Int32(i), at(i))
        out.close()
        data = open("whole.bag", "rb").read()
        found = []
        for length in range(len(data) // 2, len(data) // 2 + 400, 7):
            with open("part.bag", "wb") as file:
                file.write(data[:length])
            try:
                Bag("part.bag")
            except rosbag.ROSBagUnindexedException as error:
                reason = str(error)
            with Bag("part.bag", "a", allow_unindexed=True) as bag:
                positions = list(bag.reindex())
            again = Bag("part.bag")
            values = [m.message.data for m in again]
            found.append(values == list(range(len(values))) and 4 < len(values) < 20)
        print(reason, len(found), all(found))
        bag = Bag("part.bag", "a")
        bag.write("/a", Int32(99), at(99))
        bag.close()
        print(list(Bag("part.bag"))[-1].message.data)
    """
    assert printed(tmp_path, code) == ["Unindexed bag 58 True", "99"]


def test_failed_write_leaves_an_entry_that_breaks_the_index_as_on_ros(tmp_path: Path) -> None:
    code = """
        def tried(call):
            try:
                print(call())
            except Exception as error:
                print(type(error).__name__, error)
        def values():
            return [m.message.data for m in bag.read_messages()]
        bag = Bag("out.bag", "w", chunk_threshold=60)
        for i in range(4):
            bag.write("/a", String(str(i)), at(i + 1))
        tried(lambda: bag.write("/a", "text", at(4)))
        tried(lambda: bag.write("/new", "text", at(4)))
        bag.close()
        bag = Bag("out.bag")
        print(bag.get_message_count())
        tried(lambda: list(bag.reindex()))
        tried(values)
        bag = Bag("out.bag", "a")
        print(len(list(bag.reindex())))
        tried(values)
    """
    warning, *lines = printed(tmp_path, code)
    assert warning.startswith("cfepy: a message on /a could not be serialized")
    assert lines == [
        "AttributeError 'str' object has no attribute 'serialize'",
        "AttributeError type object 'str' has no attribute '_type'",
        *("5", "UnsupportedOperation truncate", "ROSBagException no chunk at position 4669"),
        *("3", "ROSBagException no chunk at position 4669"),
    ]


def test_records_of_a_later_version_are_skipped(tmp_path: Path) -> None:
    code = """
        from rosbag import bag
        with Bag("out.bag", "w", chunk_threshold=256) as out:
            for i in range(10):
                out.write("/int", Int32(i), at(i))
                bag._write_record(out._file, {"op": bag._pack_uint8(max(bag._OP_CODES) + 1)}, "ABCDEFGHI123456789")
            out._file.seek(0)
            out._file.write(b"#ROSBAG V2.1\\n")
        with Bag("out.bag") as found:
            print(found.version, [m.data for _, m, _ in found])
        with Bag("out.bag", "a") as found:
            print(len(list(found.reindex())) > 1, found.get_message_count())
    """
    assert printed(tmp_path, code) == ["201 [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]", "True 10"]


def test_connection_headers_are_kept(tmp_path: Path) -> None:
    code = """
        with Bag(BAGS + "/golden.bag") as source, Bag("out.bag", "w") as out:
            for topic, raw, t, header in source.read_messages("/chatter", raw=True, return_connection_header=True):
                out.write(topic, raw, t, raw=True, connection_header=header)
        header = next(Bag("out.bag").read_messages(return_connection_header=True)).connection_header
        original = next(Bag(BAGS + "/golden.bag").read_messages("/chatter", return_connection_header=True))
        print(header == original.connection_header, header["callerid"], header["latching"])
    """
    assert printed(tmp_path, code) == ["True b'/bagsrc' b'0'"]


def test_arguments_of_write(tmp_path: Path) -> None:
    code = """
        out = Bag("out.bag", "w", options={"compression": "bz2", "chunk_threshold": 99})
        print(out.options, out.compression, out.chunk_threshold, out.mode)
        def attempt(*args, **options):
            try:
                out.write(*args, **options)
            except Exception as error:
                print(type(error).__name__, error)
        attempt("", Int32(1))
        attempt("/a", None)
        attempt("/a", (1, 2), raw=True)
        attempt("/a", ("no/Such", b"", "0", None), raw=True)
        attempt("/a", Int32("x"))
        attempt("/b", ("std_msgs/Int32", b"\\x05\\0\\0\\0", Int32._md5sum, None), at(1), raw=True)
        out.compression = "none"
        out.chunk_threshold = 5
        attempt("/a", Int32(6))
        for name, value in (("compression", "zip"), ("chunk_threshold", -1)):
            try:
                setattr(out, name, value)
            except ValueError as error:
                print(error)
        try:
            out.set_encryptor("rosbag/AesCbcEncryptor", "me")
        except rosbag.ROSBagException as error:
            print(error)
        out.close()
        attempt("/a", Int32(1))
        print([(m.topic, m.message.data, 316533800 < m.timestamp.to_sec() < 316533801) for m in Bag("out.bag")])
        print(Bag("out.bag").get_compression_info().compression)
    """
    lines = [line for line in printed(tmp_path, code) if not line.startswith("cfepy: a message on /a could not")]
    assert lines[:5] == [
        "{'compression': 'bz2', 'chunk_threshold': 99} bz2 99 w",
        "ValueError topic is invalid",
        "ValueError msg is invalid",
        "ValueError msg must be of length 4 or 5",
        "ROSBagException cannot locate message class and no message class provided for [no/Such]",
    ]
    assert lines[5].startswith("SerializationError")
    assert lines[6:9] == [
        "compression must be one of: none, bz2, lz4",
        "chunk_threshold must be greater than or equal to zero",
        "Cannot set encryptor after chunks are written",
    ]
    assert lines[9] == "ValueError I/O operation on closed bag"
    assert lines[10].startswith("[('/b', 5, False), ('/b', 5, False), ('/a', 6, True)]")
    assert lines[11] == "none"


def test_encryption_is_refused(tmp_path: Path) -> None:
    code = """
        from rosbag.bag import ROSBagEncryptNotSupportedException
        out = Bag("out.bag", "w")
        try:
            out.set_encryptor("rosbag/AesCbcEncryptor", "me")
        except ROSBagEncryptNotSupportedException as error:
            print(error)
        out.set_encryptor()
        out.close()
        data = open("out.bag", "rb").read()
        field = b"encryptor=rosbag/AesCbcEncryptor"
        with open("out.bag", "wb") as file:
            size = 69 + 4 + len(field)
            head = data[13 + 4 : 13 + 4 + 69] + len(field).to_bytes(4, "little") + field
            file.write(data[:13] + size.to_bytes(4, "little") + head + (0).to_bytes(4, "little"))
        try:
            Bag("out.bag")
        except ROSBagEncryptNotSupportedException as error:
            print(error)
    """
    assert printed(tmp_path, code) == [
        "AES CBC encryptor is not supported on the simulated computer",
        "the bag is encrypted by rosbag/AesCbcEncryptor, which is not supported",
    ]


def test_exceptions_are_pickled(tmp_path: Path) -> None:
    code = """
        import pickle
        from rosbag import bag
        for error in (
            bag.ROSBagException("one"), bag.ROSBagFormatException("two"), bag.ROSBagUnindexedException(),
            bag.ROSBagEncryptNotSupportedException("three"), bag.ROSBagEncryptException("four"),
        ):
            again = pickle.loads(pickle.dumps(error))
            print(type(again) is type(error), again.value, isinstance(again, rosbag.ROSBagException))
    """
    values = ["one", "two", "Unindexed bag", "three", "four"]
    assert printed(tmp_path, code) == [f"True {value} True" for value in values]


def test_rosbagmain(tmp_path: Path) -> None:
    code = """
        with Bag("in.bag", "w") as out:
            for i in range(30):
                out.write("/ints%d" % i, Int32(i), at(i))
        run = lambda *words: rosbag.rosbagmain(["rosbag", *words])
        run("filter", "in.bag", "one.bag", "int(t.secs) == m.data and 15 <= m.data < 20 and topic.startswith('/ints')")
        run("filter", "one.bag", "two.bag", "True")
        print([m.message.data for m in Bag("one.bag")], open("one.bag", "rb").read() == open("two.bag", "rb").read())
        run("compress", "-q", "in.bag")
        run("info", "-y", "-k", "compression", "in.bag")
        run("decompress", "in.bag")
        print(os.path.exists("in.orig.bag"))
        run("decompress", "-f", "in.bag")
        run("info", "-y", "-k", "compression", "in.bag")
        with open("in.bag", "r+b") as file:
            file.truncate(6000)
        try:
            run("info", "in.bag")
        except SystemExit as error:
            print(error)
        run("reindex", "-f", "in.bag")
        run("info", "-y", "-k", "indexed", "in.bag")
    """
    assert printed(tmp_path, code) == [
        "[15, 16, 17, 18, 19] True",
        "bz2",
        "Skipping in.bag. Backup path in.orig.bag already exists.",
        "True",
        "none",
        "ERROR bag unindexed: in.bag.  Run rosbag reindex.",
        "False",
    ]


def test_missing_lz4_is_reported_with_advice(tmp_path: Path) -> None:
    (tmp_path / "lz4.py").write_text("raise ImportError('no lz4 here')\n", encoding="utf-8")
    code = """
        for attempt in (
            lambda: Bag("out.bag", "w", compression="lz4"),
            lambda: list(Bag(BAGS + "/golden_api_lz4.bag")),
        ):
            try:
                attempt()
            except Exception as error:
                print(type(error).__name__, error)
        print(len(list(Bag(BAGS + "/golden_api_bz2.bag"))))
    """
    hint = "LZ4 needs the package lz4: pip install 'cfepy[bag]'"
    assert printed(tmp_path, code) == [
        f"ValueError compression must be one of: none, bz2 ({hint})",
        f"ImportError {hint}",
        "440",
    ]
