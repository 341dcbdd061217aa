"""Random steps for MM, MD and CS with valid addresses: a block of memory that both computers have."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from random import Random

from cfepy import msg
from cfepy.fs import FileHeader, crc16
from cfepy.tbl import TableImage, build
from dev.twin.commands import BACKGROUND, PLAIN, Step
from dev.twin.flight_apps import CS, MD, MM, FlightApp

SYMBOL = "STORE_Block"
WORKED_ON = 512
"""So many bytes at the beginning are written to."""
PIECES = ((0, 64), (64, 192), (600, 1000), (4096, 4096))
"""What CS checks of the block: offsets and sizes. The last two are never written to."""
LOADS = ("/cf/load1.dat", "/cf/load2.dat", "/cf/load3.dat", "/cf/load4.dat")
DUMPS = ("/ram/dump1.dat", "/ram/dump2.dat")
RAM, EEPROM, MEM8, MEM16, MEM32 = 1, 2, 3, 4, 5
WIDTHS = {MEM8: 8, MEM16: 16, MEM32: 32}
ENABLED, DISABLED = 1, 2
TABLES_CHECKED = ("LC.LC_WDT", "SC.RTS_TBL001", "CS.DefMemoryTbl", "NO.Table")
APPS_CHECKED = ("NOBODY",)
"""OSAL on Linux does not know where the code of one is; see docs/reference/differences.md."""
PEEK, POKE, LOAD_WID, LOAD_FILE, DUMP_FILE, DUMP_EVENT, FILL, LOOKUP = range(2, 10)
START_DWELL, STOP_DWELL, JAM_DWELL = 2, 3, 4
ONE_SHOT, CANCEL_ONE_SHOT = 2, 3
DISABLE_CORE, DISABLE_OS = 7, 11
CS_ENTRY_CODES = (16, 17, 18, 19, 23, 24, 25, 26)
CS_TABLE_CODES = (30, 31, 32, 33)
CS_APP_CODES = (36, 37, 38, 39)
CS_PLAIN_CODES = (4, 5, 14, 15, 21, 22, 28, 29, 34, 35)
CS_FIND_EEPROM, CS_FIND_MEMORY = 20, 27
WAKEUPS = 6


def files(address: int) -> dict[str, bytes]:
    """Return tables for CS and files for MM to load, by virtual path, with the block at an address."""
    states = (ENABLED, DISABLED, ENABLED, ENABLED)
    memory = b"".join(
        struct.pack("<QHHI", address + at, state, 0, size) for (at, size), state in zip(PIECES, states, strict=True)
    )
    tables = b"".join(struct.pack("<H40s", ENABLED, name.encode()) for name in TABLES_CHECKED)
    apps = b"".join(struct.pack("<H20s", ENABLED, name.encode()) for name in APPS_CHECKED)
    loads = (
        _load(0, bytes(range(100)), RAM),
        _load(address + 16, bytes(range(200, 232)), MEM8, symbol=""),
        _load(32, bytes(64), MEM32),
        _load(8, b"wrong", RAM, flaw=1),
    )
    return {
        "/cf/cs_memorytbl.tbl": build(TableImage("CS.DefMemoryTbl", memory.ljust(16 * 16, b"\0"))),
        "/cf/cs_eepromtbl.tbl": build(TableImage("CS.DefEepromTbl", memory[:16].ljust(16 * 16, b"\0"))),
        "/cf/cs_tablestbl.tbl": build(TableImage("CS.DefTablesTbl", tables.ljust(24 * 42, b"\0"))),
        "/cf/cs_apptbl.tbl": build(TableImage("CS.DefAppTbl", apps.ljust(24 * 22, b"\0"))),
        **dict(zip(LOADS, loads, strict=True)),
    }


def _load(offset: int, data: bytes, kind: int, symbol: str = SYMBOL, flaw: int = 0) -> bytes:
    head = struct.pack("<Q64sIIIxxxx", offset, symbol.encode(), len(data), crc16(data) ^ flaw, kind)
    return FileHeader("MM", 0).pack() + head + data


def command(app: FlightApp, code: int, layout: str = "", *values: int | bytes) -> bytes:
    """Return a command with a payload in the letters of `struct`, without gaps but those that it names."""
    return bytes(msg.command(app.commands_mid, code, struct.pack("<" + layout, *values)))


def lookup() -> Step:
    """Return the request for the address of the block."""
    return Step(MM.name, (command(MM, LOOKUP, "64s", SYMBOL.encode()),), PLAIN)


def preparation() -> list[Step]:
    """Return steps that keep CS off the parts that differ: the code of cFE and of the operating system."""
    return [Step(CS.name, (command(CS, DISABLE_CORE), command(CS, DISABLE_OS)), PLAIN)]


class MemoryCommander:
    """Makes the steps of a flight.

    Args:
        seed: of the flight.
        address: of the block.
    """

    def __init__(self, seed: int, address: int) -> None:
        self._random = Random(seed)
        self._address = address

    def steps(self) -> Iterator[Step]:
        """Steps without an end."""
        while True:
            app, make = self._random.choice(((MM, self._mm), (MM, self._mm), (MD, self._md), (CS, self._cs)))
            pace = PLAIN if app is MD else BACKGROUND
            yield Step(app.name, (make(),), pace)
            wakeups = tuple(bytes(msg.command(app.wakeup_mid, 0)) for _ in range(WAKEUPS if app.wakeup_mid else 0))
            yield Step(app.name, (*wakeups, bytes(msg.command(app.housekeeping_mid, 0))), PLAIN)

    def _where(self, room: int, align: int = 1) -> bytes:
        """Return a symbolic address for a number of bytes, mostly a valid one."""
        offset = self._random.randrange(0, WORKED_ON - room, align)
        symbol, offset = self._random.choice(((SYMBOL, offset), ("", self._address + offset), ("nothing", offset)))
        if self._random.random() < 0.1:
            offset += 1
        return struct.pack("<Q64s", offset, symbol.encode())

    def _mm(self) -> bytes:
        random = self._random
        kind = random.choice((RAM, RAM, MEM8, MEM16, MEM32, EEPROM, 0))
        bits = WIDTHS.get(kind, random.choice((8, 16, 32)))
        size = random.choice((1, 4, 8, 20, 32, 200, 199, 255))
        place = self._where(256, bits // 8)
        data = random.randbytes(size)
        check = crc16(data) ^ (random.random() < 0.2)
        return random.choice(
            (
                command(MM, PEEK, "QI4x72s", bits, kind, place),
                command(MM, POKE, "QII8x72s", bits, kind, random.getrandbits(32), place),
                command(MM, LOAD_WID, "B3xI72s200s", size, check, place, data),
                command(MM, LOAD_FILE, "64s", random.choice(LOADS).encode()),
                command(MM, DUMP_FILE, "II72s64s", kind, size, place, random.choice(DUMPS).encode()),
                command(MM, DUMP_EVENT, "IB3x72s", kind, size, place),
                command(MM, FILL, "III4x72s", kind, size, random.getrandbits(32), place),
                command(MM, LOOKUP, "64s", random.choice((SYMBOL, "nothing")).encode()),
            )
        )

    def _md(self) -> bytes:
        random = self._random
        masks = random.choice((1, 2, 3, 8, 15))
        numbers = random.randrange(1, 5), random.randrange(1, 6), random.choice((0, 1, 2, 4, 4)), random.randrange(3)
        return random.choice(
            (
                command(MD, START_DWELL, "HH", masks, 0),
                command(MD, STOP_DWELL, "HH", masks, 0),
                *[command(MD, JAM_DWELL, "HHHH72s", *numbers, self._where(4, 4))] * 4,
            )
        )

    def _cs(self) -> bytes:
        random = self._random
        at, size = random.choice((*PIECES, (8, 300)))
        table, app = random.choice(TABLES_CHECKED), random.choice(APPS_CHECKED)
        return random.choice(
            (
                command(CS, ONE_SHOT, "QII", self._address + at, size, random.choice((0, 1, 100, 5000))),
                command(CS, CANCEL_ONE_SHOT),
                command(CS, random.choice(CS_ENTRY_CODES), "I", random.randrange(6)),
                command(CS, random.choice(CS_TABLE_CODES), "40s", table.encode()),
                command(CS, random.choice(CS_APP_CODES), "20s", app.encode()),
                command(CS, random.choice((CS_FIND_EEPROM, CS_FIND_MEMORY)), "Q", self._address + at),
                command(CS, random.choice(CS_PLAIN_CODES)),
            )
        )
