"""SBN in real time: two missions over UDP, and a mission with NASA's cFE 7.0.0 and NASA's SBN."""

from __future__ import annotations

import shutil
import socket
from pathlib import Path

import pytest

import cfepy
from apps.sbn import protocol as pr
from cfepy.mission import Arrival, Mission
from cfepy.msg import command, get_msg_id
from cfepy.time import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID
from cfepy.time import packets as time
from cfepy.writing.console import Console
from dev.host_ports import free_port
from dev.twin.real import in_network_of, installed
from tests.twin.sbn_flight import CLIENT_VARIABLE, PAIR, SBN_VARIABLE, Paced, paced, real_sbn
from tests.twin.sbn_peer import RealPeer, VirtualPeer, serve_time

SERVER, CLIENT = installed(SBN_VARIABLE), installed(CLIENT_VARIABLE)
needs_sbn = pytest.mark.skipif(SERVER is None, reason=f"{SBN_VARIABLE} names no folder")
needs_client = pytest.mark.skipif(CLIENT is None, reason=f"{CLIENT_VARIABLE} names no folder")
NOOP = bytes(command(0x1882, 0))
SAMPLE_HK, TIME_HK_OF_CLIENT = 0x0883, 0x0825
CORE_COMMANDS = (0x1801, 0x1803, 0x1804, 0x1805, 0x1806)
NOWHERE = 0
TO_SERVER = (*((1, msg_id, NOWHERE) for msg_id in (*CORE_COMMANDS, 0x1862)), (1, 0x0805, TIME_HK_OF_CLIENT))


def counter(packets: list[bytes]) -> int:
    """Return SAMPLE_APP's last reported counter of commands."""
    return packets[-1][17] if packets else -1


@pytest.mark.slow
def test_two_missions_over_udp() -> None:
    ports = {number: free_port(socket.SOCK_DGRAM) for number in (2234, 2235)}
    with (
        paced("pair", {**ports, 1234: free_port(socket.SOCK_DGRAM)}) as first,
        paced(str(PAIR / "client.scr"), ports) as second,
    ):

        def both() -> bool:
            second.step()
            return counter(first.packets(SAMPLE_HK)) != 1

        first.run_while(lambda: (second.step(), not first.says("protocol version match"))[1])
        first.send(NOOP)
        first.run_while(both)
        assert second.says("SAMPLE: NOOP command")


@needs_sbn
@pytest.mark.slow
def test_a_mission_and_nasas_sbn(tmp_path: Path) -> None:
    assert SERVER is not None
    with (
        real_sbn(SERVER, tmp_path, 2, TO_SERVER) as real,
        in_network_of(real.inside),
        paced("pair") as flight,
    ):
        flight.run_while(lambda: not flight.says("SBN protocol version match with peer 66:2"))
        flight.send(NOOP)
        flight.run_while(lambda: counter(flight.packets(SAMPLE_HK)) != 1)
        flight.run_while(lambda: not flight.packets(TIME_HK_OF_CLIENT))
        real.kill()  # it is back before it was missed
        flight.seen.clear()
        flight.run_while(lambda: counter(flight.packets(SAMPLE_HK)) != 0)
        assert real.boots() == 2
        assert_bytes_are_ours(flight)


def assert_bytes_are_ours(flight: Paced) -> None:
    """Assert that everything that NASA's SBN sent equals what cfepy's would have sent, byte for byte."""
    kinds = set()
    for data in flight.heard:
        message = pr.unpack(data, 32_768)
        assert pr.pack(message) == data
        kinds.add(message.kind)
        if message.kind == pr.SUB_MSG:
            ident, subscriptions = pr.unpack_subscriptions(message.payload)
            assert pr.pack_subscriptions(subscriptions, ident) == message.payload
            assert ident == pr.IDENT
    assert {pr.SUB_MSG, pr.APP_MSG, pr.PROTO_MSG} <= kinds


def said_by_client(folder: Path, code: list[Path]) -> list[tuple[int, bytes | int]]:
    """Return the messages of processor 2 in 20 virtual seconds, in order: type and payload, or the MsgId of packets.

    Args:
        folder: folder for its mission.
        code: files of compiled code in place of cfepy's SBN.
    """
    shutil.copytree(PAIR, folder)
    for each in code:
        shutil.copy(each, folder)
    said: list[tuple[int, bytes | int]] = []

    def listen(arrival: Arrival) -> None:
        if arrival.kind == "datagram":
            message = pr.unpack(arrival.values[-1], 32_768)
            said.append((message.kind, get_msg_id(message.payload) if message.kind == pr.APP_MSG else message.payload))

    with cfepy.boot("pair", beside=[str(folder / "client.scr")]) as flight:
        flight.mission.outside.listener = listen
        flight.run_until(20)  # later an answer and a tone meet in one millisecond, within which the two may differ
        assert flight.flown().results.beside[0]["died"] == ""
    return said


