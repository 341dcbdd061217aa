"""`python -m dev.c.emulated FOLDER`: makes the root folder of an emulated computer."""

from __future__ import annotations

import argparse
from pathlib import Path

from dev.c.emulated.computer import VARIABLE
from dev.c.emulated.root import make_root

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m dev.c.emulated", description=__doc__)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="a new one, which takes 400 MB")
    folder = parser.parse_args().folder
    make_root(folder)
    print(f"{VARIABLE}={folder.resolve()}")
