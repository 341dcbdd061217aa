"""`python -m cfepy`: the same as the command `cfepy`."""

from __future__ import annotations

import sys

from cfepy.cli.main import process

if __name__ == "__main__":
    sys.exit(process())
