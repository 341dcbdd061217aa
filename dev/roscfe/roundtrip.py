"""Messages to C++ and back: each type's random messages, decoded and encoded again, must be genpy's bytes.

    python -m dev.roscfe.roundtrip --messages 10000 --types 250 --profile host strict --genpy

Each type is a run of one generated program, which knows them all. With `--genpy`, real genpy reads and writes the same
messages beside it (Debian's python3-genpy). Without it, the bytes come from cfepy's own codec, which other tests
compare with genpy.
"""

from __future__ import annotations

import argparse
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.capacities import Capacities
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import HERE, ROSCPP, TARGETS, Target, compile_program
from dev.roscfe.random_messages import LIBRARY, Source, all_types, capacities

FOLDER = Path(__file__).parent
IN_ONE_FILE = 40  # types
BATCH = 2500  # messages that one process is sent
ROS_PYTHON = "/usr/bin/python3"
MAIN = """
#include "roundtrip.h"

#include <cstdlib>
#include <cstring>
#include <new>

std::size_t g_allocated = 0;

void *operator new(std::size_t size)
{
    g_allocated += size;
    return std::malloc(size);
}
void operator delete(void *memory) noexcept
{
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept
{
    std::free(memory);
}

namespace roscfe
{
void refuse(const char *what, const char *detail)
{
    std::fprintf(stderr, "%%s: %%s\\n", what, detail);
    std::abort();
}
}

%s

int main(int count, char **arguments)
{
    const Codec *const all[] = {%s};
    for (const Codec *codecs : all)
        for (const Codec *codec = codecs; codec->name; ++codec)
            if (count == 2 && !std::strcmp(codec->name, arguments[1]))
            {
                codec->run();
                return 0;
            }
    return 2;
}
"""


class Answer(NamedTuple):
    """Answer of the program to a frame."""

    good: bool
    allocated: int
    """Bytes that reading it took from the heap."""
    octets: bytes


class Reader:
    """Decodes frames and encodes them again, in a separate process for each type."""

    def command(self, full_name: str) -> Sequence[str]:
        """Return the command for a type."""
        raise NotImplementedError

    def answers(self, full_name: str, frames: Sequence[bytes]) -> list[Answer]:
        """Return the answers to frames."""
        given = b"".join(struct.pack("<I", len(frame)) + frame for frame in frames)
        done = subprocess.run(self.command(full_name), input=given, capture_output=True, check=False)
        assert done.returncode == 0, f"{full_name}: {done.stderr.decode(errors='replace')[:3000]}"
        answers = list(_answers(done.stdout))
        assert len(answers) == len(frames), full_name
        return answers

    def differing(self, full_name: str, frames: Sequence[bytes]) -> list[tuple[bytes, Answer]]:
        """Return the frames that come back changed, with their answers."""
        answers = zip(frames, self.answers(full_name, frames), strict=True)
        return [(frame, answer) for frame, answer in answers if not answer.good or answer.octets != frame]


class Genpy(Reader):
    """Real genpy.

    Args:
        folder: for the definitions.
    """

    def __init__(self, folder: Path) -> None:
        self._text = folder / "definition.txt"

    def command(self, full_name: str) -> Sequence[str]:
        self._text.write_text(LIBRARY.full_text(full_name), encoding="utf-8")
        return [ROS_PYTHON, str(FOLDER / "genpy_frames.py"), full_name, str(self._text)]