@needs_sbn
@pytest.mark.slow
def test_nasas_compiled_sbn_sends_the_same_messages_as_cfepys(tmp_path: Path) -> None:
    """The same shared objects as above, in virtual time.

    The only difference is that cfepy's sends its subscriptions once more.
    """
    assert SERVER is not None
    code = [SERVER / "cf" / name for name in ("sbn.so", "sbn_udp.so", "sbn_f_remap.so")]
    own = said_by_client(tmp_path / "own", [])
    nasas = said_by_client(tmp_path / "nasa", code)
    again = next(at for at, each in enumerate(own) if each[0] == pr.SUB_MSG and own.index(each) < at)
    del own[again]
    assert own == nasas
    assert len(own) > 70


VALID, INVALID, FLYWHEEL = CLOCK_VALID, CLOCK_INVALID, CLOCK_FLYWHEEL
TOLD = (VALID, 100, 10), (VALID, 100, 10), (VALID, 200, 11), (FLYWHEEL, 200, 11), (INVALID, 300, 11), (VALID, 300, 11)
TONES = (*TOLD, None, None, None, None, (VALID, 400, 12), (VALID, 400, 12))
TWO_SECONDS_LATER = len(TOLD) + 1
"""Where a client goes on by itself; on a computer on which no tone takes exactly a second, perhaps one tone later."""


def of_mission() -> list[dict[str, object]]:
    with Mission(str(PAIR / "client.scr"), console=Console(quiet=True)) as mission:
        mission.run_for(1.3)
        return list(serve_time(VirtualPeer(mission), TONES))


@pytest.mark.slow
def test_client_takes_the_time_from_another_processor() -> None:
    told = of_mission()
    states = [each["ClockStateAPI"] for each in told]
    assert states[: len(TOLD)] == [VALID, VALID, VALID, FLYWHEEL, INVALID, VALID]
    assert states[len(TOLD) :] == [VALID, FLYWHEEL, FLYWHEEL, FLYWHEEL, VALID, VALID]
    assert [each["STCF"] for each in told] == [100, 100, 200, 200, 300, 300, *[300] * 4, 400, 400]


@needs_sbn
@pytest.mark.slow
def test_client_mission_follows_nasas_server(tmp_path: Path) -> None:
    assert SERVER is not None
    with real_sbn(SERVER, tmp_path, 1, ((2, time.ONEHZ_CMD.msg_id, NOWHERE),)) as real, in_network_of(real.inside):
        peer = RealPeer(2)
        peer.join([time.DATA_CMD.msg_id])
        peer.packet(time.DATA_CMD.msg_id)
        peer.pause(0.9)  # so that the client's tones come shortly before the server's messages about them
        peer.close()
        with paced(str(PAIR / "client.scr")) as flight:
            clock = flight.mission.cfe.time
            flight.run_while(lambda: clock.tone.counters.tone_match < 2)
            data = time.DATA_CMD.read(flight.packets(time.DATA_CMD.msg_id)[-1])
            assert clock.get_met()[0] == data["AtToneMET"]["Seconds"]
            assert clock.get_stcf()[0] == data["AtToneSTCF"]["Seconds"]
            assert clock.get_clock_state() == data["AtToneState"] == INVALID
            assert flight.says("Stop FLYWHEEL")
            real.kill()
            flight.run_while(lambda: not flight.says("Start FLYWHEEL"))


@needs_client
@pytest.mark.slow
def test_nasas_client_follows_the_mission_in_the_same_way(tmp_path: Path) -> None:
    assert CLIENT is not None
    with real_sbn(CLIENT, tmp_path, 2, TO_SERVER) as real, in_network_of(real.inside):
        peer = RealPeer()
        peer.pause(1.5)
        try:
            told = list(serve_time(peer, TONES))
        finally:
            peer.close()
    expected = of_mission()
    del told[TWO_SECONDS_LATER], expected[TWO_SECONDS_LATER]
    assert told == expected
