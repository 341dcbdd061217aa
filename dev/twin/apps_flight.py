"""Fly random commands of NASA's flight applications in cfepy and in NASA's cFE, and report the differences.

Usage: CFEPY_REAL_CFE=FOLDER python -m dev.twin.apps_flight [--seed N] [--count COMMANDS] [--apps LC SC ...]

FOLDER is build/exe/cpu1 in the folder in which NASA's cFE was built together with the applications, release 7.0.0. The
same shared objects and tables fly in both.
"""

from __future__ import annotations

import itertools
import re
import struct
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, suppress
from pathlib import Path

from cfepy import msg
from cfepy.evs import packets as evs
from cfepy.status import OsalError
from dev.twin import apps_files, compare, masks
from dev.twin.apps_commands import TELEMETRY_HEARD, AppsCommander
from dev.twin.commands import PLAIN, Step
from dev.twin.flight import (
    STARTUP_PATH,
    Observed,
    Real,
    Simulated,
    file_differences,
    first_difference,
    only,
    prepared_real,
    prepared_simulation,
)
from dev.twin.flight_apps import CF, DS, FLIGHT_APPS, FM, HS, FlightApp
from dev.twin.link_app import DOWN_PORT, UP_PORT
from dev.twin.tables_real import compiled_app

LINK_APP = Path(__file__).with_name("link_app.c")
TABLES = Path(__file__).parents[2] / "missions" / "cfs"
STEPS_OF_A_FLIGHT = 400
LINE = UP_PORT, DOWN_PORT
ROWS = "".join(
    f"CFE_APP, {app.name.lower()}, {app.name}_AppMain, {app.name}, {90 + number}, 16384, 0x0, 0;\n"
    for number, app in enumerate(FLIGHT_APPS)
)
STARTUP = f"CFE_APP, link, LINK_Main, LINK, 40, 65536, 0x0, 0;\n{ROWS}!\n"
EVENTS = evs.LONG_EVENT_MSG_MID
RESET_CODE = 1
SET_DEST_COUNT, CLOSE_ALL, COPY_FILE, DELETE_ALL_FILES = 13, 18, 2, 7
FIRST_FILE = 100
FILES = (b"/cf/cf_def_config.tbl", b"/ram/a.dat"), (b"/cf/sc_rts001.tbl", b"/ram/b.dat")
"""What lies in /ram at the beginning, and where it is from."""
MASKED = {
    # events that HS counted, processor time in use, and how often tasks ran
    0x8AD: [range(28, 36), range(44, 180)],
    # checksums of the computer's own code, and CS's progress, which mostly covers that code
    0x8A4: [range(40, 56), range(76, 80)],
    0x88B: [range(28, 32)],  # when a file was changed
    0x88C: [range(92 + 68 + entry * 76, 92 + 72 + entry * 76) for entry in range(20)],  # the same of files in a folder
    0x88E: [range(16 + 64 + entry * 88, 16 + 88 + entry * 88) for entry in range(8)],  # room on the host's disks
}
"""Bytes of telemetry that the host decides."""
NAMED_BY_TIME = re.compile(rb"(/[a-z]+)\d{13}(?=\.)")
"""What DS calls a file that has a time in its name."""
FM_LISTING = 0x88C
IN_ANY_ORDER = {FM_LISTING: (92, 76), 0x88D: (20, 84)}
"""Lists of files, first byte and size of an entry: a folder has the host's order, files that are open that of ids."""
EVENT_MONITOR = b"on HS_EVENT_PIPE,app HS"
"""On a Linux without /proc/schedstat NASA's system monitor does not start, and then HS does not listen to events."""


def of_packet(packet: bytes) -> bytes | None:
    """Return the compared content of a packet, or None to leave it out."""
    packet = _without_time(packet)
    told = masks.of_packet(packet)
    msg_id = int.from_bytes(packet[:2], "big")
    if told is None or masks.is_event(packet):
        return None if told is not None and EVENT_MONITOR in told else told
    left = bytearray(packet)
    for at in itertools.chain(*MASKED.get(msg_id, ())):
        if at < len(left):
            left[at] = 0
    if msg_id == FM_LISTING and any(packet[88:92]):  # from a later file on: in another order, other files
        left[92:] = b""
    if msg_id in IN_ANY_ORDER:
        first, size = IN_ANY_ORDER[msg_id]
        left[first:] = b"".join(sorted(left[at : at + size] for at in range(first, len(left), size)))
    return bytes(left[:2] + left[4:6] + left[16:])


def differences(ours: Observed, theirs: Observed) -> list[str]:
    """Return the differences between two observations of a step, one line each."""
    mine, real_ones = ([told for told in map(of_packet, each.packets) if told is not None] for each in (ours, theirs))
    found = []
    for told in [*real_ones]:
        if told in mine:
            mine.remove(told)
            real_ones.remove(told)
    for told in [*real_ones]:
        pair = next((each for each in mine if each[:2] == told[:2] and told[:2] != EVENTS.to_bytes(2, "big")), None)
        if pair is not None:
            mine.remove(pair)
            real_ones.remove(told)
            found.append(f"telemetry 0x{told[:2].hex()}: {first_difference(pair[4:], told[4:])}, behind the header")
    files = file_differences(_without_times(ours), _without_times(theirs), _of_file)
    return [*found, *only(real_ones, mine), *files]