class Program(Reader):
    """The program, compiled for some types in one profile.

    Args:
        folder: folder in which it is made.
        types: full names of messages.
        profile: profile of the messages.
        flags: flags of the compiler.
        target: the target computer.
        longest: capacities for the strict profile.
        roscpp: use Debian's headers of ROS instead of cfepy's.
    """

    def __init__(
        self,
        folder: Path,
        types: Sequence[str],
        profile: Profile,
        *flags: str,
        target: Target = HERE,
        longest: Capacities | None = None,
        roscpp: bool = False,
    ) -> None:
        headers = folder / "headers"
        write_headers(types, headers, profile, LIBRARY, longest or capacities())
        sources = [folder / "main.cpp"]
        for at in range(0, len(types), IN_ONE_FILE):
            sources.append(folder / f"types_{at}.cpp")
            sources[-1].write_text(_codecs(f"codecs_{at}", types[at : at + IN_ONE_FILE]), encoding="utf-8")
        names = [source.stem.replace("types", "codecs") for source in sources[1:]]
        declared = "\n".join(f"extern const Codec {name}[];" for name in names)
        sources[0].write_text(MAIN % (declared, ", ".join(names)), encoding="utf-8")
        made = folder / "program"
        if roscpp:
            given = (f"-I{FOLDER}", "-DROSCPP", *flags)
            compile_program(made, sources, *given, base=("-std=c++17",), include=(), libraries=ROSCPP)
        else:
            compile_program(made, sources, f"-I{headers}", f"-I{FOLDER}", *flags, target=target)
        self._command = [*target.runner, str(made)]

    def command(self, full_name: str) -> Sequence[str]:
        return [*self._command, full_name]


def frames_of(full_name: str, count: int, seed: int = 0) -> list[bytes]:
    """Return the bytes of random messages, the first of them empty."""
    source = Source(hash_of(full_name) + seed, capacities())
    empty = LIBRARY.message_class(full_name)().__pack__()
    return [empty, *(source.message(full_name).__pack__() for _ in range(count - 1))]


def hash_of(text: str) -> int:
    """Return a number that a text has in each run."""
    return int.from_bytes(text.encode()[-8:], "big")


def _codecs(name: str, types: Sequence[str]) -> str:
    lines = ['#include "roundtrip.h"', *(f"#include <{each}.h>" for each in types), ""]
    lines += [f"extern const Codec {name}[];", f"const Codec {name}[] = {{"]
    lines += [f'    {{"{each}", run<{each.replace("/", "::")}>}},' for each in types]
    return "\n".join([*lines, "    {nullptr, nullptr}};", ""])


def _answers(octets: bytes) -> Iterator[Answer]:
    at = 0
    while at < len(octets):
        good, allocated, count = struct.unpack_from("<BII", octets, at)
        at += 9
        yield Answer(bool(good), allocated, octets[at : at + count])
        at += count


def main(arguments: list[str]) -> int:
    """Send messages of all types through the programs, and print how many came back changed."""
    parser = argparse.ArgumentParser(prog="python -m dev.roscfe.roundtrip", description=main.__doc__)
    parser.add_argument("--messages", type=int, default=200, metavar="N", help="of each type (default: 200)")
    parser.add_argument("--types", type=int, metavar="N", help="so many types, from the whole list (default: all)")
    parser.add_argument("--profile", nargs="+", choices=["host", "strict"], default=["host", "strict"])
    parser.add_argument("--target", choices=list(TARGETS), default="here", help="target of the programs")
    parser.add_argument("--genpy", action="store_true", help="let real genpy read and write the same messages")
    given = parser.parse_args(arguments)
    every = all_types()
    types = [every[at * len(every) // given.types] for at in range(given.types)] if given.types else every
    with tempfile.TemporaryDirectory() as scratch:
        readers: dict[str, Reader] = {}
        for profile in given.profile:
            (folder := Path(scratch) / profile).mkdir()
            target = TARGETS[given.target]
            readers[f"{given.target}, {profile}"] = Program(folder, types, Profile(profile), "-O1", target=target)
        if given.genpy:
            readers["genpy"] = Genpy(Path(scratch))
        wrong = dict.fromkeys(readers, 0)
        sent = octets = 0
        for number, name in enumerate(types, 1):
            for start in range(0, given.messages, BATCH):
                frames = frames_of(name, min(BATCH, given.messages - start), seed=start)
                sent, octets = sent + len(frames), octets + sum(map(len, frames))
                for reader, what in readers.items():
                    found = what.differing(name, frames)
                    wrong[reader] += len(found)
                    for frame, answer in found[:1]:
                        print(f"{reader}: {name}: {frame.hex()} came back as {answer}", flush=True)
            if number % 50 == 0 or number == len(types):
                print(f"{number:,} types, {sent:,} messages, {octets:,} bytes; differing: {wrong}", flush=True)
    return 1 if any(wrong.values()) else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
