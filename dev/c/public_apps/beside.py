"""Fly a public application on cfepy and on NASA's cFE with the same commands, and compare its packets and events.

The same sources are built twice: for cfepy with its headers, and for NASA's cFE with the headers of its build. Each
MsgId of a command pipe gets the codes 0 to 11 without a payload. If the application answers with the length that it
expects, the code comes again with that length and a random payload. Behind each command come the requests for
telemetry. A MsgId of telemetry gets an empty packet.

Both sides have the configuration of NASA's build, and no devices. The application LINK carries packets to and from the
ground (`dev/twin/link_app.py`). Times of packets, sequence counts of events and events of flywheel mode are left out.
"""

from __future__ import annotations

import random
import re
import shutil
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy import msg
from cfepy.es import StartupEntry, entries
from cfepy.evs.packets import LONG_EVENT_MSG_MID
from cfepy.mission import Mission, PacketWatch, Seen
from cfepy.mission.host_actions import PACKET
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.writing.console import Console
from dev.c.public_apps.flight import BOOT_S, COMMAND_BIT, SCRIPT, subscribed_to
from dev.c.public_apps.nasa_headers import compiled
from dev.twin import masks
from dev.twin.commands import PLAIN, Step
from dev.twin.flight import STARTUP_PATH, Observed, Real, Simulated, first_difference, only
from dev.twin.link_app import DOWN_PORT, UP_PORT
from dev.twin.real import RealCfe, release_of

LINK_APP = Path(__file__).parents[2] / "twin/link_app.c"
LINE = UP_PORT, DOWN_PORT
LINK_ENTRY = "CFE_APP, link, LINK_Main, LINK, 40, 65536, 0x0, 0;\n"
CODES = range(12)
ASKED_S = 0.5
_LENGTH = re.compile(r"[Ee]xp\w*\D{1,30}?(?:0x)?(\d+)")
_LONGEST = 2000
_SHARED = (".so", ".tbl", ".ini", ".txt", ".json", ".xml", ".csv", ".dat")
_EVENT = LONG_EVENT_MSG_MID.to_bytes(2, "big")


class Compared(NamedTuple):
    """The comparison of an application.

    Attributes:
        commands: the commands sent.
        packets: packets and events that were equal on both.
        differences: a line for each difference.
    """

    commands: int
    packets: int
    differences: tuple[str, ...]


class Rules(NamedTuple):
    """The parts of packets that are left out of a comparison.

    Attributes:
        events_only: whether telemetry is left out.
        blank: a regular expression for parts of events that are left out; nothing if empty.
    """

    events_only: bool = False
    blank: str = ""

    def of_packet(self, packet: bytes) -> bytes | None:
        """Return the compared content of a packet, or None to leave it out."""
        if masks.of_packet(packet) is None:
            return None
        if not masks.is_event(packet):
            return None if self.events_only else packet[:6] + packet[12:]
        told = packet[:2] + packet[4:6] + packet[12:]
        return re.sub(self.blank.encode(), b"", told).rstrip(b"\0") if self.blank else told


class Plan(NamedTuple):
    """The packets to send and to watch.

    Attributes:
        steps: a packet each, with the requests for telemetry behind it.
        telemetry: MsgIds that the application sends.
    """

    steps: tuple[Step, ...]
    telemetry: tuple[int, ...]


def compare(ours: Path, theirs: Path, built: Path, rules: Rules) -> Compared:
    """Fly the last application of two mission folders on both, and compare.

    Args:
        ours: the mission folder for cfepy.
        theirs: the same, built with NASA's headers.
        built: the folder of NASA's executable, inside of its build.
        rules: the parts that are left out.
    """
    [*_, app] = entries((ours / SCRIPT).read_bytes())
    plan = planned(_as_release(ours, release_of(built)), app)
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        script = (ours / SCRIPT).read_text(encoding="utf-8")
        with _real(theirs, script, plan, built, here / "real") as booted, _mission(ours, script, plan, here) as mission:
            mine, real = SimulatedApp(mission, LINE), RealApp(booted, rules)
            here_events = Counter(_events_of(mission.console.lines, app.name))
            there_events = Counter(_events_of(booted.console().decode(errors="replace").splitlines(), app.name))
            found = [f"boot: only NASA's: event {each}" for each in (there_events - here_events).elements()]
            found += [f"boot: only ours:   event {each}" for each in (here_events - there_events).elements()]
            equal = (here_events & there_events).total()
            for step in plan.steps:
                expected = mine.fly(step)
                observed = real.fly(step, expected)
                found += [f"{step.packets[0].hex()}: {line}" for line in differences(expected, observed, rules)]
                equal += (expected.told(rules.of_packet) & observed.told(rules.of_packet)).total()
    return Compared(len(plan.steps), equal, tuple(found))