def _without_times(observed: Observed) -> Observed:
    """Return the names of files without the time in them."""
    files = {_without_time(path.encode()).decode(): data for path, data in observed.files.items()}
    return observed._replace(files=files)


def _without_time(data: bytes) -> bytes:
    return NAMED_BY_TIME.sub(rb"\1.............", data)


def _of_file(path: str, ours: bytes, theirs: bytes) -> str:
    return first_difference(*(apps_files.of_file(path, each, of_packet) for each in (ours, theirs)))


def tables() -> dict[str, bytes]:
    """Return tables of missions/cfs that replace NASA's, which are nearly empty, by virtual path.

    FM looks at a disk only: its figures of a folder count the entry `..`, which cfepy does not list.
    """
    given = [each for each in TABLES.glob("*.tbl") if each.name.startswith(("lc_", "sc_", "ds_", "cf_", "hk_", "fm_"))]
    return {f"/cf/{each.name}": each.read_bytes() for each in given}


def command(app: FlightApp, code: int, payload: bytes = b"") -> Step:
    """Return a step of one command."""
    return Step(app.name, (bytes(msg.command(app.commands_mid, code, payload)),), PLAIN)


def preparation() -> list[Step]:
    """Return steps that reset counters of the boot, and hide flywheel events from applications that count events.

    DS begins with new files, because the two boots have different numbers of events.
    """
    quiet = Step("EVS", (evs.DISABLE_APP_EVENTS.packet(AppName="CFE_TIME"),), PLAIN)
    resets = [command(app, RESET_CODE, bytes(4 if app is CF else 0)) for app in FLIGHT_APPS]
    woken = Step(HS.name, (bytes(msg.command(HS.wakeup_mid, 0)),), PLAIN)
    counts = [command(DS, SET_DEST_COUNT, struct.pack("<HHI", number, 0, FIRST_FILE)) for number in range(2)]
    files = [
        *counts,
        command(DS, CLOSE_ALL),
        command(FM, DELETE_ALL_FILES, struct.pack("<64s", b"/ram")),
        *(command(FM, COPY_FILE, struct.pack("<H64s64s", 1, *names)) for names in FILES),
    ]
    growth = Step(DS.name, (bytes(msg.command(DS.housekeeping_mid, 0)),), PLAIN)  # of files, between two
    return [quiet, *files, *resets, resets[FLIGHT_APPS.index(HS)], woken, growth, growth]


class SimulatedApps(Simulated):
    """The mission in cfepy."""

    def _read_files(self) -> dict[str, bytes]:
        found = {}
        for name in self._mission.files.list_dir("/ram"):
            with suppress(OsalError):  # a folder
                found[f"/ram/{name}"] = self._mission.files.read_file(f"/ram/{name}")
        return found


class RealApps(Real):
    """The mission in NASA's cFE."""

    of_packet = staticmethod(of_packet)

    def _read_files(self) -> dict[str, bytes]:
        return self._booted.files()


def simulated(
    built: Path, more: Mapping[str, bytes] | None = None, steps: Sequence[Step] = (), memory: str = "linux"
) -> AbstractContextManager[Simulated]:
    """Return the prepared mission in cfepy.

    Args:
        built: the folder of NASA's executable.
        more: replacement files, by virtual path.
        steps: steps to fly first, after the preparation.
        memory: how applications reach memory by address, as in a mission file.
    """
    flown = [f"{app.name.lower()}.so" for app in FLIGHT_APPS]
    files = {
        f"/cf/{each.name}": each.read_bytes()
        for each in (built / "cf").iterdir()
        if each.suffix == ".tbl" or each.name in flown
    }
    heard = ", ".join(map(hex, TELEMETRY_HEARD))
    link = LINK_APP.with_suffix(".py").read_text(encoding="utf-8").replace("WATCHED = (", f"WATCHED = ({heard}, ")
    files |= {**tables(), STARTUP_PATH: STARTUP.encode(), "/cf/link.py": link.encode(), **(more or {})}
    return prepared_simulation(files, [*preparation(), *steps], lambda flown: SimulatedApps(flown, LINE), memory=memory)


def real(
    built: Path, more: Mapping[str, bytes] | None = None, steps: Sequence[Step] = ()
) -> AbstractContextManager[Real]:
    """Return the same in NASA's cFE."""
    heard = ",".join(map(hex, TELEMETRY_HEARD))
    link = compiled_app(built.parents[2], LINK_APP, f"-DMORE_WATCHED={heard},")
    files = {**tables(), STARTUP_PATH: STARTUP.encode(), "/cf/link.so": link, **(more or {})}
    return prepared_real(built, files, [*preparation(), *steps], RealApps, LINE)


def fly(built: Path, seed: int, count: int, names: list[str]) -> Iterator[compare.Flown]:
    """Fly the steps of a seed in both."""
    with real(built) as theirs, simulated(built) as ours:
        steps = itertools.islice(AppsCommander(seed, names).steps(), count)
        yield from compare.fly(ours, theirs, steps, differences)


def main() -> int:
    """Fly until there were so many commands."""
    parser = compare.parser_of("dev.twin.apps_flight", __doc__, STEPS_OF_A_FLIGHT)
    parser.add_argument("--apps", nargs="*", default=[], help="names of the applications; all of them without")
    given = parser.parse_args()
    built = compare.real_folder()
    return compare.run(given, lambda seed: fly(built, seed, given.flight, given.apps))


if __name__ == "__main__":
    sys.exit(main())
