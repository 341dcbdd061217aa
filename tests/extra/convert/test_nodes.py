"""Nodes in C++ as applications: their use of the heap, and the remains of their ends and restarts."""

from __future__ import annotations

import pytest

from cfepy.es.packets import RESTART_APP, STOP_APP
from cfepy.mission import Mission
from dev.convert.node_flights import mission_of
from dev.convert.twin_flights import recorded
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]


def texts(mission: Mission) -> list[str]:
    """Return the recorder's messages of std_msgs/String."""
    lines = [line for line in mission.console.lines if line.startswith("[recorder] RECORD ")]
    return [recorded(line, False).data[4:].decode() for line in lines]


def said_by(mission: Mission, name: str) -> list[str]:
    """Return the log of a node, without its name."""
    return [text.removeprefix(f"{name} ") for text in texts(mission) if text.startswith(f"{name} ")]


def test_working_node_allocates_nothing_on_the_heap() -> None:
    """The node counts its operator new, including the library's. cfepy counts malloc, which libstdc++.so calls."""
    with mission_of("counted") as mission:
        mission.run_for(3.5)
        assert mission.processor.compiled is not None
        before = mission.processor.compiled.allocations
        mission.run_for(3)
        assert mission.processor.compiled.allocations == before > 100
        mission.run_for(3.5)
        (line,) = [line for line in mission.console.lines if "RESULT" in line]
    assert (
        line == "[helper] RESULT 0 allocations, many before, 100 heard, 100 ticks, 50 served, 100 answered, 700 found"
    )


@pytest.mark.parametrize(("pairs", "taken"), [("false", 0), ("true", 3)])
def test_libraries_allocate_a_known_number_of_heap_blocks(pairs: str, taken: int) -> None:
    """Transforms take nothing; a TimeSynchronizer takes three blocks for each pair."""
    with mission_of("counted", "libraries", pairs=pairs) as mission:
        mission.run_for(4)
        assert mission.processor.compiled is not None
        before = mission.processor.compiled.allocations
        mission.run_for(3)
        assert mission.processor.compiled.allocations - before == taken * 20 * 3


def test_two_nodes_of_one_program_share_no_state() -> None:
    with mission_of("lives") as mission:
        mission.run_for(4)
        assert said_by(mission, "/one")[:2] == [
            "count 1 global 5 heard 0 starts 1 made before main",
            "count 2 global 6 heard 0 starts 1 made before main",
        ]
        assert said_by(mission, "/two")[:2] == [
            "count 1 global 5 heard 0 starts 100 made before main",
            "count 2 global 6 heard 0 starts 100 made before main",
        ]


def test_nodes_with_long_names_have_separate_pipes() -> None:
    with mission_of("lives", ends="long") as mission:
        mission.run_for(2)
        assert [len(said_by(mission, name)) for name in ("/a_long_name_of_one", "/a_long_name_of_another")] == [2, 2]
        assert not any("CFE_SB_CreatePipe failed" in line for line in mission.console.lines)


def test_restarted_node_begins_with_new_state() -> None:
    """Only its values on the parameter server remain."""
    with mission_of("lives") as mission:
        mission.run_for(3)
        before = len(said_by(mission, "/one"))
        mission.cfe.sb.transmit_msg(RESTART_APP.packet(Application="ONE"))
        mission.run_for(12)  # ES lets it end in its own time first
        after = said_by(mission, "/one")[before:]
        assert after[0] == "count 1 global 5 heard 0 starts 2 made before main"
        assert len(after) >= 4
        assert said_by(mission, "/two")[-1].startswith(f"count {len(said_by(mission, '/two'))} ")


def test_exit_ends_its_own_application_only() -> None:
    with mission_of("lives", ends="/one") as mission:
        mission.run_for(8)
        assert any("/one: exit(3)" in line for line in mission.console.lines)
        assert 5 <= len(said_by(mission, "/one")) <= 8
        assert len(said_by(mission, "/two")) >= 13
        assert " heard 1 " in said_by(mission, "/two")[-1]


def test_signal_handler_is_called_when_the_application_ends() -> None:
    with mission_of("lives", ends="handler") as mission:
        mission.run_for(3)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="HANDLER"))
        mission.run_for(3)
        said = [line.rpartition(": ")[2] for line in mission.console.lines if line.startswith("[/handler] ")]
    assert said == [
        "first 1",
        "then 1",
        "asked 0 1",
        "refused 1",
        "drawn 1804289383",
        "clock 0",
        "signal 2",
        "[/handler] spun",
    ]


def test_node_with_many_subscriptions_starts_at_once() -> None:
    begins = set()
    for more in range(20):  # the capacity of a report of the Software Bus; a full one may be the last one
        with mission_of("lives", more=" ".join(f"/more_{number}" for number in range(more))) as mission:
            mission.run_for(2)
            first = next(line for line in mission.console.lines if line.startswith("[recorder] RECORD "))
            begins.add(recorded(first, False).time // 10_000)  # each subscription takes some microseconds
    assert len(begins) == 1


def test_publisher_callback_reports_earlier_subscribers() -> None:
    with mission_of("lives", ends="greeters") as mission:
        mission.run_for(4)
        assert [said_by(mission, name) for name in ("/early", "/late")] == [["greets 1"], ["greets 1"]]
        assert sum("greeted 0 before it spins" in line for line in mission.console.lines) == 2


def test_empty_request_is_answered() -> None:
    with mission_of("lives", ends="greeters") as mission:
        mission.run_for(4)
        assert any(line.endswith(": reset 1") for line in mission.console.lines)


def test_a_loop_at_1_khz_loses_nothing() -> None:
    with mission_of("loop") as mission:
        mission.run_for(8)
        assert texts(mission) == ["5000 commands, the last -10000"]
        assert [line for line in mission.console.lines if "Rcv Err" in line] == []  # it waits before it has a pipe
