"""`python -m dev.fuzz KIND ... --count 10000 --seed N`: many cases of each kind, within bounds of time and memory."""

from __future__ import annotations

import argparse
import resource
import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from dev.fuzz.kinds import KINDS
from dev.fuzz.runs import Failed, failures

PATIENCE_S = 5.0
MEMORY = 500 << 20  # bytes, in addition to the interpreter's memory at the start


def main() -> int:
    """Execute the command line. Returns exit status 1 if a case failed."""
    parser = argparse.ArgumentParser(prog="python -m dev.fuzz", description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"all when none is given: {', '.join(KINDS)}")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--save", metavar="DIR", help="keep the inputs that fail there")
    parser.add_argument("--shown", type=int, default=5, help="how many different failures of a kind are shown")
    chosen = parser.parse_args()
    failed = 0
    for name in chosen.kinds or KINDS:
        KINDS[name].samples()  # before the limits apply, because this may fly a mission
        _limit_memory()
        failed += _do(name, chosen)
    return 1 if failed else 0


def _do(name: str, chosen: argparse.Namespace) -> int:
    """Run all cases of a kind. Returns the number of failures."""
    begun, seen = time.monotonic(), Counter[str]()
    with TemporaryDirectory() as folder:
        for each in failures(name, chosen.count, chosen.seed, Path(folder), PATIENCE_S):
            seen[_cause(each)] += 1
            if seen[_cause(each)] == 1 and len(seen) <= chosen.shown:
                print(f"{name} {each.seed}:{each.number} {each.data[:200]!r}\n{each.what}", flush=True)
                if chosen.save:
                    Path(chosen.save, f"{name}-{each.number}").write_bytes(each.data)
    took = time.monotonic() - begun
    print(
        f"{name}: {chosen.count:,} cases, {sum(seen.values())} failures of {len(seen)} causes, {took:.0f} s", flush=True
    )
    return len(seen)


def _cause(failed: Failed) -> str:
    """Return the location and the error of a failure. Failures of one cause are counted together."""
    lines = failed.what.strip().split("\n")
    places = [line.strip() for line in lines if line.startswith('  File "')]
    return f"{places[-1] if places else ''} {lines[-1].partition(':')[0]}"


def _limit_memory() -> None:
    """Limit the memory that this process may allocate from now on. A case that needs more fails."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0])
    limit = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))


if __name__ == "__main__":
    sys.exit(main())
