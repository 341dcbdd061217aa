"""Random steps of a flight of tables: ground commands, and calls of two applications.

A step is a list of plain values, which can be recorded: its kind, and the arguments of that kind.
"""

from __future__ import annotations

import random
from typing import Any

from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER, OPT_DUMP_ONLY, OPT_USR_DEF_ADDR, TableImage, build
from cfepy.tbl import packets as pk

Step = list[Any]
COMMAND, CALL, WRITE, READ, REMOVE = "command", "call", "write", "read", "remove"
CLOSE, REGISTRY, RESTART, RESET = "close", "registry", "restart", "reset"

TABLES = (
    ("S", 16, 0, False),
    ("V", 16, 0, True),
    ("D", 16, OPT_DBL_BUFFER, True),
    ("E", 20, OPT_DBL_BUFFER, False),
    ("O", 12, OPT_DUMP_ONLY, False),
    ("U", 16, OPT_USR_DEF_ADDR, False),
    ("C", 16, OPT_CRITICAL, True),
    ("K", 24, OPT_CRITICAL | OPT_DBL_BUFFER, False),
)
"""Name, size, options of each table of TTA, and whether it has a validation function."""
SIZES = {f"TTA.{name}": size for name, size, _, _ in TABLES}
NAMES = list(SIZES)
FIRST_BYTES = (1, 2, 0xEE, 0xDD)
"""The validation function takes the first two, and answers the others with a negative and a positive number."""
DUMPS = ["/ram/d1.tbl", "/ram/d2.tbl"]
PATHS = [*DUMPS, "/ram/none/x.tbl", "noslash", "", "/ram/averyveryverylongname.tbl", "/x/y"]
ODD_FILES = ["/ram/missing.tbl", "", "bad", "/ram/averyveryverylongname.tbl", "/" + "p" * 70]
CALLS = [*"M" * 10, *"F" * 5, *"A" * 4, *"GGGEEETTIIVVPPBBOOUSSRRQN"]
"""Letters of what an application calls, as tables_app.c has them."""
CHANCES = (
    (0.13, "load"),
    (0.22, "validate"),
    (0.30, "activate"),
    (0.37, "dump"),
    (0.43, "housekeeping"),
    (0.46, "entry"),
    (0.51, "abort"),
    (0.515, "delete"),
    (0.518, "reset counters"),
    (0.521, "noop"),
    (0.523, REGISTRY),
    (0.54, READ),
    (0.545, REMOVE),
    (0.553, CLOSE),
    (0.5555, RESTART),
    (0.5565, RESET),
    (1.0, CALL),
)


