"""Fly random ends of applications, resets and ground tones in cfepy and in NASA's cFE, and report the differences.

Usage: CFEPY_REAL_CFE=FOLDER python -m dev.twin.lives_flight [--seed N] [--count COMMANDS] [--record FILE]

FOLDER is build/exe/cpu1 in the folder in which NASA's cFE was built: LINK (link_app.c) is compiled with its files.
"""

from __future__ import annotations

import itertools
import re
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path

from cfepy.evs import packets as evs
from cfepy.fs import HEADER_SIZE, header
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.sb.events import MSGID_LIM_ERR_EID
from cfepy.time import packets as time
from dev.twin import compare, mission, recorded
from dev.twin.flight import (
    STARTUP_PATH,
    Observed,
    Real,
    Simulated,
    differences,
    preparation,
    prepared_real,
    prepared_simulation,
)
from dev.twin.link_app import DOWN_PORT, REPLY_MID, UP_PORT
from dev.twin.lives import LivesCommander
from dev.twin.tables_real import compiled_app

LINK_APP = Path(__file__).with_name("link_app.c")
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
    """Return the results of a step without times in LINK's replies and without effects of a pipe that no task reads.

    SCH_LAB gets a packet each second, and its pipe holds four. Whether a fifth one arrives between its last read
    and its end depends on the phase between the seconds of ES and TIME. NASA's cFE sends no event when SCH_LAB itself
    sends into a full pipe, because SCH_LAB is not registered with EVS; see docs/reference/differences.md.
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
    """Return how many more tones than tone data the diagnostic packet of TIME counts: the ground sent these.

    Both numbers include the clock's own, one of which may be on its way when the counters are cleared or sent.
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


def simulated(release: str) -> AbstractContextManager[Simulated]:
    """Return the mission in cfepy, prepared, on a release of cFE such as "7.0.0"."""
    files = {**mission.files(), STARTUP_PATH: STARTUP.encode(), "/cf/link.py": LINK_APP.with_suffix(".py").read_bytes()}
    return prepared_simulation(files, preparation(), lambda flown: Simulated(flown, LINE), release)


def real(built: Path) -> AbstractContextManager[Real]:
    """Return the mission in NASA's cFE, prepared."""
    link = compiled_app(built.parents[2], LINK_APP)
    files = {**mission.files(), STARTUP_PATH: STARTUP.encode(), "/cf/link.so": link}
    return prepared_real(built, files, preparation(), line=LINE)


def fly(built: Path, seed: int, count: int) -> Iterator[compare.Flown]:
    """Fly the steps of a seed in both."""
    with real(built) as theirs, simulated(theirs.release) as ours:
        steps = itertools.islice(LivesCommander(seed).steps(), count)
        yield from compare.fly(ours, theirs, steps, lambda *both: differences(*map(settled, both)))


def main() -> int:
    """Fly until there were so many commands."""
    parser = compare.parser_of("dev.twin.lives_flight", __doc__, STEPS_OF_A_FLIGHT)
    parser.add_argument("--record", type=Path, help="where to put the flights on record")
    given = parser.parse_args()
    built, flights = compare.real_folder(), list[recorded.Flight]()

    def flight(seed: int) -> Iterator[compare.Flown]:
        flights.append([])
        for flown in fly(built, seed, given.flight):
            flights[-1].append((flown.step, flown.observed))
            yield flown

    status = compare.run(given, flight)
    if given.record is not None:
        recorded.save(given.record, flights)
    return status


if __name__ == "__main__":
    sys.exit(main())