def planned(folder: Path, app: StartupEntry) -> Plan:
    """Fly an application alone in cfepy, and find its commands with their lengths, and its telemetry."""
    sent: list[Seen] = []
    watch = PacketWatch(sent.append, lambda msg_id: not msg_id & COMMAND_BIT and msg_id != LONG_EVENT_MSG_MID)
    found: list[bytes] = []
    requests: list[bytes] = []
    with Mission(str(folder), console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(BOOT_S)
        search = _Search(mission, app.name, sent)
        for msg_id in subscribed_to(mission.cfe.sb, app.name):
            if msg_id & COMMAND_BIT:
                found += search.commands(msg_id, requests)
            else:
                found.append(_telemetry(msg_id))
        telemetry = sorted({each.msg_id for each in sent if each.sender == app.name})
    return Plan(tuple(Step("", (each, *requests), PLAIN) for each in found), tuple(telemetry))


class _Search:
    """Finds the commands of an application in flight, and the lengths that it expects.

    Args:
        mission: the flight.
        app: the application.
        sent: gets the telemetry during the flight.
    """

    def __init__(self, mission: Mission, app: str, sent: Sequence[Seen]) -> None:
        self._mission, self._app, self._sent = mission, app, sent
        self._dice = random.Random(app)

    def commands(self, msg_id: int, requests: list[bytes]) -> list[bytes]:
        """Return the commands of a MsgId. A request for telemetry is added to `requests`."""
        found: list[bytes] = []
        events = 0
        for code in CODES:
            packet = bytes(msg.command(msg_id, code))
            said, has_telemetry = self._ask(packet)
            events += len(said)
            if not code and not said and has_telemetry:
                requests.append(packet)
            if not events and code > 1:  # a wakeup, or a request: it ignores the code
                break
            found.append(packet)
            lengths = {int(each[1]) for line in said for each in _LENGTH.finditer(line)}
            for length in sorted(each for each in lengths if len(packet) < each < _LONGEST):
                payload = bytes(self._dice.randrange(256) for _ in range(length - len(packet)))
                found += (bytes(msg.command(msg_id, code, each)) for each in (bytes(len(payload)), payload))
        return found

    def _ask(self, packet: bytes) -> tuple[list[str], bool]:
        """Send a packet. Returns the events, and whether the application sent telemetry."""
        lines, count = len(self._mission.console.lines), len(self._sent)
        self._mission.outside.act(PACKET, packet)
        self._mission.run_for(ASKED_S)
        said = _events_of(self._mission.console.lines[lines:], self._app)
        return said, any(each.sender == self._app for each in self._sent[count:])


def _telemetry(msg_id: int) -> bytes:
    """Return a packet of telemetry without a payload."""
    return (msg_id << 32 | 0xC0000000 | TLM_HEADER_SIZE - 7).to_bytes(6, "big") + bytes(TLM_HEADER_SIZE - 6)


def _as_release(folder: Path, release: str) -> Path:
    """Write a mission file with the release of cFE and NASA's own configuration. Returns the folder."""
    (folder / "mission.yaml").write_text(f'cfe_version: "{release}"\n', encoding="utf-8")
    return folder


def _mission(folder: Path, script: str, plan: Plan, scratch: Path) -> Mission:
    flown = scratch / "ours"
    shutil.copytree(folder, flown)
    heard = "".join(f"{each:#x}, " for each in plan.telemetry)
    link = LINK_APP.with_suffix(".py").read_text(encoding="utf-8").replace("WATCHED = (", f"WATCHED = ({heard}")
    (flown / "link.py").write_text(link, encoding="utf-8")
    (flown / SCRIPT).write_text(LINK_ENTRY + script, encoding="utf-8")
    return Mission(str(flown), console=Console(quiet=True))


def _real(folder: Path, script: str, plan: Plan, built: Path, scratch: Path) -> RealCfe:
    heard = "".join(f"{each:#x}," for each in plan.telemetry)
    files = {
        f"/cf/{each.relative_to(folder).as_posix()}": each.read_bytes()
        for each in folder.rglob("*")
        if each.is_file() and each.suffix in _SHARED
    }
    files["/cf/link.so"] = compiled(LINK_APP, scratch.with_name("link.so"), built, f"-DMORE_WATCHED={heard}")
    files[STARTUP_PATH] = (LINK_ENTRY + script).encode()
    return RealCfe(built, scratch, files, LINE)


class SimulatedApp(Simulated):
    """The mission in cfepy. Its files are not compared."""

    def _read_files(self) -> dict[str, bytes]:
        return {}


class RealApp(Real):
    """The mission in NASA's cFE. Its files are not compared.

    Args:
        booted: NASA's cFE.
        rules: the parts of packets that are left out.
    """

    def __init__(self, booted: RealCfe, rules: Rules) -> None:
        self._rules = rules
        super().__init__(booted)

    def of_packet(self, packet: bytes) -> bytes | None:
        """Return the compared content of a packet, or None to leave it out."""
        return self._rules.of_packet(packet)

    def _read_files(self) -> dict[str, bytes]:
        return {}


def differences(ours: Observed, theirs: Observed, rules: Rules) -> list[str]:
    """Return the differences between two observations of a step, one line each."""
    mine, real = ours.told(rules.of_packet), theirs.told(rules.of_packet)
    missing, added = [*(real - mine).elements()], [*(mine - real).elements()]
    found = []
    for each in [*missing]:
        pair = next((other for other in added if other[:2] == each[:2] and other[:2] != _EVENT), None)
        if pair is not None:
            missing.remove(each)
            added.remove(pair)
            found.append(f"telemetry 0x{each[:2].hex()}: {first_difference(pair, each)}")
    return [*found, *only(missing, added)]


def _events_of(lines: Sequence[str], app: str) -> list[str]:
    return [found[1] for each in lines if (found := re.search(rf"/{re.escape(app)} (\d+: .*)", each))]
