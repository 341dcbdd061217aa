"""Damaged commands for CI_LAB, and the books that record the result of every one of them.

The commands come from a session with the real cFE. Each is damaged in one way or several, or left unchanged. A damaged
command may be valid by chance. Commands that would rightly end an application or the processor, or clear the counters
of the books, are removed by a rule: `MASKED` lists their function codes, and such a packet is replaced by the NOOP of
the same application.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from random import Random

import pytest

from apps.ci_lab import packets as ci_lab
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.msg import Command, CommandTable, get_msg_id, get_size
from cfepy.msg.dispatch import BAD_CODE, BAD_LENGTH, DONE, Dispatch
from cfepy.sb.routing import Destination
from cfepy.time.commands import TimeCommands
from cfepy.units import NS_PER_MS
from cfepy.writing.console import Console

DATA = Path(__file__).parents[1] / "data"
STARTUP = """\
CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
CFE_APP, ci_lab, CI_LAB_AppMain,  CI_LAB,     60, 16384, 0x0, 0;
CFE_APP, to_lab, TO_LAB_AppMain,  TO_LAB,     70, 16384, 0x0, 0;
CFE_APP, hk,     HK_AppMain,      HK,         90, 16384, 0x0, 0;
!
"""

ES, EVS, SB, TBL, TIME = 0x1806, 0x1801, 0x1803, 0x1804, 0x1805
TO_LAB, SAMPLE, CI_LAB, HK = 0x1880, 0x1882, 0x1884, 0x189A
PIPES = {
    ES: "ES_CMD_PIPE",
    EVS: "EVS_CMD_PIPE",
    SB: "SB_CMD_PIPE",
    TBL: "TBL_CMD_PIPE",
    TIME: "TIME_CMD_PIPE",
    TO_LAB: "TO_LAB_CMD_PIPE",
    SAMPLE: "SAMPLE_APP_CMD_PIPE",
    CI_LAB: "CI_LAB_CMD_PIPE",
    HK: "HK_CMD_PIPE",
}
REQUESTS = {
    ES: 0x1808,
    EVS: 0x1809,
    SB: 0x180B,
    TBL: 0x180C,
    TIME: 0x180D,
    TO_LAB: 0x1881,
    SAMPLE: 0x1883,
    CI_LAB: 0x1885,
    HK: 0x189B,
}
"""The request for housekeeping that belongs to each command message."""
TELEMETRY = {
    ES: 0x0800,
    EVS: 0x0801,
    SB: 0x0803,
    TBL: 0x0804,
    TIME: 0x0805,
    TO_LAB: 0x0880,
    SAMPLE: 0x0883,
    CI_LAB: 0x0884,
    HK: 0x089B,
}

MASKED = {
    ES: (1, 2, 4, 5, 6, 7),  # reset counters; restart; start, stop, restart and reload an application
    SB: (1, 4, 5),  # reset counters; enable and disable a route
    **dict.fromkeys((EVS, TBL, TIME, TO_LAB, SAMPLE, CI_LAB, HK), (1,)),  # reset counters
}

NOT_COUNTED = {(TBL, BAD_LENGTH), (SAMPLE, BAD_CODE), (CI_LAB, BAD_CODE)}
"""Refused commands that NASA's code has an event for, or nothing at all, but no counter."""
COUNTED_TOO = {
    **{msg_id: [(REQUESTS[msg_id], BAD_LENGTH)] for msg_id in (ES, EVS, SAMPLE)},
    SB: [(REQUESTS[SB], BAD_LENGTH), (0x180E, BAD_CODE), (0x180E, BAD_LENGTH)],
    TIME: [(0x1860, BAD_LENGTH)],  # TIME takes its other messages at any length
}
"""What counts as a rejected command although it is none."""

PASS = 11  # datagrams that CI_LAB reads at once
PASS_MS = 20  # virtual time from one pass to the next
BATCH = 20  # passes between two looks at the counters, which have 8 bits
LONGEST = 768  # bytes that CI_LAB reads of a datagram
COMMAND = 0x1000
HIGHEST_MSG_ID = 0x1FFF


