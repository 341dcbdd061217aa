"""All errors in the definitions of a package, each with file and line, as far as genmsg agrees."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.msgs import Packages, check_definitions


def faults(folder: Path, **files: str) -> list[tuple[str, int, str, bool]]:
    """Return faults of the package `own` as (file, line, text, is_warning); files by name, as a_msg for msg/a.msg."""
    for name, text in files.items():
        stem, _, kind = name.rpartition("_")
        path = folder / "own" / kind / f"{stem}.{kind}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    (folder / "own/package.xml").write_text("<package><name>own</name></package>", encoding="utf-8")
    packages = Packages(folder / "node.py", {})
    found = check_definitions(packages, ["own"])
    return [(Path(error.file or "").name, error.line or 0, error.text, warning) for error, warning in found]


GOOD = {
    "Drive_msg": "Header header\nfloat32[4] speeds\nint8 FAST=3\nPoint[] path\n",
    "Point_msg": "geometry_msgs/Point at # here\nstring NAME = a # b\n",
    "Go_srv": "Drive drive\n---\nbool done\n",
    "Reach_action": "Point goal\n---\n---\nfloat32 left\n",
}


def test_valid_definitions_have_no_faults(tmp_path: Path) -> None:
    assert faults(tmp_path, **GOOD) == []


def test_all_faults_of_all_files_are_reported(tmp_path: Path) -> None:
    found = faults(
        tmp_path,
        **GOOD,
        A_msg="int33 x\nint32 y\nint32 y\nint8 BIG=300\nfloat32[a] z\nDrivee d\n\nint32 1a\nsensor_msgs/Imagee i\n"
        "int8 y=3\n",
        B_srv="string text\n---\nnowhere_msgs/Thing thing\nbool\n",
        C_action="int32 x\n---\nint32 y\n",
        Loop_msg="Loop[] inner\n",
    )
    assert sorted((file, line) for file, line, _, _ in found) == [
        *(("A.msg", line) for line in (1, 3, 4, 5, 6, 8, 9, 10)),
        *(("B.srv", line) for line in (3, 4)),
        ("C.action", 3),
        ("Loop.msg", 1),
    ]
    texts = "\n".join(text for _, _, text, _ in found)
    for said in (
        "unknown message type own/int33; did you mean int32?",
        "field 'y' is defined twice",
        "300 does not fit into int8",
        "'float32[a]' is not a field type",
        "unknown message type own/Drivee; did you mean own/Drive?",
        "'1a' is not a field name",
        "the constant y has the name of a field",
        "unknown message type sensor_msgs/Imagee; did you mean sensor_msgs/Image?",
        "unknown message type nowhere_msgs/Thing; add its package",
        "an action must have 3 parts",
        "message type own/Loop contains itself",
    ):
        assert said in texts
    assert not any(warning for _, _, _, warning in found)


@pytest.mark.parametrize(
    ("name", "text", "line", "said"),
    [
        ("A_msg", "int32 x\nint32\ty\n", 2, "has a tab after the type"),
        ("A_msg", "int32 X=3\nint32 X=4\n", 2, "the constant X is defined twice"),
        ("A_msg", "int32 x\nint32 1X=3\n", 2, "invalid constant name '1X'"),
        ("A_srv", "int32 x\n", 0, "missing line --- between request and response"),
    ],
)
def test_definition_that_ros_may_refuse_is_a_warning(
    tmp_path: Path, name: str, text: str, line: int, said: str
) -> None:
    ((_, found_line, found_text, is_warning),) = faults(tmp_path, **{name: text})
    assert (found_line, is_warning) == (line, True)
    assert said in found_text


def test_file_name_that_is_not_a_type_is_reported(tmp_path: Path) -> None:
    ((file, _, text, _),) = faults(tmp_path, **{"my-type_msg": "int32 x\n"})
    assert file == "my-type.msg"
    assert "invalid type name 'my-type'" in text
