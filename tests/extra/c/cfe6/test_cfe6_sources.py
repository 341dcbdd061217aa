"""Sources of cFE 6: a small application of that time, built for each release and flown."""

from __future__ import annotations

import shutil
import struct
import subprocess
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain import CompilerError, Options, build
from cfepy.extra.c.toolchain.cfe6 import CFE_6, cfe6_flags, option_of
from cfepy.extra.c.toolchain.headers import NAMES_6, headers_folder, names
from cfepy.extra.dictionaries.cosmos_writer import cosmos_text
from cfepy.ground import dictionary_of
from cfepy.mission import Mission, PacketWatch, read_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.extra.c.building import CPP, needs_compiler

pytestmark = needs_compiler

VETERAN = Path(__file__).parent / "veteran"
BETWEEN = Path(__file__).parent / "between"
SCRIPT = "CFE_APP, veteran, VETERAN_Main, VETERAN, 50, 16384, 0x0, 0;\n!\n"
FLAGS = {
    "6.5": [],
    "6.7": ["-DPRIMARY_OF(m)=(m)->SpacePacket.Hdr", "-DSIZE_OF_FILE(s)=OS_FILESTAT_SIZE(s)"],
}
"""The names that differ between the releases, of the header in a message and of a file's size."""
HK = 0x0890
NOOP = bytes.fromhex("1890c0000001 0000")
LONG_NOOP = bytes.fromhex("1890c0000002 0000 00")
SEND_HK = bytes.fromhex("1891c0000001 0000")
each_release = pytest.mark.parametrize("release", CFE_6)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Build the application for each release; return the mission folders."""
    found = {}
    for release, flags in FLAGS.items():
        folder = tmp_path_factory.mktemp(f"cfe{release}")
        made = build(VETERAN, folder / "veteran.so", Options(cfe=release, flags=["-Wno-maybe-uninitialized", *flags]))
        assert made.warnings == []
        (folder / "startup.scr").write_text(SCRIPT)
        found[release] = folder
    return found


def fly(folder: Path, *commands: bytes) -> tuple[list[str], list[bytes]]:
    """Fly a mission with commands, 0.2 s apart, and return the events of the application and its telemetry."""
    packets: list[bytes] = []
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        mission.cfe.sb.listen(packets.append)
        for each in commands:
            mission.cfe.sb.transmit_msg(each, is_origination=False)
            mission.run_for(0.2)
        lines = [line.partition("/VETERAN ")[2] for line in mission.console.lines if "/VETERAN " in line]
    return lines, [bytes(each) for each in packets if int.from_bytes(each[:2]) == HK]


@pytest.fixture(scope="module", params=FLAGS)
def flown(request: pytest.FixtureRequest, built: dict[str, Path]) -> tuple[list[str], list[bytes]]:
    """Fly each build with the same commands."""
    return fly(built[request.param], NOOP, SEND_HK, LONG_NOOP, SEND_HK)


def test_application_of_cfe_6_answers_commands(flown: tuple[list[str], list[bytes]]) -> None:
    events, _ = flown
    assert events == [
        "1: headers 0xC08",
        "1: NOOP of 66",
        "1: checksum is right 0x1",
        "1: payload at 0x8",
        "1: payload 0x55AA",
        "1: count in the header 0x5",
        "1: value 0x55AA",
        "1: missing 0x1",
        "1: read 0x4",
        "1: size 0x4",
        "1: found 0x1",
        "1: own payload of 0x8",
        "1: own time 0xF4629",
        "2: length of 0x1890, code 0: 9, not 8",
        "1: own payload of 0x8",
        "1: own time 0xF4629",
    ]


def test_telemetry_of_cfe_6_has_a_header_of_12_bytes(flown: tuple[list[str], list[bytes]]) -> None:
    _, (first, second) = flown
    assert len(first) == 12 + 8
    for packet, count, commands, errors in ((first, 1, 2, 0), (second, 2, 2, 1)):
        stream, sequence, length, seconds, _ = struct.unpack(">HHHIH", packet[:12])
        assert (stream, sequence, length + 7) == (HK, 0xC000 | count, 20)
        assert seconds == 1_001_001
        assert struct.unpack("<BBHI", packet[12:]) == (commands, errors, 7 + 1, 2)


def test_pipe_without_message_gives_null(built: dict[str, Path]) -> None:
    with Mission(str(built["6.5"]), console=Console(quiet=True)) as mission:
        mission.run_for(6)
        assert any("VETERAN 1: no message 0x1" in each for each in mission.console.lines)


def test_table_of_cfe_6_has_msgids_of_16_bits(built: dict[str, Path]) -> None:
    for folder in built.values():
        assert (folder / "veteran_rows.tbl").read_bytes()[-8:] == struct.pack("<4H", HK, 7, 0x1FFF, 9)


def test_fault_names_the_line_of_the_application(tmp_path: Path) -> None:
    app = copied(tmp_path, "Data.IsReady = TRUE;", 'Inform("code", CFE_SB_GetCmdCode(Data.MsgPtr));')
    source = (app / "fsw/src/veteran.c").read_text().splitlines()
    line = next(number for number, text in enumerate(source, 1) if 'Inform("code"' in text)
    folder = tmp_path / "mission"
    build(app, folder / "veteran.so", Options(cfe="6.5"))
    (folder / "startup.scr").write_text(SCRIPT)
    (folder / "mission.yaml").write_text("safe: true\n")
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        mission.run_for(1)
    assert any("SIGSEGV" in each and f"veteran.c:{line})" in each for each in mission.console.lines)


def test_ground_names_come_from_headers_of_12_bytes(built: dict[str, Path]) -> None:
    for folder in built.values():
        dictionary = dictionary_of(read_mission(str(folder)))
        _, packets = fly(folder, SEND_HK)
        decoded = dictionary.decode(packets[0])
        assert (decoded.name, decoded.values) == (
            "VETERAN_HK_TLM",
            {"CmdCounter": 0, "ErrCounter": 0, "Limit": 8, "Copied": 2},
        )
        assert dictionary.command("VETERAN_FILES").packet(Value=7)[8:] == b"\x07\0"
        assert dictionary.telemetry["VETERAN_HK_TLM"].length == 12 + 8
        assert "  ITEM LIMIT 112 16 UINT " in cosmos_text(read_mission(str(folder)), dictionary)


# -- between cFE 6 and 7 -----------------------------------------------------------------------------------------------


def test_application_between_6_and_7_answers_with_messages_of_cfe_7(tmp_path: Path) -> None:
    made = build(BETWEEN, tmp_path / "between.so", Options(cfe="6.8"))
    assert made.warnings == []
    (tmp_path / "startup.scr").write_text("CFE_APP, between, BETWEEN_Main, BETWEEN, 50, 16384, 0x0, 0;\n!\n")
    packets: list[bytes] = []
    watch = PacketWatch(lambda seen: packets.append(bytes(seen.packet)), lambda msg_id: msg_id in (HK, 0x1890))
    with Mission(str(tmp_path), console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(1)
        for each in (NOOP, SEND_HK):
            mission.cfe.sb.transmit_msg(each, is_origination=False)
            mission.run_for(0.2)
        lines = [line.partition("/BETWEEN ")[2] for line in mission.console.lines if "/BETWEEN " in line]
    assert lines == ["1: NOOP 0 of 0x1890, 8 bytes, 1, 1", "1: NOOP 5 of 0x1890, 8 bytes, 1, 1"]
    _, told, echo = packets
    assert (len(told), told[:6].hex(), told[16:]) == (16 + 4, "0890c000000d", struct.pack("<HH", 1, 0x1890))
    assert echo[:6].hex() == "1890c0010001"  # SendMsg counts commands, too
    assert dictionary_of(read_mission(str(tmp_path))).telemetry["BETWEEN_HK_TLM"].length == 16 + 4


def test_build_of_sources_in_which_a_msgid_is_a_number_names_the_option(tmp_path: Path) -> None:
    with pytest.raises(
        CompilerError, match=r"It uses names of cFE 6: a MsgId as a number.*Build it with --cfe 6\.8\.\)$"
    ):
        build(BETWEEN, tmp_path / "between.so")


@pytest.mark.parametrize(
    ("release", "option"),
    [("6.5.0", "--cfe 6.5"), ("6.7.3", "--cfe 6.7"), ("6.7.99", "--cfe 6.8"), ("7.0.0", None), ("6.7.?", None)],
)
def test_release_of_a_tree_names_the_option(release: str, option: str | None) -> None:
    assert option_of(release.split(".")) == option


# -- errors ------------------------------------------------------------------------------------------------------------


def copied(tmp_path: Path, old: str, new: str) -> Path:
    """Copy the application, with one text of its source replaced."""
    app = tmp_path / "veteran"
    shutil.copytree(VETERAN, app)
    source = app / "fsw/src/veteran.c"
    text = source.read_text()
    assert text.count(old) == 1
    source.write_text(text.replace(old, new))
    return app


def test_build_without_a_release_names_both_options_if_the_names_do_not_tell(tmp_path: Path) -> None:
    with pytest.raises(CompilerError) as raised:
        build(VETERAN, tmp_path / "veteran.so")
    assert str(raised.value).endswith(
        "(It uses names of cFE 6: network_includes.h. "
        "Build it with --cfe 6.5 (cFE 6.0 to 6.5) or --cfe 6.7 (cFE 6.6 and 6.7).)"
    )


@pytest.mark.parametrize(("name", "option"), [("CFE_ES_RUNSTATUS_APP_RUN", "6.5"), ("CFE_ES_RunStatus_APP_RUN", "6.7")])
def test_build_without_a_release_names_the_option_that_the_names_tell(name: str, option: str, tmp_path: Path) -> None:
    app = copied(tmp_path, "= CFE_ES_APP_RUN", f"= {name}")
    with pytest.raises(CompilerError, match=rf"Build it with --cfe {option}\.\)$"):
        build(app)


def test_removed_name_is_reported_with_its_line_and_a_replacement(tmp_path: Path) -> None:
    app = copied(tmp_path, "Data.IsReady = TRUE;", "CFE_SB_GetLastSenderId(NULL, Data.Pipe); Data.IsReady = TRUE;")
    source = app / "fsw/src/veteran.c"
    line = next(i for i, text in enumerate(source.read_text().splitlines(), 1) if "GetLastSenderId" in text)
    with pytest.raises(CompilerError) as raised:
        build(app, options=Options(cfe="6.5"))
    last = str(raised.value).splitlines()[-1]
    assert last == (
        f"{source}:{line}: error: CFE_SB_GetLastSenderId was removed: "
        "cFE 7 does not record the sender of a message; put it into the packet"
    )


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (Options(cfe="6.9"), "--cfe: unknown release '6.9'; did you mean 6.8? (expected 6.5, 6.7 or 6.8)"),
        (Options(cfe="6.5", omit_deprecated=True), "--cfe: cannot be combined with --omit-deprecated"),
        (Options(cfe="6.5", cfs=Path("cFS")), "--cfe: cannot be combined with --cfs"),
    ],
)
def test_release_that_cannot_be_built_is_refused(options: Options, text: str) -> None:
    with pytest.raises(UsageError) as raised:
        build(VETERAN, options=options)
    assert str(raised.value).startswith(text)


def test_new_mission_from_sources_of_cfe_6_flies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(VETERAN, tmp_path / "veteran")
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mission", "flown", "--from", "veteran", "--cfe", "6.5"]) == 0
    assert "build: cfepy build veteran --cfe 6.5" in capsys.readouterr().out


@each_release
@pytest.mark.parametrize("tool", [[*compiler(), "-std=gnu11"], [*CPP, "-std=gnu++17"]], ids=["c", "cpp"])
def test_headers_of_cfe_6_compile_without_warnings(release: str, tool: list[str], tmp_path: Path) -> None:
    folder = headers_folder()
    suffix = ".c" if "gnu11" in tool[-1] else ".cpp"
    source = tmp_path / f"names{suffix}"
    text = "".join(f'#include "{name}.h"\n' for name in (*names(NAMES_6), *sorted(names())))
    old = "boolean Yes = TRUE; CFE_EVS_Packet_t Event;" if release != "6.8" else "CFE_SB_MsgId_t Id = 0x1890;"
    source.write_text(f"{text}CFE_SB_MsgPtr_t Message; {old}\n")
    flags = [f"-I{folder}", *cfe6_flags(release, folder), "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    assert subprocess.run([*tool, *flags, str(source)], capture_output=True, text=True).stderr == ""
