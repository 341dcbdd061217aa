"""The fuzz driver of the interface library: it is compiled with sanitizers, and flown over the packets of an area."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.message_headers import Profile
from dev.roscfe.alone import Alone
from dev.roscfe.fuzz.corpus import entry, write_corpus

FOLDER = Path(__file__).parent
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize=vptr", "-fno-sanitize-recover=all")
FLAGS = ("-O1", "-g1", f"-I{FOLDER}", *SANITIZERS)
ARENA_BYTES = 8 << 20
MOST_GROWTH = 1 << 18
"""Bytes that the second half of the packets may add: the longest message so far may come late."""


class Flight(NamedTuple):
    """A flight over an area.

    Attributes:
        status: the exit status; 0 if all packets came and no sanitizer found anything.
        figures: counters by name, such as "accepted".
        digest: of all packets, as a hexadecimal number.
        errors: the standard error.
    """

    status: int
    figures: dict[str, int]
    digest: str
    errors: str


class Driver:
    """The driver of a profile, compiled once.

    Args:
        folder: an empty folder for the program.
        profile: the profile of the library.
        flags: flags of the compiler.
    """

    def __init__(self, folder: Path, profile: Profile, flags: tuple[str, ...] = FLAGS) -> None:
        sources = sorted(FOLDER.glob("*.cpp"))
        main = FOLDER / "node.cpp"
        arena = () if profile is Profile.HOST else (f"-DROSCFE_ARENA_BYTES={ARENA_BYTES}",)
        self._alone = Alone(folder, sources, profile=profile, flags=(*flags, *arena))
        self._folder = folder
        self._program = self._alone.program(main, *(each for each in sources if each != main), entry=entry())

    def fly(self, area: str, packets: int, seed: int = 1, timeout_s: float = 3600) -> Flight:
        """Fly over packets of an area.

        Args:
            area: one of `dev.roscfe.fuzz.corpus.AREAS`.
            packets: their number.
            seed: of the random numbers.
            timeout_s: seconds of wall time.
        """
        corpus = self._folder / f"{area}.corpus"
        write_corpus(area, corpus)
        environ = {
            "FUZZ_AREA": area,
            "FUZZ_SEED": str(seed),
            "FUZZ_PACKETS": str(packets),
            "FUZZ_CORPUS": str(corpus),
            "ASAN_OPTIONS": "detect_leaks=0:detect_stack_use_after_return=1",
            "UBSAN_OPTIONS": "print_stacktrace=1",
        }
        done = self._alone.run(self._program, environ=environ, timeout_s=timeout_s)
        words = dict(line.split() for line in done.stdout.splitlines() if line.count(" ") == 1)
        digest = words.pop("digest", "")
        return Flight(done.returncode, {name: int(value) for name, value in words.items()}, digest, done.stderr)


def faults(flight: Flight) -> list[str]:
    """Return the findings of a flight: an end before its time, or memory that grows."""
    if flight.status:
        return [f"ended with {flight.status}: {flight.errors[-3000:]}"]
    growth = flight.figures["growth"]
    return [f"{growth:,} more bytes are in use than after half of the packets"] if growth > MOST_GROWTH else []
