"""The MsgIds of a mission: names, senders, subscribers."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import read_mission
from cfepy.mission.mids import MidRow, survey
from cfepy.mission.msg_names import core_names, declared, names_of


def rows_of(mission: str) -> dict[int, MidRow]:
    return {row.msg_id: row for row in survey(read_mission(mission))}


def test_core_names_are_nasas() -> None:
    names = core_names()
    assert names[0x0808] == "CFE_EVS_LONG_EVENT_MSG"
    assert names[0x1806] == "CFE_ES_CMD"
    assert names[0x1860] == "CFE_TIME_DATA_CMD"


def test_names_in_an_apps_source(tmp_path: Path) -> None:
    file = tmp_path / "app.py"
    file.write_text(
        "from cfepy.msg import local_cmd_topic_id_to_msg_id\n"
        "CMD_MID = local_cmd_topic_id_to_msg_id(0x90)\n"
        "HK_TLM_MID = 0x0891\n"
        "LATER_MID = CMD_MID + 1\n"
        "LIMIT = 3\n"
    )
    assert list(declared(file)) == [("CMD_MID", 0x1890), ("HK_TLM_MID", 0x0891)]
    assert list(declared("installed.module")) == []


def test_names_of_a_mission() -> None:
    names = names_of(read_mission("capture"))
    assert names[0x189A] == "HK_CMD"
    assert names[0x0910] == "/joint_states"
    assert names[0x1801] == "CFE_EVS_CMD"


def test_who_sends_and_who_subscribes() -> None:
    rows = rows_of("rx64m_pubsub")
    counter = rows[0x0901]
    assert (counter.name, counter.type) == ("/counter", "std_msgs/UInt32")
    assert (counter.senders, counter.subscribers) == (["/talker"], ["/listener"])
    assert rows[0x1811].senders == ["CFE_TIME"]
    assert rows[0x1801].subscribers == ["CFE_EVS"]
    assert list(rows) == sorted(rows)