def damaged(seed: int, count: int) -> Iterator[bytes]:
    """So many datagrams."""
    random = Random(seed)
    rows = json.loads((DATA / "command_events.json").read_text(encoding="utf-8"))
    commands = [bytes.fromhex(row["hex"]) for row in rows]
    msg_ids = [get_msg_id(command) for command in commands] + list(REQUESTS.values()) + list(TELEMETRY.values())
    for _ in range(count):
        packet = bytearray(random.choice(commands))
        for _ in range(random.choice((0, 1, 1, 2))):
            _damage(packet, random, msg_ids)
        yield bytes(_masked(packet))


def _damage(packet: bytearray, random: Random, msg_ids: list[int]) -> None:
    kind = random.randrange(6)
    if kind == 0:
        for _ in range(random.randint(1, 8)):
            packet[random.randrange(len(packet))] ^= 1 << random.randrange(8)
    elif kind == 1:
        del packet[random.randint(1, len(packet)) :]
    elif kind == 2:
        packet += random.randbytes(random.choice((1, 2, 8, 64, 700)))
    elif kind == 3:
        msg_id = random.choice(msg_ids) if random.random() < 0.7 else random.randrange(0x10000)
        packet[:2] = msg_id.to_bytes(2, "big")
    elif len(packet) > 6:
        packet[6] = random.randrange(24) if kind == 4 else random.randrange(256)
    if len(packet) > 6 and random.random() < 0.7:
        packet[4:6] = (len(packet) - 7).to_bytes(2, "big")


def _masked(packet: bytearray) -> bytearray:
    if len(packet) > 6 and packet[6] & 0x7F in MASKED.get(get_msg_id(packet), ()):
        packet[6] &= 0x80
    return packet


