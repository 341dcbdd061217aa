"""Telemetry of the real cFE, packet by packet: ours is the same, except for the fields in `golden_masks`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest

from cfepy import msg
from cfepy.evs.packets import LONG_EVENT_MSG
from cfepy.ground.dictionary import dictionary_of
from cfepy.mission import read_mission
from cfepy.msg import TLM_HEADER_SIZE, Telemetry
from tests.mission.flights import write_mission
from tests.mission.golden_masks import BUILD_EVENT, MASKED
from tests.mission.golden_session import STARTUP, Session, by_msg_id, fly, recorded_telemetry

EVENTS = (0x0808, 0x0809)
TIME_OF_HEADER = slice(6, 12)
FLYWHEEL_EVENTS = {("CFE_TIME", 20), ("CFE_TIME", 21)}


class Pair(NamedTuple):
    """A recorded packet and ours."""

    name: str
    recorded: bytes
    ours: bytes


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    return fly(tmp_path_factory.mktemp("session"))


@pytest.fixture(scope="module")
def declared(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Telemetry]:
    dictionary = dictionary_of(read_mission(write_mission(tmp_path_factory.mktemp("dictionary"), STARTUP)))
    names = {row["name"] for row in recorded_telemetry() if row["mid"] not in EVENTS}
    found = {
        name: dictionary.telemetry_of(f"{mid_of(name):#x}") for name in names if not name.startswith("HK_COMBINED")
    }
    return {name: each for name, each in found.items() if isinstance(each, Telemetry)}


def mid_of(name: str) -> int:
    return next(int(row["mid"]) for row in recorded_telemetry() if row["name"] == name)


def pairs(session: Session) -> list[Pair]:
    """Return pairs of the n-th recorded packet of a MsgId and our n-th, since telemetry was switched on, without
    events."""
    ours = {msg_id: iter(packets) for msg_id, packets in by_msg_id(session.telemetry).items()}
    rows = [row for row in recorded_telemetry() if row["mid"] not in EVENTS]
    return [Pair(row["name"], bytes.fromhex(row["hex"]), next(ours[row["mid"]])) for row in rows]


def differing(declared: dict[str, Telemetry], pair: Pair) -> set[str]:
    """Return the differing fields. Bytes outside of fields (padding, header) are named by offset."""
    assert len(pair.ours) == len(pair.recorded)
    offsets = {at for at in range(len(pair.ours)) if pair.ours[at] != pair.recorded[at]}
    offsets -= set(range(len(pair.ours))[TIME_OF_HEADER])
    found = set()
    for cell in declared[pair.name].payload.cells() if pair.name in declared else ():
        inside = offsets & set(range(TLM_HEADER_SIZE + cell.offset, TLM_HEADER_SIZE + cell.offset + cell.size))
        if inside:
            offsets -= inside
            found.add(cell.path)
    return found | {f"byte {at}" for at in offsets}


def test_telemetry_packets_equal_the_recorded_ones(session: Session, declared: dict[str, Telemetry]) -> None:
    compared = pairs(session)
    assert len(compared) == 30
    wrong = {pair.name: differing(declared, pair) - set(MASKED.get(pair.name, ())) for pair in compared}
    assert {name: sorted(fields) for name, fields in wrong.items() if fields} == {}


def test_each_masked_field_differs(session: Session, declared: dict[str, Telemetry]) -> None:
    needed: dict[str, set[str]] = {}
    for pair in pairs(session):
        needed.setdefault(pair.name, set()).update(differing(declared, pair))
    assert {
        name: sorted(set(fields) - needed[name]) for name, fields in MASKED.items() if set(fields) - needed[name]
    } == {}


def test_events_equal_the_recorded_ones(session: Session) -> None:
    recorded = [bytes.fromhex(row["hex"]) for row in recorded_telemetry() if row["mid"] in EVENTS]
    ours = [packet for packet in session.telemetry if msg.get_msg_id(packet) in EVENTS]
    compared = list(comparable(recorded))
    assert len(compared) == 30
    assert list(comparable(ours)) == compared


def comparable(packets: list[bytes]) -> Iterator[bytes]:
    """Yield the compared event packets, without their masked parts."""
    for packet in packets:
        event: dict[str, Any] = LONG_EVENT_MSG.read(packet.ljust(LONG_EVENT_MSG.length, b"\0"))
        source = event["PacketID"]["AppName"], event["PacketID"]["EventID"]
        if source in FLYWHEEL_EVENTS:
            continue
        text = b"" if event["Message"].startswith(BUILD_EVENT) else packet[12:]
        yield packet[:2] + packet[4:6] + packet[12:48] + text
