"""Fly MM, MD and CS on memory with the same content in cfepy and in NASA's cFE, and report the differences.

Usage: CFEPY_REAL_CFE_RAM=FOLDER python -m dev.twin.memory_flight [--seed N] [--count COMMANDS]

FOLDER is as for dev.twin.apps_flight, but from a build with ram_direct in place of ram_notimpl in
psp/fsw/pc-linux/psp_module_list.cmake. NASA's default PSP for Linux does not read and write memory by address, so MM
could not work. The library STORE (memory_app.c) has the block that they work on. In NASA's cFE the block has the same
address as in cfepy.
"""

from __future__ import annotations

import itertools
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from dev.twin import compare
from dev.twin.apps_flight import STARTUP, differences, real, simulated
from dev.twin.flight import STARTUP_PATH
from dev.twin.memory_commands import SYMBOL, MemoryCommander, files, lookup, preparation
from dev.twin.tables_real import compiled_app

VARIABLE = "CFEPY_REAL_CFE_RAM"
STORE = Path(__file__).with_name("memory_app.c")
STEPS_OF_A_FLIGHT = 150
STARTUP_WITH_STORE = f"CFE_LIB, store, STORE_Init, STORE, 0, 0, 0x0, 0;\n{STARTUP}".encode()
FOUND = re.compile(rb"Addr = (0x[0-9A-Fa-f]+)")


def block_address(built: Path, store: bytes) -> int:
    """Return the address of the block in cfepy, which is the same in each run."""
    with simulated(built, {"/cf/store.so": store, STARTUP_PATH: STARTUP_WITH_STORE}, (), "direct") as computer:
        told = FOUND.search(b"".join(computer.fly(lookup()).packets))
    if told is None:
        raise LookupError(f"MM did not find {SYMBOL}")
    return int(told[1], 16)


def fly(built: Path, seed: int, count: int) -> Iterator[compare.Flown]:
    """Fly the steps of a seed in both."""
    here = compiled_app(built.parents[2], STORE)
    address = block_address(built, here)
    placed = f"-DSTORE_ADDRESS={address:#x}", f"-Wl,--defsym={SYMBOL}={address:#x}"
    there = compiled_app(built.parents[2], STORE, *placed)
    both = {**files(address), STARTUP_PATH: STARTUP_WITH_STORE}
    with (
        real(built, {**both, "/cf/store.so": there}, preparation()) as theirs,
        simulated(built, {**both, "/cf/store.so": here}, preparation(), "direct") as ours,
    ):
        steps = itertools.islice(MemoryCommander(seed, address).steps(), count)
        yield from compare.fly(ours, theirs, steps, differences)


def main() -> int:
    """Fly until there were so many commands."""
    given = compare.parser_of("dev.twin.memory_flight", __doc__, STEPS_OF_A_FLIGHT).parse_args()
    built = compare.real_folder(VARIABLE)
    return compare.run(given, lambda seed: fly(built, seed, given.flight))


if __name__ == "__main__":
    sys.exit(main())
