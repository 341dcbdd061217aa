"""genmsg: definitions read from texts and files, their dependencies, and their md5sums."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types.msgs import message_class, service_class
from tests.ros_libraries.world import universe

genmsg: Any = universe().importer.load("genmsg")


def context_of(full_name: str) -> tuple[Any, Any]:
    """Everything in a shipped type's full text, and the type's spec."""
    core, *others = message_class(full_name)._full_text.split("\n" + "=" * 80 + "\n")
    context = genmsg.MsgContext.create_default()
    for other in others:
        heading, _, body = other.partition("\n")
        genmsg.msg_loader.load_msg_from_string(context, body, heading.removeprefix("MSG: "))
    return context, genmsg.msg_loader.load_msg_from_string(context, core, full_name)


@pytest.mark.parametrize("name", ["sensor_msgs/PointCloud2", "nav_msgs/Odometry", "rosgraph_msgs/Log", "std_msgs/Time"])
def test_identities_of_messages(name: str) -> None:
    context, spec = context_of(name)
    genmsg.load_depends(context, spec, {})
    assert genmsg.compute_md5(context, spec) == message_class(name)._md5sum
    assert genmsg.compute_full_text(context, spec) == message_class(name)._full_text
    assert spec.has_header() == message_class(name)._has_header


def test_identity_of_a_service() -> None:
    context = genmsg.MsgContext.create_default()
    text = "bool data\n---\nbool success\nstring message\n"
    spec = genmsg.msg_loader.load_srv_from_string(context, text, "std_srvs/SetBool")
    assert genmsg.compute_md5(context, spec) == service_class("std_srvs/SetBool")._md5sum
    assert (spec.short_name, spec.response.full_name) == ("SetBool", "std_srvs/SetBoolResponse")
    assert context.is_registered("std_srvs/SetBoolRequest")


def test_fields_and_constants() -> None:
    context = genmsg.MsgContext.create_default()
    text = "Header header\nint8 A=-1 # low\nstring S= a # b \nPoint[3] corners\nother/X x\nfloat32[] y # all\n"
    spec = genmsg.msg_loader.load_msg_from_string(context, text, "pkg/M")
    assert spec.fields() == [
        ("std_msgs/Header", "header"),
        ("pkg/Point[3]", "corners"),
        ("other/X", "x"),
        ("float32[]", "y"),
    ]
    assert [str(constant) for constant in spec.constants] == ["int8 A=-1", "string S=a # b"]
    corners = spec.parsed_fields()[1]
    assert (corners.base_type, corners.is_array, corners.array_len, corners.is_builtin) == ("pkg/Point", True, 3, False)
    assert repr(spec).startswith("MsgSpec[[int8 A=-1, string S=a # b], ['std_msgs/Header'")
    assert spec == genmsg.msg_loader.load_msg_from_string(context, text, "pkg/M")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("int8", "Invalid declaration: int8"),
        ("int8 1a", "1a is not a legal message field name"),
        ("int-8 a", "int-8 is not a legal message field type"),
        ("int8 a\nint8 a", "Duplicate field names in message"),
        ("int8 A=200", r"cannot coerce \[200\] to int8 \(out of bounds\)"),
        ("Point P=1", "Point is not a legal constant type"),
        ("int8 A=1=2", "Invalid constant declaration: int8 A=1=2"),
        ("bool A=yes", "Invalid constant value"),
    ],
)
def test_mistakes(text: str, problem: str, tmp_path: Path) -> None:
    context = genmsg.MsgContext.create_default()
    with pytest.raises(genmsg.InvalidMsgSpec, match=problem):
        genmsg.msg_loader.load_msg_from_string(context, text, "pkg/M")
    file = tmp_path / "M.msg"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(genmsg.InvalidMsgSpec, match=rf"M\.msg: .*{problem}"):
        genmsg.msg_loader.load_msg_from_file(context, str(file), "pkg/M")


def test_search_path(tmp_path: Path) -> None:
    (tmp_path / "Point.msg").write_text("float64 x\n", encoding="utf-8")
    (tmp_path / "Line.msg").write_text("Point a\nPoint b\n", encoding="utf-8")
    (tmp_path / "Draw.srv").write_text("Line line\n---\n", encoding="utf-8")
    path = {"pkg": ["/nowhere", str(tmp_path)]}
    context = genmsg.MsgContext.create_default()
    spec = genmsg.load_msg_by_type(context, "pkg/Line", path)
    assert genmsg.load_depends(context, spec, path) == ["pkg/Point", "pkg/Point"]
    assert context.get_file("pkg/Point") == str(tmp_path / "Point.msg")
    assert context.get_all_depends("pkg/Line") == ["pkg/Point", "pkg/Point"]
    service = genmsg.load_srv_by_type(context, "pkg/Draw", path)
    assert genmsg.load_depends(context, service, path) == ["pkg/Line"]
    deps = universe().importer.load("genmsg.deps")
    found = deps.find_msg_dependencies_with_type("pkg", str(tmp_path / "Line.msg"), path)
    assert found == [("pkg/Point", str(tmp_path / "Point.msg"))]
    assert len(deps.find_srv_dependencies("pkg", str(tmp_path / "Draw.srv"), path)) == 2


def test_missing_packages_and_messages_are_reported() -> None:
    context = genmsg.MsgContext.create_default()
    with pytest.raises(genmsg.MsgNotFound, match=r"unknown package \[pkg\]") as found:
        genmsg.load_msg_by_type(context, "pkg/X", {})
    assert (found.value.base_type, found.value.package) == ("X", "pkg")
    with pytest.raises(genmsg.MsgNotFound, match=r"Cannot locate message \[X\] in package \[pkg\]"):
        genmsg.load_msg_by_type(context, "pkg/X", {"pkg": ["/nowhere"]})
    with pytest.raises(ValueError, match="search_path must be a dictionary"):
        genmsg.load_msg_by_type(context, "pkg/X", "/nowhere")
    with pytest.raises(KeyError):
        context.get_registered("pkg/X")
    with pytest.raises(genmsg.MsgGenerationException, match="unknown file extension"):
        genmsg.gentools.compute_full_type_name("pkg", "x.txt")


def test_names_and_types() -> None:
    names, msgs = genmsg.names, genmsg.msgs
    assert names.package_resource_name("a/b") == ("a", "b")
    assert names.package_resource_name("b") == ("", "b")
    assert (names.resource_name("a", "b"), names.resource_name("a", "b", my_pkg="a")) == ("a/b", "b")
    assert (names.resource_name_base("a/b"), names.resource_name_package("b")) == ("b", None)
    assert [names.is_legal_resource_name(each) for each in ("a/b_1", "1a", "a//b", "", None)] == [True, *[False] * 4]
    assert names.is_legal_resource_base_name("a/b") is False
    with pytest.raises(ValueError, match="invalid name"):
        names.package_resource_name("a/b/c")
    resolved = [msgs.resolve_type(each, "p") for each in ("X", "X[]", "int8[]", "q/X", "Header")]
    assert resolved == ["p/X", "p/X[]", "int8[]", "q/X", "std_msgs/Header"]
    assert [msgs.parse_type(each) for each in ("a", "a[]", "a[4]")] == [
        ("a", False, None),
        ("a", True, None),
        ("a", True, 4),
    ]
    assert [msgs.is_valid_msg_type(each) for each in ("a/b[4]", " a", "a[", "a[x]", "a[4]]")] == [True, *[False] * 4]
    for bad, problem in (("", "empty type"), ("a[x]", "Invalid array dimension"), ("a[1][2]", "1-dimensional")):
        with pytest.raises(ValueError, match=problem):
            msgs.parse_type(bad)
    command_line = universe().importer.load("genmsg.command_line")
    assert command_line.includepath_to_dict(["a:/x", "a:/y", "b:"]) == {"a": ["/x", "/y"]}
