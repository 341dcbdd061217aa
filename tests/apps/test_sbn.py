"""SBN in two processors that fly beside each other: their messages, and errors on the way."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cfepy
from apps.sbn import packets as pk
from apps.sbn import protocol as pr
from apps.sbn.definition import configuration, peer
from apps.sbn.udp import ANNOUNCE_MSG, DISCONN_MSG
from cfepy.cli.main import main
from cfepy.flight import Flight
from cfepy.journal import read_journal, record, replay
from cfepy.msg import command, get_msg_id, init
from cfepy.osal import Datagram, Place
from cfepy.pilot import RunPlan
from cfepy.status import UsageError

CLIENT = "pair/client.scr"
SERVER_PORT, CLIENT_PORT = 2234, 2235
SAMPLE_HK, TIME_HK_OF_CLIENT = 0x0883, 0x0825
RESET_OF_CLIENT = 0x1826
SAMPLE_NOOP = bytes(command(0x1882, 0))
IDS = (2, 0x42)


@pytest.fixture
def pair() -> Iterator[Flight]:
    with cfepy.boot("pair", beside=[CLIENT]) as flight:
        flight.run_until(2.5)
        yield flight


class Impostor:
    """Plays processor 2 for a mission that flies alone: its datagrams are made here."""

    def __init__(self, flight: Flight) -> None:
        self.flight = flight
        self.heard: list[pr.NetMsg] = []
        flight.mission.network.outlets.append(self._hear)

    def _hear(self, datagram: Datagram) -> None:
        if datagram.target.port == CLIENT_PORT:
            self.heard.append(pr.unpack(datagram.data, 32_768))

    def send_bytes(self, data: bytes) -> None:
        self.flight.mission.outside.datagram(SERVER_PORT, Place("127.0.0.1", CLIENT_PORT), data)

    def send(self, kind: int, payload: bytes = b"", ids: tuple[int, int] = IDS) -> None:
        self.send_bytes(pr.pack(pr.NetMsg(kind, *ids, payload)))
        self.flight.run_for(0.01)

    def kinds(self) -> list[int]:
        heard, self.heard = self.heard, []
        return [message.kind for message in heard]


@pytest.fixture
def impostor() -> Iterator[Impostor]:
    with cfepy.boot("pair") as flight:
        flight.run_until(1.2)
        yield Impostor(flight)


def answer(flight: Flight, name: str, **fields: int) -> dict[str, Any]:
    flight.send(name, **fields)
    return flight.expect_telemetry("SBN_HK_TLM").values


def said(flight: Flight, event_id: int) -> list[str]:
    return [each.text for each in flight.events if (each.app, each.event_id) == ("SBN", event_id)]


def subs(*msg_ids: int, ident: str = pr.IDENT) -> bytes:
    return pr.pack_subscriptions([pr.Sub(msg_id) for msg_id in msg_ids], ident)


def test_peers_exchange_subscriptions_and_messages(pair: Flight) -> None:
    assert answer(pair, "SBN_HK") == {"CC": 10, "CmdCnt": 0, "CmdErrCnt": 0, "SubCnt": 25, "NetCnt": 1}
    wanted = answer(pair, "SBN_HK_PEERSUBS", NetIdx=0, PeerIdx=0)
    assert {0x1882, 0x1883, 0x1810, 0x1860} <= set(wanted["Subs"][: wanted["SubCnt"]])
    assert {0x1806, 0x1826} & set(wanted["Subs"]) == {0x1826}  # as in the table
    pair.send(SAMPLE_NOOP)
    pair.run_for(2)
    assert pair.packets(f"0x{SAMPLE_HK:04X}")[-1].data[17] == 1  # its counter of commands
    assert pair.packets(f"0x{TIME_HK_OF_CLIENT:04X}")
    assert {packet.sender for packet in pair.packets("CFE_ES_HK_TLM")} == {"CFE_ES"}  # nothing of the other processor
    peer = answer(pair, "SBN_HK_PEER", NetIdx=0, PeerIdx=0)
    assert (peer["ProcessorID"], peer["SendErrCnt"], peer["RecvErrCnt"]) == (2, 0, 0)


def test_announced_peer_receives_version_and_subscriptions(impostor: Impostor) -> None:
    impostor.heard.clear()
    impostor.send(ANNOUNCE_MSG)
    assert impostor.kinds() == [pr.PROTO_MSG, pr.SUB_MSG]
    impostor.send(pr.SUB_MSG, subs(SAMPLE_HK, 0x08F0))
    assert answer(impostor.flight, "SBN_HK_PEER", NetIdx=0, PeerIdx=0)["SubCnt"] == 2
    impostor.send(pr.UNSUB_MSG, subs(0x08F0, 0x08F1))
    assert answer(impostor.flight, "SBN_HK_PEER", NetIdx=0, PeerIdx=0)["SubCnt"] == 1
    assert said(impostor.flight, 8)[-1] == "cannot process unsubscription from ProcessorID 2, msg 0x08F1 not found"


def test_peer_receives_subscriptions_again_after_an_unnoticed_reset(impostor: Impostor) -> None:
    impostor.send(pr.PROTO_MSG, b"\x0b")
    assert impostor.kinds() == [pr.PROTO_MSG, pr.SUB_MSG]
    impostor.send(pr.PROTO_MSG, b"\x0b")
    assert impostor.kinds() == [pr.SUB_MSG]


@pytest.mark.slow
def test_both_processors_recover_when_either_is_reset() -> None:
    with cfepy.boot("pair", beside=[CLIENT]) as flight:
        flight.run_until(3)
        flight.send("CFE_ES_RESTART", RestartType=1)
        flight.run_until(6.2)
        flight.send(bytes(command(RESET_OF_CLIENT, 2, b"\2\0")))
        flight.run_until(10)
        seconds = {int(packet.at) for packet in flight.packets("SAMPLE_APP_HK_TLM")}
        assert {2, 5, 9} <= seconds
        assert flight.flown().results.beside[0]["resets"] == 1


def test_silent_peer_is_dropped_and_announced_to_until_it_returns(impostor: Impostor) -> None:
    impostor.send(ANNOUNCE_MSG)
    impostor.kinds()
    impostor.flight.run_for(10.9)
    assert impostor.kinds() == [0xA0]  # a heartbeat after more than five seconds
    impostor.flight.run_for(0.4)
    assert said(impostor.flight, 5)[-1] == "Disconnected from peer 66:2."
    impostor.flight.run_for(11)
    assert ANNOUNCE_MSG in impostor.kinds()
    impostor.send(0xA0)
    assert impostor.kinds() == [pr.PROTO_MSG, pr.SUB_MSG]
    impostor.send(DISCONN_MSG)
    assert said(impostor.flight, 5).count("Disconnected from peer 66:2.") == 2


def test_other_protocol_version_is_reported_and_other_source_is_ignored(impostor: Impostor) -> None:
    impostor.send(pr.PROTO_MSG, b"\x06")
    mismatch = "SBN protocol version mismatch with peer 66:2, my version=11, peer version 6"
    assert said(impostor.flight, 1) == [f"ERROR: could not process peer message: {mismatch}"]
    impostor.send(pr.SUB_MSG, subs(SAMPLE_HK, ident="$Id$"))
    assert said(impostor.flight, 6) == ["version number mismatch with peer CpuID 2"]
    peer = answer(impostor.flight, "SBN_HK_PEER", NetIdx=0, PeerIdx=0)
    assert (peer["SubCnt"], peer["RecvErrCnt"]) == (0, 1)


def test_a_full_pipe_loses_messages_and_the_bus_counts_them(impostor: Impostor) -> None:
    impostor.send(pr.SUB_MSG, subs(0x08F0))
    impostor.flight.run_for(0.5)  # the task that sends has started
    impostor.kinds()
    packet = bytes.fromhex("08f0c000000900000000000000000000")
    for _ in range(20):
        impostor.flight.mission.outside.act("packet", packet)
    impostor.flight.run_for(0.01)
    delivered = impostor.kinds().count(pr.APP_MSG)
    lost = impostor.flight.mission.record.traffic(impostor.flight.mission.cfe.sb, ())[0x08F0].dropped_limit
    assert (delivered, lost) == (8, 12)


def test_message_longer_than_the_header_allows_is_not_sent(impostor: Impostor) -> None:
    impostor.send(pr.SUB_MSG, subs(0x08F0))
    impostor.flight.run_for(0.5)
    impostor.flight.mission.outside.act("packet", bytes(init(0x08F0, 32_768)))
    impostor.flight.run_for(0.01)
    assert said(impostor.flight, 5)[-1] == "a message of 32768 bytes cannot be sent to peer 66:2, at most 32767"


def test_remapping_table_from_the_ground_is_loaded(impostor: Impostor) -> None:
    impostor.send(pr.SUB_MSG, subs(0x08F0, 0x08F1, 0x08F2))
    impostor.flight.run_for(0.5)
    entries = [{"ProcessorID": 2, "SpacecraftID": 0x42, "FromMID": 0x08F0, "ToMID": 0x08F3}]
    impostor.flight.load_table("SBN.SBN_RemapTbl", {"RemapDefaultFlag": pk.REMAP_DEFAULT_IGNORE, "Entries": entries})
    impostor.flight.run_for(0.5)
    impostor.heard.clear()
    for msg_id in (0x08F0, 0x08F1):
        impostor.flight.mission.outside.act("packet", bytes(init(msg_id, 16)))
    impostor.flight.run_for(0.01)
    assert [get_msg_id(each.payload) for each in impostor.heard] == [0x08F3]


def test_configuration_from_the_ground_is_loaded(impostor: Impostor) -> None:
    impostor.send(ANNOUNCE_MSG)
    impostor.flight.run_for(0.5)
    impostor.heard.clear()
    peers = [peer(1, "127.0.0.1:2234"), peer(3, "127.0.0.1:2235")]
    impostor.flight.load_table("SBN.SBN_ConfTbl", pk.CONF.unpack(configuration(peers).data))
    impostor.flight.run_for(1)
    assert impostor.kinds()[0] == DISCONN_MSG
    assert "SBN re-initialized." in said(impostor.flight, 4)
    impostor.flight.run_for(1)
    impostor.kinds()
    impostor.send(ANNOUNCE_MSG, ids=(3, 0x42))
    impostor.flight.run_for(0.2)  # it polls now
    assert impostor.kinds() == [pr.PROTO_MSG, pr.SUB_MSG]


def test_invalid_commands_are_counted(impostor: Impostor) -> None:
    for wrong in (command(pk.CMD_MID, 9), command(pk.CMD_MID, 0, b"12"), command(pk.CMD_MID, 12, b"\0")):
        impostor.flight.send(bytes(wrong))
        impostor.flight.run_for(0.01)
    impostor.flight.send("SBN_HK_PEER", NetIdx=0, PeerIdx=7)
    impostor.flight.send("SBN_NOOP")
    impostor.flight.run_for(0.01)
    hk = answer(impostor.flight, "SBN_HK")
    assert (hk["CmdCnt"], hk["CmdErrCnt"]) == (1, 3)
    assert said(impostor.flight, 7)[-1] == "Invalid PeerIdx (NetIdx=0 PeerIdx=7, max is 0)"
    assert answer(impostor.flight, "SBN_HK_NET", NetIdx=0) == {"CC": 11, "ProtocolIdx": 0, "PeerCnt": 1}
    assert answer(impostor.flight, "SBN_HK_MYSUBS")["SubCnt"] == hk["SubCnt"]


@pytest.mark.slow
def test_10_000_random_datagrams_do_no_harm_and_are_counted(impostor: Impostor) -> None:
    rng = random.Random(7)
    impostor.send(ANNOUNCE_MSG)
    for number in range(10_000):
        impostor.send_bytes(damaged(rng))
        if number % 100 == 99:
            impostor.flight.run_for(0.01)
    impostor.send(0xA0)
    impostor.flight.run_for(0.1)
    peer = answer(impostor.flight, "SBN_HK_PEER", NetIdx=0, PeerIdx=0)
    assert peer["RecvErrCnt"] > 1000
    results = impostor.flight.flown().results
    assert [app.error for app in results.apps if app.error] == []
    assert {app.name: app.state for app in results.apps}["SBN"] == "RUNNING"


def damaged(rng: random.Random) -> bytes:
    """Return a damaged datagram of processor 2, or random bytes."""
    kind = rng.choice([pr.SUB_MSG, pr.UNSUB_MSG, pr.APP_MSG, pr.PROTO_MSG, pr.NO_MSG, 0x55, 0xA1])
    payload = rng.choice([subs(0x08F0, 0x18F1), rng.randbytes(rng.randrange(64)), b""])
    data = bytearray(pr.pack(pr.NetMsg(kind, *IDS, payload)))
    for _ in range(rng.randrange(4)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data[: rng.randrange(len(data) + 1)] if rng.random() < 0.3 else data)


def test_with_option_flies_both_missions_and_reports_the_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    numbers = tmp_path / "numbers.json"
    assert main(["run", "pair", "--with", f"{CLIENT}@0.1", "--for", "2", "--json", str(numbers)]) == 0
    out = capsys.readouterr().out
    assert f"{CLIENT}: EVS Port1 1980-012-14:03:20.55000 66/2/SAMPLE_APP 1:" in out
    (row,) = json.loads(numbers.read_text(encoding="utf-8"))["beside"]
    assert (row["mission"], row["booted_s"], row["lost"], row["died"]) == (f"{CLIENT}@0.1", 0.7, 0, "")
    assert min(row["sent"], row["taken"]) > 5


def test_death_in_the_other_mission_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "startup.scr").write_text("CFE_APP, app, main, APP, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "app.py").write_text("def main(cfe):\n    raise ValueError('no')\n", encoding="utf-8")
    assert main(["run", "pair", "--with", str(tmp_path), "--for", "1"]) == 1
    assert f"cfepy: {tmp_path}: APP died: ValueError: no" in capsys.readouterr().err


def test_mission_beside_itself_is_refused() -> None:
    with pytest.raises(UsageError, match="is already the processor of this mission"):
        cfepy.run("pair", seconds=1, beside=["pair"])


@pytest.mark.slow
def test_a_journal_is_replayed_without_the_other_mission(tmp_path: Path) -> None:
    journal = tmp_path / "run.cfepy"
    flown = record(RunPlan(("pair",), seconds=3, beside=(CLIENT,)), str(journal))
    again = replay(read_journal(str(journal)), tasks="thread")
    assert flown.results.beside[0]["taken"] > 10
    assert again.verdict.same
    assert again.flown.trace == flown.trace
    assert again.flown.results.beside == []
