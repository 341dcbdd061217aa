"""SBN's bytes on the wire, and its tables, as in NASA's SBN."""

from __future__ import annotations

import random
from contextlib import suppress
from pathlib import Path

import pytest

from apps.sbn import COMMANDS, TABLES, packets, protocol
from apps.sbn.definition import configuration, peer, remapping
from apps.sbn.tables import sbn_conf_tbl, sbn_remap_tbl
from cfepy.tbl import build
from tests.apps.conftest import APPS
from tests.declared import assert_complete

LONGEST = 32_768
REAL_TABLES = {"SBN.SBN_ConfTbl": 5084, "SBN.SBN_RemapTbl": 4216}
"""Bytes of the files that NASA's SBN has for x86-64."""


def test_a_message_is_a_header_and_its_payload() -> None:
    message = protocol.NetMsg(protocol.PROTO_MSG, 2, 0x42, bytes([protocol.PROTO_VER]))
    data = protocol.pack(message)
    assert data.hex() == "00010400000002000000420b"
    assert protocol.unpack(data + b"more", LONGEST) == message


def test_subscriptions_begin_with_the_commit_of_the_sender() -> None:
    payload = protocol.pack_subscriptions([protocol.Sub(0x1882), protocol.Sub(0x0808, 1, 2)], protocol.IDENT)
    assert payload[:47] == b"$Id: dccf6239093d99c4c9351e140c15b61a95d8fc37 $"
    assert payload[47:].hex() == "000002000018820000000008080102"
    assert protocol.unpack_subscriptions(payload) == (protocol.IDENT, [protocol.Sub(0x1882), protocol.Sub(0x808, 1, 2)])


@pytest.mark.parametrize(
    ("data", "why"),
    [
        ("", "0 bytes, a header has 11"),
        ("0000a0000000020000", "9 bytes, a header has 11"),
        ("ffff030000000200000042", "a payload of -1 bytes"),
        ("000503000000020000004211", "1 of the 5 bytes of its payload"),
    ],
)
def test_malformed_message_is_refused(data: str, why: str) -> None:
    with pytest.raises(protocol.Malformed, match=why):
        protocol.unpack(bytes.fromhex(data), LONGEST)


def test_random_bytes_are_unpacked_or_refused_as_malformed() -> None:
    rng = random.Random(1)
    messages = 0
    for _ in range(10_000):
        data = bytes(rng.randrange(256) * rng.randrange(2) for _ in range(rng.randrange(80)))
        with suppress(protocol.Malformed):
            message = protocol.unpack(data, LONGEST)
            messages += 1
            protocol.unpack_subscriptions(message.payload)
    assert messages > 1000


def test_the_default_tables_have_the_files_that_their_scripts_write() -> None:
    for script, table in ((sbn_conf_tbl, packets.CONF_TABLE), (sbn_remap_tbl, packets.REMAP_TABLE)):
        data = build(script.image())
        assert len(data) == REAL_TABLES[table.name]
        assert data == (APPS / "sbn" / "tables" / Path(table.file).name).read_bytes()


def test_configuration_and_remapping_tables_unpack_to_their_entries() -> None:
    table = packets.CONF_TABLE.unpack(configuration([peer(1, "127.0.0.1:2234"), peer(2, "127.0.0.1:2235")]).data)[0]
    assert table["PeerCnt"] == 2
    assert table["Peers"][1]["Address"] == "127.0.0.1:2235"
    entries = packets.REMAP_TABLE.unpack(remapping([(2, 0x1801, 0)], sends_others=False).data)[0]
    assert entries["RemapDefaultFlag"] == packets.REMAP_DEFAULT_IGNORE
    assert entries["Entries"][0] == {"ProcessorID": 2, "SpacecraftID": 0x42, "FromMID": 0x1801, "ToMID": 0}


def test_declarations_are_complete() -> None:
    assert_complete(packets)
    assert {command.msg_id for command in COMMANDS} == {0x18FA}
    assert [table.size for table in TABLES] == [4968, 4100]
    sizes = [each.payload.size for each in (packets.HK_TLM, *packets.HK_TLM.variants)]
    assert sizes == [9, 4, 35 - 4, 7 + 4 * 256, 3 + 4 * 256]
