"""Devices at ports and buses of compiled applications: Python objects and UDP ports, by hwlib and by device files."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cfepy.extra.c.toolchain import build
from cfepy.mission import Mission
from cfepy.osal import Datagram, Mailbox, Place
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, needs_compiler, said

pytestmark = needs_compiler

HERE = Path(__file__).parent
DEVICES = """
devices:
  /dev/ttyS1: {python: hardware.py:Receiver}
  /dev/i2c-1:0x1e: {python: hardware.py:Magnetometer}
  /dev/spidev0.0: {python: hardware.py:Inverter}
  gpio24: {python: hardware.py:Echo}
  can0: {python: hardware.py:Echo}
"""
SCRIPT = "CFE_APP, {0}, {0}_Main, {0}, 50, 16384, 0x0, 0;\n!\n"


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Compile the applications once."""
    folder = tmp_path_factory.mktemp("objects")
    for name in ("sensor", "files", "can"):
        source = folder / name / "fsw/src"
        source.mkdir(parents=True)
        shutil.copy(HERE / f"{name}.c", source)
        assert build(folder / name, folder / f"{name.upper()}.so").warnings == []
    return folder


def mission_of(folder: Path, objects: Path, app: str, devices: str = DEVICES) -> str:
    shutil.copy(objects / f"{app}.so", folder)
    shutil.copy(HERE / "hardware.py", folder)
    (folder / "startup.scr").write_text(SCRIPT.format(app))
    (folder / "mission.yaml").write_text(devices)
    return str(folder)


def events(mission: Mission, app: str) -> list[str]:
    return [line.partition(f"/{app} 1: ")[2].rstrip() for line in mission.console.lines if f"/{app} 1: " in line]


def fly(folder: str, app: str, seconds: float = 3) -> list[str]:
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(seconds)
        return events(mission, app)


def test_hwlib_reaches_a_device_of_each_kind(tmp_path: Path, objects: Path) -> None:
    found = fly(mission_of(tmp_path, objects, "SENSOR"), "SENSOR")
    time = "302e36"  # "0.6", when the application starts
    assert [line for line in found if not line.startswith("closed ")] == [
        "uart init 0 01",
        "uart write 4",
        "uart waiting 7",
        f"uart read 7 50494e47{time}",
        "uart nothing 0",
        "uart close 0 00",
        "uart init -27 00",
        "uart write -1",
        "uart waiting 0",
        "uart read -1",
        "uart nothing -1",
        "uart close -27 00",
        "i2c init 0",
        "i2c read 0 0f1011",
        "i2c absent -1",
        "spi init 0",
        "spi 0 f0efeefb",
        "gpio init 0",
        "gpio write 0",
        "gpio read 0 01",
        "can bitrate 0",
        "can start 0",
        "can absent -1",
        "can init 0",
        "can write 0",
        "can read 0 01ef",
        "can id 291",
        "can late -11",
    ]


def test_hwlib_refuses_a_device_that_is_not_open(tmp_path: Path, objects: Path) -> None:
    """As on Linux, where the descriptor in the structure is not open, or the pin is not exported."""
    found = fly(mission_of(tmp_path, objects, "SENSOR"), "SENSOR", 6)
    refused = ["uart -1", "uart -1", "i2c -1", "spi -12", "gpio -27", "gpio -4", "can -9"]
    assert [line.removeprefix("closed ") for line in found if line.startswith("closed ")] == refused * 2


def test_device_files_reach_the_same_devices(tmp_path: Path, objects: Path) -> None:
    found = fly(mission_of(tmp_path, objects, "FILES"), "FILES")
    assert found == [
        *("open 1", "get 0", "VMIN 1", "speed 1", "set 0", "write 4", "ioctl 0", "waiting 7", "read 7", "first 80"),
        *(
            "timeout 0",
            "nonblocking -1",
            "EAGAIN 1",
            "close 0",
            "absent -1",
            "ENOENT 1",
            "bad -1",
            "EBADF 1",
            "bad close -1",
        ),
        *("no address -1", "slave 0", "i2c write 1", "i2c read 3", f"i2c data {0x0F1011}", "both 2", "none -1"),
        *("EREMOTEIO 1", "mode 0", "got 3", "spi 3", f"spi data {0xF0EFEE}", "ENOTTY -1"),
    ]


