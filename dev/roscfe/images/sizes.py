"""`python -m dev.roscfe.images.sizes`: the memory that nodes in C++ take, for docs/reference/roscfe.md.

The nodes are linked in the strict profile at -Os, as flight software does: only with the parts of the library and of
the C++ library that they need. On Linux libc is shared and not counted, and on Cortex-M7 it is in the image.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

from dev.roscfe.images.linking import COMPUTERS, FOLDER, Computer, Linker, Sizes, entry_of

NODES = ("talker", "listener", "table_one")
ARENA = 4096
CORE = "core"


def sizes_on(computer: Computer) -> dict[str, Sizes]:
    """Return the sizes of all nodes, and of the core's own object files together.

    Args:
        computer: the kind of computer, whose compiler is installed.
    """
    with tempfile.TemporaryDirectory() as scratch:
        linker = Linker(computer, Path(scratch), [FOLDER / f"{name}.cpp" for name in NODES], ARENA)
        found = {}
        for name in NODES:
            entry = entry_of(name)
            found[name] = linker.sizes(linker.linked(FOLDER / f"{name}.cpp", entry), entry.symbol)
        found[CORE] = linker.core_sizes()
        return found


def table() -> Iterator[str]:
    """Yield the lines of the table."""
    there = {name: sizes_on(each) for name, each in COMPUTERS.items() if each.lacking is None}
    yield f"| node | {' | '.join(there)} |"
    yield "|---" * (len(there) + 1) + "|"
    for row in (*NODES, CORE):
        cells = (f"{found[row].text:,} / {found[row].ram:,}" for found in there.values())
        yield f"| {row} | {' | '.join(cells)} |"


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.roscfe.images.sizes", description=__doc__).parse_args()
    print("\n".join(table()))
