"""Public applications beside NASA's cFE: headers, plans, comparisons, and their results."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es import entries
from cfepy.evs.packets import LONG_EVENT_MSG_MID
from cfepy.msg import command
from dev.c.public_apps.beside import Rules, differences, planned
from dev.c.public_apps.comparison import compare_mission
from dev.c.public_apps.missions import PublicMission, read_missions
from dev.c.public_apps.nasa_headers import flags_file, headers, with_nasas
from dev.c.public_apps.results import (
    ANSWERS,
    DIFFERS,
    NOT_COMPARED,
    RUNS,
    SAME,
    Beside,
    page,
    read_beside,
    read_results,
    write_beside,
)
from dev.corpus.sources import Sources
from dev.twin.flight import Observed

FLAGS = """\
C_DEFINES = -DSIMULATION=native
C_INCLUDES = -I/b/inc -I/s/apps/sample_app/fsw/inc -I/s/libs/sample_lib/fsw/public_inc -I/s/cfe/modules/core_api/fsw/inc
"""
OURS = "-I/home/me/.cache/cfepy/headers-0123456789abcdef"
APP = """
from cfepy.app import Cfe

def Main(cfe: Cfe) -> None:
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(5, "PROBE")
    for msg_id in (0x1890, 0x1891, 0x0892):
        cfe.sb.subscribe(msg_id, pipe)
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe)
        msg_id, code = int.from_bytes(packet[:2], "big"), packet[6]
        if msg_id == 0x1891:
            cfe.sb.transmit_msg(cfe.msg.init(0x0890, 20))
        elif msg_id == 0x1890 and code == 2 and len(packet) != 12:
            cfe.evs.send_event(2, 3, f"Invalid msg length: CC = 2, Len = {len(packet)}, Expected = 12")
        elif msg_id == 0x1890:
            cfe.evs.send_event(1, 2, f"code {code}")
"""


def event(text: bytes, count: int = 0) -> bytes:
    """Return an event of PROBE."""
    head = LONG_EVENT_MSG_MID.to_bytes(2, "big") + (0xC000 | count).to_bytes(2, "big") + (168 - 7).to_bytes(2, "big")
    return head + bytes(10) + b"PROBE".ljust(20, b"\0") + bytes([1, 0, 2, 0]) + bytes(8) + text.ljust(124, b"\0")


def telemetry(value: int, count: int = 0, at: int = 0) -> bytes:
    """Return a packet of telemetry with a value, a sequence count and a time."""
    return (
        bytes([8, 0x90])
        + (0xC000 | count).to_bytes(2, "big")
        + bytes([0, 11])
        + bytes([at] * 6)
        + bytes(4)
        + bytes([value, 0])
    )


def test_nasas_headers_come_first_and_cfepys_are_left_out() -> None:
    found = with_nasas(["cc", "-O1", "-I/mission/inc", OURS, "-c", "a.c"], ["-I/nasa"], ["m"])
    assert found == ["cc", "-O1", "-I/nasa", "-I/mission/inc", "-c", "a.c"]
    assert with_nasas(["cc", "--version"], ["-I/nasa"], ["m"]) == ["cc", "--version"]


def test_nasas_side_is_linked_with_the_libraries_of_the_host() -> None:
    found = with_nasas(["cc", "-shared", "a.o"], ["-I/nasa"], ["m", "socketcan"])
    assert found == ["cc", "-shared", "a.o", "-Wl,--as-needed", "-lm", "-lsocketcan"]


def test_headers_of_the_sample_application_are_left_out() -> None:
    assert headers(FLAGS) == ["-I/b/inc", "-I/s/cfe/modules/core_api/fsw/inc"]


def test_executable_outside_of_its_build_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="keep the build of NASA's cFE"):
        flags_file(tmp_path / "exe/cpu1")


def test_plan_has_commands_with_the_expected_length_and_requests(tmp_path: Path) -> None:
    (tmp_path / "probe.py").write_text(APP, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, probe, Main, PROBE, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    plan = planned(tmp_path, entries((tmp_path / "startup.scr").read_bytes())[-1])
    request = bytes(command(0x1891, 0))
    assert plan.telemetry == (0x0890,)
    assert all(step.packets[1:] == (request,) for step in plan.steps)
    sent = [step.packets[0] for step in plan.steps]
    assert bytes(command(0x1890, 0)) in sent
    assert [len(each) for each in sent if each[:2] == b"\x18\x90" and each[6] == 2] == [8, 12, 12]
    assert [each for each in sent if each[:2] == b"\x08\x92"] == [bytes.fromhex("0892c0000009") + bytes(10)]


def test_times_and_counts_of_events_are_not_compared() -> None:
    ours = Observed((telemetry(1), event(b"NOOP")), {})
    theirs = Observed((telemetry(1, at=9), event(b"NOOP", count=7)), {})
    assert differences(ours, theirs, Rules()) == []


@pytest.mark.parametrize("theirs", [telemetry(2), telemetry(1, count=1)])
def test_bytes_and_counts_of_telemetry_are_compared(theirs: bytes) -> None:
    ours = Observed((telemetry(1),), {})
    assert len(differences(ours, Observed((theirs,), {}), Rules())) == 1
    assert differences(ours, Observed((theirs,), {}), Rules(events_only=True)) == []


def test_missing_and_other_events_are_reported_for_each_side() -> None:
    found = differences(Observed((event(b"one"),), {}), Observed((event(b"two"),), {}), Rules())
    assert [each.partition(":")[0] for each in found] == ["only NASA's", "only ours"]


def test_blank_leaves_out_a_time_in_a_text() -> None:
    ours, theirs = Observed((event(b"at 12 s"),), {}), Observed((event(b"at 1234 s"),), {})
    assert differences(ours, theirs, Rules(blank=r"at \d+ s")) == []
    assert len(differences(ours, theirs, Rules())) == 2


def test_applications_of_cfe_6_are_not_compared(tmp_path: Path) -> None:
    mission = PublicMission("old", "a/b", options=("--cfe", "6.7"))
    [found] = compare_mission(mission, Sources(tmp_path), tmp_path, ["app"])
    assert found == Beside("old", "app", NOT_COMPARED, "0", "0", "it is for cFE 6")


def test_each_application_that_flies_has_a_comparison() -> None:
    flying = {(each.mission, each.app) for each in read_results() if each.flown in (ANSWERS, RUNS)}
    found = read_beside()
    assert {(each.mission, each.app) for each in found} == flying
    for each in found:
        assert each.outcome in (SAME, DIFFERS, NOT_COMPARED)
        assert each.text or each.outcome == SAME
        assert int(each.packets) > 0 or each.outcome != SAME


def test_comparisons_are_read_as_they_were_written(tmp_path: Path) -> None:
    found = [Beside("one", "app", SAME, "3", "5", ""), Beside("two", "app", DIFFERS, "1", "0", "a_b | c")]
    write_beside(found, tmp_path / "beside.tsv")
    assert read_beside(tmp_path / "beside.tsv") == found
    assert read_beside(tmp_path / "gone.tsv") == []


def test_page_counts_comparisons() -> None:
    results = read_results()
    one = next(each for each in results if each.flown == ANSWERS)
    text = page(read_missions(), results, [Beside(one.mission, one.app, SAME, "3", "5", "events")])
    assert "| same: 3 commands, 5 packets (events) |" in text
    assert "| differs | 0 |" in text
