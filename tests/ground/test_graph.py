"""The graph of a mission: its content, as text, for graphviz, and drawn."""

from __future__ import annotations

from itertools import pairwise
from xml.etree import ElementTree

import pytest

from cfepy.ground import MissionGraph, graph_dot, graph_svg, graph_text
from cfepy.ground.traffic_graph.model import APP, CORE, NODE, Channel, Offer, Taker, Unit

SVG = "{http://www.w3.org/2000/svg}"
GRAPH = MissionGraph(
    "rover",
    (
        Unit("/base_controller", NODE, "BASE"),
        Unit("CFE_ES", CORE, "CFE_ES"),
        Unit("CFE_TIME", CORE, "CFE_TIME"),
        Unit("HK", APP, "HK"),
        Unit("IDLE", APP, "IDLE"),
    ),
    (
        Channel(0x0800, "CFE_ES_HK_TLM", "telemetry", 1.0, ("CFE_ES",), (Taker("HK", "HK_PIPE", 40, 4),)),
        Channel(0x0805, "CFE_TIME_HK_TLM", "telemetry", 0.0, ("CFE_TIME",), (Taker("HK", "HK_PIPE", 40, 60),)),
        Channel(0x0900, "/rosout", "rosgraph_msgs/Log", 2.0, ("/base_controller",), ()),
        Channel(0x0901, "/odom<1>", "nav_msgs/Odometry", 50.0, ("/base_controller",), (Taker("HK", "HK_PIPE", 40, 4),)),
        Channel(0x1810, "CFE_TIME_TONE_CMD", "command", 1.0, ("CFE_TIME",), (Taker("CFE_TIME", "TIME_PIPE", 12, 4),)),
        Channel(0x189A, "HK_CMD", "command", 0.0, (), (Taker("HK", "HK_CMD_PIPE", 8, 4),)),
    ),
    (
        Offer("/base/get_loggers", "roscpp/GetLoggers", "/base_controller", "service"),
        Offer("/drive", "move_msgs/Drive", "/base_controller", "action"),
    ),
)
TEXT = """\
rover: 1 node, 3 applications, 4 messages, 2 pipes

cFE (the core)
  sends
    0x0800 CFE_ES_HK_TLM -> HK  (1.0 Hz)
    0x0805 CFE_TIME_HK_TLM -> HK

/base_controller (node, in cFE BASE)
  sends
    0x0901 /odom<1> -> HK  (nav_msgs/Odometry, 50.0 Hz)
  offers the action /drive  (move_msgs/Drive)

HK (application)
  takes out of pipe HK_CMD_PIPE, depth 8
    0x189A HK_CMD <- nobody yet  (limit 4)
  takes out of pipe HK_PIPE, depth 40
    0x0800 CFE_ES_HK_TLM <- cFE  (limit 4)
    0x0805 CFE_TIME_HK_TLM <- cFE
    0x0901 /odom<1> <- /base_controller  (limit 4)

IDLE (application)
  sends nothing, and takes nothing
"""


def test_text_shows_the_nodes_of_interest() -> None:
    assert graph_text(GRAPH.of_interest()) == TEXT


@pytest.mark.parametrize("width", [40, 60])
def test_lines_fit_and_brackets_are_not_split(width: int) -> None:
    text = graph_text(GRAPH.of_interest(), width)
    assert max(map(len, text.splitlines())) <= width
    assert "(nav_msgs/Odometry, 50.0 Hz)" in text
    assert text.split() == TEXT.split()


def test_complete_graph_has_each_service_of_cfe_and_the_logs() -> None:
    text = graph_text(GRAPH)
    assert "CFE_TIME (the core)\n  sends\n    0x0805 CFE_TIME_HK_TLM -> HK\n    0x1810 CFE_TIME_TONE_CMD" in text
    assert "0x0900 /rosout -> nobody" in text
    assert "offers the service /base/get_loggers" in text


def test_names_are_quoted_for_graphviz() -> None:
    dot = graph_dot(GRAPH.of_interest())
    assert dot.startswith('digraph "rover" {\n')
    assert '"0x0901" [shape=note, label="/odom<1>\\n0x0901\\nnav_msgs/Odometry"];' in dot
    assert '"/base_controller" -> "0x0901";\n' in dot
    assert '"0x0901" -> "HK" [label="HK_PIPE\\ndepth 40, limit 4"];' in dot


def test_drawing_has_all_names_in_boxes_with_room() -> None:
    root = ElementTree.fromstring(graph_svg(GRAPH.of_interest()))
    texts = ["".join(each.itertext()) for each in root.iter(f"{SVG}text")]
    for name in ("rover", "HK", "cFE", "/base_controller", "HK_PIPE", "HK_CMD", "0x0901", "action /drive"):
        assert any(name in text for text in texts), name
    assert "/odom<1>" in " ".join(texts)
    columns: dict[str, list[tuple[float, float]]] = {}
    for rect in root.iter(f"{SVG}rect"):
        if "box" in rect.get("class", ""):
            columns.setdefault(rect.attrib["x"], []).append((float(rect.attrib["y"]), float(rect.attrib["height"])))
    assert len(columns) == 3
    for boxes in columns.values():
        boxes.sort()
        assert all(y + height < below for (y, height), (below, _) in pairwise(boxes))
        assert boxes[-1][0] + boxes[-1][1] < float(root.attrib["height"])


def test_messages_with_the_same_sender_and_receiver_share_a_box() -> None:
    root = ElementTree.fromstring(graph_svg(GRAPH.of_interest()))
    lines = [each for each in root.iter(f"{SVG}path") if each.get("class") == "line"]
    assert len(lines) == 2 + 3  # cFE and /base_controller to two boxes; these and HK_CMD to HK


def test_equal_graphs_give_equal_drawings() -> None:
    assert graph_svg(GRAPH) == graph_svg(GRAPH)


def test_empty_graph_can_be_shown() -> None:
    empty = MissionGraph("none", (), (), ())
    assert graph_text(empty) == "none: 0 nodes, 0 applications, 0 messages, 0 pipes\n"
    assert graph_svg(empty).startswith("<svg ")


def test_any_name_can_be_drawn() -> None:
    odd = MissionGraph(
        "a\0b", (Unit("<&\x1b\ud800", APP, "X"),), (Channel(1, '"\n', "", 0.0, ("<&\x1b\ud800",), ()),), ()
    )
    assert "a\N{REPLACEMENT CHARACTER}b" in "".join(ElementTree.fromstring(graph_svg(odd)).itertext())
