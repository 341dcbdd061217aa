"""`cfepy convert check` for a user and for a program. It runs the compiler, so these tests are slow."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from dev.convert.ping import ping_package

NODE = """#include <ros/ros.h>
#include <std_msgs/String.h>
void heard(const std_msgs::String::ConstPtr &message) { ROS_INFO("%s", message->data.c_str()); }
int main(int argc, char **argv)
{
  ros::init(argc, argv, "ear");
  ros::NodeHandle n;
  ros::Subscriber sub = n.subscribe("chatter", 1000, heard);
  ros::spin();
}
"""
pytestmark = pytest.mark.slow


def checked(folder: Path, text: str, *more: str) -> int:
    (folder / "ear.cpp").write_text(text, encoding="utf-8")
    return main(["convert", "check", str(folder / "ear.cpp"), *more])


def rules_of(folder: Path, text: str, profile: str = "host") -> set[str]:
    """Return the rules of the errors."""
    status = checked(folder, text, "--node-profile", profile, "--json", str(folder / "found.json"))
    (node,) = json.loads((folder / "found.json").read_text(encoding="utf-8"))["nodes"]
    assert node["refused"] == (status == 1)
    return {each["rule"] for each in node["found"] if each["level"] == "error"}


@pytest.mark.parametrize("profile", ["host", "pool", "strict"])
def test_a_node_that_converts(
    tmp_path: Path, profile: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert checked(tmp_path, NODE, "--node-profile", profile) == 0
    found, memory, *arena, count = capsys.readouterr().out.splitlines()
    assert [line.partition(": ")[2].partition(" bytes: ")[2].split(",")[:2] for line in arena] == (
        [] if profile == "host" else [["29", "696 for subscriptions"]]
    )
    assert found.startswith("ear.cpp:8:25: warning: a queue of 1,000: 64 messages are kept: ")
    assert found.endswith(" [queue-large]")
    size = {"host": 32, "pool": 32, "strict": 72}[profile]
    assert memory == f"ear: chatter (std_msgs/String): 68 x {size} = {68 * size:,} bytes"
    assert count == f"{profile}: 1 node, 0 refused; 1 warning found"


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("ros::spin();", "ros::fly();", "api-missing"),
        ("n.subscribe", "n.listen", "api-missing"),
        ("ros::spin();", "nothing();", "compile-error"),
        ("ros::spin();\n}", "", "compile-error"),
        ("#include <ros/ros.h>", "#include <ros/ros.h>\n#include <rosbag/bag.h>", "ros-library"),
        ("#include <ros/ros.h>", "#include <ros/ros.h>\n#include <none/none.h>", "include-unknown"),
        ("#include <ros/ros.h>", "#include <ros/ros.h>\n#ifndef N\n#include <rosbag/bag.h>\n#endif", "ros-library"),
    ],
)
def test_source_refused_by_the_compiler_is_never_clean(tmp_path: Path, old: str, new: str, rule: str) -> None:
    assert rule in rules_of(tmp_path, NODE.replace(old, new))


def test_finding_of_both_passes_is_reported_once(tmp_path: Path) -> None:
    checked(
        tmp_path, NODE.replace("ros::spin();", "throw 1;"), "--node-profile", "pool", "--json", str(tmp_path / "f.json")
    )
    (node,) = json.loads((tmp_path / "f.json").read_text(encoding="utf-8"))["nodes"]
    assert [each["rule"] for each in node["found"]].count("throw") == 1


def test_first_50_of_many_compiler_errors_are_reported(tmp_path: Path) -> None:
    checked(tmp_path, NODE + "".join(f"int a{at} = b{at};\n" for at in range(60)), "--json", str(tmp_path / "f.json"))
    (node,) = json.loads((tmp_path / "f.json").read_text(encoding="utf-8"))["nodes"]
    told = [each["text"] for each in node["found"] if each["rule"] == "compile-error"]
    assert len(told) == 50
    assert any(each.startswith("'b0' was not declared") for each in told)


def test_boost_is_the_hosts(tmp_path: Path) -> None:
    with_boost = NODE.replace("#include <ros/ros.h>", "#include <ros/ros.h>\n#include <boost/asio.hpp>")
    assert rules_of(tmp_path, with_boost, "pool") == {"boost-header"}


def test_strict_needs_capacities(tmp_path: Path) -> None:
    text = NODE.replace("std_msgs/String", "tf2_msgs/TFMessage").replace("std_msgs::String", "tf2_msgs::TFMessage")
    assert rules_of(tmp_path, text.replace("message->data.c_str()", '"x"'), "strict") == {"capacity-missing"}


def test_mistake_in_a_message_is_reported_for_the_node_that_includes_it(tmp_path: Path) -> None:
    package = ping_package(tmp_path)
    (package / "msg/Beat.msg").write_text("int32 number\nnone_msgs/Thing what\n", encoding="utf-8")
    assert main(["convert", "check", str(package), "--json", str(tmp_path / "found.json")]) == 1
    nodes = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))["nodes"]
    assert "message-definition" in {each["rule"] for node in nodes for each in node["found"]}


def test_a_package_and_a_launch_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    package = ping_package(tmp_path)
    assert main(["convert", "check", str(package)]) == 0
    of_package = capsys.readouterr().out
    assert main(["convert", "check", str(package / "launch/ping.launch")]) == 0
    of_launch = capsys.readouterr().out
    assert "host: 3 nodes, 0 refused; " in of_package
    assert "host: 2 nodes, 0 refused; " in of_launch


def test_bad_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", "check"]) == 2
    assert main(["convert", "check", str(tmp_path / "none.cpp"), "--force"]) == 2
    assert main(["convert", "check", "no_such_package"]) == 2
    assert main(["convert", str(tmp_path), "--sarif", "-"]) == 2


def test_sarif_is_valid(tmp_path: Path) -> None:
    """The members that SARIF 2.1.0 requires, with the types and values that its schema allows."""
    file = tmp_path / "found.sarif"
    assert checked(tmp_path, NODE.replace("ros::spin();", "exit(3); none();"), "--sarif", str(file)) == 1
    log = json.loads(file.read_text(encoding="utf-8"))
    assert log["version"] == "2.1.0"
    assert log["$schema"].endswith("sarif-schema-2.1.0.json")
    (run,) = log["runs"]
    driver = run["tool"]["driver"]
    assert driver["name"]
    ids = [rule["id"] for rule in driver["rules"]]
    assert len(set(ids)) == len(ids)
    assert all(rule["help"]["text"] and rule["shortDescription"]["text"] for rule in driver["rules"])
    assert {each["ruleId"] for each in run["results"]} >= {"exit", "compile-error", "queue-large"}
    for each in run["results"]:
        check_result(each, ids, set(run["originalUriBaseIds"]))


def check_result(result: dict[str, Any], ids: list[str], bases: set[str]) -> None:
    assert ids[result["ruleIndex"]] == result["ruleId"]
    assert result["level"] in ("none", "note", "warning", "error")
    assert result["message"]["text"]
    for location in result["locations"]:
        place = location["physicalLocation"]
        assert place["artifactLocation"]["uri"]
        assert place["artifactLocation"].get("uriBaseId", "BASE") in bases
        region = place.get("region", {"startLine": 1})
        assert region["startLine"] >= 1
        assert region.get("startColumn", 1) >= 1
