"""`python -m benchmarks.library_sizes`: the cost of the interface library for C++, for docs/reference/roscfe.md.

It adds up all object files of each part, at -Os, as `size` reports them: read-only memory (code, constants, tables for
exceptions) and writable memory (initialised or not). The arena of a node is not counted. The linker leaves out parts
that a node does not use, and adds the parts of the C++ library that it does use.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks.message_sizes import COMPILERS
from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import (
    HEAP_SOURCE,
    BuildOptions,
    core_flags,
    library_folder,
    library_includes,
    profile_flags,
)
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.message_headers import Profile, write_headers
from rospy_shim.types.msgs import shipped

FLAGS = ("-std=c++17", "-Os", "-ffunction-sections", "-fdata-sections", "-w")
ARENA = 65536  # bytes
PROFILES = (Profile.HOST, Profile.POOL, Profile.STRICT)


def parts() -> dict[str, list[Path]]:
    """Return the sources by part: the core, and the libraries beside it."""
    folder = library_folder() / "src"
    found: dict[str, list[Path]] = {"core": sorted(folder.glob("*.cpp"))}
    found |= {each.name: sorted(each.glob("*.cpp")) for each in sorted(folder.iterdir()) if each.is_dir()}
    return {name: sources for name, sources in found.items() if sources}


def sizes(sources: Sequence[Path], profile: Profile, compiler: Sequence[str], folder: Path) -> tuple[int, int]:
    """Return bytes of read-only and of writable memory that sources take together."""
    messages = folder / "messages"
    write_headers(message_types(collect(sources, library_includes()).missing, shipped()), messages, profile, shipped())
    include = [f"-I{each}" for each in (messages, *library_includes())] + ["-isystem", str(headers_folder())]
    flags = [
        *FLAGS,
        *profile_flags(BuildOptions(profile)),
        *core_flags(BuildOptions(profile)),
        f"-DROSCFE_ARENA_BYTES={ARENA}",
    ]
    objects = []
    for source in sources:
        objects.append(folder / f"{source.stem}.o")
        subprocess.run([*compiler, *flags, *include, "-c", str(source), "-o", str(objects[-1])], check=True)
    size = shutil.which(compiler[0].replace("g++", "size")) or "size"
    table = subprocess.run([size, *map(str, objects)], capture_output=True, text=True, check=True).stdout
    rows = [list(map(int, line.split()[:3])) for line in table.splitlines()[1:]]
    has_arena = profile is not Profile.HOST and any(source.name == HEAP_SOURCE for source in sources)
    return sum(row[0] for row in rows), sum(row[1] + row[2] for row in rows) - has_arena * ARENA


def table() -> str:
    """Return the table, a part in a row."""
    columns = [(target, profile) for target in COMPILERS for profile in PROFILES]
    lines = ["| part | " + " | ".join(f"{target}, {profile}" for target, profile in columns) + " |"]
    lines.append("|---" * (len(columns) + 1) + "|")
    for name, sources in parts().items():
        cells = []
        for target, profile in columns:
            with tempfile.TemporaryDirectory() as scratch:
                code, memory = sizes(sources, profile, COMPILERS[target], Path(scratch))
            cells.append(f"{code:,} / {memory:,}")
            print(f"{name}: {target}, {profile}", file=sys.stderr)
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
