"""See `dev.roscfe.fuzz`."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from cfepy.extra.convert.message_headers import Profile
from dev.roscfe import fuzz
from dev.roscfe.fuzz.corpus import AREAS
from dev.roscfe.fuzz.flying import Driver, faults

PACKETS = 1_000_000
PROFILES = [each.value for each in Profile]


def main(arguments: list[str]) -> int:
    """Fly over areas, and print the counters of each flight. Returns 1 if one has a finding."""
    parser = argparse.ArgumentParser(
        prog="python -m dev.roscfe.fuzz", description=fuzz.__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument(
        "areas", nargs="*", choices=[[], *AREAS], metavar="AREA", help=f"all by default: {', '.join(AREAS)}"
    )
    parser.add_argument("--packets", type=int, default=PACKETS, metavar="N", help="of each area (default: 1000000)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the random numbers (default: 1)")
    parser.add_argument("--profile", nargs="+", choices=PROFILES, default=PROFILES, help="all by default")
    given = parser.parse_args(arguments)
    found = 0
    with tempfile.TemporaryDirectory() as scratch:
        for profile in given.profile:
            (folder := Path(scratch) / profile).mkdir()
            driver = Driver(folder, Profile(profile))
            for area in given.areas or AREAS:
                flight = driver.fly(area, given.packets, given.seed)
                counters = ", ".join(f"{name} {number:,}" for name, number in flight.figures.items())
                print(f"{profile}, {area}: {counters}, digest {flight.digest}", flush=True)
                for fault in faults(flight):
                    print(f"{profile}, {area}: {fault}", flush=True)
                    found += 1
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
