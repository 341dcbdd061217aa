"""ROS packages on disk: searched folders, names, and precedence."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.reading.resources import shipped
from cfepy.status import UsageError
from rospy_shim.types.msgs import Packages, check_package_name
from rospy_shim.types.msgs.packages import name_of


def make_package(folder: Path, name: str = "", *files: str) -> Path:
    """Write a package with a manifest that gives it a name; without a name, write only the files."""
    folder.mkdir(parents=True)
    if name:
        (folder / "package.xml").write_text(f"<package>\n  <name> {name} </name>\n</package>\n", encoding="utf-8")
    for file in files:
        (folder / file).parent.mkdir(exist_ok=True)
        (folder / file).touch()
    return folder


def test_included_package_is_found_by_its_name_and_is_in_no_list(tmp_path: Path) -> None:
    alone = Packages(None, {})
    folder = alone.path("cfepy_plant")
    assert folder is not None
    assert (folder / "package.xml").is_file()
    assert alone.names() == []
    own = tmp_path / "cfepy_plant"
    own.mkdir()
    (own / "package.xml").write_text("<package><name>cfepy_plant</name></package>", encoding="utf-8")
    assert Packages(None, {"ROS_PACKAGE_PATH": str(tmp_path)}).folders("cfepy_plant") == [own]
    assert alone.path("../boards") is None


def test_ros_package_path_is_searched_deep(tmp_path: Path) -> None:
    rover = make_package(tmp_path / "a" / "stack" / "rover", "rover")
    make_package(rover / "inside", "inside")
    ignored = make_package(tmp_path / "a" / "old", "old")
    (tmp_path / "a" / "hidden").mkdir()
    make_package(tmp_path / "a" / "hidden" / "deep", "deep")
    (tmp_path / "a" / "hidden" / "CATKIN_IGNORE").touch()
    packages = Packages(None, {"ROS_PACKAGE_PATH": f"{tmp_path / 'a'}:{tmp_path / 'nowhere'}"})
    assert packages.names() == ["old", "rover"]
    assert packages.path("rover") == rover
    assert packages.path("old") == ignored
    assert packages.path("inside") is None


def test_the_manifest_names_the_package(tmp_path: Path) -> None:
    folder = make_package(tmp_path / "checkout-1.2", "rover")
    old = tmp_path / "rosbuild_one"
    old.mkdir()
    (old / "manifest.xml").write_text("<package/>", encoding="utf-8")
    packages = Packages(None, {"ROS_PACKAGE_PATH": str(tmp_path)})
    assert packages.names() == ["rosbuild_one", "rover"]
    assert packages.path("rover") == folder


def test_first_place_has_precedence(tmp_path: Path) -> None:
    first = make_package(tmp_path / "overlay" / "rover", "rover")
    second = make_package(tmp_path / "underlay" / "rover", "rover")
    share = make_package(tmp_path / "install" / "share" / "rover", "rover")
    environ = {
        "ROS_PACKAGE_PATH": f"{tmp_path / 'overlay'}:{tmp_path / 'underlay'}",
        "CMAKE_PREFIX_PATH": str(tmp_path / "install"),
    }
    assert Packages(None, environ).folders("rover") == [first, second, share]
    assert Packages(None, environ).path("rover") == first


def test_share_folders_need_no_manifest(tmp_path: Path) -> None:
    make_package(tmp_path / "share" / "rover_msgs", "", "msg/Drive.msg")
    make_package(tmp_path / "share" / "doc", "", "msg/readme.txt")
    assert Packages(None, {"CMAKE_PREFIX_PATH": str(tmp_path)}).names() == ["rover_msgs"]


@pytest.mark.parametrize("script", ["src/drive/scripts/node.py", "src/drive/node.py"])
def test_near_a_program(tmp_path: Path, script: str) -> None:
    drive = make_package(tmp_path / "src" / "drive", "drive", "scripts/other.py")
    messages = make_package(tmp_path / "src" / "drive_msgs", "", "srv/Stop.srv")
    make_package(tmp_path / "src" / "stack" / "far", "far")
    packages = Packages(tmp_path / script, {})
    assert packages.names() == ["drive", "drive_msgs", "far"]  # the last one is elsewhere in the catkin workspace
    assert packages.path("drive_msgs") == messages
    assert packages.package_of(tmp_path / script) == "drive"
    assert packages.package_of(messages / "srv" / "Stop.srv") is None
    assert packages.path("drive") == drive


def test_package_next_to_a_program_is_found_without_manifests(tmp_path: Path) -> None:
    mission = make_package(tmp_path / "rendezvous", "", "msg/State.msg", "node.py")
    arm = make_package(mission / "arm_msgs", "", "action/Grasp.action")
    packages = Packages(mission / "node.py", {})
    assert packages.names() == ["arm_msgs", "rendezvous"]
    assert packages.path("arm_msgs") == arm


def test_relative_paths_and_changes_of_the_environment(tmp_path: Path) -> None:
    make_package(tmp_path / "ws" / "rover", "rover")
    environ: dict[str, str] = {}
    packages = Packages(None, environ, lambda path: tmp_path / path)
    environ["ROS_PACKAGE_PATH"] = "ws"  # read when the first package is asked for
    assert packages.names() == ["rover"]


def test_python_code_of_packages(tmp_path: Path) -> None:
    rover = make_package(tmp_path / "rover", "rover", "src/rover.cpp")
    (rover / "src" / "rover").mkdir()
    (rover / "src" / "rover" / "__init__.py").touch()
    make_package(tmp_path / "other", "other", "src/main.cpp")
    assert Packages(None, {"ROS_PACKAGE_PATH": str(tmp_path)}).code_folders() == [rover / "src"]


@pytest.mark.parametrize("name", ["../x", "/x", "a b", "", "a\0b", "-a", "_a", "é", "a" * 256, "a.b", "a\nb"])
def test_invalid_package_name_is_refused(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>", encoding="utf-8")
    assert name_of(folder) == "here"
    with pytest.raises(UsageError, match="invalid package name"):
        check_package_name(folder)


@pytest.mark.parametrize("name", ["arm", "Arm_2", "a-b", "2d_nav", " arm ", "\n arm\n"])
def test_valid_package_name_is_accepted(name: str, tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(f"<package><name>{name}</name></package>", encoding="utf-8")
    check_package_name(tmp_path)
    assert name_of(tmp_path) == name.strip()


def test_too_large_manifest_is_ignored(tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    with (folder / "package.xml").open("wb") as file:
        file.write(b"<package><name>other</name>")
        file.truncate(1 << 40)
    assert name_of(folder) == "here"


def test_included_package_is_found_unless_there_is_another(tmp_path: Path) -> None:
    packages = Packages(tmp_path / "node.py", {})
    assert packages.names() == []
    assert packages.path("cfepy_plant") == shipped("ros_packages") / "cfepy_plant"
    own = make_package(tmp_path / "cfepy_plant", "cfepy_plant")
    assert Packages(tmp_path / "node.py", {}).folders("cfepy_plant") == [own]
