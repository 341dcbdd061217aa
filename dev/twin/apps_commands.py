"""Random ground commands for NASA's flight applications, made from their structure; `apps_flight` flies them.

After each step of commands come the application's wakeup, if it needs one, and its housekeeping request. Memory
addresses are left out: on Linux NASA's PSP accepts every address, and a wrong one crashes it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from random import Random

from cfepy import msg
from dev.twin import cfdp_pdus
from dev.twin.commands import BACKGROUND, PLAIN, Step
from dev.twin.flight_apps import CF, CS, DS, FLIGHT_APPS, FM, HK, HS, LC, MD, MM, Field, FlightApp, FlightCommand

FILES = (
    *("/ram/a.dat", "/ram/b.dat", "/ram/c.dat", "/ram/d.log", "/ram/sub/e.dat", "/ram/none.dat", "/nowhere/f.dat"),
    *("", "/ram", "/ram/sub", "a.dat", "/ram/" + "y" * 40, "/ram/" + "y" * 58, "z" * 63, "z" * 64, "/ram/bad name"),
    *("/ram/*.dat", "/ram/g", "/ram/a.dat/h", "/cf/lc_def_wdt.tbl"),
)
THERE = ("/ram/a.dat", "/ram/b.dat", "/cf/lc_def_wdt.tbl", "/ram/c.dat")
FOLDERS = ("/ram", "/ram/", "/ram/sub", "/ram/sub/", "/ram/new", "/nowhere", "", "/", "/ram/a.dat", "/ram/" + "p" * 58)
NAMES = (
    *("LC", "CS", "CFE_ES", "NOBODY", "", "X" * 19, "X" * 20, "LC.LC_ADT", "LC.LC_WDT", "CS.DefAppTbl", "NO.Table"),
    *("CS.DefTablesTbl", "T" * 39, "T" * 40, "SC.RTS_TBL001", "CFE_TBL.CritReg"),
)
SYMBOLS = ("", "nothing", "NoSuchSymbol", "s" * 63, "s" * 64)
SMALL = (0, 1, 2, 3, 4, 5, 7, 8, 15, 16)
LIMITS = (20, 32, 63, 64, 65, 127, 128, 174, 175, 176, 255, 256, 1000, 0x7FFF, 0x8000, 0xFFFE, 0xFFFF)
POWER_HK, PDUS_UP = 0x08D0, 0x18C8
LARGE = (0x10000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
MSG_IDS = (0x800, 0x801, 0x803, 0x808, 0x8A7, 0x890, 0x18A4, 0, 0x1FFF, 0x2000, 0xFFFFFFFF)
TELEMETRY_HEARD = tuple(each for app in FLIGHT_APPS for each in app.telemetry)
UNSAFE = {(MM.name, code) for code in (2, 3, 4, 6, 7, 8)} | {(MD.name, 4), (CS.name, 2), (CS.name, 20), (CS.name, 27)}
"""Commands that take an address: what is asked for is bad enough that nothing is read or written."""
ONLY_BAD_LENGTH = {(CS.name, 2), (CS.name, 9), (HS.name, 5)}
"""CS's checksums of any address, and of cFE's own code, which is there or not; the end of HS's event monitor, which on
some hosts never began."""
SLOW = {FM.name, CS.name, CF.name, DS.name}
"""Applications that work in the background, or for some wake-ups."""
WAKEUPS = {CF.name: 3}


class AppsCommander:
    """Makes the steps of a flight.

    Args:
        seed: seed of the flight.
        names: names of the commanded applications; all of them if empty.
    """

    def __init__(self, seed: int, names: Iterable[str] = ()) -> None:
        self._random = Random(seed)
        wanted = set(names)
        self._apps = [app for app in FLIGHT_APPS if not wanted or app.name in wanted]
        self._fresh = [(app, command) for app in self._apps for command in app.commands]
        self._random.shuffle(self._fresh)
        self._transfers = 0

    def steps(self) -> Iterator[Step]:
        """Yield steps without end. The first ones contain every command once, with valid arguments."""
        while True:
            if self._fresh:
                app, command = self._fresh.pop()
                packets = [self._packet(app, command)]
            else:
                app = self._random.choice(self._apps)
                packets = [self._any(app) for _ in range(self._random.choice((1, 1, 2)))]
            if app is CF and self._random.random() < 0.3:
                yield from self._uplink()
            if app in (LC, DS, HK) and self._random.random() < 0.5:
                yield Step(app.name, (self._charge(),), PLAIN)
            pace = BACKGROUND if app.name in SLOW else PLAIN
            yield Step(app.name, tuple(packets), pace)
            yield from self.after(app)

    def after(self, app: FlightApp) -> Iterator[Step]:
        """Yield the packets that follow commands: the wakeup and the housekeeping request."""
        wake = self.wakeup(app)
        question = bytes(msg.command(app.housekeeping_mid, 0))
        if app is HS:  # it looks at commands, and at questions, when it is woken up
            yield Step(app.name, (wake,), PLAIN)
            yield Step(app.name, (question, wake), PLAIN)
            return
        for _ in range(WAKEUPS.get(app.name, 1) if wake else 0):
            yield Step(app.name, (wake,), PLAIN)
        yield Step(app.name, (question,), PLAIN)

    def wakeup(self, app: FlightApp) -> bytes:
        """Return a scheduler's wakeup packet for an application, or b"" if it needs none."""
        if not app.wakeup_mid:
            return b""
        random, payload = self._random, b""
        if app is LC:
            start = random.choice((0, 0, 1, 5, 0xFFFF))
            payload = struct.pack("<HHHH", start, random.choice((10, 175, 0xFFFF, 200)), random.randrange(2), 0)
        elif app is HK:
            payload = struct.pack("<I", random.choice((0x89C, 0x89D, 0x89E, 0x89F, 0x8A0, 0)))
        return bytes(msg.command(app.wakeup_mid, 0, payload))

    def _uplink(self) -> Iterator[Step]:
        """Yield a file on its way up to CF, and wake-ups between its PDUs."""
        self._transfers += 1
        for pdu in cfdp_pdus.transfer(self._random, self._transfers):
            yield Step(CF.name, (bytes(msg.command(PDUS_UP, 0, pdu)),), PLAIN)
            yield Step(CF.name, (self.wakeup(CF),), PLAIN)

    def _charge(self) -> bytes:
        """Return the packet that LC watches, DS stores and HK copies: POWER's housekeeping, with low or high charge."""
        random = self._random
        payload = struct.pack("<HBB", random.choice((0, 39, 40, 41, 100, 0xFFFF)), random.randrange(2), 0)
        return bytes(msg.telemetry(POWER_HK, payload))

    def _any(self, app: FlightApp) -> bytes:
        packet = self._packet(app, self._random.choice(app.commands))
        return self._damaged(packet) if self._random.random() < 0.3 else packet

    def _packet(self, app: FlightApp, command: FlightCommand) -> bytes:
        payload = b"".join(self._value(app, command, field) for field in command.fields)
        if (app.name, command.code) in ONLY_BAD_LENGTH:
            payload = payload[:-4] or bytes(4)
        return bytes(msg.command(app.commands_mid, command.code, payload))

    def _damaged(self, packet: bytes) -> bytes:
        """Return the packet with another payload length, or with an unknown function code."""
        random = self._random
        if random.random() < 0.5:
            size = max(8, len(packet) + random.choice((-8, -2, -1, 1, 2, 8, 100)))
            data = bytearray((packet + bytes(120))[:size])
            data[4:6] = (size - 7).to_bytes(2, "big")
            return bytes(data)
        data = bytearray(packet)
        data[6] = random.choice((12, 13, 14, 20, 24, 40, 41, 99, 127))
        return bytes(data)

    def _value(self, app: FlightApp, command: FlightCommand, field: Field) -> bytes:
        size = struct.calcsize("<" + field.format)
        if field.format.endswith("x") or field.name.lower().startswith(("padding", "spare")):
            return bytes(size)
        if field.format.endswith("s"):
            return self._text(field.name, size)
        return self._number(app, command, field.name).to_bytes(8, "little")[:size]

    def _text(self, name: str, size: int) -> bytes:
        field, random = name.lower(), self._random
        if field.startswith("dataarray"):
            return random.randbytes(size)
        if "directory" in field or field == "pathname":
            text = random.choice(FOLDERS)
        elif "file" in field or field.startswith(("source", "target")):
            text = random.choice(FILES if random.random() < 0.5 else THERE)
        elif field == "symname":
            text = random.choice(SYMBOLS[1:])
        elif field in ("basename", "extension", "signature"):
            text = random.choice(("", "abc", ".x", "a b", "q" * (size - 1), "q" * size, "a*"))
        else:
            text = random.choice(NAMES)
        return text.encode()[:size].ljust(size, b"\0")

    def _number(self, app: FlightApp, command: FlightCommand, name: str) -> int:
        random = self._random
        if name in ("Address", "Offset"):
            return 0
        if (app.name, command.code) in UNSAFE and name in ("Size", "DataSize", "NumOfBytes"):
            return random.choice((0, 3, 5))
        if app is DS and name == "Value":
            return random.choice(MSG_IDS)
        if app is CF and name == "value":
            return random.choice((1, 2, 10, 100, 512))
        if app is CF and name in ("chan", "chan_num"):
            return random.choice((0, 1, 2, 254, 255))
        if app is FM and name == "Mode":
            return random.choice((0, 1, 2, 3))
        if random.random() < 0.75:
            return random.choice(SMALL)
        return random.choice((*LIMITS, *LARGE))
