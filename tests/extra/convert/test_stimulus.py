"""The comparison of nodes with Debian's roscpp: its notion of equality, the driver's script, a flight beside it."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.flight_build import message_library
from cfepy.extra.convert.node_check import programs_of
from dev.convert.stimulus.comparing import Likeness, Part, compared
from dev.convert.stimulus.flight import NodeFlight, ended, printed_by_node
from dev.convert.stimulus.outcome import Outcome, log_of, outcome_of
from dev.convert.stimulus.report import rows
from dev.convert.stimulus.script import Scene, Seen, script
from dev.convert.twin_flights import TWINS
from dev.roscfe.building import needs_cpp
from rospy_shim.types.msgs import Packages, shipped

SEEN = Seen({}, {"/in": "geometry_msgs/PoseStamped", "/any": "*"}, {"/reset": "std_srvs/SetBool"}, {})


def likeness(one: list[object], other: list[object], again: list[object] | None = None, name: str = "topic /t") -> Part:
    runs = [Outcome({name: run}, None) for run in (one, one if again is None else again, other)]
    return next(part for part in compared(*runs) if part.name == name)


def test_repeated_values_count_once_and_numbers_within_tolerance_are_equal() -> None:
    assert likeness([1.0, 1.0, 2.0], [1.0, 2.000001, 2.0]).likeness is Likeness.EQUAL
    assert likeness([1.0, 2.0], [1.0, 2.001]).likeness is Likeness.DIFFERENT
    assert likeness([1, 2], [1, 3]).likeness is Likeness.DIFFERENT
    assert likeness(["a"], []).likeness is Likeness.DIFFERENT


def test_longer_or_shifted_sequence_is_shifted_not_different() -> None:
    assert likeness(list(range(10)), list(range(2, 13))).likeness is Likeness.SHIFTED
    assert likeness(list(range(10)), list(range(8, 18))).likeness is Likeness.DIFFERENT


def test_value_that_varies_between_two_runs_of_roscpp_is_chance() -> None:
    one, again, ours = ([{"x": x, "y": y} for y in "ab"] for x in (1, 2, 3))
    assert likeness(one, ours, again).likeness is Likeness.VARIES
    assert likeness(one, ours, again).example == ".x"
    ours[1]["y"] = "c"
    assert likeness(one, ours, again).likeness is Likeness.DIFFERENT


def test_end_of_a_node_is_compared() -> None:
    runs = [Outcome({}, failed) for failed in (None, None, True)]
    assert [(part.name, part.likeness) for part in compared(*runs)] == [("end", Likeness.DIFFERENT)]


def test_seed_decides_the_whole_script_of_a_driver() -> None:
    told = script(1, SEEN, shipped(), Scene())
    assert told == script(1, SEEN, shipped(), Scene())
    assert told["steps"] != script(2, SEEN, shipped(), Scene())["steps"]
    assert len(told["steps"]) == 50
    assert {step.name for step in told["steps"]} == {"/in", "/reset"}
    assert told["publish"] == {"/in": "geometry_msgs/PoseStamped"}


def test_times_count_from_the_first_step() -> None:
    lines = ['@ ["base", 1000000]', '@ ["message", "/t", "std_msgs/Time", "%s", 0.2]', '@ ["graph", {}, {}, []]']
    times = {"step 0.2": (1_000_000, 2 * 10**8), "now": (1_000_000, 2 * 10**8 + 1), "time 5.000000000": (5, 0)}
    for said, (seconds, rest) in times.items():
        data = (seconds.to_bytes(4, "little") + rest.to_bytes(4, "little")).hex()
        outcome = outcome_of([each.replace("%s", data) for each in lines], [], shipped(), None)
        assert outcome.parts["topic /t"] == [{"data": said}]


def test_failed_driver_is_reported() -> None:
    assert outcome_of(["ImportError: rospy"], [], shipped(), None).note == "the driver failed: ImportError: rospy"


def test_warnings_of_tf2_are_lines_of_the_log() -> None:
    printed = ["Warning: no frame", "         at line 126 in ./tf2/src/buffer_core.cpp", "Warning: of the node"]
    assert log_of(printed) == ["[ WARN] [t]: no frame", "Warning: of the node"]


def test_lines_of_the_console() -> None:
    lines = ["EVS Port1 x", "[/node] [ INFO] [1.5]: hi", "past the log", "[driver] @ []", "1980-012-14:03:20.5 CFE_ES"]
    assert printed_by_node(lines) == ["[ INFO] [1.5]: hi", "past the log"]
    over = "1980-012-14:03:20.60007 CFE_ES_ExitApp: Application NODE called CFE_ES_ExitApp"
    assert [ended(lines), ended([over]), ended([over, "EVS CFE_ES 14: Exit Application NODE Completed."])] == [
        None,
        False,
        True,
    ]


def test_difference_is_marked_as_explained_or_not() -> None:
    part = {"name": "log", "likeness": "different", "seen": 3, "example": ""}
    result = {"node": "a/b/c.cpp", "verdict": "different", "parts": [part]}
    assert next(rows([result], {})).verdict == "different"
    assert next(rows([result], {("a/b/c.cpp", "log"): "chance"}))[1:] == ("explained", 0, 3, 0, "chance")
    assert next(rows([{"node": "n", "verdict": "not built", "why": "no header"}], {})).verdict == "not with roscpp"


@needs_cpp
@pytest.mark.slow
def test_node_flies_next_to_the_driver(tmp_path: Path) -> None:
    source = TWINS / "twin_services/src"
    environ = {"ROS_PACKAGE_PATH": str(TWINS)}
    program = programs_of([str(next(iter(sorted(source.glob("*.cpp")))))], environ)[0]
    library = message_library(Packages(source, environ))
    flight = NodeFlight(program, library, environ, tmp_path)
    seen = flight.look(Scene())
    told = script(1, seen, library, Scene())
    like = Outcome({}, None, begun_ns=1_700_000_000_000_000_000, base=1_700_000_003)
    outcome = flight.run(told, Scene(), like)
    assert not outcome.note
    assert outcome.parts["serves"]
    assert all(outcome.parts[f"answer {name}"] for name in outcome.parts["serves"])
    assert flight.run(told, Scene(), like) == outcome
