"""`python -m dev.fuzz.bit_flips FORMAT ... --count 10000 --seed N`: recordings with a bit that has flipped.

Each is read and recovered as `cfepy rosbag recover` does it. Only cfepy's own error may result, and all messages that
end before the bit must be kept. In a compressed file, these are the messages of chunks that end before it.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from cfepy.ground.recording import rewrite
from cfepy.status import UsageError
from dev.fuzz.recordings import FORMATS, placed_messages, read, written


@dataclass
class Flips:
    """Totals: recordings without any recovered message, messages recovered and lost, and failures."""

    count: int
    messages: int = 0
    lost: int = 0
    refused: int = 0
    failures: list[str] = field(default_factory=list)


def flips_of(file: Path, folder: Path, count: int, seed: int) -> Flips:
    """Recover damaged copies of a recording.

    Args:
        file: the recording.
        folder: for the copies.
        count: how many.
        seed: of the bits.
    """
    whole, placed, draw = file.read_bytes(), placed_messages(file), random.Random(seed)
    bad, out, found = folder / f"bad{file.suffix}", folder / f"left{file.suffix}", Flips(count)
    said = Counter(message for _, message in placed)
    for _ in range(count):
        spot, bit = draw.randrange(len(whole)), draw.randrange(8)
        data = bytearray(whole)
        data[spot] ^= 1 << bit
        bad.write_bytes(data)
        left: Counter[tuple[str, bytes, int]] = Counter()
        try:
            rewrite(str(bad), str(out))
            left = Counter(read(out))
        except UsageError:
            found.refused += 1
        except Exception as error:
            found.failures.append(f"bit {bit} of byte {spot}: {type(error).__name__}: {error}")
        lost = said - left
        found.messages += left.total()
        found.lost += lost.total()
        missing = Counter(message for end, message in placed if end <= spot) - left
        if missing:
            found.failures.append(f"bit {bit} of byte {spot}: {missing.total()} messages before it are lost")
    return found


def main() -> int:
    """Execute the command line. Returns exit status 1 if a case failed."""
    names = {f"{kind}{suffix}": (suffix, kind) for suffix, kind in FORMATS}
    parser = argparse.ArgumentParser(prog="python -m dev.fuzz.bit_flips", description=__doc__)
    parser.add_argument("formats", nargs="*", metavar="FORMAT", help=f"all if none is given: {', '.join(names)}")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    failed = False
    for name in chosen.formats or names:
        begun = time.monotonic()
        with TemporaryDirectory() as folder:
            found = flips_of(written(Path(folder), *names[name]), Path(folder), chosen.count, chosen.seed)
        failed = failed or bool(found.failures)
        print(
            f"{name}: {found.count:,} flips, {len(found.failures)} failures, nothing left of {found.refused:,}; "
            f"{found.messages:,} messages left, {found.lost / found.count:.2f} lost a flip, "
            f"{time.monotonic() - begun:.0f} s",
            flush=True,
        )
        for line in found.failures[:5]:
            print(f"  {line}", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
