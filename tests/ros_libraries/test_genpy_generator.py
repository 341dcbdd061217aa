"""genpy.generator: its sources define classes that behave like the classes that cfepy makes in memory."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types.msgs import message_class, service_class, shipped
from tests.ros_libraries.world import universe
from tests.rospy_shim.golden_msgs import build, recorded
from tests.rospy_shim.missions import run_nodes

WORLD = universe()
generator: Any = WORLD.importer.load("genpy.generator")
loader: Any = WORLD.importer.load("genmsg.msg_loader")
MESSAGES = [pytest.param(each, id=each["type"]) for each in recorded()["messages"]]


def loaded(full_name: str, full_text: str) -> tuple[Any, Any]:
    """Return a context with all types of a full text, and the spec of the first."""
    core, *others = full_text.split("\n" + "=" * 80 + "\n")
    context = generator.MsgContext.create_default()
    for other in others:
        heading, _, body = other.partition("\n")
        loader.load_msg_from_string(context, body, heading.removeprefix("MSG: "))
    return context, loader.load_msg_from_string(context, core, full_name)


def run(lines: Any) -> dict[str, Any]:
    """Return the names that a source defines when it runs in the universe."""
    scope: dict[str, Any] = {"__builtins__": vars(WORLD.builtins)}
    exec("\n".join(lines), scope)
    return scope


@pytest.mark.parametrize("message", MESSAGES)
def test_generated_source(message: dict[str, Any]) -> None:
    name = message["type"]
    ours = message_class(name)
    context, spec = loaded(name, ours._full_text)
    made = run(generator.msg_generator(context, spec, {}))[name.rpartition("/")[2]]
    for identity in ("_type", "_md5sum", "_full_text", "_has_header", "__slots__", "_slot_types"):
        assert getattr(made, identity) == getattr(ours, identity)
    assert made().__pack__() == ours().__pack__()
    for case in message["cases"]:
        golden = bytes.fromhex(case["hex"])
        values = build(shipped(), name, case["value"])
        filled = made(*(getattr(values, slot) for slot in made.__slots__))
        buff = io.BytesIO()
        filled.serialize(buff)
        assert buff.getvalue() == golden
        assert str(filled) == case["str"]
        assert made().deserialize(golden).__pack__() == golden
        assert made.__unpack__(b"prefix" + golden, 6).__pack__() == golden


def test_constants_and_reserved_words() -> None:
    text = 'uint8 A=3\nstring S=it\'s "x"\nfloat32 F=0.5\nbool B=True\nint8 from\nint8[2] self\n'
    context, spec = loaded("pkg/M", text)
    made = run(generator.msg_generator(context, spec, {}))["M"]
    assert (made.A, made.S, made.F, made.B) == (3, 'it\'s "x"', 0.5, True)
    assert made.__slots__ == ["from_", "self_"]
    assert made(from_=1, self_=[2, 3]).__pack__() == b"\1\2\3"
    assert made._full_text == text


def test_errors_of_generated_classes() -> None:
    context, spec = loaded("pkg/M", "int8 a\nstring[2] b\n")
    made = run(generator.msg_generator(context, spec, {}))["M"]
    genpy = WORLD.importer.load("genpy")
    with pytest.raises(genpy.SerializationError, match="exceeds specified width"):
        made(a=200).__pack__()
    with pytest.raises(genpy.SerializationError, match="Expecting 2 items but found 1"):
        made(b=["x"]).__pack__()
    with pytest.raises(genpy.DeserializationError):
        made().deserialize(b"\0")
    assert made(b=["x", ""]).deserialize(bytes.fromhex("0001000000ff00000000")).b == ["\ufffd", ""]


def test_service() -> None:
    context = generator.MsgContext.create_default()
    text = "bool data\n---\nbool success\nstring message\n"
    spec = loader.load_srv_from_string(context, text, "std_srvs/SetBool")
    made = run(generator.srv_generator(context, spec, {}))
    assert made["SetBool"]._md5sum == service_class("std_srvs/SetBool")._md5sum
    assert made["SetBool"]._request_class is made["SetBoolRequest"]
    assert made["SetBoolResponse"](True, "fine").__pack__() == b"\1\4\0\0\0fine"


def test_unknown_types() -> None:
    context, spec = loaded("pkg/M", "other/X x\n")
    with pytest.raises(loader.MsgNotFound, match=r"unknown package \[other\]"):
        list(generator.msg_generator(context, spec, {}))
    with pytest.raises(generator.MsgGenerationException, match=r"Unknown type \[other/X\]"):
        generator.get_registered_ex(context, "other/X")
    with pytest.raises(generator.MsgGenerationException, match="Unknown type: other/X"):
        list(generator.complex_serializer_generator(context, "pkg", "other/X", "x", True, False))
    with pytest.raises(generator.MsgGenerationException, match="Invalid array spec"):
        list(generator.array_serializer_generator(context, "pkg", "int8", "x", True, False))
    with pytest.raises(generator.MsgGenerationException, match="illegal message type"):
        generator.compute_pkg_type("a", "a/b/c")


def test_dynamic_classes() -> None:
    dynamic, genmsg = WORLD.importer.load("genpy.dynamic"), WORLD.importer.load("genmsg")
    text = message_class("geometry_msgs/PoseStamped")._full_text
    made = dynamic.generate_dynamic("geometry_msgs/PoseStamped", text)
    assert next(iter(made)) == "geometry_msgs/PoseStamped"
    assert made["geometry_msgs/Point"]._spec.names == ["x", "y", "z"]
    assert made["std_msgs/Header"]._md5sum == message_class("std_msgs/Header")._md5sum
    with pytest.raises(genmsg.MsgGenerationException, match="missing 'MSG:' type declaration header"):
        dynamic.generate_dynamic("a/B", "int8 x\n" + "=" * 80 + "\nint8 y\n")
    with pytest.raises(genmsg.MsgNotFound):
        dynamic.generate_dynamic("a/B", "C c\n")


def test_package_on_disk(tmp_path: Path) -> None:
    """A package generated elsewhere: its sources are nodes' own modules, and travel over topics."""
    (tmp_path / "defs").mkdir()
    (tmp_path / "defs" / "Reading.msg").write_text("Header header\nfloat32[] values\nstring unit\n", encoding="utf-8")
    (tmp_path / "defs" / "bad.msg").write_text("int8\n", encoding="utf-8")
    script = f"""
        import os, sys
        from genpy.generate_initpy import write_modules
        from genpy.generator import MsgGenerator
        here = {str(tmp_path)!r}
        header = os.path.join(here, "std")
        os.makedirs(header)
        with open(os.path.join(header, "Header.msg"), "w") as file:
            file.write("uint32 seq\\ntime stamp\\nstring frame_id\\n")
        out = os.path.join(here, "lab", "msg")
        files = [os.path.join(here, "defs", name) for name in ("Reading.msg", "bad.msg")]
        print(MsgGenerator().generate_messages("lab", files[:1], out, {{"std_msgs": [header]}}))
        print(MsgGenerator().generate_messages("lab", files[1:], out, {{}}))
        write_modules(out)
        open(os.path.join(here, "lab", "__init__.py"), "w").close()

        import rospy
        from lab.msg import Reading
        rospy.init_node("n")
        rospy.Subscriber("r", Reading, lambda reading: print(reading.values, reading.unit, reading.header.seq))
        publisher = rospy.Publisher("r", Reading, queue_size=1)
        rospy.sleep(0.2)
        publisher.publish(values=[0.5], unit="V")
        rospy.sleep(0.2)
    """
    run = run_nodes(tmp_path, {"N": script})
    assert run.printed["N"][0] == "0"
    assert any("bad.msg: Invalid declaration: int8" in line for line in run.printed["N"])
    assert run.printed["n"][-1] == "(0.5,) V 1"
