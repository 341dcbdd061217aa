"""The date of a mission: `epoch:` of the mission file, in the time of cFE, of nodes and of ground tools."""

from __future__ import annotations

import struct
from datetime import datetime
from pathlib import Path

import pytest

from cfepy.ground import dictionary_of
from cfepy.ground.shown_packets import PacketSerializer
from cfepy.mission import UNIX_AT_CFE_EPOCH, Mission, PacketWatch, Seen, read_mission
from cfepy.mission.mission_file import read_mission_file
from cfepy.msg import Telemetry
from cfepy.reading.mistakes import Mistakes
from cfepy.time import SysTime
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

DATE = "2026-05-01T12:00:00Z"
UNIX = 1_777_636_800
SINCE_1980 = UNIX - UNIX_AT_CFE_EPOCH
NODE = """
import rospy, time
from std_msgs.msg import Header
rospy.init_node("n")
print(f"rospy {rospy.get_time():.3f} python {time.time():.3f} at {time.gmtime().tm_year}")
"""


def flown(folder: Path, mission_yaml: str, startup: str = "!") -> Mission:
    mission = write_mission(folder, startup, n=NODE, mission_yaml=mission_yaml)
    return Mission(mission, console=Console(quiet=True))


@pytest.mark.parametrize("utc", [False, True])
def test_epoch_sets_utc_and_tai_of_the_spacecraft(tmp_path: Path, utc: bool) -> None:
    limits = f"limits: {{time_cfg_default_utc: {str(utc).lower()}}}"
    with flown(tmp_path, f"epoch: {DATE}\n{limits}") as mission:
        mission.run_for(2)
        time = mission.cfe.time
        assert (time.get_met(), time.get_leap_seconds()) == (SysTime(1002, 0), 37)
        assert time.get_utc() == SysTime(SINCE_1980 + 2, 0)
        assert time.get_tai() == SysTime(SINCE_1980 + 2 + 37, 0)
        assert time.get_time() == (time.get_utc() if utc else time.get_tai())
        assert time.text() == f"2026-121-12:00:{'02' if utc else '39'}.00000"
        assert mission.console.lines[-1].startswith(f"EVS Port1 2026-121-12:00:{'01' if utc else '38'}.00")


@pytest.mark.parametrize(
    ("limits", "stcf"),
    [
        ("{}", SINCE_1980 + 37 - 1000),
        ("{time_def_leaps: 0}", SINCE_1980 - 1000),
        ("{time_def_met_secs: 0, time_def_leaps: 18}", SINCE_1980 + 18),
    ],
)
def test_epoch_takes_leap_seconds_and_met_into_account(tmp_path: Path, limits: str, stcf: int) -> None:
    with flown(tmp_path, f"epoch: {DATE}\nlimits: {limits}") as mission:
        mission.run_for(1)
        assert mission.cfe.time.get_stcf() == SysTime(stcf, 0)
        assert mission.cfe.time.get_utc() == SysTime(SINCE_1980 + 1, 0)


def test_epoch_of_a_fraction_reaches_stcf_and_ros_time(tmp_path: Path) -> None:
    with flown(tmp_path, "epoch: 2026-05-01T12:00:00.25Z") as mission:
        mission.run_for(1)
        assert mission.cfe.time.get_utc() == SysTime(SINCE_1980 + 1, 1 << 30)
        assert mission.processor.machine.epoch_ns == UNIX * NS_PER_S + NS_PER_S // 4


def test_first_epoch_gives_a_stcf_that_wraps(tmp_path: Path) -> None:
    with flown(tmp_path, "epoch: 1980-01-01") as mission:
        mission.run_for(1)
        assert mission.cfe.time.get_stcf() == SysTime((1 << 32) - 963, 0)
        assert mission.cfe.time.text() == "1980-001-00:00:38.00000"


def test_nodes_have_the_utc_of_the_epoch(tmp_path: Path) -> None:
    with flown(tmp_path, f"epoch: {DATE}", "CFE_APP, n.py, __main__, N, 50, 8192, 0, 0;\n!") as mission:
        mission.run_for(1)
        (line,) = [line for line in mission.console.lines if "rospy " in line]
        words = line[line.index("rospy ") :].split()
        assert (float(words[1]), float(words[3])) == pytest.approx((UNIX + 0.55, UNIX + 0.55), abs=0.1)
        assert words[-1] == "2026"