class Books:
    """The sent packets, and the mission's own counters of them.

    Attributes:
        refused, deliverable: datagrams that are not packets, and packets, by the rules of CI_LAB's documentation.
        by_msg_id: packets by MsgId.
        handled: commands that each application counted as accepted or rejected.
        outcomes: (MsgId, outcome) of every message that reached a command table.
    """

    def __init__(self, mission: Mission, ground: GroundLink, outcomes: Counter[tuple[int, int]]) -> None:
        self.mission = mission
        self.ground = ground
        self.outcomes = outcomes
        self.refused = self.deliverable = 0
        self.by_msg_id: Counter[int] = Counter()
        self.handled: Counter[int] = Counter()
        self._apps = self._alive()
        self._sb = mission.cfe.sb
        self._pipe = self._sb.create_pipe(50, "BOOKS")
        for msg_id in TELEMETRY.values():
            self._sb.subscribe_ex(msg_id, self._pipe, msg_limit=50)
        self._last: dict[int, bytes] = {}
        self._look()
        self.handled.clear()
        outcomes.clear()

    def send(self, datagrams: list[bytes]) -> None:
        """Send a batch of damaged commands, let CI_LAB read them, and look at everybody's counters."""
        for start in range(0, len(datagrams), PASS):
            for datagram in datagrams[start : start + PASS]:
                assert self.ground.send(datagram)
                self._enter(datagram)
            self._sb.transmit_msg(ci_lab.READ_UPLINK.packet())
            self.mission.run_until(self.mission.kernel.now + PASS_MS * NS_PER_MS)
        self.ground.received()
        self._look()

    def check(self) -> None:
        """Every datagram is in the books once, from the socket to the counters of the application it was for.

        And everybody is alive and was never started anew, nor the processor.
        """
        assert self._alive() == self._apps
        assert self.mission.record.resets == []
        assert self.ingested() == (self.deliverable, self.refused)
        for msg_id, sent in self.by_msg_id.items():
            if msg_id & COMMAND and msg_id <= HIGHEST_MSG_ID:  # only CI_LAB sends these
                assert self.relayed(msg_id) == sent, f"bus, 0x{msg_id:04X}"
        for command, pipe in PIPES.items():
            assert self.by_msg_id[command] == self.read(command) + self.dropped(command), pipe
            assert self.read(command) == self.dispatched(command), pipe
            assert self.handled[command] == self.countable(command), pipe

    def ingested(self) -> tuple[int, int]:
        """Return CI_LAB's counters: packets and errors."""
        fields = ci_lab.HK_TLM.read(self._last[CI_LAB])
        return fields["IngestPackets"], fields["IngestErrors"]

    def relayed(self, msg_id: int) -> int:
        """Packets of a MsgId that the bus took from CI_LAB."""
        route = self._sb.routes.get(msg_id)
        return self._sb.unrouted.sent.get(msg_id, 0) + (0 if route is None else route.relayed)

    def read(self, command: int) -> int:
        """Commands that an application read from its pipe."""
        return sum(one.gets for one in self._at_pipe(command))

    def dropped(self, command: int) -> int:
        """Commands that found no room in an application's pipe."""
        return sum(one.limit_drops + one.overflow_drops for one in self._at_pipe(command))

    def dispatched(self, command: int) -> int:
        """Commands that an application had a look at."""
        return sum(self.outcomes[command, outcome] for outcome in (DONE, BAD_CODE, BAD_LENGTH))

    def countable(self, command: int) -> int:
        """How far the two counters of an application ought to have gone."""
        kinds = [(command, outcome) for outcome in (DONE, BAD_CODE, BAD_LENGTH)]
        return sum(self.outcomes[kind] for kind in [*kinds, *COUNTED_TOO.get(command, [])] if kind not in NOT_COUNTED)

    def _alive(self) -> list[tuple[str, int]]:
        """Return names and ids of the applications. A restarted application gets another id."""
        return [(app.name, app.app_id) for app in self.mission.cfe.es.apps]

    def _at_pipe(self, command: int) -> list[Destination]:
        return [one for one in self._sb.routes[command].destinations if one.pipe.name == PIPES[command]]

    def _enter(self, datagram: bytes) -> None:
        data = datagram[:LONGEST]
        if len(data) < 8 or get_size(data) > len(data):
            self.refused += 1
        else:
            self.deliverable += 1
            self.by_msg_id[get_msg_id(data)] += 1

    def _look(self) -> None:
        """Request housekeeping from all applications, and add up their counters, which wrap after 255."""
        for request in REQUESTS.values():
            self._sb.transmit_msg(bytes([request >> 8, request & 0xFF, 0xC0, 0, 0, 1, 0, 0]))
        self.mission.run_for(1)
        found: dict[int, bytes] = {}
        while (packet := self._sb.receive_buffer(self._pipe, 0)) is not None:
            found[get_msg_id(packet)] = packet
        for command, telemetry in TELEMETRY.items():
            new, old = found[telemetry], self._last.get(command, bytes(18))
            self.handled[command] += sum((new[at] - old[at]) & 0xFF for at in (16, 17))
            self._last[command] = new


def fly(folder: Path, seed: int, count: int, monkeypatch: pytest.MonkeyPatch) -> Books:
    """Send damaged commands to a new mission. Returns its books."""
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    outcomes: Counter[tuple[int, int]] = Counter()
    dispatch, reject_length = CommandTable.dispatch, TimeCommands.reject_length

    def counting(table: CommandTable, packet: bytes) -> Dispatch:
        done = dispatch(table, packet)
        outcomes[done.msg_id, done.outcome] += 1
        return done

    def counting_short(commands: TimeCommands, packet: bytes, command: Command) -> None:
        reject_length(commands, packet, command)
        outcomes[command.msg_id, BAD_LENGTH] += 1

    monkeypatch.setattr(CommandTable, "dispatch", counting)
    monkeypatch.setattr(TimeCommands, "reject_length", counting_short)
    with Mission(str(folder), console=Console(quiet=True)) as mission, GroundLink(mission) as ground:
        mission.run_for(2)
        books = Books(mission, ground, outcomes)
        datagrams = damaged(seed, count)
        while batch := list(islice(datagrams, PASS * BATCH)):
            books.send(batch)
            mission.console.lines.clear()
        books.check()
        return books
