"""The MsgIds of a mission: names, senders, subscribers; its lock file, written from them and read as pins."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.ground.mission_names import constants_in, core_names, names_of
from cfepy.ground.survey import LOOK_S, MidRow, Survey
from cfepy.mission import Mission, read_mission
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.rospy_shim.graph.test_msg_ids import FIRST, SECOND

STARTUP = "CFE_APP, n, __main__, N, 100, 16384, 0x0, 0;\n!\n"
NODE = f"""
    import rospy
    from std_msgs.msg import Empty as Nothing
    from std_srvs.srv import Empty
    rospy.init_node("n")
    keep = [rospy.Publisher(name, Nothing, queue_size=1) for name in ("{SECOND}", "{FIRST}")]
    rospy.Service("/reset", Empty, lambda request: [])
    rospy.spin()
    """


def rows_of(mission: str) -> dict[int, MidRow]:
    survey = Survey()
    with Mission(mission, console=Console(quiet=True), attachments=[survey]) as flown:
        flown.run_for(LOOK_S)
        return {row.msg_id: row for row in survey.rows()}


def test_core_names_match_nasas() -> None:
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
        "LIMIT = 3\n",
        encoding="utf-8",
    )
    assert list(constants_in(file)) == [("CMD_MID", 0x1890), ("HK_TLM_MID", 0x0891)]
    assert list(constants_in("installed.module")) == []


@pytest.mark.parametrize("text", ["CMD_MID=0x1890", "CMD_MID \\\n    = 0x1890", "(CMD_MID) = 0x1890"])
def test_constants_are_found_in_any_form_of_assignment(tmp_path: Path, text: str) -> None:
    file = tmp_path / "packets.py"
    file.write_text(f"import math\n{text}\n")
    assert list(constants_in(file)) == [("CMD_MID", 0x1890)]


def test_names_of_a_mission() -> None:
    names = names_of(read_mission("capture"))
    assert names[0x189A] == "HK_CMD"
    assert names[0x0910] == "/joint_states"
    assert names[0x1801] == "CFE_EVS_CMD"


def test_senders_and_subscribers_of_msg_ids_are_listed() -> None:
    rows = rows_of("rx64m_pubsub")
    there, back = rows[0x0901], rows[0x0902]
    assert (there.name, there.type) == ("/left_to_right", "std_msgs/UInt32")
    assert (there.senders, there.subscribers) == (["/left"], ["/right"])
    assert (back.senders, back.subscribers) == (["/right"], ["/left"])
    assert rows[0x1811].senders == ["CFE_TIME"]
    assert rows[0x1801].subscribers == ["CFE_EVS"]
    assert list(rows) == sorted(rows)


def ids_of(mission: str) -> dict[str, int]:
    with Mission(mission, console=Console(quiet=True)) as flight:
        flight.run_for(1)
        return {row.name: row.msg_id for row in flight.ros.topics()}


def test_mission_with_colliding_topics_flies_after_it_is_locked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = write_mission(tmp_path, STARTUP, n=NODE)
    assert SECOND not in ids_of(mission) or FIRST not in ids_of(mission)
    assert main(["graph", "--mids", "--lock", mission]) == 0
    assert "of them new" in capsys.readouterr().out
    spec = read_mission(mission)
    assert {FIRST, SECOND, "/rosout"} <= spec.ros.locked_topics.keys()
    assert "/reset" in spec.ros.locked_services
    flown = ids_of(mission)
    assert {name: flown[name] for name in (FIRST, SECOND)} == {
        name: spec.ros.locked_topics[name] for name in (FIRST, SECOND)
    }


def test_second_lock_only_adds_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = write_mission(tmp_path, STARTUP, n=NODE)
    main(["graph", "--mids", "--lock", mission])
    before = (tmp_path / "topics.lock").read_text(encoding="utf-8")
    main(["graph", "--mids", "--lock", mission])
    assert (tmp_path / "topics.lock").read_text(encoding="utf-8") == before
    (tmp_path / "n.py").write_text(
        (tmp_path / "n.py").read_text(encoding="utf-8").replace(f'"{FIRST}")', f'"{FIRST}", "/new")'), encoding="utf-8"
    )
    main(["graph", "--mids", "--lock", mission])
    assert capsys.readouterr().out.endswith("1 of them new\n")
    added = set((tmp_path / "topics.lock").read_text(encoding="utf-8").splitlines()) - set(before.splitlines())
    assert [line.split(":")[0].strip() for line in added] == ["/new"]


def test_lock_file_with_a_repeated_id_is_refused(tmp_path: Path) -> None:
    mission = write_mission(tmp_path, STARTUP, n=NODE, mission_yaml="topics: {/a: {msg_id: 0x0910}, /c: {msg_id: 5}}\n")
    (tmp_path / "topics.lock").write_text("topics:\n  /a: 0x0911\n  /b: 0x0910\nservices: {}\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"topics.lock:3: topics./b: the MsgId 0x0910 is already used by /a; remove"):
        read_mission(mission)
    assert [(found.file.name, found.line) for found in check_mission(mission)] == [("topics.lock", 3)]


def test_mission_file_has_precedence_over_the_lock_file(tmp_path: Path) -> None:
    mission = write_mission(tmp_path, STARTUP, n=NODE, mission_yaml="topics: {/a: {msg_id: 0x0910}}\n")
    (tmp_path / "topics.lock").write_text("topics: {/a: 0x0911, /b: 0x0911}\n", encoding="utf-8")
    assert read_mission(mission).ros.locked_topics == {"/b": 0x0911}
