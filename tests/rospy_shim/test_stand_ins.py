"""Stand-ins for modules that tests and libraries of ROS use and that may be missing: nose, BSON, PNG pictures."""

from __future__ import annotations

import zlib
from pathlib import Path

from rospy_shim.library_parts import STAND_INS
from tests.rospy_shim.missions import run_nodes


def printed(folder: Path, script: str) -> list[str]:
    """Return a node's output."""
    return [line for lines in run_nodes(folder, {"NODE": script}).printed.values() for line in lines]


def test_nose(tmp_path: Path) -> None:
    script = """
        from nose.plugins.skip import SkipTest
        from nose.tools import assert_equal, assert_raises, assert_regexp_matches, eq_, istest, nottest, ok_, raises
        from nose.tools import with_setup
        import nose.tools, unittest
        print(SkipTest is unittest.SkipTest, istest(lambda: 1).__test__, nottest(lambda: 1).__test__)
        done = []

        @with_setup(lambda: done.append("before"), lambda: done.append("after"))
        @raises(ValueError, KeyError)
        def test(text):
            int(text)

        test("x")
        print(done)
        assert_equal(1, 1), assert_regexp_matches("abc", "b"), eq_(1, 1), ok_(True)
        for wrong in (lambda: test("1"), lambda: eq_(1, 2), lambda: ok_(0, "no"), lambda: assert_equal(1, 2)):
            with assert_raises(AssertionError) as caught:
                wrong()
            print(caught.exception)
        print(hasattr(nose.tools, "assert_nothing"))
    """
    assert printed(tmp_path, script) == [
        "True True False",
        "['before', 'after']",
        "test() did not raise ValueError or KeyError",
        "1 != 2",
        "no",
        "1 != 2",
        "False",
    ]


def test_bson(tmp_path: Path) -> None:
    """The bytes of the first document are the example of bsonspec.org."""
    script = """
        import bson
        print(bson.encode({"hello": "world"}).hex())
        document = {"a": [1, -(1 << 40), 0.5], "b": {"c": None, "d": True}, "e": bson.Binary(b"xyz"), "f": "\\u00e4"}
        data = bson.BSON.encode(document)
        print(data.decode() == document, bson.decode(bytes(data)) == document, type(data).__name__)
        print(bson.decode(bson.encode({"x": bson.Binary(b"1", 5)}))["x"].subtype)
        for wrong in (lambda: bson.encode({1: 2}), lambda: bson.encode({"x": 1 << 64}), lambda: bson.encode({"x": {1}}),
                      lambda: bson.decode(data[:-1]), lambda: bson.decode(data + b"x"), lambda: bson.decode(b"")):
            try:
                wrong()
            except bson.errors.BSONError as error:
                print(type(error).__name__)
    """
    assert printed(tmp_path, script) == [
        "160000000268656c6c6f0006000000776f726c640000",
        "True True BSON",
        "5",
        *["InvalidDocument"] * 3,
        *["InvalidBSON"] * 3,
    ]


def test_pictures(tmp_path: Path) -> None:
    """Lines of a PNG file may be packed in five ways. The file here has one of each."""
    lines = b"\x00\x01\x02\x03" + b"\x01\x01\x01\x01" + b"\x02\x01\x01\x01" + b"\x03\x02\x02\x02" + b"\x04\x01\x01\x01"
    script = f"""
        import io, os, sys, zlib
        os.chdir({str(tmp_path)!r})
        sys.path.insert(0, {str(STAND_INS)!r})  # where Pillow is installed, it would come first
        from PIL import Image
        stream = io.BytesIO()
        Image.frombytes("RGB", (2, 1), bytes(range(6))).save(stream, "png")
        Image.open(io.BytesIO(stream.getvalue())).save("picture.png")
        again = Image.open("picture.png")
        print(again.mode, again.size, list(again.tobytes()), Image.new("L", (2, 2), 7).tobytes())
        number = lambda value: value.to_bytes(4, "big")
        chunk = lambda name, data: number(len(data)) + name + data + number(zlib.crc32(name + data))
        head = number(3) + number(5) + bytes([8, 0, 0, 0, 0])
        packed = bytes.fromhex("{zlib.compress(lines).hex()}")
        png = stream.getvalue()[:8] + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
        print(list(Image.open(io.BytesIO(png)).tobytes()))
        for wrong in (lambda: Image.frombytes("L", (2, 2), b"123"), lambda: Image.open(io.BytesIO(b"GIF89a")),
                      lambda: again.save(stream, "JPEG"), lambda: Image.new("CMYK", (1, 1))):
            try:
                wrong()
            except (ImportError, ValueError) as error:
                print(error)
    """
    assert printed(tmp_path, script) == [
        "RGB (2, 1) [0, 1, 2, 3, 4, 5] b'\\x07\\x07\\x07\\x07'",
        "[1, 2, 3, 1, 2, 3, 2, 3, 4, 3, 5, 6, 4, 6, 7]",
        "not enough image data",
        "pictures other than PNG need Pillow: pip install pillow",
        "pictures in the format JPEG need Pillow: pip install pillow",
        "pictures of the mode CMYK need Pillow: pip install pillow",
    ]
