"""`python -m dev.c.emulated FOLDER`: makes the root of an emulated computer."""

from __future__ import annotations

import sys
from pathlib import Path

from dev.c.emulated.computer import VARIABLE
from dev.c.emulated.root import make_root

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    make_root(Path(sys.argv[1]))
    print(f"{VARIABLE}={Path(sys.argv[1]).resolve()}")
