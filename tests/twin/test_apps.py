"""Ground commands of NASA's flight applications: their packets, and equal answers of both if they are built."""

from __future__ import annotations

import struct
from itertools import islice

import pytest

from cfepy import msg
from cfepy.fs import FileHeader
from dev.twin import apps_flight, cfdp_pdus
from dev.twin.apps_commands import AppsCommander
from dev.twin.apps_files import DS_FILE, FM_FILE, of_file
from dev.twin.apps_flight import differences, of_packet
from dev.twin.flight import Observed
from dev.twin.flight_apps import FLIGHT_APPS
from dev.twin.real import VARIABLE, installed

BUILT = installed()
needs_apps = pytest.mark.skipif(
    BUILT is None or not (BUILT / "cf/lc.so").exists(), reason=f"{VARIABLE} names no folder with LC's code"
)
ENOUGH = 1500  # steps that include every command


def test_every_command_is_sent() -> None:
    wanted = {(app.commands_mid, command.code) for app in FLIGHT_APPS for command in app.commands}
    packets = [packet for step in islice(AppsCommander(1).steps(), ENOUGH) for packet in step.packets]
    flown = {(msg.get_msg_id(each), each[6]) for each in packets if len(each) >= 8}
    assert len(wanted) == 154
    assert wanted <= flown


def test_commands_depend_only_on_the_seed() -> None:
    first, second = (list(islice(AppsCommander(5, ["CF", "FM"]).steps(), 100)) for _ in range(2))
    assert first == second
    assert {step.service for step in first} == {"CF", "FM"}


def test_difference_is_found() -> None:
    packet = bytes(msg.telemetry(0x8A7, bytes(range(40))))
    other = packet[:20] + b"\xff" + packet[21:]
    assert differences(Observed((packet,), {}), Observed((packet,), {})) == []
    assert len(differences(Observed((packet,), {}), Observed((other,), {}))) == 1
    assert len(differences(Observed((packet,), {}), Observed((), {}))) == 1
    assert differences(Observed((), {"/ram/a": b"12"}), Observed((), {"/ram/a": b"1"})) == [
        "file /ram/a: 2 bytes of ours, 1 of NASA's are compared"
    ]


def test_lists_of_files_are_compared_in_any_order() -> None:
    names = [name.ljust(84, b"\0") for name in (b"/ram/a", b"/ram/b")]
    one, other = (bytes(msg.telemetry(0x88D, bytes(4) + b"".join(order))) for order in (names, names[::-1]))
    assert of_packet(one) == of_packet(other)


def test_files_are_compared_without_their_times() -> None:
    def file(subtype: int, seconds: int, content: bytes) -> bytes:
        return FileHeader("x", subtype, time_seconds=seconds).pack() + content

    packets = [bytes(msg.telemetry(0x8A7, bytes([number] * 20))) for number in range(2)]
    stored = [file(DS_FILE, at, bytes([at] * 8) + bytes(68) + b"".join(packets[:: 1 - 2 * at])) for at in range(2)]
    entries = [bytes([number] * 68) + bytes([at] * 4) + bytes(4) for at, number in enumerate((1, 2))]
    listed = [file(FM_FILE, at, bytes(72) + b"".join(entries[:: 1 - 2 * at])) for at in range(2)]
    for one, other in (stored, listed):
        assert one != other
        assert of_file("/ram/x", one, of_packet) == of_file("/ram/x", other, of_packet)
        assert of_file("/ram/x", one, of_packet) != of_file("/ram/x", other[:-1] + b"\xee", of_packet)
    assert of_file("/ram/x", b"text", of_packet) == b"text"


def test_size_of_a_list_in_its_own_listing_is_ignored() -> None:
    def listed(name: bytes, size: int) -> bytes:
        return FileHeader("x", FM_FILE).pack() + bytes(72) + struct.pack("<64sIII", name, size, 0, 6)

    for name, is_same in ((b"list.dat", True), (b"other.dat", False)):
        one, other = (of_file("/ram/list.dat", listed(name, size), of_packet) for size in (136, 668))
        assert (one == other) == is_same


def test_names_with_a_time_are_equal() -> None:
    one, other = (f"/ram/power1980012140{at}.dat" for at in (357, 432))
    assert differences(Observed((), {one: b"1"}), Observed((), {other: b"1"})) == []
    assert differences(Observed((), {one: b"1"}), Observed((), {other: b"2"})) != []
    told = [bytes(msg.telemetry(0x8BA, name.encode())) for name in (one, other)]
    assert differences(Observed((told[0],), {}), Observed((told[1],), {})) == []


def test_the_checksum_of_cfdp() -> None:
    assert cfdp_pdus.checksum(b"") == 0
    assert cfdp_pdus.checksum(b"\x01\x02\x03\x04\x05") == 0x06020304


@needs_apps
@pytest.mark.slow
def test_commands_give_the_answers_of_nasas_applications() -> None:
    assert BUILT is not None
    assert [flown for flown in apps_flight.fly(BUILT, 2, 60, []) if flown.lines] == []
