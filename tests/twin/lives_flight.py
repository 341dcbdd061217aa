"""Fly random ends of applications, resets and ground tones in cfepy and in NASA's cFE, and tell what differs.

Usage: CFEPY_REAL_CFE=FOLDER python -m tests.twin.lives_flight [--seed N] [--count COMMANDS] [--record FILE]

FOLDER is build/exe/cpu1 in the folder in which NASA's cFE was built: LINK (link_app.c) is compiled with what is there.
"""

from __future__ import annotations

import argparse
import itertools
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cfepy.console import Console
from cfepy.evs import packets as evs
from cfepy.fs import HEADER_SIZE, header
from cfepy.mission import Mission
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.sb.events import MSGID_LIM_ERR_EID
from cfepy.time import packets as time
from tests.twin import mission, recorded
from tests.twin.commands import Step
from tests.twin.flight import Observed, Real, Simulated, differences, preparation
from tests.twin.link_app import DOWN_PORT, REPLY_MID, UP_PORT
from tests.twin.lives import LivesCommander
from tests.twin.real import VARIABLE, RealCfe, installed
from tests.twin.tables_real import compile_app

HERE = Path(__file__).parent
LINE = UP_PORT, DOWN_PORT
STEPS_OF_A_FLIGHT = 40
OVERFLOW = re.compile(rb"Msg Limit Err,MsgId 0x1811,pipe SCH_LAB_CMD_PIPE|.*sender SCH_LAB\0")
SHORT_OVERFLOW = b"CFE_SB".ljust(20, b"\0") + MSGID_LIM_ERR_EID.to_bytes(2, "little")
"""How the same begins without its text."""
SB_AS_APP = 1, 2
"""Which of the applications SB is, in release 7.0.0 and in 7.0.1."""
FILTERS = 8
LINK = "CFE_APP, link, LINK_Main, LINK, 40, 65536, 0x0, 0;\n"
_LIBRARY, _, _APPS = mission.STARTUP.partition("\n")
STARTUP = f"{_LIBRARY}\n{LINK}{_APPS}"


def settled(observed: Observed) -> Observed:
    """What came of a step, without times in LINK's replies, and what comes of a pipe that nobody reads.

    SCH_LAB gets a packet each second, of which its pipe takes four. Whether there is a fifth one between its last look
    and its end depends on how the seconds of ES and TIME lie to each other. Of what SCH_LAB itself sends into a full
    pipe no event tells in NASA's, since SCH_LAB is not registered with EVS; see docs/differences.md.
    """
    packets = (_without_overflow(each) for each in observed.packets)
    files = {path: _filters_without_overflow(data) for path, data in observed.files.items()}
    return Observed(tuple(each for each in packets if each), files)


def _without_overflow(packet: bytes) -> bytes:
    msg_id = int.from_bytes(packet[:2], "big")
    if msg_id == time.DIAG_TLM_MID:
        return _tones(packet)
    if msg_id == REPLY_MID:
        return packet[:2] + bytes(2) + packet[4:6] + bytes(6) + packet[12:]
    if msg_id == evs.LONG_EVENT_MSG_MID and OVERFLOW.match(packet[48:]):
        return b""
    if msg_id == evs.SHORT_EVENT_MSG_MID and packet[16:38] == SHORT_OVERFLOW:
        return b""
    if msg_id == evs.HK_TLM_MID:
        for number in SB_AS_APP:
            at = TLM_HEADER_SIZE + evs.HOUSEKEEPING.offsets["AppData"] + number * evs.APP_TLM.size
            packet = _blanked(packet, at + evs.APP_TLM.offsets["AppMessageSentCounter"], 2)
    return packet


def _tones(packet: bytes) -> bytes:
    """Of the diagnostic packet of TIME, how many more tones than data of tones came: the ground sent these.

    Both also count the clock's own, of which one may just be on its way when the counters are cleared or told.
    """
    fields = time.DIAG_TLM.read(packet)
    return f"more tones than data: {fields['ToneSignalCounter'] - fields['ToneDataCounter']}".encode()