class Steps:
    """Makes steps.

    Args:
        seed: the same seed makes the same steps.
    """

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._resets = 0
        self._good = [f"/ram/g{number}.tbl" for number in range(len(NAMES) * len(FIRST_BYTES))]
        self._odd = [f"/ram/f{number}.tbl" for number in range(40)]

    def make(self, count: int) -> list[Step]:
        """Return `count` steps, or a few more. The first ones register the tables and write the files."""
        steps = [*self._register_all(1.0), *self._files()]
        while len(steps) < count:
            steps += self._next()
        return steps

    def _register_all(self, chance: float) -> list[Step]:
        return [_register(slot) for slot in range(len(TABLES)) if self._random.random() < chance]

    def _files(self) -> list[Step]:
        steps: list[Step] = [[WRITE, path, self._odd_file().hex()] for path in self._odd]
        paths = iter(self._good)
        for name in NAMES:
            for first in FIRST_BYTES:
                data = build(TableImage(name, self._data(first, SIZES[name]), "test"))
                steps.append([WRITE, next(paths), data.hex()])
        return steps

    def _data(self, first: int, size: int) -> bytes:
        return bytes([first, *(self._random.randrange(256) for _ in range(size - 1))])

    def _odd_file(self) -> bytes:
        """Return a table file with an extent of its own, and often with something wrong."""
        roll = self._random
        name = roll.choice(NAMES)
        size = number = SIZES[name]
        offset = 0
        kind = roll.random()
        if kind < 0.15:
            number = roll.randrange(1, size + 1)
        elif kind < 0.3:
            offset = roll.randrange(size)
            number = roll.randrange(1, size - offset + 1)
        elif kind < 0.36:
            number = size + roll.randrange(1, 5)
        elif kind < 0.4:
            offset = roll.randrange(size, size + 4)
        file = bytearray(build(TableImage(name, self._data(roll.choice(FIRST_BYTES), number), "test", offset)))
        return self._spoil(file, number)

    def _spoil(self, file: bytearray, number: int) -> bytes:
        roll = self._random
        kind = roll.random()
        if kind < 0.03:
            file[:4] = b"xFE1"
        elif kind < 0.06:
            file[4:8] = roll.randrange(12).to_bytes(4, "big")
        elif kind < 0.08:
            return bytes(file[: roll.randrange(1, len(file))])
        elif kind < 0.12:
            return bytes(file[: -roll.randrange(1, number + 1)])
        elif kind < 0.16:
            file += bytes(roll.randrange(1, 4))
        elif kind < 0.18:
            file[72:76] = bytes(4)
        elif kind < 0.2:
            file[68:76] = (0xFFFFFFF8).to_bytes(4, "big") + (16).to_bytes(4, "big")
        elif kind < 0.22:
            file[76:116] = roll.choice([b"TTA.X", b"TTB.S", b"", b"A" * 40]).ljust(40, b"\0")
        elif kind < 0.24:
            file[72:76] = b"\xff" * 4
        return bytes(file)

    def _next(self) -> list[Step]:
        roll = self._random
        number = roll.random()
        kind = next(kind for chance, kind in CHANCES if number < chance)
        if roll.random() < 0.02:
            return self._register_all(0.6)
        if kind in (REGISTRY, CLOSE):
            return [[kind]]
        if kind in (READ, REMOVE):
            return [[kind, roll.choice(DUMPS)]]
        if kind == RESET and self._resets == 2:
            return []  # the next one would be a power-on reset
        if kind in (RESET, RESTART):
            self._resets += kind == RESET
            return [[kind], *self._register_all(0.95)]
        return [self._call()] if kind == CALL else [[COMMAND, self._command(kind).hex()]]

    def _name(self) -> str:
        return self._random.choice(NAMES * 4 + ["TTA.X", "", "NOPE", "TTB.S", "T" * 39])

    def _command(self, kind: str) -> bytes:
        roll = self._random
        path = roll.choice(PATHS + DUMPS * 3)
        which, of_dump = roll.choice([0, 0, 0, 1, 1, 2]), roll.choice([0, 1, 1, 1, 2, 9])
        file = roll.choice([*self._good * 2, *self._odd, *PATHS, "/ram/missing.tbl"])
        name = self._name()
        made = {
            "load": lambda: pk.LOAD.packet(LoadFilename=file),
            "validate": lambda: pk.VALIDATE.packet(ActiveTableFlag=which, TableName=name),
            "activate": lambda: pk.ACTIVATE.packet(TableName=name),
            "dump": lambda: pk.DUMP.packet(ActiveTableFlag=of_dump, TableName=name, DumpFilename=path),
            "housekeeping": lambda: pk.SEND_HK.packet(),
            "entry": lambda: pk.SEND_REGISTRY.packet(TableName=name),
            "abort": lambda: pk.ABORT_LOAD.packet(TableName=name),
            "delete": lambda: pk.DELETE_CDS.packet(TableName=name),
            "reset counters": lambda: pk.RESET_COUNTERS.packet(),
            "noop": lambda: pk.NOOP.packet(),
        }
        return bytes(made[kind]())

    def _call(self) -> Step:
        """[CALL, application, letter, slot of the handle, options, number, other number, text]."""
        roll = self._random
        who, slot, letter = roll.choice("AAAB"), roll.randrange(8), roll.choice(CALLS)
        options = number = other = 0
        text = ""
        if letter == "R" and who == "A":
            step = _register(slot)
            step[5] += roll.random() < 0.1
            return step
        if letter == "F":
            text = roll.choice([*self._good * 3, *self._odd, *ODD_FILES])
        elif letter == "A":
            number = roll.choice(FIRST_BYTES)
        elif letter in "SI":
            text, slot = self._name(), slot if who == "B" else 8 + slot % 4
        elif letter == "O":
            number = roll.choice([1, 2, 0xEE])
        elif letter == "N":
            options, number, other = roll.randrange(100), 0x18F1 if who == "A" else 0x18F2, roll.randrange(1 << 32)
        return [CALL, who, letter, slot, options, number, other, text]


def _register(slot: int) -> Step:
    name, size, options, has_validator = TABLES[slot]
    return [CALL, "A", "R", slot, options, size, int(has_validator), name]
