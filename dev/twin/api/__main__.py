"""python -m dev.twin.api: plays random scripts on the real cFE and on cfepy, and prints the differences."""

from __future__ import annotations

import argparse
import sys
from collections import Counter

from dev.twin.api import real, twin
from dev.twin.api.compare import counts, differences
from dev.twin.api.recorded import Record, write_record
from dev.twin.api.script import KINDS, write_script
from dev.twin.real import release_of


def main() -> int:
    """Compare. Returns exit status 1 if anything differs."""
    parser = argparse.ArgumentParser(prog="python -m dev.twin.api", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the first script")
    parser.add_argument("--count", type=int, default=3500, help="calls of a script")
    parser.add_argument("--scripts", type=int, default=1, help="how many scripts, with seeds that count up")
    parser.add_argument("--kind", choices=KINDS, default="usual", help="programs that are mostly right, or wrong ones")
    parser.add_argument("--record", action="store_true", help="keep the real one's answers for tests without it")
    options = parser.parse_args()
    built = real.installed()
    if built is None:
        parser.error(
            f"{real.VARIABLE} is not a folder with a real cFE; dev/twin/api/real.py describes how to build one"
        )
    release = release_of(built)
    totals: Counter[str] = Counter()
    found = 0
    for seed in range(options.seed, options.seed + options.scripts):
        script = write_script(seed, options.count, options.kind)
        answers = real.play(built, script)
        if options.record:
            write_record(Record(release, seed, options.count, options.kind), answers)
        unlike = differences(script, answers, twin.play(script, release))
        found += len(unlike)
        totals += counts(script)
        print(f"seed {seed}: {len(unlike)} differences", *unlike, sep="\n")
    print(f"{totals.total()} calls, {found} differences:", *(f"{name} {count}" for name, count in totals.most_common()))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