def _filters_without_overflow(data: bytes) -> bytes:
    if int.from_bytes(data[4:8], "big") != header.SUBTYPE_EVS_APPDATA:
        return data
    for at in range(HEADER_SIZE, len(data), evs.APP_DATA_RECORD.size):
        for number in range(FILTERS if data[at : at + 7] == b"CFE_SB\0" else 0):
            filters = at + evs.APP_DATA_RECORD.offsets["Filters"] + number * evs.FILTER_RECORD.size
            data = _blanked(data, filters + evs.FILTER_RECORD.offsets["Count"], 2)
    return data


def _blanked(data: bytes, at: int, size: int) -> bytes:
    return data[:at] + bytes(size) + data[at + size :]


@contextmanager
def simulated(release: str) -> Iterator[Simulated]:
    """The mission in cfepy, prepared, on a release of cFE such as "7.0.0"."""
    with tempfile.TemporaryDirectory() as folder:
        for path, data in mission.files().items():
            (Path(folder) / Path(path).name).write_bytes(data)
        (Path(folder) / "startup.scr").write_text(STARTUP)
        (Path(folder) / "link.py").write_text((HERE / "link_app.py").read_text())
        (Path(folder) / "mission.yaml").write_text(f'cfe_version: "{release}"\n')
        with Mission(folder, console=Console(quiet=True)) as flown:
            computer = Simulated(flown, LINE)
            for step in preparation():
                computer.fly(step)
            yield computer


@contextmanager
def real(built: Path) -> Iterator[Real]:
    """The mission in NASA's cFE, prepared."""
    with tempfile.TemporaryDirectory() as folder:
        app = Path(folder) / "link.so"
        compile_app(built.parents[2], app, HERE / "link_app.c")
        files = {**mission.files(), "/cf/cfe_es_startup.scr": STARTUP.encode(), "/cf/link.so": app.read_bytes()}
        with RealCfe(built, Path(folder) / "cfe", files, LINE) as booted:
            computer = Real(booted)
            for step in preparation():
                computer.fly(step)
            yield computer


def fly(built: Path, seed: int, count: int) -> Iterator[tuple[Step, Observed, list[str]]]:
    """Fly the steps of a seed in both: each, with what came of it in NASA's and what differs."""
    with real(built) as theirs, simulated(theirs.release) as ours:
        for step in itertools.islice(LivesCommander(seed).steps(), count):
            expected = ours.fly(step)
            observed = theirs.fly(step, expected)
            yield step, observed, differences(settled(expected), settled(observed))


def main() -> int:
    """Fly until there were so many commands."""
    parser = argparse.ArgumentParser(prog="python -m tests.twin.lives_flight", description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of the first flight; the next ones count up")
    parser.add_argument("--count", type=int, default=100, help="commands in all")
    parser.add_argument("--flight", type=int, default=STEPS_OF_A_FLIGHT, help="steps of a flight")
    parser.add_argument("--record", type=Path, help="where to put the flights on record")
    given = parser.parse_args()
    built = installed()
    if built is None:
        sys.exit(f"{VARIABLE} does not say where the folder of NASA's core-cpu1 is")
    commands = unlike = 0
    flights: list[recorded.Flight] = []
    for seed in itertools.count(given.seed):
        flights.append([])
        for number, (step, observed, lines) in enumerate(fly(built, seed, given.flight)):
            flights[-1].append((step, observed))
            commands += len(step.packets)
            unlike += bool(lines)
            if lines:
                sent = " ".join(packet.hex() for packet in step.packets)
                print(f"seed {seed}, step {number}, {step.service} {step.pace}: {sent}", *lines, sep="\n  ", flush=True)
        print(f"seed {seed}: {commands} commands so far, {unlike} steps differ", flush=True)
        if commands >= given.count:
            break
    if given.record is not None:
        recorded.save(given.record, flights)
    return 1 if unlike else 0


if __name__ == "__main__":
    sys.exit(main())