def test_without_epoch_ros_time_is_the_spacecraft_time_also_as_utc(tmp_path: Path) -> None:
    limits = "time_def_met_subs: 250000, time_def_stcf_subs: 500000"
    for utc, leaps in (("false", 0), ("true", 37)):
        with flown(tmp_path, f"limits: {{time_cfg_default_utc: {utc}, {limits}}}") as mission:
            mission.run_for(1)
            now = mission.cfe.time.get_time()
            unix_ns = (UNIX_AT_CFE_EPOCH + now.seconds) * NS_PER_S + (now.subseconds * NS_PER_S >> 32)
            ros_ns = mission.processor.machine.epoch_ns + mission.kernel.now
            assert now.seconds == 1_001_001 - leaps
            assert abs(unix_ns - ros_ns) < 1000


@pytest.mark.parametrize("utc", ["false", "true"])
def test_packet_becomes_a_message_with_the_utc_of_the_epoch(tmp_path: Path, utc: str) -> None:
    seen: list[Seen] = []
    folder = write_mission(tmp_path, "!", mission_yaml=f"epoch: {DATE}\nlimits: {{time_cfg_default_utc: {utc}}}")
    watch = PacketWatch(seen.append, lambda msg_id: msg_id == 0x0808)
    with Mission(folder, console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(1.5)
        telemetry = dictionary_of(mission.spec).telemetry_of("CFE_EVS_LONG_EVENT_MSG")
        assert isinstance(telemetry, Telemetry)
        serializer = PacketSerializer(telemetry.payload, mission.spec.zero_s(mission.config))
        message = serializer.message(seen[-1].packet)
        assert message is not None
        assert struct.unpack_from("<4xI", message) == (UNIX + 1,)


@pytest.mark.parametrize(
    "said",
    [
        DATE,
        "2026-05-01 14:00:00+02:00",
        "2026-05-01T12:00:00",
        "'2026-05-01T12:00:00Z'",
        "2026-05-01T12:00Z",
        "2026-05-01T12:00:00.000Z",
    ],
)
def test_spellings_of_a_date_are_read(tmp_path: Path, said: str) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(f"epoch: {said}\n", encoding="utf-8")
    mistakes = Mistakes()
    assert read_mission_file(file, mistakes).epoch == UNIX * NS_PER_S
    assert mistakes.errors == []
    assert datetime.fromisoformat(DATE).timestamp() == UNIX


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("epoch: soon", "must be a date such as 2026-05-01T12:00:00Z, not 'soon'"),
        ("epoch: 2026", "must be a date such as 2026-05-01T12:00:00Z, not 2026"),
        ("epoch: '2026-13-01'", "not '2026-13-01': the month must be 1 to 12"),
        ("epoch: 2026-02-30T00:00:00Z", "has an invalid timestamp: day is out of range for month"),
        ("epoch: 1979-12-31T23:59:59Z", "must be in the years 1980 to 2105, not the date 1979-12-31 23:59:59+00:00"),
        ("epoch: 2106-01-01", "must be in the years 1980 to 2105, not the date 2106-01-01"),
        (
            "epoch: 0001-01-01T00:00:00+10:00",
            "years 1980 to 2105, not the date 0001-01-01 00:00:00+10:00",
        ),
        ("epoch: 2026-05-01\nlimits: {time_def_stcf_secs: 5}", "cannot be combined with limits.time_def_stcf_secs"),
    ],
)
def test_wrong_epoch_is_refused_with_file_line_and_field(tmp_path: Path, text: str, error: str) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(f"name: m\n{text}\n", encoding="utf-8")
    mistakes = Mistakes()
    mistakes.attempt(lambda: read_mission_file(file, mistakes))
    (found,) = mistakes.errors
    assert str(found).startswith(f"{file}:2: epoch: ")
    assert error in str(found)


def test_launch_file_takes_the_epoch_of_the_mission_file_beside_it(tmp_path: Path) -> None:
    write_mission(tmp_path, "!", n=NODE, mission_yaml=f"epoch: {DATE}")
    (tmp_path / "startup.scr").unlink()
    (tmp_path / "n.py").chmod(0o755)
    (tmp_path / "package.xml").write_text("<package><name>demo</name></package>", encoding="utf-8")
    (tmp_path / "n.launch").write_text('<launch><node pkg="demo" type="n.py" name="n"/></launch>', encoding="utf-8")
    assert read_mission(str(tmp_path / "n.launch")).epoch_ns == UNIX * NS_PER_S
