"""See `dev.roscfe.endurance`."""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
from pathlib import Path

from dev.roscfe.endurance import fly


def main(arguments: list[str]) -> int:
    """Print the counters of the nodes after five minutes, half of the time, and all of it."""
    parser = argparse.ArgumentParser(prog="python -m dev.roscfe.endurance", description=main.__doc__)
    parser.add_argument("--hours", type=float, default=24.0, metavar="H", help="hours of virtual time (default: 24)")
    given = parser.parse_args(arguments)
    seconds = 3600 * given.hours
    times = [300.0, seconds / 2, seconds]
    with tempfile.TemporaryDirectory() as scratch:
        for time, counters in zip(times, fly(Path(scratch), times), strict=True):
            for name, values in counters.items():
                print(f"{time:8.0f} s, {name}: {values}")
    print(f"most memory of the process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss:,} KB")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
