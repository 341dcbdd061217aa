"""`cfepy graph`: the graph of a mission that the command flies."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.ros_missions import robot

ROOT = Path(__file__).parents[2]
Capture = pytest.CaptureFixture[str]


def test_nodes_applications_messages_and_pipes_of_a_mission(tmp_path: Path, capsys: Capture) -> None:
    drawing, dot = tmp_path / "graph.svg", tmp_path / "graph.gv"
    assert main(["graph", "capture", "--for", "2", "--svg", str(drawing), "--dot", str(dot)]) == 0
    text = capsys.readouterr().out
    assert "\n/arm_control (node, in cFE ARM)\n  sends\n    0x0910 /joint_states -> /main_control  (sensor_" in text
    assert "  takes out of pipe ARM.motor_co.1, depth 1\n    0x0911 /motor_command <- /main_control\n" in text
    assert "  takes out of pipe HK_CMD_PIPE, depth 40\n    0x0800 CFE_ES_HK_TLM <- " in text
    assert "0x0901 /arm_health/samples <- /arm_health  (limit 4)\n" in text
    assert drawing.read_text(encoding="utf-8").startswith("<svg ")
    assert dot.read_text(encoding="utf-8").startswith("digraph")


def test_services_and_a_script_that_looks_as_one_wants(tmp_path: Path, capsys: Capture) -> None:
    mission = str(robot(tmp_path))
    assert main(["graph", mission, "--for", "1", "--all", "--json", "-"]) == 0
    graph = json.loads(capsys.readouterr().out)
    nodes = {unit["name"]: unit["app"] for unit in graph["units"] if unit["kind"] == "node"}
    assert nodes
    assert {offer["unit"] for offer in graph["offers"]} <= set(nodes)
    assert any(offer["name"].endswith("/set_logger_level") for offer in graph["offers"])


def test_a_drawing_alone_on_standard_output(capsys: Capture) -> None:
    assert main(["graph", "lab", "--for", "1", "--svg", "-"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("<svg ")
    assert out.endswith("</svg>\n")


def test_what_died_on_the_way_is_told(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "startup.scr").write_text("CFE_APP, app, main, APP, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "app.py").write_text("def main(cfe):\n    raise ValueError('no')\n", encoding="utf-8")
    assert main(["graph", str(tmp_path), "--for", "1"]) == 0
    said = capsys.readouterr()
    assert said.out.endswith("APP (application)\n  sends nothing, and takes nothing\n")
    assert "cfepy: APP died: ValueError: no" in said.err


@pytest.mark.slow
def test_the_drawing_in_the_documentation_is_that_of_today(tmp_path: Path) -> None:
    drawing = tmp_path / "graph.svg"
    assert main(["graph", "capture", "--svg", str(drawing)]) == 0
    assert drawing.read_text(encoding="utf-8") == (ROOT / "docs" / "pictures" / "graph.svg").read_text(encoding="utf-8")