def test_read_of_a_serial_port_waits_in_virtual_time(tmp_path: Path, objects: Path) -> None:
    with Mission(mission_of(tmp_path, objects, "FILES"), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        lines = [each for each in mission.console.lines if "/FILES 1: first" in each or "/FILES 1: timeout" in each]
    first, late = (float(each.split()[2].rpartition(":")[2]) for each in lines)
    assert late - first == pytest.approx(0.2, abs=0.001)


def test_sockets_of_can_exchange_frames_with_a_bus(tmp_path: Path, objects: Path) -> None:
    assert fly(mission_of(tmp_path, objects, "CAN"), "CAN") == [
        "unbound -1",
        "ENXIO 1",
        "can0 0",
        "bind 0",
        "can0 0",
        "bind 0",
        "can7 -1",
        "bind 0",
        "ENODEV 1",
        "index 2",
        "write 16",
        "short -1",
        "read 16",
        "id 291",
        "second 16",
        "echo 16",
        "data 3",
        "nonblocking -1",
        "EAGAIN 1",
        "filter 0",
        "filtered -1",
        "poll 1",
        "passed 16",
        "id 767",
    ]


def test_udp_port_is_a_device(tmp_path: Path, objects: Path) -> None:
    devices = "devices:\n  /dev/ttyS1: {udp: 5010, to: 5011}\n  /dev/i2c-1:0x1e: {python: hardware.py:Magnetometer}\n"
    devices += "  /dev/spidev0.0: {python: hardware.py:Inverter}\n"
    with Mission(mission_of(tmp_path, objects, "FILES", devices), console=Console(quiet=True)) as mission:
        peer = Mailbox()
        mission.network.datagrams.bind(peer, Place("127.0.0.1", 5011))
        mission.run_for(0.5)
        mission.network.send(Datagram(Place("127.0.0.1", 5011), Place("127.0.0.1", 5010), b"hello"))
        mission.run_for(2)
        assert peer.take().data == b"ping"
        assert "read 5" in events(mission, "FILES")


def test_check_reports_device_files_without_devices(tmp_path: Path, objects: Path) -> None:
    folder = mission_of(tmp_path, objects, "FILES", "safe: true\n")
    (warning,) = [each.text for each in check_mission(folder)]
    names = re.sub(r" \(files\.c:\d+\)", "", warning)
    assert names.startswith("FILES needs cfgetispeed, cfmakeraw, cfsetispeed, tcgetattr, tcsetattr for a device, but")
    assert "the mission connects none; add `devices:` to the mission file" in warning
    (tmp_path / "mission.yaml").write_text(DEVICES)
    assert check_mission(folder) == []


def test_device_files_without_devices_do_not_exist(tmp_path: Path, objects: Path) -> None:
    folder = mission_of(tmp_path, objects, "FILES", "safe: true\n")
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(1)
    assert any("open() of /dev/ttyS1: it is not a device of the mission" in each for each in mission.console.lines)


@pytest.mark.parametrize(
    ("devices", "text"),
    [
        ("{python: hardware.py}", "'hardware.py' is not a class; expected FILE.py:CLASS"),
        ("{python: none.py:Thing}", "none.py not found"),
        ("{udp: 5010}", "requires `to: HOST:PORT`"),
        ("{udp: 70000, to: 1}", "70000"),
        ("{udp: 1, to: x:y}", "'x:y' is not an address; expected PORT or HOST:PORT"),
        ("{python: hardware.py:Echo, to: 5}", "is only valid with `udp` or `topic`"),
        ("{python: hardware.py:Echo, type: std_msgs/String}", "is only valid with `topic`"),
        ("{topic: gps raw}", "'gps raw' is not a ROS name; expected /NAME"),
        (
            "{topic: /gps, type: std_msgs/Int8}",
            "'std_msgs/Int8' carries no bytes; expected std_msgs/UInt8MultiArray or",
        ),
        ("{udp: 5, to: 6, topic: /gps}", "requires one of"),
        ("{}", "requires one of `python: FILE.py:CLASS`, `udp: PORT` and `topic: NAME`"),
        ("{pyton: hardware.py:Echo}", "did you mean python"),
    ],
)
def test_wrong_device_is_reported_with_its_line(devices: str, text: str, tmp_path: Path, objects: Path) -> None:
    folder = mission_of(tmp_path, objects, "FILES", f"devices:\n  /dev/ttyS1: {devices}\n")
    found = [str(each) for each in check_mission(folder) if not each.is_warning]
    assert len(found) == 1
    assert "mission.yaml:2: devices./dev/ttyS1" in found[0]
    assert text in found[0]


@pytest.mark.parametrize(
    ("source", "text"),
    [
        ("class Thing:\n    pass\n", "has no class Thing that is a cfepy.extra.c.Device"),
        ("from cfepy.extra.c import Device\nclass Thing(Device):\n    x = 1 / 0\n", "ZeroDivisionError"),
    ],
)
def test_class_that_is_not_a_device_is_an_error_at_start(source: str, text: str, tmp_path: Path, objects: Path) -> None:
    folder = mission_of(tmp_path, objects, "FILES", "devices:\n  /dev/ttyS1: {python: thing.py:Thing}\n")
    (tmp_path / "thing.py").write_text(source)
    with pytest.raises(UsageError, match=text), Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(1)


def test_headers_of_hwlibs_can_compile_without_the_hosts_library(tmp_path: Path) -> None:
    source = tmp_path / "can/fsw/src/can.c"
    source.parent.mkdir(parents=True)
    source.write_text('#include <libsocketcan.h>\nint up(void) { return can_set_bitrate("can0", 500000); }\n')
    assert build(tmp_path / "can", tmp_path / "can.so").warnings == []


NODE = """
#!/usr/bin/env python3
import rospy
from std_msgs.msg import String, UInt8MultiArray

rospy.init_node("gps")
answers = rospy.Publisher("/gps/{answers}", {kind}, queue_size=10)


def answer(message):
    data = message.data if isinstance(message.data, bytes) else message.data.encode()
    answers.publish({kind}(data=bytes(data).upper(){decode}))


rospy.Subscriber("/gps/commands", {kind}, answer)
rospy.spin()
"""
PORT = """
    #include <fcntl.h>
    #include <sys/stat.h>
    #include <unistd.h>
    void TEST_Main(void)
    {
        char data[32] = "";
        struct stat facts = {0};
        SAY("stat %d", stat("/dev/ttyS1", &facts));
        SAY("is a device %d", S_ISCHR(facts.st_mode));
        int port = open("/dev/ttyS1", O_RDWR);
        OS_TaskDelay(1000);
        SAY("write %d", (int)write(port, "position?", 9));
        int count = read(port, data, 5);
        SAY("read %d %s", count, data);
        count = read(port, data, sizeof data);
        SAY("read %d %.4s", count, data);
    }
"""


@pytest.mark.parametrize(("kind", "priority"), [("String", 40), ("UInt8MultiArray", 60)])
def test_node_is_a_device_by_two_topics(tmp_path: Path, kind: str, priority: int) -> None:
    named = ", type: std_msgs/String" if kind == "String" else ""
    mission = f"devices:\n  /dev/ttyS1: {{topic: /gps/answers, to: gps/commands{named}}}\n"
    decode = ".decode()" if kind == "String" else ""
    compile_c(tmp_path, "TEST", PORT)
    (tmp_path / "mission.yaml").write_text(mission)
    (tmp_path / "gps.py").write_text(NODE.format(answers="answers", kind=kind, decode=decode).lstrip())
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, gps.py, __main__, GPS, 60, 65536, 0x0, 0;\n" + SCRIPT.format("TEST")
    )
    with Mission(str(tmp_path), console=Console(quiet=True)) as flown:
        flown.run_for(4)
        found = said("\n".join(flown.console.lines))
    assert found == ["stat 0", "is a device 1", "write 9", "read 5 POSIT", "read 4 ION?"]
