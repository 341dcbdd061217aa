"""`python -m dev.c.api [NAME ...]`: flies the applications on NASA's cFE and records their output.

CFEPY_REAL_CFE names the folder of NASA's core-cpu1, built for Linux from the release that `dev.c.api.flights` names.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from dev.c.api.flights import HERE, NAMES, fly_on_real_cfe
from dev.twin.real import VARIABLE, installed


def main() -> None:
    """Fly all, or those that are named."""
    parser = argparse.ArgumentParser(prog="python -m dev.c.api", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as cds; all when none is given")
    names = parser.parse_args().names
    built = installed()
    if built is None:
        sys.exit(f"{VARIABLE} does not say where the folder of NASA's core-cpu1 is")
    for name in names or NAMES:
        with tempfile.TemporaryDirectory() as folder:
            lines = fly_on_real_cfe(name, built, Path(folder))
        (HERE / f"{name}.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
        print(f"{name}: {len(lines)} lines")


if __name__ == "__main__":
    main()
