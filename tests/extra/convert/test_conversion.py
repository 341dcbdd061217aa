"""Results of `cfepy convert` for a launch file: names, MsgIds, parameters, entry points, and files that stay."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.convert.build import library_folder, library_sources
from cfepy.extra.convert.entry import NodeEntry, entry_symbol, parameter_rows, quoted
from cfepy.mission import read_mission
from cfepy.osal import OS_MAX_FILE_NAME
from cfepy.status import UsageError
from dev.convert.ping import ping_package
from rospy_shim.parameters.table import ROW_BYTES
from rospy_shim.roslaunch.launch_plan import app_name


def convert(package: Path, out: Path, *more: str) -> int:
    """Convert without the check, which has its own tests."""
    return main(["convert", str(package / "launch/ping.launch"), "--no-check", *more, "-o", str(out)])


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return ping_package(tmp_path)


def test_a_launch_file_becomes_applications(package: Path, tmp_path: Path) -> None:
    out = tmp_path / "made"
    assert convert(package, out, "hz:=20") == 0
    said = json.loads((out / "report.json").read_text(encoding="utf-8"))
    left, ear = said["nodes"]
    assert (left["node"], left["app"], left["entry"]) == ("/arm/left", "ARM_LEFT", "ARM_LEFT_AppMain")
    assert left["sources"] == ["ping/src/sender.cpp", "ping/src/words.cpp"]
    assert left["topics"] == ear["topics"] == ["/pulse"]
    assert left["message_types"] == ["ping/Beat"]
    lines = (out / "startup_lines.scr").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "CFE_APP, arm_left, ARM_LEFT_AppMain, ARM_LEFT, 60, 65536, 0x0, 0;"
    entry = (out / "arm_left/fsw/src/arm_left_entry.cpp").read_text(encoding="utf-8")
    for text in ('{"/arm/beat", "/pulse"}', '{"/arm/left/hz", "20"}', '{"/prefix", "plain"}', '    "!",'):
        assert text in entry
    assert '"/arm/left/hz"' not in (out / "arm_ear/fsw/src/arm_ear_entry.cpp").read_text(encoding="utf-8")
    cmake = (out / "arm_left/CMakeLists.txt").read_text(encoding="utf-8")
    assert 'target_compile_definitions(arm_left PRIVATE ROS_PACKAGE_NAME="ping" GREETING="beat")' in cmake
    assert "../packages/ping/include" in cmake
    assert "-Wl,--version-script=${ROSCFE_DIR}/exports.map" in (out / "roscfe/roscfe.cmake").read_text(encoding="utf-8")
    assert (out / "roscfe/exports.map").read_text(
        encoding="utf-8"
    ) == "{ global: *_AppMain; RN_*_Main; roscfe_node; local: *; };\n"
    assert (out / "packages/ping/include/ping/words.h").read_bytes() == (package / "include/ping/words.h").read_bytes()
    assert (out / "roscfe/msg/ping/Beat.h").is_file()
    assert (len((out / "tables/arm_left_params.tbl").read_bytes()) - 64 - 52) % ROW_BYTES == 0


def test_converted_mission_has_the_reported_msg_ids(package: Path, tmp_path: Path) -> None:
    out = tmp_path / "made"
    assert convert(package, out) == 0
    spec = read_mission(str(out / "mission"))
    said = json.loads((out / "report.json").read_text(encoding="utf-8"))["topics"]
    assert {name: f"0x{id_:04X}" for name, id_ in spec.ros.locked_topics.items()} == said


def test_each_converted_node_has_a_msg_id_for_the_ground(package: Path, tmp_path: Path) -> None:
    out = tmp_path / "made"
    assert convert(package, out) == 0
    spec = read_mission(str(out / "mission"))
    said = json.loads((out / "report.json").read_text(encoding="utf-8"))
    by_node = {name: ground.msg_id for name, ground in spec.cpp_nodes.ground.items()}
    assert set(by_node) == {"/arm/left", "/arm/ear"}
    assert len({*by_node.values(), *spec.ros.locked_topics.values()}) == 2 + len(spec.ros.locked_topics)
    assert [each["housekeeping"] for each in said["nodes"]] == [f"0x{id_:04X}" for id_ in by_node.values()]
    entry = (out / "arm_left/fsw/src/arm_left_entry.cpp").read_text(encoding="utf-8")
    assert f"    0x{by_node['/arm/left']:04X}, roscfe::kNoMarks}};" in entry


def test_a_mission_chooses_the_ground_s_numbers_of_a_converted_node(package: Path, tmp_path: Path) -> None:
    mission = tmp_path / "mission"
    mission.mkdir()
    (mission / "startup.scr").write_text("!\n", encoding="utf-8")
    ground = "cpp_nodes:\n  ground:\n    /arm/left: {msg_id: 0x0A10, performance_id: 40}\n"
    (mission / "mission.yaml").write_text(ground, encoding="utf-8")
    out = tmp_path / "made"
    assert convert(package, out, "--ids", str(mission)) == 0
    entry = (out / "arm_left/fsw/src/arm_left_entry.cpp").read_text(encoding="utf-8")
    assert "    0x0A10, 40};" in entry
    written = read_mission(str(out / "mission")).cpp_nodes.ground
    assert (written["/arm/left"].msg_id, written["/arm/left"].performance_id) == (0x0A10, 40)


@pytest.mark.slow
def test_second_conversion_changes_nothing_and_refuses_hand_edited_files(package: Path, tmp_path: Path) -> None:
    out = tmp_path / "made"
    assert convert(package, out) == 0
    first = {each: each.read_bytes() for each in out.rglob("*") if each.is_file()}
    assert convert(package, out) == 0
    assert {each: each.read_bytes() for each in out.rglob("*") if each.is_file()} == first
    changed = out / "arm_left/CMakeLists.txt"
    changed.write_text("# mine\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"arm_left/CMakeLists\.txt changed by hand since"):
        run_or_raise(package, out)
    assert changed.read_text(encoding="utf-8") == "# mine\n"
    assert convert(package, out, "--force") == 0
    assert changed.read_bytes() == first[changed]


@pytest.mark.slow
def test_a_node_that_the_check_refuses_is_not_converted(
    package: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = package / "src/sender.cpp"
    source.write_text(
        source.read_text(encoding="utf-8")
        + '#include <cstdlib>\nstatic void spare() { std::system("reboot"); spare(); }\n',
        encoding="utf-8",
    )
    words = ["convert", str(package / "launch/ping.launch"), "-o", str(tmp_path / "made")]
    assert main(words) == 1
    err = capsys.readouterr().err
    assert "sender.cpp:" in err
    assert "[process]" in err
    assert "/arm/left is not converted: 1 error, see above; --no-check converts it all the same" in err
    said = json.loads((tmp_path / "made/report.json").read_text(encoding="utf-8"))
    assert [each["node"] for each in said["nodes"]] == ["/arm/ear"]
    assert [each["node"] for each in said["refused"]] == ["/arm/left"]
    assert main([*words, "--no-check", "--force"]) == 0


def run_or_raise(package: Path, out: Path) -> None:
    from cfepy.cli.main import parser_for
    from cfepy.extra.convert.commands.convert import run

    words = ["convert", str(package / "launch/ping.launch"), "--no-check", "-o", str(out)]
    run(parser_for(words).parse_args(words))


def test_two_names_of_one_msg_id_are_reported(
    package: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = tmp_path / "mission"
    mission.mkdir()
    (mission / "startup.scr").write_text("!\n", encoding="utf-8")
    from rospy_shim.graph.msg_ids import msg_id_of

    (mission / "mission.yaml").write_text(f"topics:\n  /other: {{msg_id: {msg_id_of('/pulse')}}}\n", encoding="utf-8")
    assert convert(package, tmp_path / "made", "--ids", str(mission)) == 2
    assert "cfepy graph --lock" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("app", "symbol"), [("TALKER", "TALKER_AppMain"), ("LISTENER_CL", "LISTENER_CL_AppMain"), ("LISTENER_CLASS", None)]
)
def test_entry_points_fit_into_osal(app: str, symbol: str | None) -> None:
    found = entry_symbol(app)
    assert len(found) <= 19
    assert found == symbol if symbol else found.startswith("RN_")


def test_parameters_of_other_nodes_are_excluded() -> None:
    params = {"a": {"x": 1, "y": {"z": "text"}}, "b": {"x": 2}, "all": True, "long": "v" * 100}
    rows = [row for row in parameter_rows(params, "/a", ["/b"]) if row != ("", "")]
    assert rows == [("/a/x", "1"), ("/a/y/z", "text"), ("/all", "true"), ("/long", "v" * 80), ("+", "v" * 20)]
    assert parameter_rows({"a": "\xe9"}, "/a")[0] == ("/a", '"\\u00e9"')


def test_texts_are_quoted_as_in_c() -> None:
    assert quoted('a"b\\c\n?') == r'"a\"b\\c\012\077"'
    text = NodeEntry("APP", "n", takes_arguments=False).text()
    assert "int roscfe_main() __asm__" in text
    assert "nullptr, 0," in text


def test_unused_parts_of_the_library_are_excluded(package: Path, tmp_path: Path) -> None:
    """Messages of unused parts have no capacity, so no strict node could be built beside them."""
    out = tmp_path / "made"
    assert convert(package, out, "--node-profile", "strict") == 0
    cmake = (out / "roscfe/roscfe.cmake").read_text(encoding="utf-8")
    assert "/src/core/topics.cpp" in cmake
    assert "/src/tf/" not in cmake
    header = library_folder() / "include/tf2_ros/buffer.h"
    assert any(each.parent.name == "tf" for each in library_sources([header]))


def test_names_of_applications_fit_into_osals_names_of_files() -> None:
    first = app_name("add_two_ints_server")
    names = [first, app_name("add_two_ints_server_class", [first])]
    assert names == ["ADD_TWO_INTS_SER", "ADD_TWO_INTS_SE2"]
    assert all(len(f"{name}.so") < OS_MAX_FILE_NAME for name in names)
